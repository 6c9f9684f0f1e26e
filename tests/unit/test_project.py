"""The project itself: what may import what, what the lock files hold, and that a wheel is complete."""

import ast
import inspect
import os
import re
import subprocess
import sys
import tomllib
import zipfile
from collections.abc import Iterator
from importlib.metadata import packages_distributions, version
from pathlib import Path

import pytest
from packaging.markers import Marker
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import navcore
from navcore.foundation.assets import asset_path, assets_folder

LOCKS = (
    "requirements/run.lock",
    "requirements/build.lock",
    "requirements/test.lock",
    "requirements/docs.lock",
    "requirements/supply.lock",
    "requirements/benchmarks.lock",
)
TOP_LEVEL = {
    *("app", "assets", "deploy", "docs", "examples", "navcore", "requirements", "tests", "tools", ".ci"),
    *(
        "CHANGELOG.md",
        "CONTRIBUTING.md",
        "SECURITY.md",
        "Dockerfile",
        "LICENSE",
        "Makefile",
        "README.md",
        "pyproject.toml",
    ),
    *(".dockerignore", ".gitattributes", ".gitignore"),
}
PACKAGES = {"app": "schuler_bench", "navcore": "navcore"}
"""Folders of the checkout, and the name by which each is imported."""
NEVER_IN_NAVCORE = {*PACKAGES, "plotly", "viser"} - {"navcore"}
HEAVY = {"control", "joblib", "matplotlib", "pandas", "plotly", "pyarrow", "rich", "scipy"}
LONGEST_MODULE = 400


def tracked_files(root: Path) -> list[Path]:
    """Files that are in git, and new ones that it does not ignore."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=root,
        capture_output=True,
        text=True,
    )
    if listed.returncode != 0:
        pytest.skip("not a git checkout")
    return [root / name for name in listed.stdout.split("\0") if name and (root / name).is_file()]


def modules(root: Path, *packages: str) -> list[Path]:
    """Python files of some packages."""
    return sorted(path for package in packages for path in (root / package).rglob("*.py"))


def imported(tree: ast.AST) -> Iterator[str]:
    """First names of all absolute imports below a node."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            yield node.module.split(".")[0]


def imported_on_loading(tree: ast.AST) -> Iterator[str]:
    """Like `imported`, without what lies inside functions or under ``if TYPE_CHECKING``."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda):
            continue
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            continue
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield from imported(ast.Module([node], []))
        yield from imported_on_loading(node)


def test_navcore_imports_nothing_of_the_dashboard(repo_root: Path):
    files = modules(repo_root, "navcore")
    assert files
    offending = {
        (path.name, name)
        for path in files
        for name in imported(ast.parse(path.read_text("utf-8")))
        if name in NEVER_IN_NAVCORE
    }
    assert not offending


def test_loading_navcore_loads_nothing_of_the_dashboard(repo_root: Path):
    names = [
        ".".join(path.relative_to(repo_root).with_suffix("").parts)
        for path in modules(repo_root, "navcore")
        if path.name not in ("__init__.py", "__main__.py")
    ]
    code = f"import importlib, sys\nfor name in {names!r}: importlib.import_module(name)\nprint(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], cwd=repo_root, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    loaded = {name.split(".")[0] for name in done.stdout.split()}
    assert "navcore" in loaded
    assert not loaded & NEVER_IN_NAVCORE


def test_heavy_packages_are_imported_where_they_are_used(repo_root: Path):
    offending = set()
    for path in modules(repo_root, "app", "navcore"):
        names = set(imported_on_loading(ast.parse(path.read_text("utf-8"))))
        # viser loads rich itself: beside viser it costs nothing more.
        free = {"rich"} if "viser" in names else set()
        offending |= {(str(path.relative_to(repo_root)), name) for name in (names & HEAVY) - free}
    assert not offending


@pytest.mark.parametrize(
    ("names", "unwanted"),
    [
        ("schuler_bench.cli", HEAVY | {"viser"}),
        ("navcore.analysis, navcore.networks.discrete", HEAVY | {"numba"}),
        # numba itself loads the bare scipy package
        (
            "schuler_bench.views.frequency.figure, schuler_bench.views.poles.figure, "
            "schuler_bench.views.step.figure, schuler_bench.views.errors.figure, "
            "schuler_bench.views.scene.track, schuler_bench.views.metrics.table, schuler_bench.plots.legend",
            HEAVY - {"scipy"} | {"viser", "scipy.linalg", "scipy.signal"},
        ),
    ],
    ids=["command", "loop", "figures"],
)
def test_it_starts_light(names: str, unwanted: set[str]):
    code = f"import sys, {names}; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.split())
    assert set(names.split(", ")) <= loaded and not loaded & unwanted


def test_imports_are_told_apart():
    tree = ast.parse(
        "import numpy, schuler_bench.cli\nfrom scipy.signal import bode\nfrom . import x\n"
        "if TYPE_CHECKING:\n    import pandas\ndef f():\n    import control\n"
        "try:\n    import rich\nfinally:\n    pass"
    )
    assert set(imported(tree)) == {"numpy", "schuler_bench", "scipy", "pandas", "control", "rich"}
    assert set(imported_on_loading(tree)) == {"numpy", "schuler_bench", "scipy", "rich"}


def test_modules_are_short(repo_root: Path):
    lengths = {
        str(path.relative_to(repo_root)): len(path.read_text("utf-8").splitlines())
        for path in modules(repo_root, "app", "navcore", "tests", "tools")
    }
    assert {name: length for name, length in lengths.items() if length >= LONGEST_MODULE} == {}


def test_public_names_are_no_modules():
    """A name that is also a module's turns into that module once the module is loaded."""
    code = (
        "import navcore, types\n"
        "first = [getattr(navcore, name) for name in navcore.__all__]\n"
        "again = [getattr(navcore, name) for name in navcore.__all__]\n"
        "print([n for n, a, b in zip(navcore.__all__, first, again)"
        " if a is not b or isinstance(b, types.ModuleType)])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.stdout.strip() == "[]", done.stdout + done.stderr


def test_every_parameter_of_a_public_function_is_in_its_docstring():
    names = getattr(navcore, "__all__", None) or list(vars(navcore))
    public = {name: getattr(navcore, name) for name in names}
    functions = {name: value for name, value in public.items() if inspect.isfunction(value)}
    assert "simulate" in functions
    missing = [
        f"navcore.{name}: {parameter}"
        for name, function in functions.items()
        for parameter in inspect.signature(function).parameters
        if not re.search(rf"\b{parameter}\b", inspect.getdoc(function) or "")
    ]
    assert not missing


def test_top_level_is_the_agreed_one(repo_root: Path):
    found = {path.relative_to(repo_root).parts[0] for path in tracked_files(repo_root)}
    assert found <= TOP_LEVEL


def test_no_file_holds_an_index_address_or_a_path_of_this_machine(repo_root: Path):
    # In two pieces, or this file would be found.
    hosts = [
        "py" + "pi.org",
        "python" + "hosted.org",
        "np" + "mjs.org",
        "deb." + "debian.org",
        "ana" + "conda.org",
    ]
    paths = [r"/ro" + r"ot/\.", r"/ho" + r"me/\w+/", r"/Us" + r"ers/\w+/", re.escape(str(repo_root)) + r"\b"]
    sought = re.compile("|".join([*map(re.escape, hosts), *paths]))
    files = tracked_files(repo_root)
    assert len(files) > 10
    found = {
        (path.name, hit[0])
        for path in files
        for hit in [sought.search(path.read_text("utf-8", errors="replace"))]
        if hit
    }
    assert not found


def locked(root: Path, lock: str) -> dict[str, list[Requirement]]:
    """Pinned requirements of a lock file by name, after a look at its form."""
    text = (root / lock).read_text("utf-8").replace("\\\n", " ")
    entries: dict[str, list[Requirement]] = {}
    for line in text.splitlines():
        pin, *hashes = re.split(r"\s+--hash=", line.strip())
        assert hashes, f"{lock}: no hash: {line}"
        assert all(re.fullmatch(r"sha256:[0-9a-f]{64}", hash_) for hash_ in hashes)
        requirement = Requirement(pin)
        assert re.fullmatch(r"==[\w.]+", str(requirement.specifier)), f"{lock}: not pinned: {pin}"
        assert requirement.url is None
        entries.setdefault(requirement.name, []).append(requirement)
    return entries


def applies(requirement: Requirement, environment: dict[str, str]) -> bool:
    """Whether a requirement is for an environment."""
    return requirement.marker is None or Marker(str(requirement.marker)).evaluate(environment)


@pytest.mark.parametrize("lock", LOCKS)
def test_lock_holds_pins_and_hashes_and_nothing_else(repo_root: Path, lock: str):
    assert locked(repo_root, lock)
    assert "://" not in (repo_root / lock).read_text("utf-8")


@pytest.mark.parametrize(
    "platform", [("linux", "x86_64"), ("linux", "aarch64"), ("darwin", "x86_64"), ("darwin", "arm64")]
)
def test_locks_satisfy_what_the_project_asks_for(repo_root: Path, platform: tuple[str, str]):
    project = tomllib.loads((repo_root / "pyproject.toml").read_text("utf-8"))
    groups = project["dependency-groups"]
    extras = project["project"]["optional-dependencies"]
    runtime = project["project"]["dependencies"]
    asked_by = ("build", "test", "docs", "supply")
    per_lock = (runtime, *(groups[name] for name in asked_by), extras["benchmarks"])
    asked = dict(zip(LOCKS, per_lock, strict=True))
    environment = {"sys_platform": platform[0], "platform_machine": platform[1]}
    for lock, texts in asked.items():
        entries = locked(repo_root, lock)
        for requirement in map(Requirement, texts):
            if applies(requirement, environment):
                pins = [
                    str(pin.specifier)[2:]
                    for pin in entries.get(requirement.name, [])
                    if applies(pin, environment)
                ]
                assert len(pins) == 1, f"{lock}: {requirement.name} on {platform}: {pins}"
                assert requirement.specifier.contains(pins[0]), (
                    f"{lock}: {requirement} is locked to {pins[0]}"
                )


RUN_BY_NAME = {"axe-playwright-python", "basedpyright", "ipykernel", "pytest-timeout", "pytest-xdist", "ruff"}
"""Required by the tests and imported nowhere: programs, plugins of pytest, a script for the page, kernel."""


def test_imports_and_requirements_are_the_same_packages(repo_root: Path):
    """Nothing is used that only came along with another package, and nothing is required in vain."""
    project = tomllib.loads((repo_root / "pyproject.toml").read_text("utf-8"))
    extras = project["project"]["optional-dependencies"]
    extra = [text for name, texts in extras.items() if name != "benchmarks" for text in texts]
    required = {Requirement(text).name for text in project["project"]["dependencies"]}
    runtime = required | {Requirement(text).name for text in extra}
    testing = {Requirement(text).name for text in project["dependency-groups"]["test"]}
    known = {*sys.stdlib_module_names, "docs", "examples", "navcore", "schuler_bench", "tests", "tools"}
    providers = packages_distributions()
    used: set[str] = set()
    for packages, asked in (
        (("app", "navcore", "examples"), runtime),
        (("tests", "tools"), runtime | testing),
    ):
        for path in modules(repo_root, *packages):
            for name in set(imported(ast.parse(path.read_text("utf-8")))) - known:
                owners = {canonicalize_name(found) for found in providers.get(name, (name,))}
                assert asked & owners, f"{path.relative_to(repo_root)} imports {name}"
                used |= owners
        assert required <= used, "required and imported nowhere"
    assert testing - used == RUN_BY_NAME


def test_locks_agree_with_each_other(repo_root: Path):
    pins: dict[str, set[str]] = {}
    for lock in LOCKS:
        for name, requirements in locked(repo_root, lock).items():
            pins.setdefault(name, set()).add(" ".join(sorted({str(r.specifier) for r in requirements})))
    assert {name: found for name, found in pins.items() if len(found) > 1} == {}


def test_build_lock_covers_the_build_backend(repo_root: Path):
    project = tomllib.loads((repo_root / "pyproject.toml").read_text("utf-8"))
    assert set(project["build-system"]["requires"]) == set(project["dependency-groups"]["build"])


def test_version_is_told_once(repo_root: Path):
    assert version("schuler-bench") == navcore.__version__
    heading = re.search(r"^## (\S+)", (repo_root / "CHANGELOG.md").read_text("utf-8"), re.MULTILINE)
    assert heading
    assert heading[1] == navcore.__version__


def test_assets_are_found_and_nothing_outside_them(repo_root: Path):
    assert assets_folder() == repo_root / "assets"
    assert asset_path("presets") == repo_root / "assets" / "presets"
    for name in (
        "../pyproject.toml",
        "presets/../../LICENSE",
        str(repo_root / "LICENSE"),
        "",
        "nothing.toml",
        "a\0b",
    ):
        with pytest.raises(FileNotFoundError, match="no asset"):
            asset_path(name)


@pytest.fixture(scope="module")
def wheel(repo_root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Wheel built from the checkout, without network."""
    folder = tmp_path_factory.mktemp("wheel")
    command = [
        "wheel",
        "--quiet",
        "--no-deps",
        "--no-index",
        "--no-build-isolation",
        f"--wheel-dir={folder}",
        ".",
    ]
    done = subprocess.run(
        [sys.executable, "-m", "pip", *command], cwd=repo_root, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    [built] = folder.glob("*.whl")
    return built


def test_wheel_holds_code_and_assets_and_no_tests(repo_root: Path, wheel: Path):
    names = set(zipfile.ZipFile(wheel).namelist())
    for path in modules(repo_root, *PACKAGES):
        folder, *below = path.relative_to(repo_root).parts
        assert "/".join((PACKAGES[folder], *below)) in names
    for path in (p for p in (repo_root / "assets").rglob("*") if p.is_file()):
        assert f"navcore/_assets/{path.relative_to(repo_root / 'assets').as_posix()}" in names
    tops = {name.split("/")[0] for name in names}
    assert tops == {*PACKAGES.values(), f"schuler_bench-{navcore.__version__}.dist-info"}


def test_assets_are_found_in_an_installed_wheel(wheel: Path, tmp_path: Path):
    zipfile.ZipFile(wheel).extractall(tmp_path)
    code = "from navcore.foundation.assets import asset_path; print(asset_path('presets'))"
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert Path(done.stdout.strip()) == tmp_path / "navcore" / "_assets" / "presets"
