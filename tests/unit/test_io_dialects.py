"""Messages of ArduPilot and MAVLink as tables: units and flags by definition, several sensors in one file."""

from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.checks.map_guess import guessed_map
from navcore.foundation.units import DEG, MICRO_G
from navcore.io.column_map import parse_map
from navcore.io.dialects import DIALECTS, dialect_of, meant
from navcore.io.imu_table import is_imu_table, read_imu_table
from navcore.io.recording import read_recording

T0 = 1715938200.0
GPS = "timestamp,TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U"
IMU = "timestamp,TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,EG,EA,T,GH,AH,GHz,AHz"


def _gps(status: int, k: int, instance: int = 0, stamp: bool = True) -> str:
    time = f"{T0 + k:.2f}," if stamp else ""
    place = f"{45 + 5e-5 * k:.7f},{12 + 1e-5 * k + instance:.7f}"
    return (
        f"{time}{10**7 + k * 10**6},{instance},{status},{466218000 + k},2314,12,0.8,{place},20,5.61,8,0,0,1"
    )


def _write(path: Path, header: str, rows: list[str]) -> Path:
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def test_every_column_of_a_message_is_known() -> None:
    for dialect in DIALECTS:
        header = [*dialect.signs, *dialect.columns]
        assert dialect_of(header) is not None
        assert len(meant(header)) == len(header)
    assert dialect_of(["Lat", "Lng", "Spd"]) is None


@pytest.mark.parametrize("stamp", [True, False])
def test_ardupilot_gps_has_its_status_and_speed_in_mps(tmp_path: Path, stamp: bool) -> None:
    rows = [_gps((0, 1, 3, 6)[min(k // 20, 3)], k, stamp=stamp) for k in range(120)]
    path = _write(tmp_path / "gps.csv", GPS if stamp else GPS.removeprefix("timestamp,"), rows)
    read = read_recording(path)
    assert read.position is not None and read.velocity is not None and read.heading is None
    assert read.position.time_s.size == 80 and read.position.dated == stamp
    np.testing.assert_allclose(np.hypot(*read.velocity.values.T), 5.61)
    np.testing.assert_allclose(read.position.time_s[0], T0 + 40.0 if stamp else 50.0)
    told = " ".join(check_file(path).warnings)
    assert "those of an ArduPilot message GPS" in told and "40 rows of lat, lon" in told
    assert "names no unit" not in told and "is not that of the positions" not in told


def test_of_several_receivers_the_first_is_read_and_the_others_are_counted(tmp_path: Path) -> None:
    rows = [_gps(3, k, instance) for k in range(50) for instance in (0, 1)]
    read = read_recording(_write(tmp_path / "gps.csv", GPS, rows))
    assert read.position is not None and read.position.time_s.size == 50
    np.testing.assert_allclose(np.rad2deg(read.position.values[:, 1]).max(), 12.00049)
    (source,) = read.sources
    assert source.lines == 100 == source.used + sum(one.count for one in source.lines_left_out)
    assert any("50 rows of other sensors of this kind" in told for told in read.warnings)


@pytest.mark.parametrize("instances", [1, 3])
def test_ardupilot_imu_is_in_si(instances: int) -> None:
    rows = [
        f"{T0 + k / 50:.4f},{10**7 + k * 20000},{i},0.0{i + 1},-0.02,0.03,0.1,-0.2,-9.8,0,0,45,1,1,1000,1000"
        for k in range(100)
        for i in range(instances)
    ]
    text = "\n".join([IMU, *rows]) + "\n"
    assert is_imu_table(text)
    table = read_imu_table(text.encode(), "imu.csv")
    np.testing.assert_allclose(np.diff(table.time_s), 0.02)
    np.testing.assert_allclose(table.values[5], [0.01, -0.02, 0.03, 0.1, -0.2, -9.8])
    told = " ".join(table.warnings)
    assert "an ArduPilot message IMU" in told
    assert (f"{100 * (instances - 1)} rows of other sensors" in told) == (instances > 1)


@pytest.mark.parametrize(
    ("extra", "row", "values"),
    [
        ("xmag", "3,-5,-1000,1,0,-2,4", [1e-3, 0, -2e-3, 3e3 * MICRO_G, -5e3 * MICRO_G, -1e6 * MICRO_G]),
        ("fields_updated", "0.1,-0.2,-9.8,0.01,0,-0.02,63", [0.01, 0, -0.02, 0.1, -0.2, -9.8]),
    ],
)
def test_mavlink_imus_have_their_own_units(extra: str, row: str, values: list[float]) -> None:
    text = f"timestamp,time_boot_ms,xacc,yacc,zacc,xgyro,ygyro,zgyro,{extra}\n"
    text += "".join(f"{T0 + k * 0.02:.4f},{k * 20},{row}\n" for k in range(50))
    np.testing.assert_allclose(read_imu_table(text.encode(), "imu.csv").values[7], values, atol=1e-9)


def test_mavlink_positions_are_integers_with_placeholders(tmp_path: Path) -> None:
    header = "timestamp,time_boot_ms,lat,lon,alt,relative_alt,vx,vy,vz,hdg"
    rows = [
        f"{T0 + k},{k * 1000},{450000000 + 500 * k},{120000000 + 100 * k},20100,100,556,78,0,"
        f"{65535 if k < 5 else 800}"
        for k in range(60)
    ]
    path = _write(tmp_path / "pos.csv", header, rows)
    read = read_recording(path)
    assert read.position is not None and read.velocity is not None and read.heading is not None
    np.testing.assert_allclose(read.position.values[0, :2], [45 * DEG, 12 * DEG])
    np.testing.assert_allclose(read.velocity.values[0], [0.78, 5.56])
    assert read.heading.time_s.size == 55
    np.testing.assert_allclose(read.heading.values[:, 0], 8.0 * DEG)
    assert not [told for told in check_file(path).warnings if "is not that of" in told or "radians" in told]
    mapped = read_recording(path, parse_map(guessed_map(str(path)), "map"))
    assert mapped.position is not None
    np.testing.assert_allclose(mapped.position.values[0, :2], [45 * DEG, 12 * DEG])


def test_a_dataflash_log_as_text_is_refused_by_its_name(tmp_path: Path) -> None:
    lines = ["FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns"]
    lines += [
        "FMT, 130, 45, GPS, QBBIHBcLLeffffB, TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ,Yaw,U"
    ]
    lines += [
        f"GPS, {10**7 + k * 10**6}, 0, 3, 466218000, 2314, 12, 0.8, 45, 12, 20, 5, 8, 0, 0, 1"
        for k in range(30)
    ]
    (fault,) = check_file(_write(tmp_path / "00000012.log", lines[0], lines[1:])).faults
    assert "ArduPilot log" in fault.allowed and "mavlogdump.py" in fault.allowed
