"""NMEA 0183 logs: sentences to SI, times, counted faults, refusals."""

import math
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pynmea2
import pytest
from hypothesis import given
from hypothesis import strategies as st

from navcore.foundation import guarded
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.io.nmea_lines import Tally, intact_sentences
from navcore.io.nmea_sentences import decode
from navcore.io.recording import read_recording
from navcore.io.source import LARGEST_FILE_BYTES, require_file
from tests.nmea import START, gga, rmc, sentence, stamped, vbw, write

T0 = START.timestamp()


def vbw_lines(count: int) -> list[str]:
    return [stamped(k, vbw((0.1, 9.0 + k), (-0.2, 8.0))) for k in range(count)]


def decoded(body: str) -> Any:
    """What one sentence says, None where it says nothing; None when it makes no sense."""
    (sentences,) = intact_sentences(sentence(body), Tally())
    readings = decode(sentences)
    if not readings.rows.size or not readings.rows["sensible"][0]:
        return None
    said: dict[str, Any] = dict.fromkeys(("position", "velocity", "water", "ground", "heading"))
    said |= {name: tuple(values[0]) for name, rows, values in readings.quantities if rows.size}
    time_of_day, day = (
        None if np.isnan(t[0]) else t[0] for t in (readings.rows["time_of_day"], readings.rows["day"])
    )
    valid = not readings.rows["invalid"][0]
    return SimpleNamespace(**said, time_of_day=time_of_day, day=day, valid=valid)


def refusal(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        read_recording(path)
    assert all("\n" not in str(fault) for fault in caught.value.faults)
    return str(caught.value)


def test_vbw_gives_water_and_ground_speed_along_the_axes_in_si(tmp_path):
    path = write(tmp_path / "log.txt", [stamped(0.5, "VDVBW,9.7,-0.2,A,8.6,0.1,A,,V,,V")])
    recording = read_recording(path)
    assert recording.water.values == pytest.approx(np.array([[-0.2 * KNOT, 9.7 * KNOT]]))
    assert recording.ground.values == pytest.approx(np.array([[0.1 * KNOT, 8.6 * KNOT]]))
    assert recording.water.time_s == pytest.approx([T0 + 0.5], abs=1e-6)
    assert recording.heading is recording.position is recording.velocity is None


@pytest.mark.parametrize(
    ("flags", "valid"), [("AA", (True, True)), ("VA", (False, True)), ("AV", (True, False))]
)
def test_vbw_flags_make_a_reading_invalid_and_zero(tmp_path, flags, valid):
    path = write(tmp_path / "log.txt", [stamped(0, vbw((0.5, 9.0), (0.4, 8.0), flags))])
    recording = read_recording(path)
    assert (bool(recording.water.valid[0]), bool(recording.ground.valid[0])) == valid
    for series in (recording.water, recording.ground):
        assert np.all(series.values[~series.valid] == 0.0)
    assert recording.sources[0].invalid == (flags != "AA")


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("VWVHW,123.0,T,100.0,M,5.0,N,9.3,K", {"water": (0.0, 5.0 * KNOT), "heading": (123.0 * DEG,)}),
        ("GPVTG,090.0,T,,M,10.0,N,18.5,K,A", {"velocity": (10.0 * KNOT, 0.0)}),
        ("GPVTG,,T,,M,0.0,N,0.0,K,A", {"velocity": (0.0, 0.0)}),
    ],
    ids=["VHW", "VTG", "at rest without a course"],
)
def test_speeds_and_headings_are_in_si(tmp_path, body, expected):
    recording = read_recording(write(tmp_path / "log.txt", [stamped(0, body)]))
    found = {name: tuple(getattr(recording, name).values[0]) for name in expected}
    assert found == {name: pytest.approx(values, abs=1e-12) for name, values in expected.items()}


def test_rmc_uses_its_own_utc_and_the_stamps_only_for_the_day(tmp_path):
    # The logger writes after midnight what the receiver measured before it.
    path = write(tmp_path / "log.txt", [stamped(120.15, rmc(119.69, 48.5, -123.25, 8.0, 45.0))])
    recording = read_recording(path)
    assert recording.position.time_s == pytest.approx([T0 + 119.69], abs=1e-6)
    assert recording.position.values[0, :2] == pytest.approx([48.5 * DEG, -123.25 * DEG], abs=1e-9)
    assert math.isnan(recording.position.values[0, 2])
    assert recording.velocity.values == pytest.approx(np.full((1, 2), 8.0 * KNOT * math.sqrt(0.5)))


def test_gga_height_is_above_the_ellipsoid_and_serves_positions_together_with_rmc(tmp_path):
    lines = [sentence(rmc(0, 48.0, -123.0, 8.0, 45.0)), sentence(gga(0, 48.0, -123.0, 12.0))]
    lines += [sentence(rmc(1, 48.0, -123.0, 8.0, 45.0)), sentence(gga(2, 48.0, -123.0, 14.0, quality=0))]
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.position.time_s == pytest.approx([T0, T0 + 1.0])
    assert recording.position.values[:, 2] == pytest.approx([-8.0, math.nan], nan_ok=True)
    assert recording.sources[0].invalid == 1


def test_a_void_rmc_is_no_position(tmp_path):
    lines = [sentence(rmc(0, 48.0, -123.0, 8.0, 45.0)), sentence(rmc(1, 48.0, -123.0, 8.0, 45.0, status="V"))]
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.position.time_s.size == 1
    assert recording.sources[0].invalid == 1


def test_without_stamps_the_last_timed_sentence_gives_the_time_through_midnight(tmp_path):
    lines = [sentence("HEHDT,10.0,T")]
    for k in (119, 120, 121):
        lines += [sentence(rmc(k, 48.0, -123.0, 8.0, 45.0)), sentence(f"HEHDT,{k - 100}.0,T")]
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.heading.time_s == pytest.approx([T0 + 119, T0 + 120, T0 + 121])
    assert recording.heading.values[:, 0] == pytest.approx(np.array([19.0, 20.0, 21.0]) * DEG)
    assert recording.sources[0].untimed == 1


def test_times_of_day_without_any_date_are_said_to_be_undated(tmp_path):
    lines = [sentence(gga(k, 48.0, -123.0, 12.0)) for k in (118, 119, 120, 121)]
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert np.diff(recording.position.time_s) == pytest.approx([1.0, 1.0, 1.0])
    assert not recording.position.dated
    assert any("without a date" in warning for warning in recording.warnings)


def test_any_talker_serves_and_the_one_that_says_most_is_taken(tmp_path):
    lines = [stamped(0, "INHDT,10.0,T")] + [stamped(k, "TNHDT,20.0,T") for k in (1, 2)]
    heading = read_recording(write(tmp_path / "log.txt", lines)).heading
    assert heading.what == "TNHDT"
    assert heading.time_s.size == 2


def test_wrong_checksums_are_counted_and_left_out(tmp_path):
    lines = vbw_lines(20)
    lines[3] = lines[3].replace("VDVBW,12", "VDVBW,92")
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.water.time_s.size == 19
    assert recording.water.values[:, 1].max() < 30.0 * KNOT
    assert recording.sources[0].checksum_faults == 1
    assert any("line 4" in warning for warning in recording.warnings)


def test_lines_that_make_no_sense_are_counted_and_left_out(tmp_path):
    nonsense = [
        "garbage",
        stamped(0, "VDVBW,fast,0.0,A,8.0,0.0,A"),
        stamped(0, "HEHDT,361.0,T"),
        stamped(0, "VDVBW,nan,0.0,A,8.0,0.0,A"),
        "2024-02-30T00:00:00Z " + sentence("HEHDT,10.0,T"),
        stamped(0, "GPRMC,000000.00,A,9912.0,N,00000.0,E,1.0,1.0,280224,,,A"),
    ]
    recording = read_recording(write(tmp_path / "log.txt", [*nonsense, *vbw_lines(3)]))
    assert recording.sources[0].unparsable == len(nonsense)
    assert recording.water.time_s.size == 3
    assert recording.position is None


@pytest.mark.parametrize(
    "body",
    [
        "GPZDA,120001e400,29,02,2024,00,00",
        "GPZDA,120000.00,29,02,99999999999999999999,00,00",
        "PASHR,1200009e400,77.5,T,0.1,0.2,0.3",
    ],
)
def test_a_time_that_no_calendar_has_is_left_out(tmp_path: Path, body: str) -> None:
    recording = read_recording(write(tmp_path / "log.txt", [stamped(0, body), *vbw_lines(3)]))
    assert recording.sources[0].unparsable == 1
    assert recording.water is not None and recording.water.time_s[0] == pytest.approx(T0)


def test_a_missing_checksum_is_accepted_and_said(tmp_path):
    lines = [line.rsplit("*")[0] for line in vbw_lines(3)]
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.water.time_s.size == 3
    assert recording.sources[0].without_checksum == 3
    assert recording.warnings


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (
            [
                line.replace("VDVBW,", "VDVBW,0" if k % 3 == 0 else "VDVBW,")
                for k, line in enumerate(vbw_lines(30))
            ],
            "10 of 30 sentences have a wrong checksum",
        ),
        (
            [
                *(stamped(k, "HEHDT,10.0,T") for k in range(100)),
                *(line.replace("VDVBW,", "VDVBW,0") for line in vbw_lines(10)),
            ],
            "VDVBW 10/10",
        ),
        (vbw_lines(10)[::-1], "log.txt, line 2: time runs backwards by 1.0 s (VDVBW)"),
        (
            [stamped(10.0 - 0.1 * k, "HEHDT,10.0,T") for k in range(5)],
            "line 4: time runs backwards by 0.3 s",
        ),
    ],
    ids=["wrong checksums", "of one kind that is used", "backwards", "backwards in small steps"],
)
def test_a_damaged_log_is_refused_with_the_reason(tmp_path, lines, said):
    assert said in refusal(write(tmp_path / "log.txt", lines))


def test_jitter_between_interleaved_kinds_is_no_fault(tmp_path):
    lines = []
    for k in range(5):
        lines += [stamped(k + 0.4, "HEHDT,10.0,T"), stamped(k, vbw((0.0, 9.0), (0.0, 9.0)))]
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.heading.time_s.size == recording.water.time_s.size == 5


def test_jitter_within_the_tolerance_is_sorted_and_counted(tmp_path):
    lines = [stamped(t, f"HEHDT,{10 * (k + 1)}.0,T") for k, t in enumerate((0.0, 1.0, 0.9, 2.0))]
    recording = read_recording(write(tmp_path / "log.txt", lines))
    assert recording.heading.values[:, 0] == pytest.approx(np.array([10.0, 30.0, 20.0, 40.0]) * DEG)
    assert recording.sources[0].jitter == 1


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"   \r\n \n", "empty"),
        (bytes(range(256)) * 20, "binary"),
        (b"\xff\xd8\xff\xe0" * 100 + b"plain", "is a picture"),
        (b"hello, world\nthis is no log\n", "not a log this reader knows"),
        (b"[run]\nduration_h = 1.0\n", "not a log this reader knows"),
        ((sentence("GPZDA,000000.00,06,12,2018,00,00") + "\n").encode(), "no usable sentence"),
        ((sentence("HEHDT,10.0,T") + "\n").encode(), "no time"),
        (b"2024-02-28T00:00:00Z $VDVBW,9.0,0.0,A*zz\n", "not a log this reader knows"),
    ],
)
def test_files_that_are_no_log_are_refused_in_one_line(tmp_path, content, said):
    path = tmp_path / "log.txt"
    path.write_bytes(content)
    assert said in refusal(path)


def test_line_noise_of_single_bytes_costs_only_its_line(tmp_path):
    path = write(tmp_path / "log.txt", vbw_lines(50))
    path.write_bytes(path.read_bytes().replace(b"VDVBW,12", b"VDVBW,\xfe2"))
    recording = read_recording(path)
    assert recording.water.time_s.size == 49


def test_a_byte_order_mark_does_not_cost_the_first_line(tmp_path):
    path = write(tmp_path / "log.txt", vbw_lines(3))
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert read_recording(path).water.time_s.size == 3


def test_gaps_and_rates_are_counted(tmp_path):
    lines = [stamped(t, "HEHDT,10.0,T") for t in (0, 1, 2, 3, 10, 11, 12, 20, 21)]
    recording = read_recording(write(tmp_path / "log.txt", lines))
    stream = recording.sources[0].streams[0]
    assert (stream.rate_hz, stream.gaps, stream.longest_gap_s) == pytest.approx((1.0, 2, 8.0))


def test_a_too_large_file_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "log.txt"
    with path.open("wb") as stream:
        stream.truncate(LARGEST_FILE_BYTES + 1)
    with pytest.raises(InputError, match="at most 64 MiB"):
        require_file(path)


@pytest.mark.parametrize("name", ["missing.txt", ".", "a\0b", "x" * 5000])
def test_paths_that_are_no_file_are_refused(tmp_path, name):
    with pytest.raises(InputError):
        require_file(tmp_path / name, "", "file")


SENTENCES = st.one_of(
    st.builds(
        rmc, st.floats(0, 1e5), st.floats(-89, 89), st.floats(-179, 179), st.floats(0, 60), st.floats(0, 360)
    ),
    st.builds(gga, st.floats(0, 1e5), st.floats(-89, 89), st.floats(-179, 179), st.floats(-50, 9000)),
    st.builds(
        vbw, st.tuples(st.floats(-5, 5), st.floats(-9, 60)), st.tuples(st.floats(-5, 5), st.floats(-9, 60))
    ),
)


@given(body=SENTENCES)
def test_fields_are_those_that_pynmea2_names(body: str) -> None:
    theirs: Any = pynmea2.parse(sentence(body))
    ours = decoded(body)
    assert ours is not None
    if ours.position is not None:
        assert ours.position[:2] == pytest.approx((theirs.latitude * DEG, theirs.longitude * DEG), abs=1e-14)
        moment = theirs.timestamp
        seconds = 3600.0 * moment.hour + 60.0 * moment.minute + moment.second + 1e-6 * moment.microsecond
        assert ours.time_of_day == pytest.approx(seconds, abs=2e-6)
    if body[2:5] == "RMC":
        assert ours.day == datetime(*theirs.datestamp.timetuple()[:3], tzinfo=UTC).timestamp()
        assert math.hypot(*(ours.velocity or (0.0, 0.0))) == pytest.approx(float(theirs.spd_over_grnd) * KNOT)
    if body[2:5] == "GGA":
        assert ours.position is not None and ours.position[2] == float(theirs.altitude) + float(
            theirs.geo_sep
        )
    if body[2:5] == "VBW":
        assert ours.water == (float(theirs.trans_water_spd) * KNOT, float(theirs.lon_water_spd) * KNOT, True)
        assert ours.ground == (float(theirs.trans_grnd_spd) * KNOT, float(theirs.lon_grnd_spd) * KNOT, True)


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("GPRMC,120000.00,A,4500.0,N,01200.0,E,10.0,0.0", {"day": None, "velocity": (0.0, 10.0 * KNOT)}),
        ("IIVHW,,T,,M,10.0", {"water": (0.0, 10.0 * KNOT, True), "heading": None}),
        ("VDVBW,10.0,0.0,A", {"water": (0.0, 10.0 * KNOT, True), "ground": None}),
        ("GPVTG,0.0,T,,M,10.0", {"velocity": (0.0, 10.0 * KNOT)}),
        ("GPGGA,120000.00,4500.0,N,01200.0,E,0", {"valid": False}),
        ("HCHDG,101.1", {"heading": None, "valid": True}),
    ],
)
def test_an_older_talker_may_leave_out_the_last_fields(body: str, expected: dict[str, object]) -> None:
    reading = decoded(body)
    assert reading is not None
    assert {name: getattr(reading, name) for name in expected} == expected


@pytest.mark.parametrize(
    "body",
    [
        "GPRMC,250000.00,A,4500.0,N,01200.0,E,10.0,0.0,030624",
        "GPRMC,120000e1,A,4500.0,N,01200.0,E,10.0,0.0,030624",
        "GPRMC,120000.00,A,4500.0,N,01200.0,E,10.0,0.0,0306241",
        "GPRMC,120000.00,A,4500.0,,01200.0,E,10.0,0.0,030624",
        "GPRMC,120000.00,A,4500,N,01200.0,E,10.0,0.0,030624",
        "GPRMC,120000.00,A,4500.1e1,N,01200.0,E,10.0,0.0,030624",
        "GPGGA,120000.00,9100.0,N,01200.0,E,1,08,1.0,30.0,M,,M",
        "HETHS,77.5",
        "HEHDT",
    ],
)
def test_nonsense_in_a_field_is_no_reading(body: str) -> None:
    assert decoded(body) is None


def test_a_damaged_letter_is_no_right_checksum(tmp_path: Path) -> None:
    """A letter that no sentence holds counts with its own number."""
    good = sentence("HEHDT,77.5,T")
    damaged = sentence("HEHDT,77.5?,T").replace("?", "\ufffd")
    path = tmp_path / "log.txt"
    path.write_text(
        "".join(f"2024-02-28T23:58:0{k}Z {good}\n" for k in range(6)) + f"2024-02-28T23:58:07Z {damaged}\n"
    )
    assert read_recording(path).sources[0].checksum_faults == 1


@pytest.mark.nightly
def test_the_largest_log_that_can_be_uploaded_is_read_within_the_bounds(tmp_path: Path) -> None:
    """16 MiB, in a child with the server's bounds of memory and processor time."""
    bodies = (
        body
        for k in range(10**6)
        for body in (rmc(0.1 * k, 45.0, 12.0, 10.0, 45.0), vbw((0.1, 10.0), (0.0, 9.9)))
    )
    lines = [sentence(body) for body in islice(bodies, 284_000)]
    path = write(tmp_path / "large.txt", lines)
    assert 16 * 2**20 < path.stat().st_size < 18 * 2**20
    guarded.start(("navcore.io.recording",))
    try:
        recording = guarded.call(path.name, read_recording, path)
    finally:
        guarded.stop()
    assert recording.water.time_s.size == 142_000
