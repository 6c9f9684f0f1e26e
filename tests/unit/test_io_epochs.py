"""Epochs of numeric times: days, GPS seconds and Unix time are told apart, or asked for."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.io.recording import read_recording
from navcore.io.series import Recording
from navcore.io.times.counts import gps_to_unix

_START = datetime(2021, 8, 3, 6, 0, tzinfo=UTC).timestamp()


def _read(folder: Path, name: str, times: list[float]) -> Recording:
    path = folder / "log.csv"
    path.write_text(f"{name},heading\n" + "".join(f"{time:.9f},40\n" for time in times))
    return read_recording(path)


@pytest.mark.parametrize("at_1970", [25569.0, 40587.0, 719529.0, 2440587.5])
def test_a_count_of_days_is_dated_and_told(tmp_path: Path, at_1970: float) -> None:
    read = _read(tmp_path, "time", [at_1970 + (_START + 2.0 * k) / 86400.0 for k in range(20)])
    assert read.heading is not None
    assert read.heading.dated
    assert read.heading.time_s[0] == pytest.approx(_START, abs=1e-2)
    assert np.median(np.diff(read.heading.time_s)) == pytest.approx(2.0, abs=1e-3)
    assert any("counts days since" in word for word in read.warnings)


def test_seconds_of_the_size_of_a_day_count_stay_seconds(tmp_path: Path) -> None:
    read = _read(tmp_path, "time", [45000.0 + k for k in range(20)])
    assert read.heading is not None
    assert not read.heading.dated
    assert not read.warnings


def test_numbers_that_may_be_days_or_seconds_are_asked_for(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="may count days since 1899"):
        _read(tmp_path, "time", [45000.0 + 0.01 * k for k in range(20)])


@pytest.mark.parametrize(("name", "scale"), [("gps_time", 1.0), ("gps_time (ms)", 1e3), ("time (GPS)", 1.0)])
def test_gps_seconds_become_utc_and_are_told(tmp_path: Path, name: str, scale: float) -> None:
    read = _read(tmp_path, name, [(_START - 315964800.0 + 18.0 + k) * scale for k in range(5)])
    assert read.heading is not None
    assert read.heading.time_s == pytest.approx(_START + np.arange(5))
    assert any("GPS time" in word for word in read.warnings)


def test_leap_seconds_are_those_of_the_date() -> None:
    assert gps_to_unix(np.array([0.0, 1025136014.0, 1025136016.0])).tolist() == [
        315964800.0,
        1341100799.0,
        1341100800.0,
    ]


def test_dates_in_gps_time_become_utc(tmp_path: Path) -> None:
    path = tmp_path / "track.pos"
    path.write_text("%  GPST   latitude(deg) longitude(deg)\n2021/08/03 06:00:18.0 44.0 8.0\n")
    position = read_recording(path).position
    assert position is not None
    assert position.time_s[0] == pytest.approx(_START)
