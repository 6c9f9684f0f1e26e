"""Flags of quality of every sentence that is read: what is not valid is left out, what was not measured is
told.
"""

from pathlib import Path

import numpy as np
import pytest

from navcore.io.nmea_flags import DEAD_RECKONED, FLAGS, INVALID, UNKNOWN, Flag, meaning
from navcore.io.nmea_sentences import KINDS
from navcore.io.recording import read_recording
from tests.nmea import sentence, stamped, write

PLACE = "3800.0000,N,00900.0000,E"
BODIES = {
    "RMC": "GPRMC,23580{k}.00,A," + PLACE + ",5.0,20.0,280224,,,A",
    "GLL": "GPGLL," + PLACE + ",23580{k}.00,A,A",
    "GGA": "GPGGA,23580{k}.00," + PLACE + ",1,08,1.0,12.0,M,-20.0,M,,",
    "GNS": "GNGNS,23580{k}.00," + PLACE + ",A,12,0.9,10.0,-20.0,,",
    "VTG": "GPVTG,20.0,T,,M,5.0,N,9.3,K,A",
    "THS": "HETHS,20.0,A",
    "VBW": "VDVBW,8.0,0.1,A,7.9,0.1,A,,V,,V",
    "PASHR": "PASHR,23580{k}.00,20.0,T,1.0,-1.0,0.1,0.1,0.1,0.2,1,1",
    "DTM": "GPDTM,W84,,0.0,N,0.0,E,0.0,W84",
    "PSXN,20": "PSXN,20,0,0,0,0",
    "PSAT,HPR": "PSAT,HPR,23580{k}.00,20.0,1.0,-1.0,N",
    "PHOCT": "PHOCT,01,23580{k}.000,T,00,020.000,T,+000.2,T,+00.1,T,+00.1,T,0,0,0,0,0,0,0",
    "PHINF": "PHINF,00000000",
}
SPOKEN_OF = {
    "DTM": "GPGLL," + PLACE,
    "PSXN,20": "PSXN,23,1.0,-1.0,20.0,0.1",
    "PHINF": "HEHDT,20.0,T",
}
"""Sentences whose readings another one flags."""
LETTERS = sorted({letter for flag in FLAGS for letter in flag.meanings} | {"A", "V", "N", "Q", "4"})
ROWS = [(flag, letter) for flag in FLAGS for letter in LETTERS]


def _body(flag: Flag, letter: str, k: int) -> str:
    fields = BODIES[flag.sentence].format(k=k).split(",")
    fields += [""] * (flag.place + 2 - len(fields))
    fields[flag.place + 1] = letter
    return ",".join(fields)


def _lines(flag: Flag, letter: str, count: int) -> list[str]:
    lines: list[str] = []
    for k in range(count):
        lines.append(stamped(k, _body(flag, letter, k)))
        if flag.sentence in SPOKEN_OF:
            lines.append(stamped(k, SPOKEN_OF[flag.sentence]))
    return lines


@pytest.mark.parametrize(("flag", "letter"), ROWS, ids=[f"{f.sentence} {f.place} {x!r}" for f, x in ROWS])
def test_a_flag_means_the_same_in_the_table_and_in_a_log(tmp_path: Path, flag: Flag, letter: str) -> None:
    said = meaning(flag, letter)
    lines = [*_lines(flag, letter, 5), stamped(6, "PRDID,1.0,2.0,47.3"), stamped(7, "VWVHW,,,,,5.0,N,,")]
    read = read_recording(write(tmp_path / "log.txt", lines))
    told = " ".join(read.warnings)
    for quantity in flag.quantities:
        series = read.quantities().get(quantity)
        count = 0 if series is None else int(series.valid[series.time_s < series.time_s[0] + 5.5].sum())
        name = SPOKEN_OF.get(flag.sentence, flag.sentence).partition(",")[0]
        of_flag = series is not None and name in series.what
        assert (count if of_flag else 0) == (0 if said == INVALID else 5)
    if said == INVALID:
        assert "flagged invalid" in told and "5 readings of the" in told
    elif said:
        assert f"are {said}" in told and "5 readings" in told
    else:
        assert "flagged" not in told and "no truth" not in told


def test_every_sentence_that_is_read_has_flags_or_is_known_to_have_none() -> None:
    flagged = {flag.sentence.partition(",")[0] for flag in FLAGS}
    assert set(KINDS.split(", ")) - flagged == {"HDG", "HDT", "PIXSE", "PRDID", "VHW", "ZDA"}


def test_letters_of_several_systems_count_where_they_agree() -> None:
    gns = next(flag for flag in FLAGS if flag.sentence == "GNS")
    assert [meaning(gns, modes) for modes in ("NN", "AN", "EN", "EA", "SS", "")] == [
        INVALID, "", DEAD_RECKONED, "", "simulated", INVALID,
    ]  # fmt: skip


def test_a_letter_in_no_table_is_told(tmp_path: Path) -> None:
    lines = [sentence(BODIES["RMC"].format(k=k)[:-1] + "Q") for k in range(3)]
    assert any(UNKNOWN in told for told in read_recording(write(tmp_path / "log.txt", lines)).warnings)


def test_the_quality_of_one_seapath_says_nothing_of_another(tmp_path: Path) -> None:
    lines: list[str] = []
    for k in range(10):
        moment = f"2024-02-28T23:58:{k:02d}Z"
        lines += [
            f"old {moment} {sentence('PSXN,20,0,0,2,0')}",
            f"old {moment} {sentence('PSXN,23,1,1,211.3,0')}",
        ]
        lines += [
            f"new {moment} {sentence('PSXN,20,0,0,0,0')}",
            f"new {moment} {sentence('PSXN,23,1,1,60.0,0')}",
        ]
    read = read_recording(write(tmp_path / "log.txt", lines))
    assert read.heading is not None
    assert read.heading.time_s.size == 10
    assert any("10 readings of the heading (PSXN) flagged invalid" in told for told in read.warnings)


def test_of_a_log_that_has_lost_the_water_another_is_taken(tmp_path: Path) -> None:
    lines = [
        x for k in range(5) for x in (stamped(k, "VDVBW,,,V,8.0,0.1,A"), stamped(k, "VWVHW,,,,,5.0,N,,"))
    ]
    read = read_recording(write(tmp_path / "log.txt", lines))
    assert read.water is not None and read.ground is not None
    assert (read.water.what, read.ground.what) == ("VWVHW", "VDVBW")


def _vbw(k: int, body: str) -> str:
    return stamped(k, f"VDVBW,{body}")


def test_speeds_that_a_log_never_gives_are_absent_and_hide_none_that_are_invalid(tmp_path: Path) -> None:
    """An EM log sends empty fields over ground with the letter V in each sentence."""
    lines = [_vbw(k, "5.0,0.1,A,,,V") for k in range(200)]
    lines[50:60] = [_vbw(k, "5.0,0.1,V,,,V") for k in range(50, 60)]
    lines[80:83] = [_vbw(k, ",,V,,,V") for k in range(80, 83)]
    read = read_recording(write(tmp_path / "log.txt", lines))
    assert read.ground is None and read.water is not None
    assert int(np.count_nonzero(~read.water.valid)) == 13 and read.sources[0].invalid == 13
    told = [words for words in read.warnings if "flagged invalid" in words]
    assert len(told) == 1 and "13 readings of the speed through the water" in told[0]


def test_speeds_that_are_empty_at_times_are_invalid_there(tmp_path: Path) -> None:
    lines = [_vbw(k, "5.0,0.1,A,4.0,0.0,A" if k % 4 else "5.0,0.1,A,,,V") for k in range(40)]
    read = read_recording(write(tmp_path / "log.txt", lines))
    assert read.ground is not None and int(np.count_nonzero(read.ground.valid)) == 30
    assert any("10 readings of the speed over ground" in words for words in read.warnings)


def test_the_worse_status_before_or_behind_holds_for_a_heading_of_an_octans(tmp_path: Path) -> None:
    words = ["00000021", "00000021", "00000020", "00000100", "00000000", "00000000"]
    lines: list[str] = []
    for k, word in enumerate(words):
        lines += [stamped(k, f"HEHDT,{20 + k}.0,T"), stamped(k + 0.5, f"HEHDT,{20 + k}.5,T")]
        lines += [stamped(k + 0.7, "PHTRO,0.48,M,0.43,T"), stamped(k + 0.8, f"PHINF,{word}")]
    read = read_recording(write(tmp_path / "log.txt", lines))
    assert read.heading is not None
    assert np.rad2deg(read.heading.values[:, 0]).tolist() == pytest.approx(
        [20.0 + k / 2 for k in range(6, 12)]
    )
    told = " ".join(read.warnings)
    assert "6 readings of the heading (HEHDT) flagged invalid" in told
    assert "4 readings of HEHDT are of reduced quality" in told
    other = [stamped(k, "GPHDT,20.0,T") for k in range(6)]
    lines = [line for pair in zip(other, lines[3::4], strict=True) for line in pair]
    assert "flagged" not in " ".join(read_recording(write(tmp_path / "other.txt", lines)).warnings)
