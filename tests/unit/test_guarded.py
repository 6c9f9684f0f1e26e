"""Hostile files and scenarios: read in a child with bounds, told in a short line, the caller unharmed."""

import errno
import os
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from navcore.foundation import guarded
from navcore.foundation.errors import Fault, InputError
from navcore.io.recording import load
from schuler_bench.session.uploads import Uploads, opened_scenario
from tests.bombs import FILES, SCENARIOS

LIMITS = guarded.Limits(memory_bytes=1 << 30, cpu_s=10, wall_s=120.0)
READERS = (
    "schuler_bench.session.uploads",
    "navcore.io.csv",
    "navcore.io.tables",
    "pyarrow.parquet",
    "scipy.io",
)


def _answer(what: str) -> object:
    """What a child is made to do."""
    if what == "memory":
        return len([np.ones(1 << 20) for _ in range(1000)])
    if what == "time":
        while True:
            pass
    if what == "sleep":
        time.sleep(600)
    if what == "die":
        os.abort()
    if what == "break":
        raise KeyError("some parser's own")
    if what == "refuse":
        raise OSError(errno.EFBIG, os.strerror(errno.EFBIG), "/opt/some/place")
    if what == "faults":
        raise InputError([Fault("file", f"field {k}", "x" * 10_000, "must not") for k in range(1000)])
    if what == "write":
        Path(f"/tmp/written-{os.getpid()}").write_text("x" * 100)
    return os.getpid()


@pytest.fixture
def limits() -> Iterator[guarded.Limits]:
    yield from _guard(guarded.Limits(memory_bytes=1 << 29, cpu_s=4, wall_s=60.0))


@pytest.fixture
def uploads(tmp_path: Path) -> Iterator[Uploads]:
    for _ in _guard(LIMITS):
        yield Uploads(tmp_path / "session")


def _guard(limits: guarded.Limits) -> Iterator[guarded.Limits]:
    guarded.start(READERS, limits)
    try:
        yield limits
    finally:
        guarded.stop()


def _told(call: object, *arguments: object) -> str:
    with pytest.raises(InputError) as caught:
        call(*arguments)  # pyright: ignore[reportCallIssue]
    return str(caught.value)


def test_without_a_guard_a_function_is_called_here() -> None:
    assert guarded.call("input", _answer, "pid") == os.getpid()


def test_a_result_comes_from_another_process(limits: guarded.Limits) -> None:
    assert guarded.call("input", _answer, "pid") != os.getpid()


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ("memory", "input: needs more than 0.5 GiB of memory to read"),
        ("time", "input: takes more than 4 s of processor time to read"),
        ("die", "input: cannot be read: it needs more than 0.5 GiB of memory, or is damaged"),
        ("break", "input: cannot be read (KeyError)"),
        ("refuse", "input: cannot be read (OSError: File too large)"),
        ("write", "input: cannot be read"),
    ],
)
def test_a_child_that_takes_too_much_or_breaks_is_one_line(
    limits: guarded.Limits, what: str, said: str
) -> None:
    told = _told(guarded.call, "input", _answer, what)
    assert told.startswith(said) and "\n" not in told
    assert guarded.call("input", _answer, "pid") != os.getpid()


def test_a_child_that_only_waits_is_ended(tmp_path: Path) -> None:
    for _ in _guard(guarded.Limits(wall_s=1.0)):
        assert "takes longer than 1 s" in _told(guarded.call, "input", _answer, "sleep")


def test_very_many_faults_come_back_as_a_few(limits: guarded.Limits) -> None:
    told = _told(guarded.call, "input", _answer, "faults")
    assert len(told.splitlines()) == 51 and len(told) < 20_000
    assert told.endswith("and 950 more faults")


def test_a_good_recording_comes_through_the_child_unchanged(uploads: Uploads) -> None:
    rows = "".join(f"{t},{t / 10},90.0\n" for t in range(50))
    upload = uploads.add("log.csv", b"t_s,speed_mps,heading_deg\n" + rows.encode())
    assert upload.quantities == {"water", "heading"}
    assert load(upload.path).water.values[:, 1] == pytest.approx(np.arange(50) / 10.0)


# ------------------------------------------------------------ what stopped the server before


@pytest.mark.parametrize("name", FILES)
def test_a_hostile_file_is_refused_in_a_short_line(uploads: Uploads, name: str) -> None:
    told = _told(uploads.add, "file", FILES[name]())
    assert len(told) < 3000 and "Traceback" not in told
    assert list(uploads.folder.iterdir()) == []


@pytest.mark.parametrize("name", SCENARIOS)
def test_a_hostile_scenario_is_told_in_a_few_lines(uploads: Uploads, name: str) -> None:
    text, said = SCENARIOS[name]
    began = time.process_time()
    told = _told(opened_scenario, "scenario.toml", text.encode(), uploads)
    assert said in told and len(told) < 4000
    assert time.process_time() - began < 2.0  # of this process; the child has its own bound
