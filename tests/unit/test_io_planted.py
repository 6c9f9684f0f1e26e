"""A wrong unit, sign, epoch, hemisphere or clock in a good recording is told or refused."""

from pathlib import Path

import pytest

from tests.planted import FORMATS, IMU, LARGE, Case, cases, moved, told

ALL = [case for case in cases() if moved(case) > LARGE or case.column == "time"]


@pytest.mark.parametrize("form", [*FORMATS, IMU])
def test_nothing_is_told_of_a_good_recording(form: str, tmp_path: Path) -> None:
    assert told(Case(form), tmp_path) == []


def test_there_are_at_least_300_combinations() -> None:
    assert len(ALL) >= 300 and {case.format for case in ALL} == {*FORMATS, IMU}


@pytest.mark.parametrize("case", ALL[::16], ids=lambda case: case.name)
def test_a_planted_fault_is_told_or_refused(case: Case, tmp_path: Path) -> None:
    assert told(case, tmp_path)


@pytest.mark.nightly
@pytest.mark.timeout(1800)
def test_every_planted_fault_is_told_or_refused(tmp_path: Path) -> None:
    missed: list[str] = []
    for number, case in enumerate(ALL):
        folder = tmp_path / str(number)
        folder.mkdir()
        missed += [] if told(case, folder) else [case.name]
    assert missed == []
