"""Flags and second columns of tables: what is not valid is missing, and which column is taken is said."""

from pathlib import Path

import pytest

from navcore.checks.file import check_file
from navcore.io.nmea_flags import INVALID
from navcore.io.recording import read_recording
from navcore.io.series import Recording
from navcore.io.table_flags import TABLE_FLAGS, TableFlag

COLUMNS = {
    "lat": "50.0", "lon": "-4.0", "sog": "8.0", "cog": "60.0", "heading": "60.0", "speed": "8.1",
    "speed_starboard": "0.1", "ground": "8.0", "ground_starboard": "0.0",
}  # fmt: skip
HOLDING = {"lat": "position", "heading": "heading", "speed": "water", "ground": "ground"}
CASES = [
    (flag, name, cell)
    for flag in TABLE_FLAGS
    for name in (flag.names[0], flag.names[-1])
    for cell in flag.meanings
    if cell
]


def _table(folder: Path, columns: dict[str, str], flag: str = "", cells: tuple[str, ...] = ()) -> Path:
    path = folder / "log.csv"
    rows = [",".join(["t_s", *columns, *([flag] if flag else [])])]
    rows += [
        ",".join([str(k), *columns.values(), *([cells[k % len(cells)]] if flag else [])]) for k in range(20)
    ]
    path.write_text("\n".join(rows) + "\n")
    return path


@pytest.mark.parametrize(("flag", "name", "cell"), CASES, ids=lambda part: str(part)[:24])
def test_a_flag_of_a_table_means_what_its_kind_says(
    tmp_path: Path, flag: TableFlag, name: str, cell: str
) -> None:
    good = next(letter for letter, meaning in flag.meanings.items() if letter and not meaning)
    read: Recording = read_recording(_table(tmp_path, COLUMNS, name, (good, cell)))
    said = flag.meanings[cell]
    quantity = next(HOLDING[stem] for stem in flag.stems if stem in HOLDING)
    series = read.quantities()[quantity]
    assert series.time_s.size == (10 if said == INVALID else 20)
    told = " ".join(read.warnings)
    assert (f"are {said}" in told) == bool(said and said != INVALID)
    assert ("10 rows of" in told and "flagged invalid" in told) == (said == INVALID)


def test_a_column_of_other_words_is_no_flag(tmp_path: Path) -> None:
    read = read_recording(_table(tmp_path, COLUMNS, "status", ("MOORED", "V")))
    assert read.position is not None and read.position.time_s.size == 20
    assert any("columns not used: status" in told for told in read.warnings)


@pytest.mark.parametrize(
    ("name", "cell", "said"),
    [
        (
            "gyro_heading",
            "70.0",
            "heading: column heading is taken, gyro_heading is not used: they differ by 10 °",
        ),
        ("log_speed", "6.5", "speed is taken, log_speed is not used: they differ by 1.6 kn"),
        ("gps_lat", "50.01", "position: column lat is taken, gps_lat is not used: they differ by 1.1"),
    ],
)
def test_of_two_columns_the_one_that_is_taken_is_said(
    tmp_path: Path, name: str, cell: str, said: str
) -> None:
    report = check_file(_table(tmp_path, COLUMNS, name, (cell,)))
    assert any(said in told for told in report.warnings)
    assert any(said in line for line in report.text)


def test_columns_that_agree_are_told_without_a_warning(tmp_path: Path) -> None:
    report = check_file(_table(tmp_path, COLUMNS, "gyro_heading", ("60.5",)))
    assert any("differ by 0.5 °" in line for line in report.text)
    assert not any("differ" in told for told in report.warnings)
