"""Maps: what the columns of a table mean, said by the user."""

import json
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.io.column_map import parse_map, read_map
from navcore.io.recording import load, read_recording
from navcore.io.series import Recording
from navcore.scenario.file import load as load_scenario
from navcore.sensors.recorded_imu import read_imu
from schuler_bench.cli import main

GERMAN = """\
Fahrt der Anna, Mai 2024
zeit;fahrt;kurs;nord
01.05.2024 12:00:00;10,5;350,0;x
01.05.2024 12:00:01;10,6;351,0;x
---
01.05.2024 12:00:02;kaputt;352,0;x
01.05.2024 12:00:03;10,8;353,0;x
"""
GERMAN_MAP = """
time = { column = "zeit", unit = "%d.%m.%Y %H:%M:%S", zone = "Europe/Berlin" }
decimal = ","
delimiter = ";"
skip_bad_rows = true
[quantity.speed]
column = "fahrt"
unit = "kn"
[quantity.heading_deg]
column = "kurs"
sign = -1
"""


def _files(folder: Path, table: str, text: str) -> tuple[Path, Path]:
    (folder / "log.csv").write_text(table)
    (folder / "map.toml").write_text(text)
    return folder / "log.csv", folder / "map.toml"


def _read(folder: Path, table: str, text: str) -> Recording:
    table_file, map_file = _files(folder, table, text)
    return read_recording(table_file, read_map(map_file))


def _utc(*moment: int) -> float:
    return datetime(*moment, tzinfo=UTC).timestamp()  # pyright: ignore[reportArgumentType]


def test_a_table_in_local_time_with_decimal_commas_is_read(tmp_path: Path) -> None:
    read = _read(tmp_path, GERMAN, GERMAN_MAP)
    assert read.water is not None and read.heading is not None
    start = _utc(2024, 5, 1, 10)
    np.testing.assert_allclose(read.water.time_s, start + np.array([0, 1, 3]))
    np.testing.assert_allclose(read.water.values[:, 1], KNOT * np.array([10.5, 10.6, 10.8]))
    np.testing.assert_allclose(read.heading.values[:, 0] / DEG % 360, [10.0, 9.0, 7.0])
    assert any("2 rows that cannot be read skipped: 5, 6" in w for w in read.warnings)


def test_bad_rows_are_faults_unless_they_may_be_skipped(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="row 5"):
        _read(tmp_path, GERMAN, GERMAN_MAP.replace("true", "false"))


def _one(column: str, unit: str, cells: list[str], zone: str = "", header: str = "when") -> tuple[str, str]:
    names = ", ".join(f'"{name}"' for name in column.split("+"))
    time = f'column = [{names}], unit = "{unit}"' + (f', zone = "{zone}"' if zone else "")
    table = "\n".join([f"{header};stw", *(f"{cell};5" for cell in cells)])
    return table, f'time = {{ {time} }}\n[quantity.speed]\ncolumn = "stw"\nunit = "mps"\n'


@pytest.mark.parametrize(
    ("column", "unit", "zone", "header", "cells", "first"),
    [
        ("when", "iso", "", "when", ["2024-05-01T12:00:00", "2024-05-01T12:00:01"], _utc(2024, 5, 1, 12)),
        ("when", "iso", "+02:00", "when", ["2024-05-01T12:00:00", "2024-05-01T12:00:01"],
         _utc(2024, 5, 1, 10)),
        ("when", "iso", "Europe/Berlin", "when", ["2024-05-01T12:00:00Z", "2024-05-01T12:00:01Z"],
         _utc(2024, 5, 1, 12)),
        ("when", "%d/%m/%Y %H:%M:%S", "", "when", ["01/05/2024 12:00:00", "01/05/2024 12:00:01"],
         _utc(2024, 5, 1, 12)),
        ("when", "%m/%d/%Y %H:%M:%S", "", "when", ["01/05/2024 12:00:00", "01/05/2024 12:00:01"],
         _utc(2024, 1, 5, 12)),
        ("when", "s", "", "when", ["1714564800", "1714564801"], _utc(2024, 5, 1, 12)),
        ("when", "ms", "", "when", ["1714564800000", "1714564801000"], _utc(2024, 5, 1, 12)),
        ("when", "ms", "", "when", ["5000", "6000"], 5.0),
        # 2024-05-01 is a Wednesday: GPS week 2312, 3 days; 18 leap seconds.
        ("week+tow", "gps_week_s", "", "week;tow", ["2312;302418", "2312;302419"], _utc(2024, 5, 1, 12)),
        ("day+time", "%d.%m.%Y %H:%M:%S", "", "day;time", ["01.05.2024;12:00:00", "01.05.2024;12:00:01"],
         _utc(2024, 5, 1, 12)),
    ],
)  # fmt: skip
def test_times_are_read_as_the_map_says(
    tmp_path: Path, column: str, unit: str, zone: str, header: str, cells: list[str], first: float
) -> None:
    water = _read(tmp_path, *_one(column, unit, cells, zone, header)).water
    assert water is not None
    np.testing.assert_allclose(water.time_s, [first, first + 1.0])


def test_the_hour_that_local_clocks_show_twice_is_told_by_the_order(tmp_path: Path) -> None:
    cells = [f"2024-10-27T{clock}" for clock in ("01:30", "02:00", "02:30", "02:00", "02:30", "03:00")]
    read = _read(tmp_path, *_one("when", "iso", cells, "Europe/Berlin"))
    assert read.water is not None
    np.testing.assert_allclose(np.diff(read.water.time_s), 1800.0)
    assert any("4 times are of the hour that local clocks show twice" in w for w in read.warnings)


def test_an_hour_that_local_clocks_leave_out_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="leave this hour out"):
        _read(tmp_path, *_one("when", "iso", ["2024-03-31T02:30:00", "2024-03-31T02:30:01"], "Europe/Berlin"))


@pytest.mark.parametrize(
    ("old", "new", "wanted"),
    [
        (
            'column = "fahrt"',
            'column = "speed"',
            r"log.csv: map = 'speed': is no column.*zeit, fahrt, kurs, nord",
        ),
        ('unit = "kn"', 'unit = "furlong"', r"quantity.speed.unit = 'furlong': must be one of mps, kn"),
        ('unit = "kn"', 'unit = "deg"', r"quantity.speed.unit = 'deg': must be one of mps, kn"),
        ('unit = "kn"', "", r"quantity.speed.unit.*must be one of mps, kn"),
        ("[quantity.speed]", "[quantity.sped]", r"quantity.sped.*known: lat, lon"),
        ("sign = -1", "sign = 2", r"quantity.heading_deg.sign"),
        ('"Europe/Berlin"', '"Europe/Bonn"', r"time.zone = 'Europe/Bonn'"),
        ('"Europe/Berlin"', '"../../etc/passwd"', r"time.zone"),
        ('"%d.%m.%Y %H:%M:%S"', '"dmy"', r"time.unit = 'dmy': must be iso"),
        ('decimal = ","', 'decimal = ";"', r"decimal"),
        ("skip_bad_rows", "skip_rows", r"skip_rows"),
        ("time = {", "time = [", r"not TOML"),
    ],
)
def test_what_is_wrong_in_a_map_is_named(tmp_path: Path, old: str, new: str, wanted: str) -> None:
    assert old in GERMAN_MAP
    with pytest.raises(InputError, match=wanted):
        _read(tmp_path, GERMAN, GERMAN_MAP.replace(old, new))


IMU = "\n".join(
    ["zeit;wa;wb;wc;ba;bb;bc", *(f"{k};0,1;0,2;0,3;1,0;2,0;-9810,0" for k in range(0, 500, 10)), "---"]
)
IMU_MAP = """
time = { column = "zeit", unit = "ms" }
decimal = ","
skip_bad_rows = true
""" + "".join(
    f'[quantity.{kind}{axis}{unit}]\ncolumn = "{letter}{column}"\nunit = "{given}"\nsign = {sign}\n'
    for kind, unit, letter, given in (("g", "_rad_s", "w", "deg/s"), ("f", "_mps2", "b", "mm/s²"))
    for axis, column, sign in (("x", "b", 1), ("y", "a", 1), ("z", "c", -1))
)


def test_an_imu_is_read_by_a_map_with_its_axes_turned(tmp_path: Path) -> None:
    table, text = _files(tmp_path, IMU, IMU_MAP.replace("mm/s²", "g").replace("[quantity", "\n[quantity"))
    record = read_imu(table, column_map=read_map(text))
    assert record.rate_hz == pytest.approx(100.0) and len(record.increments) == 50
    np.testing.assert_allclose(record.increments[3, :3], np.array([0.2, 0.1, -0.3]) * DEG * 0.01)
    np.testing.assert_allclose(record.increments[3, 3:], np.array([2.0, 1.0, 9810.0]) * 9.80665 * 0.01)
    assert "1 row that cannot be read skipped: 52" in record.warnings[0]


def test_the_map_of_a_scenario_stands_beside_its_file(tmp_path: Path) -> None:
    _files(tmp_path, GERMAN, GERMAN_MAP)
    (tmp_path / "run.toml").write_text(
        'schema = 1\n[reference]\nkind = "file"\nfile = "log.csv"\nmap = "map.toml"\n[[method]]\n'
    )
    scenario = load_scenario(str(tmp_path / "run.toml"))
    assert scenario.reference.map == str(tmp_path / "map.toml")
    read = load(scenario.reference.file or (), map_file=scenario.reference.map)
    assert read.water is not None and read.water.values[0, 1] == pytest.approx(10.5 * KNOT)


def test_a_changed_map_is_read_anew(tmp_path: Path) -> None:
    table, text = _files(tmp_path, GERMAN, GERMAN_MAP)
    before = load(str(table), map_file=text).water
    text.write_text(GERMAN_MAP.replace('"kn"', '"mps" '))
    after = load(str(table), map_file=text).water
    assert before is not None and after is not None
    np.testing.assert_allclose(after.values * KNOT, before.values)


def test_a_map_of_no_table_is_refused(tmp_path: Path) -> None:
    _, text = _files(tmp_path, GERMAN, GERMAN_MAP)
    (tmp_path / "log.nmea").write_text("$HEHDT,10.0,T*2F\n" * 9)
    with pytest.raises(InputError, match="describes a table"):
        read_recording(tmp_path / "log.nmea", read_map(text))


LOGS = {
    "log": "time,STW (m/s),Heading\n" + "\n".join(f"2024-05-01T12:00:{k:02d}Z,5.0,{k}.5" for k in range(20)),
    "semicolon": "t;speed (kn)\n" + "\n".join(f"{k};5.{k}" for k in range(10)),
    "tabs": "date\ttime\tlat\tlon\n" + "\n".join(f"2024-05-01\t12:00:{k:02d}\t1.0\t2.0" for k in range(20)),
    "imu": "Time (ms),GYRO X [deg/s],GYRO Y [deg/s],GYRO Z [deg/s],ACC X [g],ACC Y [g],ACC Z [g]\n"
    + "\n".join(f"{10 * k},1e-3,0,0,0,0,1.0" for k in range(40)),
}


@pytest.mark.parametrize("name", LOGS)
def test_the_guess_reads_the_file_as_it_was_read(
    tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "a.csv").write_text(LOGS[name])
    file, target = str(tmp_path / "a.csv"), str(tmp_path / "m.toml")
    assert main(["check", file, "--write-map", target, "--json"]) == 0
    before = json.loads(capsys.readouterr().out)
    assert main(["check", file, "--map", target, "--json"]) == 0
    after = json.loads(capsys.readouterr().out)
    same = ("quantities", "samples", "rate_hz", "mean_force_mps2", "mean_turn_dph")
    assert [before.get(key) for key in same] == [after.get(key) for key in same]
    assert parse_map(Path(target).read_text(), "m.toml").quantity


def test_the_guess_of_a_file_that_is_refused_lists_its_columns(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table, _ = _files(tmp_path, GERMAN.split("\n", 1)[1], "")
    target = tmp_path / "m.toml"
    assert main(["check", str(table), "--write-map", str(target)]) == 2
    assert '#   "fahrt": 10,5, 10,6' in target.read_text()
    assert main(["check", str(table), "--write-map", str(tmp_path / "no" / "m.toml")]) == 2
    assert "--write-map" in capsys.readouterr().err
