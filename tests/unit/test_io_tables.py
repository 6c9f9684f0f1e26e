"""CSV, Parquet and MAT tables: columns named with their units, faults that name row and column."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.io.recording import read_recording
from navcore.io.series import utc_text

T0 = datetime(2024, 2, 28, 23, 59, 59, tzinfo=UTC).timestamp()
CSV = """# a comment
utc,lat_deg,lon_deg,height_m,heading_deg,speed_kn,speed_starboard_kn,remark
2024-02-28T23:59:59Z,48.0,-123.0,5.0,359.0,10.0,0.5,a
2024-02-29T00:00:00.500Z,48.1,-123.1,6.0,1.0,11.0,-0.5,"b, c"
"""


def csv_file(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "table.csv"
    path.write_text(text, encoding="utf-8")
    return path


def faults(path: Path) -> list[str]:
    with pytest.raises(InputError) as caught:
        read_recording(path)
    return [str(fault) for fault in caught.value.faults]


def test_csv_columns_become_quantities_in_si(tmp_path):
    recording = read_recording(csv_file(tmp_path, CSV))
    assert recording.position.time_s == pytest.approx([T0, T0 + 1.5])
    assert recording.position.values[1] == pytest.approx([48.1 * DEG, -123.1 * DEG, 6.0])
    assert recording.heading.values[:, 0] == pytest.approx([359.0 * DEG, 1.0 * DEG])
    assert recording.water.values == pytest.approx(np.array([[0.5, 10.0], [-0.5, 11.0]]) * KNOT)
    assert recording.ground is recording.velocity is recording.attitude is None
    assert recording.warnings == ("table.csv: columns not used: remark",)


def test_csv_with_semicolons_and_seconds_is_undated(tmp_path):
    recording = read_recording(csv_file(tmp_path, 't_s;"ve_mps";VN_MPS\n0;1;2\n0.5;3;4\n'))
    assert recording.velocity.values.tolist() == [[1.0, 2.0], [3.0, 4.0]]
    assert not recording.velocity.dated


def test_a_zone_is_heeded_and_no_zone_means_utc(tmp_path):
    text = "utc,heading_deg\n2024-02-29T01:59:59+02:00,1\n2024-02-29T00:00:00,1\n"
    assert read_recording(csv_file(tmp_path, text)).heading.time_s == pytest.approx([T0, T0 + 1.0])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("lat_deg,lon_deg\n1,2\n", ["table.csv: missing column: utc (ISO 8601) or t_s (seconds)"]),
        ("t_s,foo\n1,2\n", ["table.csv: no column of a quantity"]),
        ("t_s,lat_deg\n1,2\n", ["missing column: lon_deg"]),
        ("t_s,vn_mps\n1,2\n", ["missing column: ve_mps"]),
        ("t_s,speed_starboard_kn\n1,2\n", ["missing column: speed_mps or speed_kn"]),
        ("t_s,heading_deg,heading_deg\n1,2,3\n", ["'heading_deg': column given twice"]),
        ("t_s,heading_deg\n", ["a header but no rows"]),
        ("t_s,heading_deg\n0,1\n1,x\n2,\n", ["row 3: heading_deg = 'x': is not"]),
        ("t_s;heading_deg\n0;1,5\n1;1.5\n", ["row 2: heading_deg = '1,5': has a decimal comma, and"]),
        ("t_s,heading_deg\n0,nan\n", ["row 2: heading_deg = nan: must be a number from -360 to 360"]),
        ("t_s,heading_deg\n0,inf\n", ["row 2: heading_deg = inf"]),
        ("t_s,lat_deg,lon_deg\n0,91,0\n", ["row 2: lat_deg = 91.0: must be a number from -90 to 90"]),
        ("t_s,heading_deg\n0,1\n0,2\n", ["row 3: t_s: time is the same as in the row before"]),
        ("t_s,heading_deg\n1,1\n0.5,2\n0.1,2\n", ["row 3: t_s: time runs backwards by 0.5 s (2 such rows)"]),
        ("t_s,heading_deg\n0,1,2\n", ["row 2: has 3 cells, the header 2"]),
        ("utc,heading_deg\nyesterday,1\n", ["row 2: utc = 'yesterday': is not an ISO 8601 time"]),
        ('t_s,heading_deg\n0,"1\n', ["not a CSV row"]),
    ],
)
def test_csv_faults_name_row_and_column(tmp_path, text, said):
    found = faults(csv_file(tmp_path, text))
    assert len(found) == len(said)
    for line, expected in zip(found, said, strict=True):
        assert expected in line


def test_many_faults_of_a_kind_are_cut_short(tmp_path):
    text = "t_s,heading_deg\n" + "".join(f"{k},x\n" for k in range(500))
    found = faults(csv_file(tmp_path, text))
    assert len(found) == 11
    assert "490 more" in found[-1]


def columns() -> dict[str, np.ndarray]:
    return {
        "t_s": np.array([0.0, 1.0]),
        "heading_deg": np.array([10.0, 20.0]),
        "speed_mps": np.array([5, 6]),
        "note": np.array(["a", "b"]),
    }


def write_parquet(path, data):
    import pyarrow.parquet as parquet
    from pyarrow import table

    parquet.write_table(table(data), path)


def test_parquet_has_the_same_columns(tmp_path):
    utc = [datetime(2024, 2, 28, 23, 59, 59, tzinfo=UTC), datetime(2024, 2, 29, tzinfo=UTC)]
    write_parquet(tmp_path / "table.parquet", columns() | {"utc": utc})
    recording = read_recording(tmp_path / "table.parquet")
    assert recording.heading.time_s == pytest.approx([T0, T0 + 1.0])
    assert recording.water.values.tolist() == [[0.0, 5.0], [0.0, 6.0]]


def test_mat_has_the_same_columns(tmp_path):
    from scipy.io import savemat

    savemat(tmp_path / "table.mat", {k: v for k, v in columns().items() if k != "note"})
    recording = read_recording(tmp_path / "table.mat")
    assert recording.heading.values[:, 0] == pytest.approx([10.0 * DEG, 20.0 * DEG])
    assert not recording.heading.dated


def test_parquet_faults_are_those_of_a_table(tmp_path):
    write_parquet(tmp_path / "a.parquet", {"t_s": [0.0, 0.0], "heading_deg": [1.0, 2.0]})
    write_parquet(tmp_path / "b.parquet", {"t_s": [0.0, 1.0], "heading_deg": [1.0, None]})
    write_parquet(tmp_path / "c.parquet", {"t_s": [0.0, 1.0], "heading_deg": ["x", "y"]})
    write_parquet(tmp_path / "e.parquet", {"t_s": [0.0, 1.0], "heading_deg": [[1.0], [2.0]]})
    write_parquet(tmp_path / "f.parquet", {"utc": ["2024-02-28T23:59:59Z"] * 2, "heading_deg": [1.0, 2.0]})
    write_parquet(tmp_path / "d.parquet", {"t_s": [0, 1, 2], "heading_deg": [1, None, 2]})
    assert read_recording(tmp_path / "d.parquet").heading.time_s.tolist() == [0.0, 2.0]
    assert "row 2: t_s: time is the same" in faults(tmp_path / "a.parquet")[0]
    assert "time is the same as in the row before" in faults(tmp_path / "f.parquet")[0]
    recording = read_recording(tmp_path / "b.parquet")
    assert recording.heading.values[:, 0] == pytest.approx([1.0 * DEG])
    assert recording.warnings == ("b.parquet: empty cells, missing samples: heading_deg 1",)
    for name in ("c.parquet", "e.parquet"):
        assert "heading_deg: must be a column of numbers" in faults(tmp_path / name)[0]


@pytest.mark.parametrize("head", [b"PAR1", b"MATLAB 5.0 MAT-file, "])
def test_a_damaged_binary_table_is_one_line(tmp_path, head):
    path = tmp_path / "damaged"
    path.write_bytes(head + bytes(range(256)) * 3)
    found = faults(path)
    assert len(found) == 1
    assert "cannot be read as a" in found[0]


# ------------------------------------------------------------ as ships' loggers write tables


@pytest.mark.parametrize("separator", [",", ";", "\t", "|", " "])
def test_any_separator_and_common_names_are_read(tmp_path, separator):
    rows = [("Time", "Latitude", "Longitude", "Gyro", "STW", "SOG", "COG")]
    rows += [(f"2024-02-28T23:59:5{k}Z", "48.0", "-123.0", "90.0", "9.5", "10.0", "90.0") for k in range(3)]
    recording = read_recording(csv_file(tmp_path, "\n".join(separator.join(row) for row in rows)))
    assert recording.position.values[0, :2] == pytest.approx([48.0 * DEG, -123.0 * DEG])
    assert recording.heading.values[0, 0] == pytest.approx(90.0 * DEG)
    assert recording.water.values[0] == pytest.approx([0.0, 9.5 * KNOT])
    assert recording.velocity.values[0] == pytest.approx([10.0 * KNOT, 0.0], abs=1e-9)
    assert [w.removeprefix("table.csv: ") for w in recording.warnings] == [
        "column STW names no unit: taken as kn",
        "column SOG names no unit: taken as kn",
    ]


@pytest.mark.parametrize(
    ("name", "mps"),
    [("speed_mps", 2.0), ("Speed (m/s)", 2.0), ("Water Speed [kn]", 2 * KNOT), ("stw_kts", 2 * KNOT),
     ("SpeedThroughWater_knots", 2 * KNOT), ("log_speed (km/h)", 2 / 3.6), ("PL_SOW", 2.0)],
)  # fmt: skip
def test_units_stand_in_the_name(tmp_path, name, mps):
    recording = read_recording(csv_file(tmp_path, f"t_s,{name}\n0,2\n1,2\n"))
    assert recording.water.values[0] == pytest.approx([0.0, mps])


def test_a_row_of_units_below_the_header_is_heeded(tmp_path):
    text = "utc,heading,sog,cog\nISO,degrees,m/s,degrees\n2024-02-28T23:59:59Z,90,2,0\n"
    recording = read_recording(csv_file(tmp_path, text))
    assert recording.velocity.values[0] == pytest.approx([0.0, 2.0])


def test_an_unknown_header_names_the_columns_found_and_those_needed(tmp_path):
    found = faults(csv_file(tmp_path, "takt\tkurs_mag\ttiefe\n1\t2\t3\n2\t3\t4\n"))
    assert len(found) == 2
    assert all("columns found: takt, kurs_mag, tiefe" in fault for fault in found)
    assert "utc" in found[0] and "lat_deg" in found[1] and "speed_kn" in found[1]


def test_an_empty_cell_is_a_missing_sample(tmp_path):
    text = (
        "t_s,lat_deg,lon_deg,heading_deg,speed_kn\n0,48,-123,10,\n1,,-123,20,5\n2,48,-123,,6\n,48,-123,1,1\n"
    )
    recording = read_recording(csv_file(tmp_path, text))
    assert recording.position.time_s.tolist() == [0.0, 2.0]
    assert recording.heading.time_s.tolist() == [0.0, 1.0]
    assert recording.water.time_s.tolist() == [1.0, 2.0]
    assert any("lat_deg 1, heading_deg 1, speed_kn 1" in warning for warning in recording.warnings)
    assert any("1 row without a time" in warning for warning in recording.warnings)


def test_numbers_that_stand_for_no_reading_are_missing(tmp_path):
    recording = read_recording(csv_file(tmp_path, "t_s,heading_deg\n0,1\n1,-999\n2,nan\n3,2\n"))
    assert recording.heading.time_s.tolist() == [0.0, 3.0]


@pytest.mark.parametrize(
    ("names", "cells"),
    [
        ("timestamp", "26.03.2019 10:06:31.5"),
        ("timestamp", "03/26/2019 10:06:31.5"),
        ("timestamp", "1553594791.5"),
        ("timestamp", "1553594791500"),
        ("timestamp", "2019:085:10:06:31.5"),
        ("Date,Time", "03/26/2019,10:06:31.5"),
    ],
)
def test_times_of_a_column_or_two_in_any_known_form(tmp_path, names, cells):
    recording = read_recording(csv_file(tmp_path, f"{names},heading\n{cells},1\n"))
    assert recording.heading.time_s == pytest.approx([1553594791.5])
    assert recording.heading.dated


@pytest.mark.parametrize(
    ("lat", "lon"), [("48.5N", "123.25W"), ("48 30.0' N", "123 15.0' W"), ("4830.000N", "12315.000W")]
)
def test_degrees_with_a_hemisphere(tmp_path, lat, lon):
    recording = read_recording(csv_file(tmp_path, f"t_s,lat,lon\n0,{lat},{lon}\n"))
    assert recording.position.values[0, :2] == pytest.approx([48.5 * DEG, -123.25 * DEG])


def test_a_preamble_and_a_row_cut_off_at_the_end(tmp_path):
    text = (
        "Cruise: X\nShip: Y\n\nutc,lat_deg,lon_deg,heading_deg\n2024-02-28T23:59:59Z,48,-123,1,\n2024-02-29T0"
    )
    recording = read_recording(csv_file(tmp_path, text))
    assert recording.heading.time_s.size == 1
    assert any("cut off" in warning for warning in recording.warnings)


def test_a_nul_byte_costs_its_row(tmp_path):
    path = csv_file(tmp_path, "t_s,heading_deg\n0,1\n1,2\n2,3\n")
    path.write_bytes(path.read_bytes().replace(b"1,2", b"1\0,2"))
    recording = read_recording(path)
    assert recording.heading.time_s.tolist() == [0.0, 2.0]
    assert recording.warnings == ("table.csv: 1 line with NUL bytes left out",)


def test_ground_speed_along_the_axes_is_a_column(tmp_path):
    recording = read_recording(csv_file(tmp_path, "t_s,ground_kn,ground_starboard_kn,speed_kn\n0,8,0.1,9\n"))
    assert recording.ground.values == pytest.approx(np.array([[0.1, 8.0]]) * KNOT)


def test_millions_of_columns_are_told_in_one_short_line(tmp_path):
    found = faults(csv_file(tmp_path, "," * 400_000 + "\n1\n"))
    assert len(found) == 1 and len(found[0]) < 300
    found = faults(csv_file(tmp_path, "t_s," + ",".join(f"unknown {k}" for k in range(900)) + "\n1\n"))
    assert len(found) == 1 and len(found[0]) < 2000


def test_a_mat_file_of_cells_is_refused_unread(tmp_path):
    from scipy.io import savemat

    cell = np.empty((1, 1), dtype=object)
    cell[0, 0] = np.zeros((10, 10))
    savemat(tmp_path / "table.mat", {"t_s": np.array([0.0]), "heading_deg": cell})
    assert "heading_deg: must be a column of numbers, is of class cell" in faults(tmp_path / "table.mat")[0]


def test_a_date_and_a_time_in_gmt_are_one_time(tmp_path: Path) -> None:
    path = tmp_path / "voyage.csv"
    rows = [f"2023/02/11,18:05:{second:02d}.250,80.0" for second in range(30)]
    path.write_text("\n".join(["DATE_GMT,TIME_GMT,HDT", *rows]) + "\n", "utf-8")
    heading = read_recording(path).heading
    assert heading is not None and heading.dated
    assert heading.time_s[1] - heading.time_s[0] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("dates", "first_day"),
    [
        (["13/05/2024", "13/05/2024"], "2024-05-13"),
        (["05/13/2024", "05/13/2024"], "2024-05-13"),
        (["31/05/2024", "01/06/2024"], "2024-05-31"),
        (["01/05/2024", "02/05/2024", "03/05/2024"], "2024-05-01"),
        (["05/01/2024", "05/02/2024", "05/03/2024"], "2024-05-01"),
        (["05/05/2024", "05/05/2024"], "2024-05-05"),
    ],
)
def test_day_or_month_first_is_told_by_the_dates(tmp_path: Path, dates: list[str], first_day: str) -> None:
    path = tmp_path / "log.csv"
    path.write_text("utc,stw_kn\n" + "".join(f"{date} 12:00:0{k},5\n" for k, date in enumerate(dates)))
    water = read_recording(path).water
    assert water is not None and utc_text(water.time_s[0]).startswith(first_day)


def test_day_or_month_first_is_asked_where_both_are_possible(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("utc,stw_kn\n01/05/2024 12:00:00,5\n01/05/2024 12:00:01,5\n")
    with pytest.raises(InputError, match=r"row 2: utc = '01/05/2024 12:00:00': may begin with the day or"):
        read_recording(path)
