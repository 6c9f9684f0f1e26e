"""`check_file`: what a file holds, in words and as JSON; never an exception for a file's content."""

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from navcore.checks.file import Checker, check_file
from navcore.checks.report import FileReport
from tests.nmea import sentence, ship_files, stamped, vbw, write


def test_a_log_is_described(tmp_path):
    report = check_file(ship_files(tmp_path, seconds=60)["log"])
    assert report.ok
    assert report.kind == "NMEA 0183 log"
    data = json.loads(json.dumps(report.as_dict(), allow_nan=False))
    assert data["ok"] is True
    assert data["sentences"]["VDVBW"] == {
        "count": 54,
        "used": True,
        "start_utc": "2024-02-28T23:58:00.6Z",
        "end_utc": "2024-02-28T23:58:58.9Z",
        "span_s": 58.3,
        "rate_hz": 0.9091,
        "gaps": 0,
        "longest_gap_s": 0.0,
    }
    assert data["checksum_faults"] == 0
    assert data["quantities"]["water"]["forward_kn"] == [11.0, 11.0]
    assert data["quantities"]["ground"]["starboard_kn"] == [0.0, 0.0]
    assert any("54 VDVBW, 0.909 Hz" in line for line in report.lines())


def test_faults_and_gaps_of_a_log_are_told(tmp_path):
    lines = [stamped(t, vbw((0.0, 9.0), (0.0, 9.0))) for t in (*range(20), 30, 31)]
    lines[5] = lines[5].replace("9.00", "9.01", 1)
    lines.append("garbage")
    report = check_file(write(tmp_path / "log.txt", lines))
    data = report.as_dict()
    assert (data["checksum_faults"], data["unparsable_lines"]) == (1, 1)
    assert data["sentences"]["VDVBW"]["gaps"] == 1
    words = "\n".join(report.lines())
    assert "1 checksum faults, 1 unparsable" in words
    assert "warning: speed through water: 1 gaps, the longest 11.0 s" in words


def test_a_track_table_is_described(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("t_s,lat_deg,lon_deg,heading_deg\n0,48,-123,10\n1,48.0001,-123,12\n")
    data = check_file(path).as_dict()
    assert data["quantities"]["position"]["lat_deg"] == [48.0, 48.0001]
    assert data["quantities"]["heading"]["heading_deg"] == [10.0, 12.0]
    assert data["quantities"]["heading"]["start_utc"] is None


@pytest.mark.parametrize("content", [b"", b"\0\1\2", b"nonsense\n"])
def test_what_is_not_understood_is_a_fault_of_one_line(tmp_path, content):
    path = tmp_path / "file"
    path.write_bytes(content)
    report = check_file(path)
    assert not report.ok
    assert len(report.lines()) == 1
    assert json.dumps(report.as_dict(), allow_nan=False)


def test_a_missing_file_is_named(tmp_path):
    report = check_file(tmp_path / "nothing.txt")
    assert report.lines() == [f"{tmp_path / 'nothing.txt'}: no such file"]


def test_further_kinds_are_asked_first(tmp_path):
    path = tmp_path / "x.toml"
    path.write_text("schema = 1\n")
    asked = []

    def recognises(file: Path, head: bytes) -> bool:
        asked.append((file, head))
        return head.startswith(b"schema")

    report = check_file(path, [Checker(recognises, lambda file: FileReport(str(file), "a scenario"))])
    assert report.kind == "a scenario"
    assert asked == [(path, b"schema = 1\n")]
    assert check_file(ship_files(tmp_path)["gyro"], [Checker(recognises, lambda file: FileReport("", ""))]).ok


_FIELD = st.text(st.sampled_from("0123456789.-+ANVE,enf"), max_size=12)
_BODY = st.builds(
    lambda kind, fields: f"XX{kind}," + ",".join(fields),
    st.sampled_from(["VBW", "VHW", "VTG", "RMC", "GGA", "HDT", "ZDA"]),
    st.lists(_FIELD, max_size=14),
)


_CELL = st.text(st.sampled_from('0123456789.-,;"enaT:Z\n'), max_size=6)


_LINES = st.one_of(_BODY.map(sentence), _BODY.map(lambda body: stamped(0, body)), st.text(max_size=30))
_LOG = st.lists(_LINES, max_size=8).map(lambda lines: "\n".join(lines).encode(errors="replace"))
_ROWS = st.lists(st.lists(_CELL, min_size=2, max_size=3).map(",".join), max_size=6)
_TABLE = st.builds(
    lambda clock, rows: "\n".join([f"{clock},heading_deg", *rows]).encode(),
    st.sampled_from(["utc", "t_s"]),
    _ROWS,
)


@given(
    st.one_of(
        st.tuples(st.just("log.txt"), _LOG),
        st.tuples(st.just("t.csv"), _TABLE),
        st.tuples(st.just("file"), st.binary(max_size=400)),
    )
)
@settings(max_examples=300)
def test_no_file_however_odd_raises(tmp_path_factory, file):
    name, content = file
    path = tmp_path_factory.mktemp("odd") / name
    path.write_bytes(content)
    report = check_file(path)
    assert report.ok or report.faults
    json.dumps(report.as_dict(), allow_nan=False)
