"""Placeholders and quality flags: what is not available or not measured is missing or told, with counts."""

from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.units import DEG
from navcore.io.recording import read_recording
from tests.nmea import gga, rmc, sentence, stamped, write


def test_numbers_of_ais_are_missing_samples_and_told(tmp_path: Path) -> None:
    path = tmp_path / "ais.csv"
    rows = ["0,55,7,9,360,200", "1,91,181,102.3,360,511", "2,55,7,9,90,200"]
    path.write_text("\n".join(["t_s,lat,lon,sog_kn,cog,heading", *rows]) + "\n")
    read = read_recording(path)
    assert read.position is not None
    assert read.velocity is not None
    assert read.heading is not None
    assert read.position.time_s.tolist() == [0, 2]
    assert read.heading.time_s.tolist() == [0, 2]
    assert read.velocity.time_s.tolist() == [2]
    told = " ".join(read.warnings)
    assert "heading = 511: not available, 1 missing" in told
    assert "cog = 360: not available, 2 missing" in told


def test_a_course_of_360_is_north_in_another_table(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t_s,sog_kn,cog\n0,9,360\n1,9,360\n")
    velocity = read_recording(path).velocity
    assert velocity is not None
    assert np.all(velocity.values[:, 1] > 4.0)


def _fixes(folder: Path, *places: tuple[float, float]) -> Path:
    lines = [sentence(rmc(k, lat, lon, 5.0, 20.0)) for k, (lat, lon) in enumerate(places)]
    return write(folder / "fixes.nmea", lines)


def test_places_at_zero_are_left_out_and_named(tmp_path: Path) -> None:
    good = [(38.0 + 1e-5 * k, 9.0) for k in range(6)]
    read = read_recording(_fixes(tmp_path, *good[:3], (0.0, 0.0), (0.0, 0.0), *good[3:]))
    assert read.position is not None
    assert read.position.values[:, 0].min() > 37.0 * DEG
    assert any("2 positions at 0 N 0 E left out" in w and "23:58:03" in w for w in read.warnings)


def test_a_ship_that_passes_zero_keeps_its_fix(tmp_path: Path) -> None:
    read = read_recording(_fixes(tmp_path, *((1e-4 * k, 1e-4 * k) for k in range(-2, 3))))
    assert read.position is not None
    assert read.position.time_s.size == 5
    assert not any("0 N 0 E" in w for w in read.warnings)


@pytest.mark.parametrize(
    ("quality", "doubt"), [(6, "estimated (dead-reckoned)"), (7, "typed in (manual)"), (8, "simulated")]
)
def test_a_fix_that_is_not_measured_is_told(tmp_path: Path, quality: int, doubt: str) -> None:
    lines = [stamped(k, gga(k, 38.0, 9.0, 20.0, quality if k < 3 else 2)) for k in range(8)]
    read = read_recording(write(tmp_path / "fixes.nmea", lines))
    assert any(f"3 readings of GPGGA are {doubt}" in w for w in read.warnings)


@pytest.mark.parametrize(
    ("mode", "doubt"), [("E", "estimated (dead-reckoned)"), ("S", "simulated"), ("A", ""), ("D", "")]
)
def test_the_mode_of_rmc_is_heeded(tmp_path: Path, mode: str, doubt: str) -> None:
    lines = [sentence(f"{rmc(k, 38.0, 9.0, 5.0, 20.0)[:-1]}{mode}") for k in range(4)]
    read = read_recording(write(tmp_path / "fixes.nmea", lines))
    assert any(f"4 readings of GPRMC are {doubt}" in w for w in read.warnings) == bool(doubt)


def test_a_place_without_time_and_status_is_taken_at_its_stamp(tmp_path: Path) -> None:
    lines = [stamped(k, "GPGLL,3800.000,N,00900.000,E") for k in range(4)]
    read = read_recording(write(tmp_path / "fixes.nmea", lines))
    assert read.position is not None
    assert read.position.time_s.size == 4
    assert not any("invalid" in w for w in read.warnings)


def test_a_place_whose_status_is_empty_stays_invalid(tmp_path: Path) -> None:
    lines = [stamped(k, f"GPGLL,3800.000,N,00900.000,E,23580{k}.00,,") for k in range(4)]
    read = read_recording(write(tmp_path / "fixes.nmea", [*lines, stamped(4, "HEHDT,20.0,T")]))
    assert read.position is None
