"""Tables as loggers of many countries and makers write them: names, parts of dates, flags, indexed names."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.foundation.units import DEG, KNOT
from navcore.io.column_names import known_columns
from navcore.io.imu_columns import imu_column
from navcore.io.recording import read_recording
from navcore.io.times.parts import part_columns

NAMES = {
    "Breite": "lat",
    "Länge": "lon",
    "Laenge": "lon",
    "Kurs rw (°)": "heading",
    "FdW [kn]": "speed",
    "Fahrt durchs Wasser (kn)": "speed",
    "FüG (Knoten)": "sog",
    "KüG (Grad)": "cog",
    "Datum": "utc",
    "Zeit": "utc",
    "Cap (°)": "heading",
    "Vitesse fond (nœuds)": "sog",
    "Route fond (°)": "cog",
    "Vitesse surface (nds)": "speed",
    "Horodatage": "utc",
    "temps (ms)": "utc",
    "Latitud": "lat",
    "BaseDateTime": "utc",
    "Bearing": "cog",
    "GCrs": "cog",
    "Spd": "sog",
    "lat_e7": "lat",
    "lon (1e-7 deg)": "lon",
}


@pytest.mark.parametrize("name", NAMES)
def test_a_name_of_another_language_or_maker_is_known(name: str) -> None:
    (column,) = known_columns([name]).values()
    assert column.stem == NAMES[name] and not column.unknown


PARTS = {
    "YYYY,MM,DD,hh,mm,ss": "2024,05,17,09,30,{s:02d}",
    "year,doy,sec_of_day": "2024,138,{t}",
    "Year,DOY,Hour,Minute,Second": "2024,138,9,30,{s}",
    "yy,jday": "24,{day:.9f}",
    "Jahr,Monat,Tag,Stunde,Minute,Sekunde": "2024,5,17,9,30,{s}",
}


@pytest.mark.parametrize("header", PARTS)
def test_the_parts_of_a_time_are_joined(tmp_path: Path, header: str) -> None:
    rows = [
        PARTS[header].format(s=s, t=34200 + s, day=138 + (34200 + s) / 86400) + f",{60 + s}"
        for s in range(20)
    ]
    path = tmp_path / "log.csv"
    path.write_text("\n".join([f"{header},heading", *rows]) + "\n")
    read = read_recording(path)
    assert read.heading is not None and read.heading.dated
    begin = datetime(2024, 5, 17, 9, 30, tzinfo=UTC).timestamp()
    assert read.heading.time_s == pytest.approx(begin + np.arange(20.0), abs=1e-3)
    assert any("the time is read from" in told for told in read.warnings)


def test_a_part_that_is_no_date_is_refused_with_its_text(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("year,doy,sec_of_day,heading\n2024,400,0,10\n2024,400,1,10\n")
    (fault,) = check_file(path).faults
    assert "year, doy, second_of_day" in fault.allowed and fault.value == "2024 400 0"


def test_a_time_without_a_year_has_no_parts() -> None:
    assert part_columns(["hour", "minute", "second"]) == {}


def test_numbers_of_1e7_and_a_speed_beside_a_course_are_over_ground(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t_s,lat_e7,lon_e7,speed,bearing\n0,543000000,102000000,8,0\n1,543000004,102000000,8,0\n")
    read = read_recording(path)
    assert read.position is not None and read.velocity is not None and read.water is None
    assert read.position.values[0, 0] == pytest.approx(54.3 * DEG)
    assert read.velocity.values[0, 1] == pytest.approx(8 * KNOT)
    assert any("taken as over ground" in told for told in read.warnings)


@pytest.mark.parametrize(
    ("name", "kind", "axis", "unit"),
    [
        ("gyro_rad[0]", "rate", "x", "rad_s"),
        ("accelerometer_m_s2[2]", "force", "z", "mps2"),
        ("delta_angle[1]", "angle", "y", ""),
    ],
)
def test_an_indexed_name_has_an_axis(name: str, kind: str, axis: str, unit: str) -> None:
    column = imu_column(0, name)
    assert column is not None and (column.kind, column.axis, column.unit) == (kind, axis, unit)
    assert not column.unknown


@pytest.mark.parametrize("run", [(30, 31), (30, 60), (5, 50)])
def test_a_run_of_positions_elsewhere_is_named(tmp_path: Path, run: tuple[int, int]) -> None:
    lat = 54.0 + 4e-5 * np.arange(120)
    lat[slice(*run)] += 0.05
    path = tmp_path / "log.csv"
    path.write_text("t_s,lat,lon\n" + "".join(f"{k},{one:.6f},10\n" for k, one in enumerate(lat)))
    told = [text for text in check_file(path).warnings if "farther than a ship gets" in text]
    assert len(told) == 1 and f"positions: {run[1] - run[0]} from {run[0]} s" in told[0]
