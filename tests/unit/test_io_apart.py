"""Streams that share no time for a known reason say which."""

from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.io.recording import load, shared_window
from navcore.io.series import Series


def _series(start_s: float) -> Series:
    time_s = start_s + np.arange(60.0)
    return Series(time_s, np.zeros((60, 1)), np.ones(60, dtype=bool), "log", "HDT")


@pytest.mark.parametrize(
    ("apart_s", "said"),
    [
        (1024 * 604800.0, "1024 weeks"),
        (-2048 * 604800.0 + 7.0, "2048 weeks"),
        (3 * 3600.0, "3 h: is one of them in local time"),
    ],
)
def test_the_reason_is_named(apart_s: float, said: str) -> None:
    with pytest.raises(InputError, match=said):
        shared_window([_series(1.6e9), _series(1.6e9 + apart_s)])


def test_no_reason_is_made_up() -> None:
    with pytest.raises(InputError) as caught:
        shared_window([_series(1.6e9), _series(1.6e9 + 5.3e6)])
    assert "apart" not in str(caught.value)


def _table(folder: Path, name: str, header: str, offset: float, begin_s: float = 0.0) -> Path:
    path = folder / name
    rows = [f"{1.7e9 + begin_s + k},{10.0 + offset}" for k in range(30)]
    path.write_text("\n".join([f"unix_time,{header}", *rows]) + "\n")
    return path


@pytest.mark.parametrize(
    ("header", "offset", "said"),
    [
        ("stw_kn", 1.5, "a.csv speed is taken (30), b.csv speed (30) is not used: they differ "
                        "by 1.5 kn"),
        ("heading_deg", 4.0, "a.csv heading_deg is taken (30), b.csv heading_deg (30) is not used: they "
                             "differ by 4 °"),
    ],
)  # fmt: skip
def test_a_quantity_of_two_files_is_compared(tmp_path: Path, header: str, offset: float, said: str) -> None:
    files = [_table(tmp_path, "a.csv", header, 0.0), _table(tmp_path, "b.csv", header, offset)]
    assert any(said in text for text in load(files).warnings)
    assert not load(files[:1]).warnings and not load([files[0], files[0]]).warnings


def test_files_one_after_the_other_are_said_not_to_be_joined(tmp_path: Path) -> None:
    files = [_table(tmp_path, "a.csv", "stw_kn", 0.0), _table(tmp_path, "b.csv", "stw_kn", 0.0, 100.0)]
    (told,) = load(files).warnings
    assert "a.csv speed is taken" in told and "they share too little time" in told
