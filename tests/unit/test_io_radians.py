"""Angles in radians that no name tells: taken where something decides it, else told with the remedy."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.io import savemat

from navcore.checks.file import check_file
from navcore.foundation.earth import WGS84
from navcore.foundation.units import DEG, KNOT
from navcore.io.column_map import parse_map
from navcore.io.recording import read_recording
from navcore.io.series import Recording

T = np.arange(600.0)
LAT, LON, SPEED = 45.0, 12.0, 10.0 * KNOT
MERIDIAN, PRIME = WGS84.radii(LAT * DEG)


def _ship(
    course: float = 8.0, speed: float = SPEED, lat: float = LAT, lon: float = LON
) -> dict[str, np.ndarray]:
    """Degrees of a ship that keeps its course, and its speed in knots."""
    north, east = speed * np.cos(course * DEG) * T, speed * np.sin(course * DEG) * T
    return {
        "time_s": T,
        "latitude": lat + north / MERIDIAN / DEG,
        "longitude": lon + east / (PRIME * np.cos(lat * DEG)) / DEG,
        "heading": np.full(T.size, course),
        "course": np.full(T.size, course),
        "sog_kn": np.full(T.size, speed / KNOT),
        "speed_kn": np.full(T.size, speed / KNOT + 1.0),
        "roll": 2.0 * np.sin(T),
        "pitch": 1.0 * np.sin(0.7 * T),
    }


def _table(
    folder: Path, columns: list[str], radians: list[str], ship: dict[str, np.ndarray] | None = None
) -> Path:
    held = ship or _ship()
    cells = [held[name] * (DEG if name in radians else 1.0) for name in columns]
    path = folder / "log.csv"
    rows = "\n".join(",".join(f"{cell:.10f}" for cell in row) for row in zip(*cells, strict=True))
    path.write_text(",".join(columns) + "\n" + rows + "\n")
    return path


def _told(read: Recording, words: str) -> list[str]:
    return [told for told in read.warnings if words in told]


PLACES = ["latitude", "longitude"]
TAKEN = {
    "by the log": (
        ["time_s", *PLACES, "heading", "speed_kn"],
        [*PLACES, "heading"],
        "with which speed_kn agrees",
    ),
    "by the receiver": (
        ["time_s", *PLACES, "course", "sog_kn"],
        [*PLACES, "course"],
        "with which sog_kn agrees",
    ),
    "positions alone": (
        ["time_s", *PLACES, "heading", "sog_kn", "course"],
        PLACES,
        "with which sog_kn agrees",
    ),
    "roll and pitch": (
        ["time_s", *PLACES, "heading", "roll", "pitch", "speed_kn"],
        [*PLACES, "heading", "roll", "pitch"],
        "latitude, longitude, heading, pitch, roll",
    ),
}


@pytest.mark.parametrize("name", TAKEN)
def test_angles_are_radians_where_a_speed_decides_it(tmp_path: Path, name: str) -> None:
    columns, radians, words = TAKEN[name]
    ship = _ship(course=20.0)
    read = read_recording(_table(tmp_path, columns, radians, ship))
    assert read.position is not None
    np.testing.assert_allclose(np.rad2deg(read.position.values[0, :2]), [LAT, LON], atol=1e-6)
    (told,) = _told(read, "taken as radians")
    assert words in told
    if read.heading is not None:
        np.testing.assert_allclose(np.rad2deg(read.heading.values[:, 0]), 20.0, atol=1e-6)
    if read.attitude is not None:
        np.testing.assert_allclose(np.rad2deg(read.attitude.values[:, 1]).max(), 2.0, atol=1e-3)
    assert not _told(read, "stream")


def test_the_course_of_the_track_decides_where_there_is_no_speed(tmp_path: Path) -> None:
    path = _table(tmp_path, ["time_s", *PLACES, "heading"], [*PLACES, "heading"], _ship(course=120.0))
    read = read_recording(path)
    assert read.heading is not None
    np.testing.assert_allclose(np.rad2deg(read.heading.values[:, 0]), 120.0, atol=1e-6)
    assert _told(read, "with which heading follows the track")


UNDECIDED: dict[str, tuple[list[str], dict[str, Any]]] = {
    "no speed and a course near north": ([*PLACES, "heading"], {}),
    "positions alone": (PLACES, {}),
    "moored": ([*PLACES, "heading", "sog_kn"], {"speed": 0.0}),
}


@pytest.mark.parametrize("name", UNDECIDED)
def test_where_nothing_decides_it_the_remedy_is_told_and_works(tmp_path: Path, name: str) -> None:
    columns, ship = UNDECIDED[name]
    path = _table(tmp_path, ["time_s", *columns], columns, _ship(**ship))
    read = read_recording(path)
    (told,) = _told(read, "would fit radians too")
    assert "latitude_rad" in told and read.position is not None
    np.testing.assert_allclose(np.rad2deg(read.position.values[0, 0]), LAT * DEG, atol=1e-6)
    text = path.read_text().replace("latitude", "latitude_rad").replace("longitude", "longitude_rad")
    path.write_text(text)
    renamed = read_recording(path).position
    assert renamed is not None
    np.testing.assert_allclose(np.rad2deg(renamed.values[0, 0]), LAT, atol=1e-6)


def test_a_turning_heading_without_positions_is_told(tmp_path: Path) -> None:
    ship = _ship() | {"heading": (10.0 + T) % 360.0}
    assert _told(
        read_recording(_table(tmp_path, ["time_s", "heading"], ["heading"], ship)), "would fit radians"
    )
    assert not _told(read_recording(_table(tmp_path, ["time_s", "heading"], [], ship)), "would fit radians")


SILENT = {
    "degrees": (["time_s", *PLACES, "heading"], {}),
    "degrees at the origin, with a speed": (
        ["time_s", *PLACES, "heading", "speed_kn"],
        {"lat": 0.1, "lon": 0.2},
    ),
    "too fast for a ship in radians": (["time_s", *PLACES, "heading"], {"lat": 0.1, "lon": 0.2}),
    "a steady heading near north": (["time_s", "heading", "speed_kn"], {"course": 3.0}),
}


@pytest.mark.parametrize("name", SILENT)
def test_degrees_are_taken_without_a_word(tmp_path: Path, name: str) -> None:
    columns, ship = SILENT[name]
    assert not _told(read_recording(_table(tmp_path, columns, [], _ship(**ship))), "radians")


def test_units_that_are_stated_are_not_doubted(tmp_path: Path) -> None:
    path = _table(tmp_path, ["time_s", *PLACES], PLACES)
    text = 'time = { column = "time_s", unit = "s" }\n' + "".join(
        f'[quantity.{stem}]\ncolumn = "{name}"\nunit = "deg"\n'
        for stem, name in zip(("lat", "lon"), PLACES, strict=True)
    )
    assert not _told(read_recording(path, parse_map(text, "map")), "radians")
    path.write_text(
        path.read_text().replace("latitude", "latitude_deg").replace("longitude", "longitude_deg")
    )
    assert not _told(read_recording(path), "radians")


def test_a_log_against_positions_in_radians_that_are_called_degrees_is_no_stream(tmp_path: Path) -> None:
    path = _table(tmp_path, ["time_s", *PLACES, "speed_kn"], PLACES)
    path.write_text(
        path.read_text().replace("latitude", "latitude_deg").replace("longitude", "longitude_deg")
    )
    (told,) = [words for words in check_file(path).warnings if "through the water" in words]
    assert "positions in radians" in told and "a stream of" not in told


def test_a_mat_file_is_in_degrees_where_its_speed_says_so(tmp_path: Path) -> None:
    ship = _ship(lat=0.1, lon=0.2)
    path = tmp_path / "log.mat"
    savemat(path, {name: ship[name] for name in ("time_s", "latitude", "longitude", "sog_kn")})
    read = read_recording(path)
    assert read.position is not None
    np.testing.assert_allclose(np.rad2deg(read.position.values[0, 0]), 0.1, atol=1e-9)
