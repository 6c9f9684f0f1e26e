"""Files that a user names: what is no regular file, or has no end, is refused by every command."""

from __future__ import annotations

import os
import socket
from collections.abc import Callable
from pathlib import Path

import pytest

from navcore.foundation import inputs
from navcore.foundation.inputs import NotRegularError, TooLargeError, opened, read_bytes, regular
from schuler_bench.cli import main

SHIP = 'schema = 1\n[run]\nduration_h = 0.1\n[[method]]\nname = "free"\n'
STUDY = 'schema = 1\nseeds = 1\nscenario = "{}"\n'
TRACK = '[motion]\nkind = "track"\nfile = "{}"\n'
LOG = '[reference]\nkind = "file"\nfile = "{}"\n'
IMU = '[run]\nfidelity = "strapdown"\nduration_h = 0.01\n[imu]\nfile = "{}"\n'
VARY = ["--objective", "tilt_rms", "--vary", "method.0.network.xi"]

COMMANDS: dict[str, Callable[[str], list[str]]] = {
    "run": lambda name: ["run", name],
    "budget": lambda name: ["budget", name],
    "tune": lambda name: ["tune", name, *VARY],
    "tune --worst-of": lambda name: ["tune", "zha-fast", *VARY, "--worst-of", name],
    "tune --over": lambda name: ["tune", "zha-fast", *VARY, "--over", name],
    "pareto": lambda name: ["pareto", name],
    "adapt": lambda name: ["adapt", name],
    "design": lambda name: ["design", name],
    "design --over": lambda name: ["design", "zha-fast", "--over", name],
    "study": lambda name: ["study", name],
    "check": lambda name: ["check", name],
    "check --map": lambda name: ["check", "log.csv", "--map", name],
    "check --write-map": lambda name: ["check", name, "--write-map", "map.toml"],
}
BLOCKS = {
    "scenario of a study": ("study", STUDY),
    "track": ("run", TRACK),
    "log": ("run", LOG),
    "IMU": ("run", IMU),
    "map": ("run", LOG.format("log.csv") + 'map = "{}"\n'),
}


def a_pipe(place: Path) -> None:
    os.mkfifo(place)


def a_socket(place: Path) -> None:
    here = os.getcwd()
    os.chdir(place.parent)  # the path of a socket is short
    try:
        with socket.socket(socket.AF_UNIX) as held:
            held.bind(place.name)
    finally:
        os.chdir(here)


def zeros(place: Path) -> None:
    place.symlink_to("/dev/zero")


def a_loop(place: Path) -> None:
    place.symlink_to(place)


def a_dead_link(place: Path) -> None:
    place.symlink_to(place.parent / "nowhere")


def a_folder(place: Path) -> None:
    place.mkdir()


def a_large_file(place: Path) -> None:
    with place.open("wb") as stream:
        stream.truncate(1 << 40)


ODD = [a_pipe, a_socket, zeros, a_loop, a_dead_link, a_folder, a_large_file]
REASONS = (
    "is a",
    "is neither",
    "Too many levels",
    "no such file",
    "No such file",
    "cannot be",
    "MiB",
    "larger",
)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "log.csv").write_text("t_s,speed_mps\n0,5\n1,5\n2,5\n")
    return tmp_path


def refusal(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    capsys.readouterr()
    assert main(arguments) == 2
    told = capsys.readouterr()
    assert told.out == "" and "Traceback" not in told.err and told.err.count("\n") == 1
    return told.err


@pytest.mark.timeout(30)
@pytest.mark.parametrize("make", ODD)
@pytest.mark.parametrize("command", COMMANDS)
def test_what_is_no_file_is_refused_at_once(
    command: str, make: Callable[[Path], None], here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A pipe kept them waiting for ever, /dev/zero took all memory, a loop of links was a traceback."""
    make(here / "odd.toml")
    told = refusal(COMMANDS[command]("odd.toml"), capsys)
    assert "odd.toml" in told and any(reason in told for reason in REASONS)


@pytest.mark.timeout(30)
@pytest.mark.parametrize("make", ODD)
@pytest.mark.parametrize("block", BLOCKS)
def test_so_is_what_a_scenario_or_a_study_names(
    block: str, make: Callable[[Path], None], here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    make(here / "odd.csv")
    command, text = BLOCKS[block]
    (here / "mine.toml").write_text(text.format("odd.csv"))
    told = refusal([command, "mine.toml"], capsys)
    followed = make in (zeros, a_dead_link)  # to a path of another name
    assert (followed or "odd.csv" in told) and any(reason in told for reason in REASONS)


@pytest.mark.parametrize("name", ["/dev/null", "/dev/full", "/proc/self/mem", "/proc/kmsg", "/dev/stdin"])
def test_files_of_the_system_keep_nobody_waiting(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    code = main(["network", 'id = "classic2"']) or main(["check", name])
    assert code in (0, 2) and "Traceback" not in capsys.readouterr().err


@pytest.mark.parametrize("name", ["a" * 5000, "a/" * 3000, "no\x01such", "\udcff.toml", ".", "..", "/", ""])
def test_odd_names_are_told_in_one_line(name: str, here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for command in ("run", "study", "budget"):
        assert refusal([command, name], capsys).isprintable() is False  # the line's own end
        (here / "mine.toml").write_text('schema = 1\nscenario = "a\\u0000b"\n')
        assert "mine.toml" in refusal(["run", "mine.toml"], capsys)
    assert "a\\x00b" in refusal(["study", "mine.toml"], capsys)


# ---------------------------------------------------------------- the mechanism


def test_a_file_that_becomes_a_pipe_meanwhile_is_not_waited_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    os.mkfifo(tmp_path / "pipe")
    monkeypatch.setattr(inputs, "regular", lambda path: None)
    with pytest.raises(NotRegularError, match="is a pipe"):
        opened(tmp_path / "pipe")


def test_no_more_is_read_than_is_allowed(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"12345")
    assert read_bytes(tmp_path / "file", 5) == b"12345" and regular(tmp_path / "file").st_size == 5
    with pytest.raises(TooLargeError, match="is larger than 4 bytes"):
        read_bytes(tmp_path / "file", 4)
    (tmp_path / "file").write_bytes(b"")
    assert read_bytes(tmp_path / "file", 5) == b""
    with pytest.raises(OSError, match="Invalid argument"):
        regular("a\0b")


@pytest.mark.parametrize("name", ["pipe", "missing"])
def test_a_recording_that_no_method_reads_is_refused_by_its_field(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It was met when the scenario was hashed, after the run, and told as one that was stopped."""
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "ship.toml").write_text(f'run.duration_h = 0.01\n[reference]\nfile = "{name}"\n')
    assert main(["run", str(tmp_path / "ship.toml"), "--quiet"]) == 2
    assert "reference.file" in capsys.readouterr().err
