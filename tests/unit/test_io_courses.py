"""Heading, course, speed and positions judge each other: a wrong unit or sign of one is told."""

import re
from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file

_N = 150


def _warnings(folder: Path, **changed: np.ndarray) -> list[str]:
    """What is told of a ship at 24 S that turns slowly from 230 deg at 6 m/s, with some columns changed."""
    t = np.arange(_N, dtype=float)
    course = np.deg2rad(230.0 + 0.1 * t)
    north, east = np.cumsum(6.0 * np.cos(course)), np.cumsum(6.0 * np.sin(course))
    columns = {
        "t_s": t,
        "lat": -24.0 + np.rad2deg(north / 6.36e6),
        "lon": 150.0 + np.rad2deg(east / 6.378e6 / np.cos(np.deg2rad(24.0))),
        "heading": np.rad2deg(course) + 3.0,
        "cog": np.rad2deg(course),
        "sog (m/s)": np.full(_N, 6.0),
    } | changed
    path = folder / "log.csv"
    rows = [",".join(f"{value:.8f}" for value in row) for row in zip(*columns.values(), strict=True)]
    path.write_text("\n".join([",".join(columns), *rows]) + "\n")
    report = check_file(path)
    assert report.ok, report.faults
    return list(report.warnings)


def _course() -> np.ndarray:
    return 230.0 + 0.1 * np.arange(_N)


def test_nothing_is_told_of_a_ship_whose_columns_agree(tmp_path: Path) -> None:
    assert _warnings(tmp_path) == []


@pytest.mark.parametrize(
    ("column", "values", "told"),
    [
        ("heading", np.deg2rad(_course() + 3.0), "the heading .*radians"),
        ("cog", np.deg2rad(_course()), "the course over ground .*radians"),
        ("heading", 360.0 - _course(), "the heading .*sign"),
        ("heading", _course() - 180.0, "the heading .*opposite"),
        ("sog (m/s)", np.full(_N, 6.0 / 0.514444), "speed over ground .*knots taken for m/s"),
    ],
)
def test_a_column_that_contradicts_the_track_is_told(
    tmp_path: Path, column: str, values: np.ndarray, told: str
) -> None:
    words = _warnings(tmp_path, **{column: values})
    assert any(re.search(told, word) for word in words), words


def test_a_latitude_without_its_sign_is_told(tmp_path: Path) -> None:
    north = np.cumsum(6.0 * np.cos(np.deg2rad(_course())))
    words = _warnings(tmp_path, lat=24.0 - np.rad2deg(north / 6.36e6))
    assert any("hemisphere" in word for word in words), words
