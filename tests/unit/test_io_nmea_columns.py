"""Columns of an NMEA 0183 log are read as its fields would be one by one, wherever its blocks end."""

import re
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navcore.io import nmea_lines
from navcore.io.decimals import MOST_LETTERS, decimals
from navcore.io.iso_stamps import iso_seconds
from navcore.io.nmea_plain import Block
from navcore.io.recording import read_recording
from tests.nmea import gga, rmc, sentence, stamped, vbw, write

PLAIN = re.compile(rf"-?(?=.{{1,{MOST_LETTERS}}}$)(?:\d+\.?\d*|\.\d+)", re.ASCII)


def cells(texts: list[str]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Characters of texts joined by commas, and where each begins and ends."""
    block = Block(",".join(texts) + "\n")
    return block.letters, np.append(0, block.commas + 1), np.append(block.commas, block.letters.size - 1)


@given(st.lists(st.from_regex(PLAIN, fullmatch=True) | st.text("0123456789.-+e_x", max_size=18), min_size=1))
def test_decimal_numbers_are_what_float_makes_of_them(texts: list[str]) -> None:
    for text, number in zip(texts, decimals(*cells(texts)).tolist(), strict=True):
        assert repr(number) == (repr(float(text)) if PLAIN.fullmatch(text) else "nan")


@given(
    st.datetimes(datetime(2000, 1, 1), datetime(2199, 12, 31)),
    st.integers(0, 9),
    st.sampled_from(["", " ", "\t"]),
)
def test_iso_stamps_are_what_datetime_makes_of_them(moment: datetime, places: int, blank: str) -> None:
    fraction = f".{moment.microsecond:06d}999"[: places + 1] if places else ""
    text = f"{moment:%Y-%m-%dT%H:%M:%S}{fraction}Z"
    seconds = iso_seconds(*cells([text + blank, text[:-1], "", text.replace("-", "/")]))
    assert seconds[0] == datetime.fromisoformat(text).replace(tzinfo=UTC).timestamp()
    assert np.isnan(seconds[1:]).all()


@pytest.mark.parametrize("text", ["2023-02-29T00:00:00Z", "2024-13-01T00:00:00Z", "2024-01-01T24:00:00Z"])
def test_a_stamp_that_no_calendar_has_is_none(text: str) -> None:
    assert np.isnan(iso_seconds(*cells([text]))).all()


@pytest.mark.parametrize("size", [1, 100, 700])
def test_a_log_says_the_same_wherever_its_blocks_end(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, size: int
) -> None:
    lines = []
    for k in range(40):
        lines += [stamped(k, rmc(k, 48.0, 12.0, 8.0, 45.0)), stamped(k, gga(k, 48.0, 12.0, 12.0))]
        lines += [f"# {k}", "", sentence("HEHDT,77.5,T"), stamped(k, vbw((0.1, 9.0), (0.0, 8.0)))]
    lines[100] = lines[100].replace("$", "$VD")
    lines[150] = f"{' ' * 900}{lines[150]}"
    lines[151] = "x" * 3000
    path = write(tmp_path / "log.txt", lines)
    whole = read_recording(path)
    monkeypatch.setattr(nmea_lines, "_BLOCK", size)
    parts = read_recording(path)
    assert parts.sources == whole.sources and parts.sources[0].unparsable == 1
    for name, series in whole.quantities().items():
        assert np.array_equal(series.time_s, parts.quantities()[name].time_s)
        assert np.array_equal(series.values, parts.quantities()[name].values, equal_nan=True)
