"""What the tests are made with: Chromium, audit, mutations, points of the page; the memory of a server."""

import ast
import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.browser.driver import SIZES
from tests.browser.windows.conftest import LOCALES, RUNS
from tools import chromium, fonts
from tools.mutation.equivalent import is_equivalent, listed
from tools.mutation.mutants import changed, mutants_of
from tools.mutation.planted import Planted, planted
from tools.mutation.results import ROOT, sample
from tools.mutation.rooms import ROOMS
from tools.supply import UNREACHABLE, VULNERABLE, judged

# ---------------------------------------------------------------- where a Chromium is looked for


def stand_in(folder: Path, name: str, script: str = "exit 0") -> Path:
    """Executable of some name."""
    path = folder / name
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return path


@pytest.fixture
def empty_machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """Nothing on the PATH, nothing of playwright's, not root; the only folder of the PATH."""
    monkeypatch.delenv("SCHULER_CHROMIUM", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(chromium, "_playwrights_own", lambda: None)
    monkeypatch.setattr("os.geteuid", lambda: 1000)
    return tmp_path


def test_the_named_one_goes_before_the_systems(empty_machine: Path, monkeypatch: pytest.MonkeyPatch):
    system, own = stand_in(empty_machine, "chromium-browser"), stand_in(empty_machine, "my-own")
    assert chromium.provide_chromium() == (system, "found")
    for named, path in ((own, own), (empty_machine / "missing", None)):
        monkeypatch.setenv("SCHULER_CHROMIUM", str(named))
        assert chromium.find_chromium() == path


def test_root_gets_it_from_the_distribution(empty_machine: Path, monkeypatch: pytest.MonkeyPatch):
    target = empty_machine / "chromium"
    stand_in(empty_machine, "apt-get", f"test $1 = update || /bin/cp {empty_machine}/apt-get {target}")
    monkeypatch.setattr("os.geteuid", lambda: 0)
    assert chromium.provide_chromium() == (target, "installed by apt-get install chromium")


def test_fonts_are_named_to_a_user_and_installed_for_root(
    empty_machine: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(fonts, "_FOLDERS", (str(empty_machine),))
    families, command = ", ".join(fonts.FONTS), "apt-get install fonts-liberation fonts-dejavu-core"
    told = fonts.provide_fonts()
    assert told.startswith(f"no {families}") and command in told
    files = " ".join(f"> {empty_machine / file};" for file, _ in fonts.FONTS.values())
    stand_in(empty_machine, "apt-get", f"test $1 = update && exit\n{files}")
    monkeypatch.setattr("os.geteuid", lambda: 0)
    assert fonts.provide_fonts() == f"{families} (installed by {command})"
    assert fonts.provide_fonts() == f"{families} (found)"


def test_what_failed_is_told(empty_machine: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("sys.executable", str(stand_in(empty_machine, "python", "echo no way; exit 1")))
    path, how = chromium.provide_chromium()
    assert path is None and "playwright install chromium" in how and how.endswith("no way")


# ---------------------------------------------------------------- the audit


@pytest.mark.parametrize(
    ("flaws", "code", "line"),
    [
        ([], 0, "2 packages looked up, none is known to be vulnerable"),
        (
            [{"id": "PYSEC-1", "fix_versions": ["2.2"]}],
            VULNERABLE,
            "weak 2.1: PYSEC-1, mended in 2.2",
        ),
    ],
)
def test_a_vulnerable_package_is_named_with_its_mend(flaws: list[dict[str, object]], code: int, line: str):
    packages = [("sound", "1.0", []), ("weak", "2.1", flaws)]
    report = [{"name": name, "version": version, "vulns": bad} for name, version, bad in packages]
    assert judged(json.dumps({"dependencies": report}), "") == (code, [line])


@pytest.mark.parametrize("said", ["", "not json", "[]", '{"dependencies"'])
def test_no_report_is_no_clean_bill(said: str):
    code, lines = judged(said, "Traceback\nConnectionError: no route\n\n")
    assert code == UNREACHABLE
    assert lines[0].startswith("Nothing was looked up") and lines[1] == "ConnectionError: no route"


# ---------------------------------------------------------------- the points of tests/browser/windows


FIXTURES = {"window", "pinned", "visitor"}
"""Each gives a page in all windows and languages, one after the other."""
BOTH = {"language", "size"}


def asked_by(path: Path) -> dict[str, set[str]]:
    """Name of each function of a module and the fixtures it asks for."""
    functions = [n for n in ast.parse(path.read_text("utf-8")).body if isinstance(n, ast.FunctionDef)]
    return {function.name: {argument.arg for argument in function.args.args} for function in functions}


def test_every_point_has_a_test_in_all_windows_and_languages(repo_root: Path) -> None:
    folder = repo_root / "tests" / "browser" / "windows"
    points = tomllib.loads((folder / "points.toml").read_text("utf-8"))
    named = [test for part in points.values() for test in part.values()]
    assert len(named) >= 45
    tests = {
        f"{path.name}::{name}": asked
        for path in folder.glob("test_*.py")
        for name, asked in asked_by(path).items()
        if name.startswith("test_")
    }
    assert [test for test in named if not (tests[test] & FIXTURES or tests[test] >= BOTH)] == []
    assert set(tests) == set(named), "a test without its point"


def test_the_fixtures_take_all_windows_and_languages(repo_root: Path) -> None:
    path = repo_root / "tests" / "browser" / "windows" / "conftest.py"
    asked, text = asked_by(path), path.read_text("utf-8")
    assert "resized" in asked["window"] and "size" in asked["resized"] and "spoken" in asked["resized"]
    assert "language" in asked["spoken"] and asked["visitor"] >= BOTH
    assert text.count("params=SIZES") == 1 and text.count("params=tuple(LOCALES)") == 1
    assert set(RUNS) == {(language, size) for language in LOCALES for size in SIZES} and len(RUNS) == 6


# ---------------------------------------------------------------- the mutation run


def test_a_larger_sample_begins_with_the_smaller_one() -> None:
    small, large = (sample("mechanization", size, 1) for size in (5, 12))
    assert large[:5] == small and len(set(large)) == 12
    assert sample("mechanization", 5, 2) != small


def test_a_change_is_one_place() -> None:
    source = "a = b + 2.0 * c\nif a < -1.0 and b:\n    d = min(a, 3)\n"
    found = {changed(source, place) for place in range(8)}
    assert len(found) == 8
    for old, new in (("+", "-"), ("2.0", "2.2"), ("-", "+"), ("and", "or"), ("min", "max")):
        assert source.strip().replace(old, new) in found


def test_a_kept_value_a_refusal_and_a_doubt_are_changes_too(tmp_path: Path) -> None:
    source = "def f(s, a):\n    if not a:\n        return 0.5\n    s.kept = s.met[1] = True\n    s.met &= a\n"
    path = tmp_path / "source.py"
    path.write_text(source)
    found = {changed(source, one.place) for one in mutants_of(path, tmp_path)}
    for old, new in (
        ("if not a:", "if False:"),
        ("not a", "not not a"),
        ("s.kept = s.met[1] = True", "pass"),
        ("s.met &= a", "pass"),
    ):
        assert source.strip().replace(old, new) in found


@pytest.mark.parametrize("change", planted(), ids=lambda change: change.what)
def test_what_is_planted_stands_once_in_the_code_as_it_is(change: Planted) -> None:
    source = (ROOT / change.file).read_text("utf-8")
    ast.parse(change.applied(source))
    assert change.applied(source) != source and change.room in ROOMS


@pytest.mark.parametrize("entry", listed(), ids=lambda entry: f"{entry['file']}: {entry['what']}")
def test_the_list_names_changes_of_the_code_as_it_is(entry: dict[str, str]) -> None:
    same = [m for m in mutants_of(ROOT / entry["file"], ROOT) if is_equivalent(m, (entry,))]
    lines = {m.line for m in same}
    assert len(lines) == 1, f"{entry['what']!r} is a change of {len(lines)} lines of {entry['file']}"
    assert len(entry["why"]) > 30


# ---------------------------------------------------------------- the garbage collector of a server


_CHILD = """
import gc
from schuler_bench.memory import collect_seldom

lasting = [[number] for number in range(10_000)]
collect_seldom()
later = [[number] for number in range(10_000)]
seen = {id(one) for one in gc.get_objects()}
print(sum(id(one) in seen for one in lasting), sum(id(one) in seen for one in later))
"""


def test_only_what_came_later_is_looked_through():
    assert subprocess.check_output([sys.executable, "-c", _CHILD], text=True) == "0 10000\n"


_ARRAYS = """
import resource
import numpy as np
from schuler_bench.memory import keep_freed

def pages():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(20):
        np.ones(1 << 18)
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

apart = pages()
keep_freed()
print(apart, pages())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="other systems keep freed memory by rules of their own")
def test_memory_of_arrays_is_used_again_where_dask_gives_it_back():
    environment = os.environ | {"MALLOC_TRIM_THRESHOLD_": "65536"}
    told = subprocess.check_output([sys.executable, "-c", _ARRAYS], text=True, env=environment)
    apart, kept = map(int, told.split())
    assert apart > 15 * 512, "each of twenty arrays of 2 MiB came page by page"
    assert kept < 2 * 512, "the first one alone"
