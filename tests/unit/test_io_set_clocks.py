"""A clock that is set forward within a file is told as that, by the ship's motion or by its known size."""

import re
from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from tests.nmea import rmc, sentence, write

KNOTS, COUNT = 9.0, 120


def _table(
    folder: Path, forward_s: float, sailed_s: float, interval_s: float = 1.0, track: bool = True
) -> Path:
    """Rows of a ship that sails north; halfway the clock goes on by a time in which she sails another."""
    late = np.arange(COUNT) >= COUNT // 2
    time_s = interval_s * np.arange(COUNT) + forward_s * late
    lat = 54.0 + KNOTS / 216000.0 * (interval_s * np.arange(COUNT) + sailed_s * late)
    place = [f"{one:.7f},10.0" for one in lat] if track else ["", ""]
    rows = [f"{1.7e9 + t:.1f},{k % 7 + 10}" for k, t in enumerate(time_s)]
    if track:
        rows = [f"{row},{one}" for row, one in zip(rows, place, strict=True)]
    path = folder / "log.csv"
    path.write_text("\n".join(["unix_time,heading" + (",lat,lon" if track else ""), *rows]) + "\n")
    return path


def _warned(path: Path) -> str:
    return "\n".join(check_file(path).warnings)


@pytest.mark.parametrize(
    ("forward_s", "interval_s", "said"),
    [
        (18.0, 1.0, "forward by 18.0 s.*leap seconds"),
        (3600.0, 1.0, "forward by 3600.0 s.*local time"),
        (7200.0, 10.0, "forward by 2 h.*local time"),
        (300.0, 1.0, "forward by 300.0 s"),
    ],
)
def test_a_step_while_the_ship_moves_on_is_one_of_the_clock(
    tmp_path: Path, forward_s: float, interval_s: float, said: str
) -> None:
    warned = _warned(_table(tmp_path, forward_s, 0.0, interval_s))
    assert re.search(said, warned)
    assert "gaps, the longest" not in warned


@pytest.mark.parametrize("silent_s", [18.0, 300.0, 3600.0])
def test_a_gap_in_which_the_ship_sails_is_a_gap(tmp_path: Path, silent_s: float) -> None:
    warned = _warned(_table(tmp_path, silent_s, silent_s))
    assert "clock" not in warned and "gap" in warned


@pytest.mark.parametrize(("forward_s", "said"), [(18.0, "leap seconds"), (3600.0, "local time"), (25.0, "")])
def test_without_a_track_a_known_size_is_asked_about(tmp_path: Path, forward_s: float, said: str) -> None:
    warned = _warned(_table(tmp_path, forward_s, 0.0, track=False))
    assert said in warned and ("was the clock set" in warned) == bool(said)


def test_a_step_of_the_receiver_is_told_of_every_stream_of_its_log(tmp_path: Path) -> None:
    lines = [
        sentence(body)
        for k in range(COUNT)
        for body in (
            rmc(k + 18.0 * (k >= COUNT // 2), 54.0 + KNOTS / 216000.0 * k, 10.0, KNOTS, 0.0),
            f"HEHDT,{k % 7}.0,T",
        )
    ]
    warned = [
        text for text in check_file(write(tmp_path / "log.txt", lines)).warnings if "leap seconds" in text
    ]
    assert any(text.startswith("heading") for text in warned)
    assert any(text.startswith("positions") for text in warned)
