"""Stamps coarser than the data are neither gaps nor disorder."""

from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.io.recording import read_recording
from navcore.io.series import Recording


def _read(folder: Path, times: list[str]) -> Recording:
    path = folder / "log.csv"
    rows = (f"2022-11-05T04:00:{time}Z,{70 + 0.1 * k:.1f}\n" for k, time in enumerate(times))
    path.write_text("utc,heading\n" + "".join(rows))
    return read_recording(path)


@pytest.mark.parametrize("rows", [2, 5, 10])
def test_rows_of_one_second_are_spread_over_it(tmp_path: Path, rows: int) -> None:
    read = _read(tmp_path, [f"{k // rows:02d}" for k in range(8 * rows)])
    assert read.heading is not None
    assert np.diff(read.heading.time_s) == pytest.approx(1.0 / rows, abs=1e-6)
    assert any("same time" in word for word in read.warnings)


def test_a_second_that_begins_before_the_file_has_its_last_rows(tmp_path: Path) -> None:
    read = _read(tmp_path, [f"{(k + 3) // 4:02d}" for k in range(22)])
    assert read.heading is not None
    assert np.diff(read.heading.time_s) == pytest.approx(0.25, abs=1e-6)


def test_a_time_that_is_there_twice_with_other_values_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="same as in the row before, with other values"):
        _read(tmp_path, [f"{k:02d}" for k in (0, 1, 2, 2, 3, 4, 5)])


def test_rows_out_of_order_are_still_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="put the rows in order"):
        _read(tmp_path, ["00", "00", "01", "01", "00", "02", "02"])


def test_a_table_without_any_time_is_refused_and_raises_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("utc,heading\n,\n,5\n")
    with pytest.raises(InputError):
        read_recording(path)
