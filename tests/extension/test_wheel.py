"""The wheel by itself: built, installed beside the locked requirements in a clean environment, and used.

Beside a user's own `app`, and installed as a wheel, by way of the source distribution, or as a checkout.
"""

import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile
from importlib.metadata import Distribution
from pathlib import Path

import pytest
from packaging.requirements import Requirement

pytestmark = pytest.mark.timeout(1800)
USED = """
from importlib.util import find_spec
from navcore import load, parse_network, simulate
assert find_spec("tests") is None
run = simulate(load("zha-fast", ["run.duration_h=0.1"]))
assert run.status == "ok" and len(run.figure("errors").data)
assert len(parse_network('id = "unity2"').figure("bode").data)
"""


FOREIGN = {"app.py": "app.py", "a package app": "app/__init__.py"}
"""A module or a package of the user's own."""
STUDY = """
import sys
from navcore import load, simulate
figure = simulate(load("zha-fast", ["run.duration_h=0.01"])).figure("errors")
assert len(figure.data) and "app" not in sys.modules
"""


def command(*arguments: str | Path, cwd: Path, **variables: str) -> str:
    """Run a program; return what it prints."""
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"} | variables
    line = [str(argument) for argument in arguments]
    ended = subprocess.run(line, cwd=cwd, env=clean, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stdout[-5000:] + ended.stderr[-5000:]
    return ended.stdout


@pytest.fixture(scope="module")
def wheel(repo_root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of this tree."""
    folder = tmp_path_factory.mktemp("wheel")
    command(sys.executable, "-m", "pip", "wheel", "--no-deps", "-w", folder, repo_root, cwd=folder)
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module", params=["wheel", "editable"])
def python(request: pytest.FixtureRequest, repo_root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Python of an environment with the packages of this one, in which the program is installed anew."""
    folder = tmp_path_factory.mktemp(request.param)
    pip = sys.executable, "-m", "pip"
    offline = "--no-deps", "--no-index", "--no-build-isolation"
    built = ["--editable", repo_root]
    if request.param == "wheel":
        command(sys.executable, "-m", "hatchling", "build", "-t", "sdist", "-d", folder, cwd=repo_root)
        (source,) = folder.glob("*.tar.gz")
        command(*pip, "wheel", *offline, "-w", folder, source, cwd=folder)
        built = list(folder.glob("*.whl"))
    command(sys.executable, "-m", "venv", "--without-pip", folder / "own", cwd=folder)
    (site,) = (folder / "own" / "lib").glob("python*/site-packages")
    (site / "shared.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    python = folder / "own" / "bin" / "python"
    command(*pip, "--python", python, "install", *offline, *built, cwd=folder)
    return python


def test_the_wheel_holds_kernels_that_were_compiled_into_the_package(repo_root: Path, tmp_path: Path) -> None:
    """Git ignores them; nothing else that it ignores may come along."""
    tree, code = tmp_path / "tree", "navcore/_kernels/kernels-0/navcore.module/module.kernel-0.py311.1.nbc"
    for name in ("pyproject.toml", "README.md", "LICENSE", ".gitignore"):
        tree.mkdir(exist_ok=True)
        shutil.copy(repo_root / name, tree)
    for held in (
        code,
        "navcore/foundation/version.py",
        "navcore/__pycache__/old.pyc",
        "app/__init__.py",
        "assets/a",
    ):
        (tree / held).parent.mkdir(parents=True, exist_ok=True)
        (tree / held).write_text('__version__ = "1"\n')
    command(sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", tmp_path, cwd=tree)
    (built,) = tmp_path.glob("*.whl")
    names = set(zipfile.ZipFile(built).namelist())
    assert code in names and "schuler_bench/__init__.py" in names
    assert not [name for name in names if name.endswith(".pyc")]


@pytest.mark.slow
@pytest.mark.parametrize("foreign", FOREIGN)
def test_an_app_of_the_users_own_changes_nothing(foreign: str, python: Path, tmp_path: Path) -> None:
    own = tmp_path / FOREIGN[foreign]
    own.parent.mkdir(exist_ok=True)
    own.write_text("raise SystemExit('the own app was imported')\n")
    (tmp_path / "study.py").write_text(STUDY)
    command(python, "study.py", cwd=tmp_path)
    checked = command(
        python.with_name("schuler"), "check", "zha-fast", cwd=tmp_path, PYTHONPATH=str(tmp_path)
    )
    assert "zha-fast" in checked


@pytest.mark.nightly
@pytest.mark.parametrize("version", ["3.11", "3.13"])
def test_the_wheel_works_in_a_clean_environment(
    version: str, wheel: Path, repo_root: Path, tmp_path: Path
) -> None:
    asked = ["-c", "import sys; print('%d.%d' % sys.version_info[:2])"]
    present = subprocess.run([f"python{version}", *asked], capture_output=True, text=True, check=False)
    if present.stdout.strip() != version:
        pytest.skip(f"this machine has no Python {version}")
    command(f"python{version}", "-m", "venv", tmp_path / "clean", cwd=tmp_path)
    python = tmp_path / "clean" / "bin" / "python"
    pip = python, "-m", "pip", "install", "--quiet"
    command(*pip, "--require-hashes", "-r", repo_root / "requirements/run.lock", cwd=tmp_path)
    command(*pip, "--no-deps", wheel, cwd=tmp_path)
    command(python, "-m", "pip", "check", cwd=tmp_path)
    (site,) = (tmp_path / "clean" / "lib").glob("python*/site-packages")
    (folder,) = site.glob("schuler_bench-*.dist-info")
    needed = {Requirement(line).name for line in Distribution.at(folder).requires or ()}
    assert {"plotly", "viser"} <= needed and not needed & {"matplotlib", "pytest", "playwright"}
    command(python, "-c", USED, cwd=tmp_path)
    schuler = tmp_path / "clean" / "bin" / "schuler"
    assert "zha-fast" in command(schuler, "presets", cwd=tmp_path)
    command(schuler, "run", "zha-fast", "--set", "run.duration_h=0.1", "--out", "out", cwd=tmp_path)
    assert (tmp_path / "out" / "metrics.json").is_file()
