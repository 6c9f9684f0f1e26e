"""Files as strangers hand them in: what is read, and what the refusal or the warning says."""

from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.io.recording import read_recording

T0 = 1715938200
T = np.arange(120)


def _write(folder: Path, text: str) -> Path:
    path = folder / "log.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_a_row_of_units_may_have_empty_cells(tmp_path: Path) -> None:
    rows = "".join(f"{T0 + k},{0.78 + 1e-6 * k:.8f},{0.2:.8f},9.5,60\n" for k in T)
    read = read_recording(_write(tmp_path, f"unix_time,Lat,Lon,STW,Hdg\n,rad,rad,,deg (T)\n{rows}"))
    assert read.position is not None and read.heading is not None
    np.testing.assert_allclose(read.position.values[0, :2], [0.78, 0.2])
    assert read.sources[0].lines == T.size and not any("without a time" in told for told in read.warnings)


def test_a_row_of_sides_is_no_row_of_units(tmp_path: Path) -> None:
    rows = "".join(f"{T0 + k},45.{k:04d},N,12.0,E\n" for k in T)
    read = read_recording(_write(tmp_path, f"unix_time,lat,lat_dir,lon,lon_dir\n,,S,,E\n{rows}"))
    assert read.position is not None and read.position.values[0, 0] == pytest.approx(45.0 * DEG)


@pytest.mark.parametrize(
    ("group", "decimal"), [("'", "."), ("’", "."), ("\u202f", ","), ("\u00a0", ","), ("\u2009", ".")]
)
def test_apostrophes_and_narrow_spaces_group_digits_in_times_too(
    tmp_path: Path, group: str, decimal: str
) -> None:
    def cell(value: float) -> str:
        return f"{value:,.1f}".replace(",", "g").replace(".", decimal).replace("g", group)

    rows = "".join(f"{cell(1000.0 * k)};{cell(9.5)};{60 + k % 3}\n" for k in T)
    water = read_recording(_write(tmp_path, f"time_ms;speed_kn;heading\n{rows}")).water
    assert water is not None
    np.testing.assert_allclose(water.time_s, T)
    np.testing.assert_allclose(water.values[:, 1], 9.5 * KNOT)


def test_a_time_with_a_unit_that_is_no_number_is_called_so(tmp_path: Path) -> None:
    path = _write(tmp_path, "time_ms;speed_kn;heading\n99,000;9.5;60\n1,00,000;9.5;60\n1,01,000;9.5;60\n")
    with pytest.raises(InputError) as refused:
        read_recording(path)
    assert [fault.value for fault in refused.value.faults] == ["1,00,000", "1,01,000"]
    assert all("is not a number" in fault.allowed for fault in refused.value.faults)


def test_files_one_behind_the_other_have_their_header_again(tmp_path: Path) -> None:
    def rows(begin: int) -> str:
        return "unix_time,heading\n" + "".join(f"{begin + k},{60 + k % 7}\n" for k in T)

    read = read_recording(_write(tmp_path, rows(T0) + rows(T0 + T.size) + rows(T0 + T.size)))
    assert read.heading is not None and read.heading.time_s.size == 2 * T.size
    assert any("the header stands in 2 rows more" in told for told in read.warnings)
    (source,) = read.sources
    assert source.lines == source.used + sum(one.count for one in source.lines_left_out)


@pytest.mark.parametrize("names", ["header.stamp.sec,header.stamp.nanosec", "stamp_secs,stamp_nsecs"])
def test_the_nanoseconds_of_a_ros_stamp_are_read(tmp_path: Path, names: str) -> None:
    rows = "".join(
        f"{T0 + k // 10},{(0, 120, 190, 300, 410, 480, 600, 720, 780, 900)[k % 10]}000000,{k}\n" for k in T
    )
    heading = read_recording(_write(tmp_path, f"{names},heading\n{rows}")).heading
    assert heading is not None and heading.dated
    np.testing.assert_allclose(heading.time_s[:4] - T0, [0.0, 0.12, 0.19, 0.3], atol=1e-6)


def test_degrees_and_minutes_run_together_are_named(tmp_path: Path) -> None:
    rows = "".join(f"{T0 + k},{4530.1 + 1e-3 * k:.4f},N,{1210.5:.4f},W\n" for k in T)
    path = _write(tmp_path, f"unix_time,latitude,N/S,longitude,E/W\n{rows}")
    assert all("degrees and minutes run together?" in f.allowed for f in check_file(path).faults if f.value)


def test_a_px4_fix_is_read_by_its_definition(tmp_path: Path) -> None:
    header = "timestamp,time_utc_usec,lat,lon,alt,eph,vel_m_s,vel_n_m_s,vel_e_m_s,cog_rad,fix_type,heading"
    rows = "".join(
        f"{5_000_000 + k * 10**6},{(T0 + k) * 10**6},{450_000_000 + 500 * k},{120_000_000 + 100 * k},"
        f"20100,0.9,5.61,5.56,0.79,{8.0 * DEG:.5f},{0 if k < 20 else 3},nan\n"
        for k in T
    )
    read = read_recording(_write(tmp_path, f"{header}\n{rows}"))
    assert read.position is not None and read.velocity is not None and read.heading is None
    assert read.position.time_s[0] == pytest.approx(T0 + 20.0)
    np.testing.assert_allclose(np.hypot(*read.velocity.values.T), 5.61)
    assert not [told for told in check_file(tmp_path / "log.csv").warnings if "is not that of" in told]


@pytest.mark.parametrize(
    ("heading", "said"),
    [
        (8.0 * DEG - np.pi, "radians taken for degrees"),
        (-1.5, "radians taken for degrees"),
        (940.0 % 360.0, "tenths of a degree taken for degrees"),
    ],
)
def test_a_heading_in_another_unit_is_named_among_the_causes(
    tmp_path: Path, heading: float, said: str
) -> None:
    course = {True: np.rad2deg(heading), False: 22.0}[said.startswith("radians")]
    north, east = 5e-5 * np.cos(course * DEG), 5e-5 * np.sin(course * DEG) / np.cos(45.0 * DEG)
    rows = "".join(f"{T0 + k},{45 + north * k:.7f},{12 + east * k:.7f},{heading:.5f}\n" for k in T)
    path = _write(tmp_path, f"unix_time,lat,lon,heading\n{rows}")
    (told,) = [words for words in check_file(path).warnings if "from the course of the track" in words]
    assert said in told
