"""Logs as research vessels write them: the time and whatever else stands beside a sentence."""

from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.io.recording import read_recording
from navcore.io.stamps import StampReader
from tests.nmea import START, gga, rmc, sentence, stamped, vbw, write

T0 = START.timestamp()


def ms(moment: datetime) -> int:
    return moment.microsecond // 1000


FORMS: dict[str, Callable[[datetime], str]] = {
    "iso": lambda t: f"{t:%Y-%m-%dT%H:%M:%S}.{ms(t):03d}Z ",
    "iso, comma": lambda t: f"{t:%Y-%m-%d %H:%M:%S},{ms(t):03d} ",
    "iso, zone": lambda t: f"{t + timedelta(hours=2):%Y-%m-%dT%H:%M:%S}.{ms(t):03d}+02:00\t",
    "name, then iso": lambda t: f"seapath 2 {t:%Y-%m-%dT%H:%M:%S}.{ms(t):03d}Z ",
    "slashes": lambda t: f"{t:%Y/%m/%d %H:%M:%S}.{ms(t):03d} ",
    "Lamont": lambda t: f"{t:%y}+{t:%j}:{t:%H:%M:%S}.{ms(t):03d} ",
    "Lamont with a name": lambda t: f"CP: {t:%y}+{t:%j}:{t:%H:%M:%S}.{ms(t):03d} gps ",
    "LDS": lambda t: f"{t:%Y}:{t:%j}:{t:%H:%M:%S}.{ms(t):03d}\t",
    "SCS": lambda t: f"{t:%m/%d/%Y,%H:%M:%S}.{ms(t):03d},",
    "German": lambda t: f"{t:%d.%m.%Y %H:%M:%S}.{ms(t):03d};",
    "day-month-year": lambda t: f"{t:%d-%m-%Y %H:%M:%S}.{ms(t):03d} ",
    "month by name": lambda t: f"{t:%d-%b-%Y %H:%M:%S}.{ms(t):03d} ",
    "compact": lambda t: f"{t:%Y%m%dT%H%M%S}.{ms(t):03d}Z,",
    "compact digits": lambda t: f"{t:%Y%m%d%H%M%S}{ms(t):03d} ",
    "Unix seconds": lambda t: f"{t.timestamp():.3f} ",
    "Unix milliseconds": lambda t: f"{round(t.timestamp() * 1e3)} ",
    "archive id": lambda t: f"0004711;gyro;{t:%Y-%m-%dT%H:%M:%S}.{ms(t):03d}Z;",
    "tag block": lambda t: f"\\s:GP0001,c:{round(t.timestamp() * 1e3)}*5E\\",
    "brackets": lambda t: f"[{t:%Y-%m-%d %H:%M:%S}.{ms(t):03d}] ",
    "quotes": lambda t: f'"{t:%Y-%m-%dT%H:%M:%S}.{ms(t):03d}Z","',
}


@pytest.mark.parametrize("name", FORMS)
def test_the_time_beside_a_sentence_is_read(tmp_path: Path, name: str) -> None:
    """Heading and log sentences have no time: theirs is the stamp's, through midnight to a leap day."""
    form, tail = FORMS[name], '"' if name == "quotes" else ""
    times = [117.25 + 1.5 * k for k in range(6)]
    lines = []
    for t in times:
        moment = START + timedelta(seconds=t)
        lines += [form(moment) + sentence(body) + tail for body in ("HEHDT,30.00,T", vbw((0, 9), (0, 8)))]
    recording = read_recording(write(tmp_path / "log.txt", lines))
    for series in (recording.heading, recording.water, recording.ground):
        assert series.time_s == pytest.approx([T0 + t for t in times], abs=2e-3)
    assert recording.heading.values == pytest.approx(np.full((6, 1), 30.0 * DEG))
    assert recording.warnings == ()


@pytest.mark.parametrize(("digits", "year"), [("68", 2068), ("69", 1969), ("79", 1979), ("80", 1980)])
def test_a_year_of_two_digits_is_the_same_in_sentences_and_stamps(
    tmp_path: Path, digits: str, year: int
) -> None:
    """The sentence's own date, the date that it gives to times of day beside others, and a stamp's date."""
    times = [f"10:06:3{second}" for second in range(5)]
    plain = [f"GPRMC,{t.replace(':', '')},A,4800.0,N,12300.0,W,8.0,45.0,2603{digits},," for t in times]
    lines = {
        "own": [sentence(body) for body in plain],
        "beside": [f"{t} {sentence(body)}" for t in times for body in ("HEHDT,30.00,T", plain[0])],
        "stamp": [f"26-03-{digits} {t} {sentence('HEHDT,30.00,T')}" for t in times],
    }
    found = {name: read_recording(write(tmp_path / f"{name}.txt", text)) for name, text in lines.items()}
    begin = datetime(year, 3, 26, 10, 6, 30, tzinfo=UTC).timestamp()
    for series in (found["own"].position, found["beside"].heading, found["stamp"].heading):
        assert series.time_s[0] == begin


def test_a_stamp_may_stand_behind_the_sentence(tmp_path: Path) -> None:
    lines = [f"{sentence('HEHDT,30.00,T')},2024-02-28T23:58:0{k}.5Z" for k in range(5)]
    heading = read_recording(write(tmp_path / "log.txt", lines)).heading
    assert heading.time_s == pytest.approx([T0 + k + 0.5 for k in range(5)])


def test_seconds_of_a_tag_block_serve_a_position(tmp_path: Path) -> None:
    lines = [f"\\s:GP0001,c:{round(T0) + k}*5E\\{sentence(gga(k, 48.0, -123.0, 12.0))}" for k in range(5)]
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.position.dated
    assert recording.position.time_s == pytest.approx([T0 + k for k in range(5)])


def test_dates_with_slashes_begin_with_the_day_when_one_is_above_twelve(tmp_path: Path) -> None:
    lines = [
        f"{START + timedelta(days=k):%d/%m/%Y %H:%M:%S} {sentence('HEHDT,30.0,T')}" for k in range(-20, 1)
    ]
    heading = read_recording(write(tmp_path / "log.txt", lines)).heading
    assert heading.time_s == pytest.approx([T0 + 86400.0 * k for k in range(-20, 1)])


def test_a_time_of_day_takes_its_date_from_the_sentences(tmp_path: Path) -> None:
    lines = []
    for k in range(115, 125):
        moment = START + timedelta(seconds=k)
        lines.append(f"{moment:%H:%M:%S}.250 {sentence('HEHDT,30.0,T')}")
        lines.append(f"{moment:%H:%M:%S}.300 {sentence(rmc(k, 48.0, -123.0, 8.0, 45.0))}")
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.heading.time_s == pytest.approx([T0 + k + 0.25 for k in range(115, 125)])
    assert recording.position.time_s == pytest.approx([T0 + k for k in range(115, 125)])


def test_stamps_in_local_time_are_corrected_and_told(tmp_path: Path) -> None:
    lines = []
    for k in range(10):
        moment = START + timedelta(seconds=k, hours=-8)
        lines.append(f"{moment:%m/%d/%Y,%H:%M:%S}.250,{sentence(rmc(k, 48.0, -123.0, 8.0, 45.0))}")
        lines.append(f"{moment:%m/%d/%Y,%H:%M:%S}.500,{sentence('HEHDT,30.0,T')}")
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.heading.time_s == pytest.approx([T0 + k + 0.5 for k in range(10)])
    assert recording.position.time_s == pytest.approx([T0 + k for k in range(10)])
    assert ["local time, -8 h" in warning for warning in recording.warnings] == [True]


def test_the_hawaiian_loggers_day_of_the_year_serves_the_lines_after_it(tmp_path: Path) -> None:
    lines = []
    for k in range(5):
        day = (T0 + k - datetime(2024, 1, 1, tzinfo=START.tzinfo).timestamp()) / 86400.0
        lines += [f"$UNIXD,{day:.7f},{day:.7f}", sentence("HEHDT,30.0,T")]
    heading = read_recording(write(tmp_path / "km2024_058_86280.hdg", lines)).heading
    assert heading.time_s == pytest.approx([T0 + k for k in range(5)], abs=0.02)


@pytest.mark.parametrize(
    ("body", "heading"),
    [
        ("HETHS,290.1,A", 290.1),
        ("PASHR,235800.50,290.12,T,-1.50,2.40,0.10,0.1,0.1,0.2,1,1", 290.12),
        ("PSXN,23,1.2,-0.5,290.1,0.1", 290.1),
        ("PRDID,-1.31,7.81,47.31", 47.31),
        ("HCHDG,290.0,1.0,E,12.0,W", 279.0),
    ],
)
def test_headings_of_other_sentences(tmp_path: Path, body: str, heading: float) -> None:
    series = read_recording(write(tmp_path / "log.txt", [stamped(0.5, body)])).heading
    assert series.values[:, 0] == pytest.approx([heading * DEG])
    assert series.time_s == pytest.approx([T0 + 0.5])


def test_positions_of_gll_and_gns_and_the_date_of_zda(tmp_path: Path) -> None:
    lines = [sentence("GPZDA,235800.00,28,02,2024,00,00")]
    lines += [sentence(f"GPGLL,4800.0000,N,12300.0000,W,23580{k}.00,A,A") for k in range(3)]
    found = read_recording(write(tmp_path / "gll.txt", lines)).position
    assert found.dated
    assert found.time_s == pytest.approx([T0, T0 + 1, T0 + 2])
    lines[1:] = [sentence(f"GNGNS,23580{k}.00,4800.0,N,12300.0,W,AA,12,0.9,10.0,-20.0,,") for k in range(3)]
    found = read_recording(write(tmp_path / "gns.txt", lines)).position
    assert found.values == pytest.approx(np.array([[48.0 * DEG, -123.0 * DEG, -10.0]] * 3))


def test_of_two_instruments_with_one_address_one_is_taken(tmp_path: Path) -> None:
    lines = []
    for k in range(10):
        moment = f"{START + timedelta(seconds=k):%Y-%m-%dT%H:%M:%S}Z"
        lines.append(f"cnav {moment} {sentence(gga(k, 48.0, -123.0, 12.0))}")
        if k % 2:
            lines.append(f"seapath {moment} {sentence(gga(k - 1, 48.5, -123.0, 12.0))}")
    position = read_recording(write(tmp_path / "log.txt", lines)).position
    assert position.values[:, 0] == pytest.approx(np.full(10, 48.0 * DEG))


def test_a_nul_byte_costs_its_line_and_is_told(tmp_path: Path) -> None:
    path = write(tmp_path / "log.txt", [stamped(k, "HEHDT,30.00,T") for k in range(100)])
    content = path.read_bytes()
    path.write_bytes(content[:2000] + b"\0" + content[2001:] + b"\0" * 4096)
    recording = read_recording(path)
    assert recording.heading.time_s.size == 99
    assert recording.warnings == ("log.txt: 2 lines with NUL bytes left out",)


def test_text_of_two_bytes_a_character_is_read(tmp_path: Path) -> None:
    path = tmp_path / "log.txt"
    path.write_bytes("\r\n".join(stamped(k, "HEHDT,30.00,T") for k in range(5)).encode("utf-16"))
    assert read_recording(path).heading.time_s.size == 5


def test_a_single_sentence_out_of_order_is_left_out_and_told(tmp_path: Path) -> None:
    lines = [stamped(k, "HEHDT,30.00,T") for k in range(200)]
    lines[100] = stamped(20, "HEHDT,99.00,T")
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.heading.values == pytest.approx(np.full((199, 1), 30.0 * DEG))
    assert any("line 101" in warning for warning in recording.warnings)


def test_two_sentences_run_together_are_both_read(tmp_path: Path) -> None:
    line = stamped(0, "HEHDT,30.00,T") + sentence(vbw((0, 9), (0, 8)))
    cut = stamped(1, "HEHDT,31.00,T").replace("*", "")[:-4] + sentence("HEHDT,32.00,T")
    recording = read_recording(write(tmp_path / "log.txt", [line, cut]))
    assert recording.heading.values[:, 0] == pytest.approx([30.0 * DEG, 32.0 * DEG])
    assert recording.water.values[0, 1] == pytest.approx(9 * KNOT)


@pytest.mark.parametrize(
    "text", ["2024-02-30T00:00:00Z ", "19+400:10:00:00 ", "10:61:00 ", "31.04.2024 10:00:00 "]
)
def test_a_time_that_cannot_be_is_a_line_that_makes_no_sense(tmp_path: Path, text: str) -> None:
    with pytest.raises(ValueError):
        StampReader().read(text)
    lines = [text + sentence("HEHDT,10.0,T"), stamped(0, "HEHDT,30.0,T")]
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.sources[0].unparsable == 1
    assert recording.heading.time_s.size == 1


@pytest.mark.parametrize("text", ["", "id 12345 ", "record0001234567 ", "48.5 "])
def test_numbers_that_are_no_time_are_none(text: str) -> None:
    assert StampReader().read(text)[0] is None


def test_very_many_kinds_of_sentences_are_told_in_one_short_line(tmp_path: Path) -> None:
    lines = [f"${k:06X}A,1" for k in range(50_000)]
    path = write(tmp_path / "log.txt", lines)
    with pytest.raises(InputError) as caught:
        read_recording(path)
    assert len(str(caught.value)) < 500
    path.write_text("\n".join([stamped(0, "HEHDT,30.0,T"), *lines]), encoding="utf-8")
    recording = read_recording(path)
    assert len(recording.sources[0].streams) < 250
    assert sum(map(len, recording.warnings)) < 500
