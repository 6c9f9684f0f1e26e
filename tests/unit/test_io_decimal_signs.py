"""Commas and points of the numbers of a table: decimal sign, groups of three, or refused by name."""

from pathlib import Path

import numpy as np
import pytest

from navcore.checks.map_guess import guessed_map
from navcore.foundation.errors import InputError
from navcore.io.column_map import parse_map
from navcore.io.decimal_signs import Signs, signs_of
from navcore.io.recording import read_recording

TABLES = [
    ({"t": ["0", "1"], "v": ["5.0", "5.1"]}, Signs(".", "")),
    ({"t": ["0", "1"], "v": ["5,0", "5,1"]}, Signs(",", "")),
    ({"lat": ["45,123", "45,234"]}, Signs(",", "")),
    ({"t": ["0,123", "1,000"]}, Signs(",", "")),
    ({"t": ["0", "1,125", "2,255"]}, Signs(",", "")),
    ({"t": ["0", "500", "1,000", "1,500"], "v": ["5", "5"]}, Signs(".", ",")),
    ({"t": ["0", "1,000"], "v": ["5.0", "5.0"]}, Signs(".", ",")),
    ({"t": ["999,000", "1,000,000"], "v": ["5", "5"]}, Signs(".", ",")),
    ({"t": ["1,000.25", "1,000.50"]}, Signs(".", ",")),
    ({"t": ["0", "1.000", "2.000"], "v": ["5,0", "5,1", "5,2"]}, Signs(",", ".")),
    ({"t": ["1.000,25", "1.000,5"], "v": ["5,0", "5"]}, Signs(",", ".")),
    ({"t": ["1.000.000", "1.001.000"]}, Signs(",", ".")),
    ({"date": ["17.05.2024", "18.05.2024"], "v": ["5,0", "5,1"]}, Signs(",", "")),
    ({"t": ["2024-05-17T09:30:00,5", "2024-05-17 09:30:01,5"], "v": ["5.0", "5.1"]}, Signs(".", "")),
]


@pytest.mark.parametrize(("columns", "signs"), TABLES)
def test_a_table_has_one_decimal_sign(columns: dict[str, list[str]], signs: Signs) -> None:
    assert signs_of("log.csv", columns, range(2, 9)) == signs


def test_groups_that_begin_late_in_a_long_table_are_seen() -> None:
    counts = [f"{t:,}" for t in range(0, 5_000_000, 500)]
    assert signs_of("log.csv", {"t": counts}, range(len(counts))) == Signs(".", ",")


@pytest.mark.parametrize(
    "columns",
    [
        {"t": ["0", "1"], "lat": ["45,12", "45,13"], "v": ["5.0", "5.1"]},
        {"v": ["5,25", "5.25"]},
        {"t": ["0,250", "0,500"], "v": ["5.125", "5.130"]},
    ],
)
def test_signs_that_do_not_go_together_are_refused_by_name(columns: dict[str, list[str]]) -> None:
    with pytest.raises(InputError) as refused:
        signs_of("log.csv", columns, range(2, 9))
    (fault,) = refused.value.faults
    assert fault.where == "log.csv, row 2"
    assert f"{fault.field} = {fault.value}" in ("lat = 45,12", "v = 5,25", "t = 0,250")
    assert "v = 5." in fault.allowed and "decimal of a map" in fault.allowed


@pytest.mark.parametrize("header", ["time_ms;speed_mps;heading_deg", '"time (ms)",speed_mps,heading_deg'])
def test_thousands_are_read_with_and_without_a_map(tmp_path: Path, header: str) -> None:
    separator = ";" if ";" in header else ","
    rows = [separator.join([f'"{t * 1000:,}"', "5.0", "90.0"]) for t in range(1200)]
    path = tmp_path / "log.csv"
    path.write_text("\n".join([header, *rows]) + "\n")
    read = read_recording(path)
    assert read.water is not None
    np.testing.assert_allclose(read.water.time_s, np.arange(1200.0))
    assert any("commas before groups of three digits" in told for told in read.warnings)
    mapped = read_recording(path, parse_map(guessed_map(str(path)), "map")).water
    assert mapped is not None
    np.testing.assert_allclose(mapped.time_s, np.arange(1200.0))


def test_a_map_reads_both_signs_as_decimal_signs(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t;lat;lon;fahrt\n" + "".join(f"{t},234;45,1234;12.5;5.123\n" for t in range(20)))
    time = 'time = { column = "t", unit = "s" }\ndecimal = ","\n'
    speed = '[quantity.speed]\ncolumn = "fahrt"\nunit = "mps"\n'
    water = read_recording(path, parse_map(time + speed, "map")).water
    assert water is not None
    np.testing.assert_allclose(water.time_s, np.arange(20) + 0.234)
    np.testing.assert_allclose(water.values[:, 1], 5.123)
