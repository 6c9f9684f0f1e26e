"""The wheel by itself: built, installed beside the locked requirements in a clean environment, and used."""

import os
import subprocess
import sys
from importlib.metadata import Distribution
from pathlib import Path

import pytest
from packaging.requirements import Requirement

pytestmark = [pytest.mark.nightly, pytest.mark.timeout(1800)]
USED = """
from importlib.util import find_spec
from navcore import load, parse_network, simulate
assert find_spec("tests") is None
run = simulate(load("zha-fast", ["run.duration_h=0.1"]))
assert run.status == "ok" and len(run.figure("errors").data)
assert len(parse_network('id = "unity2"').figure("bode").data)
"""


def command(*arguments: str | Path, cwd: Path) -> str:
    """Run a program; return what it prints."""
    clean = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
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
