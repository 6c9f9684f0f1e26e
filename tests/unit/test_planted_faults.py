"""A wrong unit, sign or hemisphere planted in a good recording is told or refused, never read in silence."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from navcore.checks.file import check_file
from navcore.checks.imu import IMU_CHECKER
from navcore.checks.report import FileReport

Columns = dict[str, np.ndarray]
COUNT = 240


def _ship(course_deg: float, speed: float, lat: float, lon: float) -> Columns:
    """A ship on a course that winds by 10 deg, 10 s a row; deg and m/s."""
    t = 10.0 * np.arange(COUNT)
    course = np.radians(course_deg + 10.0 * np.sin(t / 400.0))
    north, east = np.cumsum(speed * np.cos(course)) * 10.0, np.cumsum(speed * np.sin(course)) * 10.0
    lats = lat + np.degrees(north / 6.371e6)
    degrees = np.degrees(course) % 360.0
    return {
        "utc": 1714564800.0 + t,
        "lat_deg": lats,
        "lon_deg": lon + np.degrees(east / 6.371e6) / np.cos(np.radians(lats)),
        "sog_mps": np.full(COUNT, speed),
        "cog_deg": degrees,
        "heading_deg": degrees,
        "speed_mps": np.full(COUNT, speed) + 0.01 * np.sin(t),
    }


def _check(folder: Path, columns: Columns) -> FileReport:
    path = folder / "log.csv"
    np.savetxt(
        path, np.column_stack(list(columns.values())), "%.9f", ",", header=",".join(columns), comments=""
    )
    return check_file(path, [IMU_CHECKER])


def _scaled(*names: str, by: float) -> Callable[[Columns], Columns]:
    return lambda columns: columns | {name: columns[name] * by for name in names}


PLANTED: dict[str, Callable[[Columns], Columns]] = {
    "heading in rad": _scaled("heading_deg", by=np.pi / 180),
    "course in rad": _scaled("cog_deg", by=np.pi / 180),
    "speed over ground in kn": _scaled("sog_mps", by=1 / 0.514444),
    "speed over ground in km/h": _scaled("sog_mps", by=3.6),
    "water speed in kn": _scaled("speed_mps", by=1 / 0.514444),
    "water speed in km/h": _scaled("speed_mps", by=3.6),
    "south as north": lambda c: c | {"lat_deg": -c["lat_deg"]},
    "west as east": lambda c: c | {"lon_deg": -c["lon_deg"]},
    "positions in rad": _scaled("lat_deg", "lon_deg", by=np.pi / 180),
    "heading of the other sign": lambda c: c | {"heading_deg": -c["heading_deg"] % 360.0},
    "heading backwards": lambda c: c | {"heading_deg": (c["heading_deg"] + 180.0) % 360.0},
}
RECORDINGS = st.builds(
    _ship,
    st.sampled_from([40.0, 65.0, 120.0, 150.0, 215.0, 240.0, 300.0, 320.0]),
    st.floats(4.0, 12.0),
    st.sampled_from([-55.0, -20.0, 12.0, 47.0, 60.0]),
    st.sampled_from([-150.0, -40.0, 8.0, 120.0]),
)
quiet = settings(
    max_examples=30,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
    derandomize=True,
)


@given(recording=RECORDINGS)
@quiet
def test_a_good_recording_is_read_without_a_word(tmp_path: Path, recording: Columns) -> None:
    report = _check(tmp_path, recording)
    assert report.ok and not report.warnings


@pytest.mark.parametrize("slip", PLANTED)
@given(recording=RECORDINGS)
@quiet
def test_a_planted_slip_is_told_or_refused(tmp_path: Path, slip: str, recording: Columns) -> None:
    report = _check(tmp_path, PLANTED[slip](recording))
    assert not report.ok or report.warnings
