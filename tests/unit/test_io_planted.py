"""A wrong unit, sign, epoch, hemisphere or clock in a good recording is told or refused."""

from pathlib import Path

import pytest

from navcore.motion.track import TrackMotion
from navcore.sensors.recorded import recording_notices
from navcore.sensors.reference import Reference
from tests.planted import FILE_FAULTS, FORMATS, IMU, LARGE, Case, cases, moved, told, told_of_file
from tests.recordings import OWN_SHIP

ALL = [case for case in cases() if moved(case) > LARGE or case.column == "time"]


@pytest.mark.parametrize("form", [*FORMATS, IMU])
def test_nothing_is_told_of_a_good_recording(form: str, tmp_path: Path) -> None:
    assert told(Case(form), tmp_path) == []


def test_nothing_is_told_of_a_real_ship_that_hardly_turns() -> None:
    motion, log = TrackMotion(file=OWN_SHIP.track), Reference(kind="file", file=OWN_SHIP.log, frame="body")
    assert [words for words in recording_notices(motion, log) if "agrees" in words or "late" in words] == []


def test_there_are_at_least_300_combinations() -> None:
    assert len(ALL) >= 300 and {case.format for case in ALL} == {*FORMATS, IMU}


@pytest.mark.parametrize("case", ALL[::16], ids=lambda case: case.name)
def test_a_planted_fault_is_told_or_refused(case: Case, tmp_path: Path) -> None:
    assert told(case, tmp_path)


@pytest.mark.parametrize("name", FILE_FAULTS)
def test_a_fault_of_a_whole_file_is_told_or_does_no_harm(name: str, tmp_path: Path) -> None:
    words, same = told_of_file(name, tmp_path)
    assert words or same


@pytest.mark.nightly
@pytest.mark.timeout(1800)
def test_every_planted_fault_is_told_or_refused(tmp_path: Path) -> None:
    missed: list[str] = []
    for number, case in enumerate(ALL):
        folder = tmp_path / str(number)
        folder.mkdir()
        missed += [] if told(case, folder) else [case.name]
    assert missed == []
