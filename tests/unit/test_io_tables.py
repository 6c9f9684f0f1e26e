"""CSV, Parquet and MAT tables: columns named with their units, faults that name row and column."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from navcore.errors import InputError
from navcore.io.recording import read_recording
from navcore.units import DEG, KNOT

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
        ("t_s,heading_deg\n0,1\n1,x\n2,\n", ["row 3: heading_deg = 'x': is not", "row 4: heading_deg = ''"]),
        ("t_s;heading_deg\n0;1,5\n", ["row 2: heading_deg = '1,5': is not a number (decimal comma?)"]),
        ("t_s,heading_deg\n0,nan\n", ["row 2: heading_deg = nan: must be a number from -360 to 360"]),
        ("t_s,heading_deg\n0,inf\n", ["row 2: heading_deg = inf"]),
        ("t_s,lat_deg,lon_deg\n0,91,0\n", ["row 2: lat_deg = 91.0: must be a number from -90 to 90"]),
        ("t_s,heading_deg\n0,1\n0,2\n", ["row 3: t_s: time is the same time as the row before"]),
        ("t_s,heading_deg\n1,1\n0.5,2\n0.1,2\n", ["row 3: t_s: time runs backwards by 0.5 s (2 such rows)"]),
        ("t_s,heading_deg\n0,1,2\n", ["row 2: has 3 cells, the header 2"]),
        ("utc,heading_deg\nyesterday,1\n", ["row 2: utc = 'yesterday': is not an ISO 8601 time"]),
        ('t_s,heading_deg\n0,"1\n', ["not a CSV row"]),
    ],
)  # fmt: skip
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


def test_parquet_has_the_same_columns(tmp_path):
    import pandas as pd

    frame = pd.DataFrame(
        columns() | {"utc": pd.to_datetime(["2024-02-28T23:59:59Z", "2024-02-29T00:00:00Z"])}
    )
    frame.to_parquet(tmp_path / "table.parquet")
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
    import pandas as pd

    pd.DataFrame({"t_s": [0.0, 0.0], "heading_deg": [1.0, 2.0]}).to_parquet(tmp_path / "a.parquet")
    pd.DataFrame({"t_s": [0.0, 1.0], "heading_deg": [1.0, None]}).to_parquet(tmp_path / "b.parquet")
    pd.DataFrame({"t_s": [0.0, 1.0], "heading_deg": ["x", "y"]}).to_parquet(tmp_path / "c.parquet")
    assert "row 2: t_s: time is the same" in faults(tmp_path / "a.parquet")[0]
    assert "row 2: heading_deg = nan" in faults(tmp_path / "b.parquet")[0]
    assert "heading_deg: must be a column of numbers" in faults(tmp_path / "c.parquet")[0]


@pytest.mark.parametrize("head", [b"PAR1", b"MATLAB 5.0 MAT-file, "])
def test_a_damaged_binary_table_is_one_line(tmp_path, head):
    path = tmp_path / "damaged"
    path.write_bytes(head + bytes(range(256)) * 3)
    found = faults(path)
    assert len(found) == 1
    assert "cannot be read as a" in found[0]
