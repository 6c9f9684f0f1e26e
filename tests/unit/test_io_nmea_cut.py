"""NMEA 0183 sentences that are cut off: left out and counted, never used with half a number."""

from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.io.nmea_lines import Tally, intact_sentences
from navcore.io.nmea_sentences import decode
from navcore.io.recording import read_recording
from tests.nmea import sentence

WHOLE = (
    "GPGGA,120000.00,4500.1000,N,01200.2000,E,1,08,1.0,12.34,M,45.60,M,,",
    "GPGLL,4500.1000,N,01200.2000,E,120000.00,A,A",
    "GPGNS,120000.00,4500.1000,N,01200.2000,E,AA,08,1.0,12.34,45.60,,",
    "HCHDG,123.4,1.5,E,4.5,W",
    "HEHDT,123.4,T",
    "GPRMC,120000.00,A,4500.1000,N,01200.2000,E,10.25,123.4,130524,,,A",
    "HETHS,123.4,A",
    "VDVBW,10.25,0.35,A,10.45,0.55,A,,V,,V",
    "VDVHW,123.4,T,,M,10.25,N,18.98,K",
    "GPVTG,123.4,T,,M,10.25,N,18.98,K,A",
    "GPZDA,120000.00,13,05,2024,00,00",
    "PSAT,HPR,120000.00,123.40,-1.25,2.35,N",
    "PSXN,23,1.25,-2.35,123.40,0.15",
)
"""One of each kind, without a checksum; of PRDID the heading stands at the end, with no field behind it."""


def _decoded(line: str) -> dict[str, list[float]]:
    (sentences,) = intact_sentences(line + "\n", Tally())
    return {
        name: [value for value in values[0].tolist() if value == value]
        for name, rows, values in decode(sentences).quantities
        if rows.size
    }


@pytest.mark.parametrize("body", WHOLE)
def test_no_part_of_a_sentence_gives_another_reading(body: str) -> None:
    whole = _decoded(f"${body}")
    for size in range(len(body)):
        for name, values in _decoded(f"${body[:size]}").items():
            assert values == pytest.approx(whole[name][: len(values)]), body[:size]
    assert _decoded(sentence(body)) == whole


def _log(folder: Path, checksum: bool) -> Path:
    lines: list[str] = []
    for t in range(60):
        rmc = f"GPRMC,12{t // 60:02d}{t % 60:02d}.00,A,4500.{t:04d},N,01200.2000,E,10.1,045.0,130524,,,A"
        lines += [sentence(rmc) if checksum else f"${rmc}"]
        hdt = f"HEHDT,12{t % 10}.4,T"
        lines += [f"${hdt[:8]}" if t % 10 == 0 else sentence(hdt) if checksum else f"${hdt}"]
    path = folder / "log.nmea"
    path.write_text("\n".join([*lines, "$HEHDT,121.4,T*", "$HEHDT,12" + sentence("HEHDT,123.4,T")]) + "\n")
    return path


@pytest.mark.parametrize("checksum", [True, False])
def test_what_is_cut_off_is_unparsable_counted_and_told(tmp_path: Path, checksum: bool) -> None:
    path = _log(tmp_path, checksum)
    read = read_recording(path)
    (source,) = read.sources
    assert source.unparsable == 8 and source.lines == 123
    assert source.lines == source.used + sum(one.count for one in source.lines_left_out)
    assert any("8 sentences that are cut off left out (8 HEHDT)" in told for told in read.warnings)
    assert not any("flagged invalid" in told for told in read.warnings)
    assert source.without_checksum == (0 if checksum else 114)
    assert read.heading is not None
    degrees = [120.4 + t % 10 for t in range(60) if t % 10] + [123.4]
    np.testing.assert_allclose(np.rad2deg(read.heading.values[:, 0]), degrees)
    lost = {(one["kind"], one["why"]): one["count"] for one in check_file(path).as_dict()["lines_left_out"]}
    assert lost["HEHDT", "cut off"] == 8
