"""``schuler check`` of several recordings: each by itself, and what does not agree between them."""

import json
from pathlib import Path

import numpy as np
import pytest

from schuler_bench.cli import main
from schuler_bench.cli.check import check_together

T0 = 1.7e9


def _files(folder: Path, late_s: float = 0.0, apart_s: float = 0.0) -> tuple[str, str]:
    """A log in one file, and positions with a heading in another, of a ship that changes speed and course."""
    t = np.arange(0.0, 5400.0)
    levels = np.array([5.0, 8.0, 4.0, 6.5, 3.0, 7.0, 5.0, 8.0, 4.0, 6.0])
    speed = np.interp(
        t,
        np.repeat(np.arange(0.0, 6000.0, 600.0), 2)[1:-1] + np.tile([0.0, 60.0], 9),
        np.repeat(levels, 2)[:-2],
    )
    heading = np.radians(40.0 + 70.0 * np.sin(t / 700.0))
    north, east = np.cumsum(speed * np.cos(heading)), np.cumsum(speed * np.sin(heading))
    lat, lon = (
        48.0 + np.degrees(north / 6.38e6),
        -5.0 + np.degrees(east / (6.38e6 * np.cos(np.radians(48.0)))),
    )
    log, track = folder / "log.csv", folder / "track.csv"
    reading = np.interp(t - late_s, t, speed) + np.random.default_rng(1).normal(0.0, 0.03, t.size)
    np.savetxt(log, np.column_stack([T0 + apart_s + t, reading]), "%.4f", ",",
               header="unix_time,speed_mps", comments="")  # fmt: skip
    np.savetxt(track, np.column_stack([T0 + t, lat, lon, np.degrees(heading) % 360.0]), "%.8f", ",",
               header="unix_time,lat_deg,lon_deg,heading_deg", comments="")  # fmt: skip
    return str(log), str(track)


def test_a_clock_that_neither_file_shows_is_told_of_both(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = _files(tmp_path, late_s=90.0)
    assert main(["check", *files, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert [one["file"] for one in document["files"]] == [*files]
    assert not any("late" in text for one in document["files"] for text in one["warnings"])
    (told,) = (text for text in document["together"]["warnings"] if "late" in text)
    assert abs(float(told.split(" is ")[1].split(" s")[0]) - 90.0) < 3.0
    assert document["together"]["shared_s"] == pytest.approx(5400.0, abs=1.0)
    assert main(["check", *files]) == 0
    out = capsys.readouterr().out
    assert out.count("CSV") == 2 and "are shared by all streams" in out and f"warning: {told}" in out


def test_files_that_agree_have_no_warning_together(tmp_path: Path) -> None:
    report = check_together(_files(tmp_path))
    assert report.ok and not report.warnings
    assert report.details["taken"].keys() == {"position", "heading", "water"}


def test_files_of_different_times_are_refused_together(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = _files(tmp_path, apart_s=1e5)
    assert main(["check", *files]) == 2
    captured = capsys.readouterr()
    assert "the streams share no time" in captured.err and captured.out.count("CSV") == 2


def test_a_map_is_guessed_of_one_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = _files(tmp_path)
    assert main(["check", *files, "--write-map", str(tmp_path / "map.toml")]) == 2
    assert "is the map of one FILE" in capsys.readouterr().err
    assert main(["check"]) == 2
    assert "check needs FILE" in capsys.readouterr().err
