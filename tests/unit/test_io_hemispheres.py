"""Hemispheres in columns of their own decide the sign of a place."""

from pathlib import Path

import pyarrow
import pyarrow.parquet
import pytest

from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG
from navcore.io.recording import read_recording


def _table(folder: Path, *lines: str) -> Path:
    path = folder / "places.csv"
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize(
    ("lat_side", "lon_side"),
    [("LatDir", "LonDir"), ("N/S", "E/W"), ("lat_hemisphere", "lon_hemisphere"), ("x", "y")],
)
def test_a_column_of_hemispheres_gives_the_sign(tmp_path: Path, lat_side: str, lon_side: str) -> None:
    path = _table(tmp_path, f"t_s,lat,{lat_side},lon,{lon_side}", "0,12.5,S,70.25,W", "1,12.5,S,70.25,w")
    read = read_recording(path)
    position = read.position
    assert position is not None
    assert any(f"column {lat_side} gives the sign of lat" in warning for warning in read.warnings)
    assert not any("not used" in warning for warning in read.warnings)
    assert position.values[:, 0] == pytest.approx(-12.5 * DEG)
    assert position.values[:, 1] == pytest.approx(-70.25 * DEG)


def test_hemispheres_may_stand_apart_and_change(tmp_path: Path) -> None:
    path = _table(tmp_path, "t_s,lat,lon,EW,NS", "0,0.01,5,E,S", "1,0.01,5,E,N", "2,-0.01,5,E,S")
    position = read_recording(path).position
    assert position is not None
    assert position.values[:, 0] / DEG == pytest.approx([-0.01, 0.01, -0.01])


@pytest.mark.parametrize(("row", "field"), [("0,12.5,q,70", "LatDir"), ("0,-12.5,N,70", "LatDir")])
def test_a_hemisphere_that_makes_no_sense_is_refused_by_name(tmp_path: Path, row: str, field: str) -> None:
    with pytest.raises(InputError, match=field):
        read_recording(_table(tmp_path, "t_s,lat,LatDir,lon", row, "1,12.5,S,70"))


def test_a_hemisphere_in_a_parquet_file_is_refused_by_name(tmp_path: Path) -> None:
    path = tmp_path / "places.parquet"
    content = {"t_s": [0.0, 1.0], "lat": [12.5, 12.5], "lat_dir": ["S", "S"], "lon": [70.0, 70.0]}
    pyarrow.parquet.write_table(pyarrow.table(content), path)
    with pytest.raises(InputError, match="lat_dir"):
        read_recording(path)


def test_a_number_of_satellites_is_no_hemisphere(tmp_path: Path) -> None:
    position = read_recording(_table(tmp_path, "t_s,lat,lon,ns", "0,12.5,70,9", "1,12.5,70,9")).position
    assert position is not None
    assert position.values[:, 0] == pytest.approx(12.5 * DEG)
