"""What people read: names from a file steer no terminal and no table. What a broken installation says."""

from __future__ import annotations

import csv
import errno
import io
import json
import logging
import subprocess
import sys
from pathlib import Path

import pytest

from navcore.foundation.cells import safe_cell
from navcore.foundation.visible import visible
from schuler_bench.cli import main
from schuler_bench.cli.carried_out import refused_by_the_system
from schuler_bench.cli.installed import missing
from schuler_bench.cli.progress import Bar
from schuler_bench.logs import begin_logging

ROOT = Path(__file__).resolve().parents[2]
NASTY = "\x1b]0;mine\x07\x1b[2J\r\x9b31m\u202eevil\u2028\nwarning: all is well"
SCENARIO = """schema = 1
title = {nasty}
source = {nasty}
[run]
duration_h = 0.1
[[requirement]]
quantity = "tilt_max_arcsec"
at_most = 30.0
[[method]]
name = {nasty}
damping = "external"
network = {{ id = "unity2" }}
[reference]
kind = "log"
"""
COMMANDS = [
    ["run"],
    ["check"],
    ["budget"],
    ["design", "--as-set", "--seeds", "2"],
    ["run", "--set", "method.0.network.xi=nonsense"],
    ["run", "--set", f"{NASTY}=1"],
]


def clean(text: str) -> bool:
    """Whether a text holds nothing that steers a terminal."""
    return all(letter == "\n" or visible(letter) == letter for letter in text)


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_names_from_a_scenario_do_nothing_to_the_terminal(
    command: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"ship{NASTY.replace('/', '')}.toml"
    path.write_text(SCENARIO.format(nasty=json.dumps(NASTY)))
    main([command[0], str(path), *command[1:]])
    told = capsys.readouterr()
    assert clean(told.out) and clean(told.err)
    assert "\\x1b" in told.out + told.err
    assert not any(line.startswith("warning: all is well") for line in (told.out + told.err).splitlines())


def test_json_keeps_the_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "ship.toml"
    path.write_text(SCENARIO.format(nasty=json.dumps(NASTY)))
    assert main(["run", str(path), "--json"]) == 0
    out = capsys.readouterr().out
    assert json.loads(out)["methods"][0]["name"] == NASTY and clean(out)


def test_the_bar_and_the_log_show_them_too(capsys: pytest.CaptureFixture[str]) -> None:
    with Bar(NASTY, show=True) as bar:
        bar._appear()
        assert bar._bar is not None and bar._bar[0].tasks[0].description == visible(NASTY)
    capsys.readouterr()
    log = logging.getLogger("schuler")
    before = log.handlers
    try:
        begin_logging("text")
        try:
            raise ValueError(NASTY)
        except ValueError:
            log.exception("the session %s is gone", NASTY)
        first, *rest = capsys.readouterr().err.splitlines()
    finally:
        log.handlers = before
    assert first == f"schuler: the session {visible(NASTY)} is gone"
    assert rest[0].startswith("Traceback") and clean("\n".join(rest))


@pytest.mark.parametrize("name", ['=HYPERLINK("http://x")', "+1", "-1", "@SUM(1)", "\t=1", "  =1", "＝1"])
def test_no_csv_file_holds_a_formula(name: str, tmp_path: Path) -> None:
    """The files of ``run --format csv`` held what the page's own exports had quoted."""
    path = tmp_path / "ship.toml"
    path.write_text(SCENARIO.format(nasty=json.dumps(name)))
    assert main(["run", str(path), "--out", str(tmp_path / "out"), "--format", "csv", "--json"]) == 0
    rows = csv.reader(io.StringIO((tmp_path / "out" / "timeseries.csv").read_text("utf-8"), newline=""))
    assert {row[0] for row in rows} == {"method", f"'{name}"} and safe_cell(name) == f"'{name}"
    assert safe_cell("bridge (10 s)") == "bridge (10 s)" and safe_cell(-1.5) == "-1.5" and safe_cell(-1) == -1


# ---------------------------------------------------------------- a broken installation


_COMMAND = "import sys\nfrom schuler_bench.cli import main\nsys.exit(main())"


def command(code: str, *arguments: str, **environment: str) -> tuple[int, list[str]]:
    """Exit code of the command after some code, and its lines on stderr."""
    words = [sys.executable, "-c", f"{code}\n{_COMMAND}"]
    done = subprocess.run([*words, *arguments], capture_output=True, text=True, cwd=ROOT, env=environment)
    assert done.stdout == ""
    return done.returncode, done.stderr.splitlines()


_WITHOUT = """
import sys
from importlib.abc import MetaPathFinder
class Without(MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name == {0!r}:
            raise ModuleNotFoundError("No module named {0}", name=name)
sys.meta_path.insert(0, Without())
"""


@pytest.mark.parametrize("package", ["tyro", "numpy", "pydantic", "navcore.foundation.cores"])
def test_a_missing_package_is_named(package: str) -> None:
    code, lines = command(_WITHOUT.format(package), "run", "zha-fast")
    assert (code, len(lines)) == (2, 1)
    assert lines[0].startswith("schuler: ") and f"No module named {package}" in lines[0]
    assert "pip install" in lines[0]


def test_what_is_missing_of_our_own_is_installed_anew() -> None:
    assert "--force-reinstall" in missing(ImportError("x", name="navcore.foundation"))
    assert "package numba cannot be loaded (x)" in missing(ImportError("x", name="numba.core"))


def test_a_foreign_navcore_is_named(tmp_path: Path) -> None:
    """It stood first on PYTHONPATH, and the command ended in a traceback."""
    (tmp_path / "navcore.py").write_text("")
    code, lines = command(f"import sys; sys.path.insert(0, {str(tmp_path)!r})", "--version")
    assert (code, len(lines)) == (2, 1)
    assert f"{tmp_path / 'navcore.py'} is loaded in place of {ROOT / 'navcore'}" in lines[0]


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (RuntimeError("can't start new thread"), "the system allows no further thread or process"),
        (BlockingIOError(errno.EAGAIN, "Resource temporarily unavailable"), "no further thread or process"),
        (MemoryError(), "the memory is used up"),
        (OSError(errno.EMFILE, "Too many open files", "x.csv"), "Too many open files: x.csv"),
    ],
)
def test_what_the_system_refuses_is_one_line(
    error: Exception, said: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """``schuler study`` under ``ulimit -u`` ended in a traceback."""

    def refusing(*_: object) -> None:
        raise error

    monkeypatch.setattr("navcore.study.study.run_points", refusing)
    assert main(["study", "latitudes", "--workers", "1", "--quiet"]) == 3
    told = capsys.readouterr().err
    assert told.startswith("schuler: stopped: ") and said in told and told.count("\n") == 1


def test_a_fault_of_the_program_is_not_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("navcore.scenario.file.load", lambda *_, **__: int("x"))
    with pytest.raises(ValueError, match="invalid literal"):
        main(["run", "zha-fast"])
    assert refused_by_the_system(RuntimeError("deque mutated")) == ""


# ---------------------------------------------------------------- the address of a cluster

NO_ADDRESSES = [
    "garbage",
    "tcp://x:0",
    "tcp://x:70000",
    "tcp://[::1]:99999",
    "tcp://[:::1]:80",
    "tcp://..:80",
]


@pytest.mark.parametrize("address", [*NO_ADDRESSES, f"tcp://{'a' * 100}:80", "tcp://a b:80", "tcp://x:80\n"])
def test_what_can_be_no_address_is_refused_at_once(address: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Some were a traceback, others ten seconds of waiting."""
    for words in (["study", "latitudes", "--scheduler"], ["serve", "--cluster"]):
        assert main([*words, address]) == 2
        told = capsys.readouterr().err
        assert "must be tcp://HOST:PORT" in told and told.count("\n") == 1


def test_a_study_says_once_that_its_cluster_cannot_be_reached(
    capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It said that heavy jobs are done here, and ended."""
    distributed = pytest.importorskip("distributed")

    def unreachable(*_: object, **__: object) -> None:
        raise OSError("Timed out")

    monkeypatch.setattr(distributed, "Client", unreachable)
    assert main(["study", "latitudes", "--scheduler", "tcp://127.0.0.1:1", "--quiet"]) == 2
    told = capsys.readouterr().err
    assert "cannot be reached (OSError: Timed out)" in told and told.count("\n") == 1
    assert not caplog.records
