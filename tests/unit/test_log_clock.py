"""The clock of a log that is recorded without a heading, by the changes of its speed."""

from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.checks.report import FileReport

LATE = "the speed through the water is"


def _checked(
    folder: Path, late_s: float, changes: float = 1.0, factor: float = 1.0, current: float = 1.0
) -> FileReport:
    """A ship that turns, changes its speed now and then, and drifts with a current; 1 Hz, 50 min."""
    t = np.arange(3000.0)
    normal = np.random.default_rng(3).normal

    def speed(at: np.ndarray) -> np.ndarray:
        levels = np.array([5.0, 7.5, 4.0, 6.0, 8.0, 5.5, 3.5, 6.5, 5.0, 7.0])
        slow = np.interp(
            at, 300.0 * np.arange(10) + np.array([0, 40, -70, 90, 10, -50, 60, 0, -30, 80]), levels
        )
        return 5.5 + changes * (slow - 5.5)

    course = np.radians(40.0 + 60.0 * np.sin(t / 500.0))
    east, north = speed(t) * np.sin(course) + 0.3 * current, speed(t) * np.cos(course) - 0.2 * current
    sog, cog = np.hypot(east, north) + normal(0, 0.05, t.size), np.degrees(np.arctan2(east, north)) % 360.0
    water = factor * speed(t - late_s) + normal(0, 0.05, t.size)
    path = folder / "log.csv"
    rows = np.column_stack([1.7e9 + t, sog, cog, water])
    np.savetxt(path, rows, "%.3f", ",", header="unix_time,sog_mps,cog_deg,speed_mps", comments="")
    return check_file(path)


@pytest.mark.parametrize(("late_s", "factor"), [(20.0, 1.0), (90.0, 1.0), (-180.0, 1.05), (600.0, 0.9)])
def test_a_log_that_is_late_is_told_with_the_time(tmp_path: Path, late_s: float, factor: float) -> None:
    (told,) = (words for words in _checked(tmp_path, late_s, factor=factor).warnings if LATE in words)
    said, reach = (float(part.split(" s")[0]) for part in told.removeprefix(LATE).split("(± "))
    assert abs(said - late_s) <= min(reach, 20.0)


@pytest.mark.parametrize("late_s", [0.0, 5.0])
def test_a_log_in_time_is_said_to_be_so_with_how_sure_that_is(tmp_path: Path, late_s: float) -> None:
    report = _checked(tmp_path, late_s)
    assert not [words for words in report.warnings if "late" in words]
    (told,) = (words for words in report.text if "late by the changes of its speed" in words)
    said, reach = (float(part.split(" s")[0]) for part in told.removeprefix("  the log is").split("(± "))
    assert abs(said - late_s) <= reach <= 40.0


@pytest.mark.parametrize(
    ("changes", "factor", "current", "why"),
    [(0.0, 1.0, 0.0, "changes by 0"), (0.0, 1.0, 1.0, "together"), (1.0, 0.0, 1.0, "together")],
)
def test_a_clock_that_cannot_be_told_is_refused_by_name(
    tmp_path: Path, changes: float, factor: float, current: float, why: str
) -> None:
    report = _checked(tmp_path, 120.0, changes, factor, current)
    assert not [words for words in report.warnings if "late" in words]
    (told,) = (words for words in report.text if "clock cannot be told without a heading" in words)
    assert why in told
