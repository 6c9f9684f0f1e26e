"""Every line of a log has a time, or is counted by kind, field and reason."""

from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.foundation.errors import InputError
from navcore.io.recording import read_recording
from tests.nmea import START, gga, rmc, sentence, stamped, vbw, write

T0 = START.timestamp()
VBW = vbw((0.1, 9.0), (0.1, 8.9))


def _log(folder: Path, clock: dict[int, str], count: int = 40) -> Path:
    """One heading and one log a second, behind the sentence that gives the time, if any."""
    lines: list[str] = []
    for k in range(count):
        body = clock.get(k, rmc(k, 38.0, 9.0, 5.0, 20.0))
        lines += [sentence(body)] if body else []
        lines += [sentence("HEHDT,20.0,T"), sentence(VBW)]
    return write(folder / "log.txt", lines)


def _accounted(path: Path) -> dict[str, int]:
    """Counts of what is left out by kind and reason; the lines that are used and these are all."""
    report = check_file(path).as_dict()
    lost = {f"{one['kind']}: {one['why']}": one["count"] for one in report["lines_left_out"]}
    assert report["lines"] == report["lines_used"] + sum(lost.values())
    return lost


OUTAGE = range(10, 20)
WITHOUT_FIX = {
    "void, with its time": lambda k: rmc(k, 38.0, 9.0, 5.0, 20.0, status="V"),
    "mode N": lambda k: rmc(k, 38.0, 9.0, 5.0, 20.0)[:-1] + "N",
    "quality 0": lambda k: gga(k, 38.0, 9.0, 12.0, quality=0),
    "empty": lambda _: "GPRMC,,V,,,,,,,,,,N",
    "silent": lambda _: "",
    "a clock that begins anew": lambda k: f"GPRMC,0000{k:02d}.00,V,,,,,,,060180,,,N",
}


@pytest.mark.parametrize("kind", WITHOUT_FIX)
def test_an_outage_of_the_satellites_does_not_take_the_log(tmp_path: Path, kind: str) -> None:
    read = read_recording(path := _log(tmp_path, {k: WITHOUT_FIX[kind](k) for k in OUTAGE}))
    assert read.water is not None and read.heading is not None and read.position is not None
    for series in (read.water, read.heading):
        assert series.time_s == pytest.approx(T0 + np.arange(40.0), abs=1e-6)
    assert read.position.time_s.size == 30
    lost = _accounted(path)
    assert sum(lost.values()) == (0 if kind == "silent" else 10)


def test_a_receiver_that_never_has_a_fix_is_still_a_clock(tmp_path: Path) -> None:
    path = _log(tmp_path, {k: rmc(k, 38.0, 9.0, 5.0, 20.0, status="V") for k in range(40)})
    read = read_recording(path)
    assert read.heading is not None and read.position is None
    assert read.heading.time_s[[0, -1]] == pytest.approx([T0, T0 + 39.0])


def test_lines_before_a_clock_that_is_not_set_are_left_out_by_kind(tmp_path: Path) -> None:
    path = _log(tmp_path, {k: f"GPRMC,0000{k:02d}.00,V,,,,,,,060180,,,N" for k in range(10)})
    lost = _accounted(path)
    assert lost["HEHDT: before the first known time"] == lost["VDVBW: before the first known time"] == 10
    assert any("(10 HEHDT, 10 VDVBW)" in told for told in read_recording(path).warnings)


@pytest.mark.parametrize("rate", [2, 5, 10])
def test_a_gyro_faster_than_the_clock_is_spread_between_its_times(tmp_path: Path, rate: int) -> None:
    lines: list[str] = []
    for k in range(20):
        lines.append(sentence(rmc(k, 38.0, 9.0, 5.0, 20.0)))
        lines += [sentence(f"HEHDT,{k + i / rate:.1f},T") for i in range(rate)]
    heading = read_recording(write(tmp_path / "log.txt", lines)).heading
    assert heading is not None
    assert heading.time_s == pytest.approx(T0 + np.arange(20 * rate) / rate, abs=1e-6)


def test_lines_before_a_logger_was_switched_off_are_not_spread_over_the_hours(tmp_path: Path) -> None:
    lines: list[str] = []
    for k in (*range(20), *range(7200, 7220)):
        lines.append(sentence(rmc(k, 38.0, 9.0, 5.0, 20.0)))
        lines += [sentence("HEHDT,20.0,T")] * 4
    heading = read_recording(write(tmp_path / "log.txt", lines)).heading
    assert heading is not None
    assert np.sort(np.diff(heading.time_s))[-2:] == pytest.approx([0.25, 7180.25])


NOISE = {
    "NUL before": (b"\0", b""), "two NUL before": (b"\0\0", b""), "NUL behind": (b"", b"\0"),
    "text frame": (b"\x02", b"\x03"), "flow control": (b"\x11", b""), "idle line": (b"\xff", b""),
}  # fmt: skip


@pytest.mark.parametrize("kind", NOISE)
def test_a_sentence_begins_at_its_mark_whatever_stands_before(tmp_path: Path, kind: str) -> None:
    before, behind = NOISE[kind]
    path = tmp_path / "log.txt"
    lines = [stamped(k, VBW) for k in range(30)]
    lines += [sentence(rmc(k, 38.0, 9.0, 5.0, 20.0)) for k in range(30, 60)]
    path.write_bytes(
        b"".join(line.encode().replace(b"$", before + b"$") + behind + b"\r\n" for line in lines)
    )
    read = read_recording(path)
    assert read.water is not None and read.position is not None
    assert (read.water.time_s.size, read.position.time_s.size) == (30, 30)
    assert not _accounted(path)


def test_every_reason_is_counted_and_all_lines_are_accounted_for(tmp_path: Path) -> None:
    good = [stamped(k, VBW) for k in range(200)]
    lines = [
        *good,
        *(stamped(k, "VMVBW,6.5,0.0,A,,,V") for k in range(3)),
        stamped(5, "HEHDT,,T"),
        stamped(5, "HEHDT,400.0,T"),
        stamped(198.5, VBW)[:-2] + "00",
        stamped(5, "GPGSV,1,1,00"),
        stamped(199.0005, VBW),
        "noise",
        stamped(6, "HEHDT,41.0,T") + sentence("HCHDG,290.0,,,,"),
    ]
    lost = _accounted(write(tmp_path / "log.txt", lines))
    assert lost == {
        "VMVBW: another source is taken": 3,
        "HEHDT: no reading in its fields": 1,
        "HEHDT: makes no sense": 1,
        "VDVBW: wrong checksum": 1,
        "GPGSV: this kind is not read": 1,
        "VDVBW: another stands at the same time": 1,
        ": is no sentence": 1,
        "HCHDG: no reading in its fields": 1,
    }


@pytest.mark.parametrize("stamps", [False, True])
def test_leap_seconds_that_a_receiver_learns_are_taken_off(tmp_path: Path, stamps: bool) -> None:
    lines: list[str] = []
    for k in range(120):
        own = k + (18 if k < 40 else 0)
        for body in (rmc(own, 38.0, 9.0, 5.0, 20.0), "HEHDT,20.0,T"):
            lines.append(stamped(k, body) if stamps else sentence(body))
    read = read_recording(write(tmp_path / "log.txt", lines))
    assert read.position is not None and read.heading is not None
    for series in (read.position, read.heading):
        assert series.time_s == pytest.approx(T0 + np.arange(120.0), abs=1e-6)
    assert any("leap seconds" in told for told in read.warnings)


@pytest.mark.parametrize(
    ("step_s", "said"),
    [(3600.0, "1 h: is one of them in local time"), (400.0, "the clock was set back"), (17.3, "set back")],
)
def test_another_step_back_is_refused_with_its_likely_cause(tmp_path: Path, step_s: float, said: str) -> None:
    lines = [sentence(rmc(5000 + k - (step_s if k >= 600 else 0), 38.0, 9.0, 5.0, 20.0)) for k in range(1200)]
    with pytest.raises(InputError, match=said):
        read_recording(write(tmp_path / "log.txt", lines))


def test_lines_in_another_order_are_to_be_put_in_order(tmp_path: Path) -> None:
    seconds = [*range(50, 100), *range(50)]
    with pytest.raises(InputError, match="put the rows in order"):
        read_recording(write(tmp_path / "log.txt", [sentence(rmc(k, 38.0, 9.0, 5.0, 20.0)) for k in seconds]))


def test_sentences_of_a_clock_that_was_not_set_are_left_out(tmp_path: Path) -> None:
    lines = [f"1970-01-01T00:00:{k:02d}Z {sentence('HEHDT,20.0,T')}" for k in range(10)]
    path = write(tmp_path / "log.txt", [*lines, *(stamped(k, "HEHDT,20.0,T") for k in range(20))])
    read = read_recording(path)
    assert read.heading is not None
    assert read.heading.time_s == pytest.approx(T0 + np.arange(20.0))
    assert any(
        "10 sentences dated 1970 left out" in told and "2024-02-28T23:58:00Z" in told
        for told in read.warnings
    )
    assert _accounted(path) == {"HEHDT: dated before the clock was set": 10}


def test_of_two_logs_the_one_that_is_taken_is_said_with_the_difference(tmp_path: Path) -> None:
    lines = [x for k in range(20) for x in (stamped(k, VBW), stamped(k, "VMVBW,7.5,0.1,A,8.9,0.1,A"))]
    report = check_file(write(tmp_path / "log.txt", lines))
    assert any(
        "VDVBW is taken (20), VMVBW (20) is not used: they differ by 1.5 kn" in w for w in report.warnings
    )
    assert not any("ground" in w for w in report.warnings)
    assert any("VMVBW, 1 Hz (not used)" in line for line in report.text)


def test_two_receivers_of_one_ship_are_told_without_a_warning(tmp_path: Path) -> None:
    lines = [
        x
        for k in range(20)
        for x in (stamped(k, gga(k, 38.0, 9.0, 12.0)), stamped(k, gga(k, 38.0001, 9.0, 12.0)))
    ]
    lines = [line.replace("GPGGA", "GNGGA") if i % 2 else line for i, line in enumerate(lines)]
    lines = [line.partition(" ")[0] + " " + sentence(line.partition("$")[2][:-3]) for line in lines]
    report = check_file(write(tmp_path / "log.txt", lines))
    assert not report.warnings
    assert any(
        "position: GPGGA is taken (20), GNGGA (20) is not used: they differ by 11.1 m" in t
        for t in report.text
    )


@pytest.mark.parametrize("stamps", [False, True])
def test_lines_that_are_there_twice_are_one(tmp_path: Path, stamps: bool) -> None:
    lines = [
        x
        for k in range(30)
        for body in (rmc(k, 38.0, 9.0, 5.0, 20.0), f"HEHDT,{k / 10:.1f},T", VBW)
        for x in [stamped(k, body) if stamps else sentence(body)] * 2
    ]
    read = read_recording(path := write(tmp_path / "log.txt", lines))
    assert read.heading is not None and read.water is not None
    for series in (read.heading, read.water):
        assert series.time_s == pytest.approx(T0 + np.arange(30.0), abs=1e-6)
    assert any("30 HEHDT repeat another one" in told for told in read.warnings)
    assert _accounted(path) == {
        f"{kind}: another stands at the same time": 30 for kind in ("GPRMC", "HEHDT", "VDVBW")
    }


@pytest.mark.parametrize("seconds", [1, 60])
def test_stamps_coarser_than_the_lines_are_spread(tmp_path: Path, seconds: int) -> None:
    times = np.arange(0.0, 10.0 * seconds, seconds / 10.0)
    lines = [
        f"2024-02-28T23:{58 + int(t // seconds * seconds) // 60:02d}:{int(t // seconds * seconds) % 60:02d}Z "
        + sentence(f"HEHDT,{k / 10:.1f},T")
        for k, t in enumerate(times[: 20 if seconds == 60 else 100])
    ]
    heading = read_recording(write(tmp_path / "log.txt", lines)).heading
    assert heading is not None
    assert heading.time_s.size == len(lines)
    assert np.diff(heading.time_s[:10]) == pytest.approx(seconds / 10.0, abs=1e-6)


@pytest.mark.parametrize(("first", "second"), [((0, 40), (0, 40)), ((0, 30), (20, 40)), ((0, 40), (35, 40))])
def test_lines_that_are_there_again_are_left_out(
    tmp_path: Path, first: tuple[int, int], second: tuple[int, int]
) -> None:
    moving = {k: rmc(k, 38.0 + 1e-4 * k, 9.0, 5.0, 20.0) for k in range(40)}
    whole = _log(tmp_path, moving).read_text().splitlines()
    twice = [line for begin, end in (first, second) for line in whole[3 * begin : 3 * end]]
    read = read_recording(path := write(tmp_path / "twice.txt", twice))
    for series in (read.water, read.heading, read.position):
        assert series is not None and series.time_s == pytest.approx(T0 + np.arange(40.0), abs=1e-6)
    assert sum(_accounted(path).values()) == len(twice) - len(whole)
    assert any("repeat" in text for text in check_file(path).warnings)


def test_another_recording_behind_the_first_is_still_refused(tmp_path: Path) -> None:
    whole = _log(tmp_path, {}).read_text().splitlines()
    other = [sentence(rmc(k, 39.0, 9.0, 5.0, 20.0)) for k in range(40)]
    with pytest.raises(InputError, match="runs backwards"):
        read_recording(write(tmp_path / "other.txt", [*whole, *other]))
