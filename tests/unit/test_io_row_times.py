"""Rows of tables: a clock that was not set, rows that are there twice, steps of a clock, headers and
commas.
"""

from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.foundation.errors import InputError
from navcore.io.recording import load, read_recording, require_no_gap
from navcore.motion.track import TrackMotion
from navcore.sensors.recorded import recorded_window
from navcore.sensors.reference import Reference

T0 = 1715938200.0


def _table(folder: Path, times: np.ndarray, twice: int = 1, name: str = "log.csv") -> Path:
    k = np.arange(len(times))
    rows = [
        f"{t:.2f},{50 + 2e-5 * i:.6f},{-4 + 5e-5 * i:.6f},{60 + 0.01 * i:.2f},8.1\n"
        for i, t in zip(k, times, strict=True)
    ]
    path = folder / name
    path.write_text("unix_time,lat,lon,heading_deg,speed_kn\n" + "".join(row * twice for row in rows))
    return path


UNSET = {
    "1970 for 30 rows": np.concatenate([10.0 + np.arange(30), T0 + 30 + np.arange(90)]),
    "1980 for one row": np.concatenate([[315964800.0], T0 + 1 + np.arange(119)]),
    "1970 for most rows": np.concatenate([10.0 + np.arange(80), T0 + 80 + np.arange(40)]),
    "1970 again in between": np.concatenate(
        [T0 + np.arange(50), 1.0 + np.arange(5), T0 + 55 + np.arange(65)]
    ),
    "2093 for three rows": np.concatenate(
        [T0 + np.arange(60), 3.9e9 + np.arange(3), T0 + 63 + np.arange(57)]
    ),
}


@pytest.mark.parametrize("kind", UNSET)
def test_rows_of_a_clock_that_was_not_set_are_left_out(tmp_path: Path, kind: str) -> None:
    path, times = _table(tmp_path, UNSET[kind]), UNSET[kind]
    kept = times[(times > 1.7e9) & (times < 1.8e9)]
    read = read_recording(path)
    assert read.position is not None
    assert read.position.time_s == pytest.approx(kept)
    assert any(
        "the clock was not set" in told and "first time that is trusted" in told for told in read.warnings
    )
    report = check_file(path).as_dict()
    assert report["lines"] == len(times) == report["lines_used"] + report["lines_left_out"][0]["count"]


def test_a_year_that_cannot_be_is_doubted(tmp_path: Path) -> None:
    assert any(
        "of the year 2093" in told
        for told in read_recording(_table(tmp_path, 3.9e9 + np.arange(20.0))).warnings
    )


JUMPS = {
    "weeks": (1024 * 604800.0, "1024 weeks"),
    "years": (9 * 365.25 * 86400.0, "longer than all the rest: was the clock set there"),
    "hours": (3 * 3600.0, "It is an interval and 3 h"),
}


@pytest.mark.parametrize("kind", JUMPS)
def test_no_run_bridges_a_step_of_the_clock(tmp_path: Path, kind: str) -> None:
    step, said = JUMPS[kind]
    path = _table(tmp_path, np.concatenate([T0 - step + np.arange(30), T0 + 30 + np.arange(90)]))
    assert any(said in told for told in check_file(path).warnings)
    track = TrackMotion(file=str(path))
    with pytest.raises(
        InputError, match=r"at most 10% are bridged: was the clock set there.*begins at 2024-05-17"
    ):
        track._covering(100.0, None)
    assert not any("bridged" in told for told in track.notices())


def test_a_run_beside_a_gap_is_none_of_its_business(tmp_path: Path) -> None:
    path = _table(tmp_path, np.concatenate([T0 + np.arange(300), T0 + 30000 + np.arange(60)]))
    track = TrackMotion(file=str(path))
    track._covering(250.0, None)
    with pytest.raises(InputError, match="shorten the run"):
        track._covering(1000.0, None)


def test_short_gaps_are_bridged_and_a_silent_log_is_refused(tmp_path: Path) -> None:
    times = np.delete(T0 + np.arange(300.0), np.arange(100, 120))
    streams = load(_table(tmp_path, times)).quantities().values()
    require_no_gap(streams, T0, 290.0, 0.1, "log.csv")
    with pytest.raises(InputError, match="a gap of 21.0 s"):
        require_no_gap(streams, T0, 150.0, 0.1, "log.csv")
    window = recorded_window(TrackMotion(file=str(tmp_path / "log.csv")), Reference())
    assert window is not None and window.span_s == pytest.approx(301.0, abs=1.1)


@pytest.mark.parametrize("twice", [2, 3])
@pytest.mark.parametrize("each_s", [1.0, 10.0])
def test_rows_that_are_there_twice_are_one(tmp_path: Path, twice: int, each_s: float) -> None:
    read = read_recording(_table(tmp_path, T0 + each_s * np.arange(40), twice))
    assert read.position is not None
    assert read.position.time_s == pytest.approx(T0 + each_s * np.arange(40))
    assert any(f"{40 * (twice - 1)} rows are identical to earlier ones" in told for told in read.warnings)


def test_a_file_with_itself_behind_it_is_one(tmp_path: Path) -> None:
    path = _table(tmp_path, T0 + np.arange(20.0))
    head, _, rows = path.read_text().partition("\n")
    path.write_text(f"{head}\n{rows}{rows}")
    read = read_recording(path)
    assert read.position is not None and read.position.time_s.size == 20
    path.write_text(f"{head}\n{rows}" + rows.splitlines()[-1] + "\n")
    assert any("1 row is identical" in told for told in read_recording(path).warnings)


def test_rows_that_differ_in_a_column_that_is_not_used_are_not_the_same(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(
        "utc,heading,count\n" + "".join(f"2024-05-17T09:30:{k // 4:02d}Z,60,{k}\n" for k in range(40))
    )
    heading = read_recording(path).heading
    assert heading is not None
    assert np.diff(heading.time_s) == pytest.approx(0.25, abs=1e-6)


STEPS = {
    "an hour": (3600.0, "the clock steps by 1 h"),
    "five minutes": (300.0, "the clock was set back, or two recordings"),
}


@pytest.mark.parametrize("kind", STEPS)
def test_a_clock_that_steps_back_is_not_put_in_order(tmp_path: Path, kind: str) -> None:
    back, said = STEPS[kind]
    times = T0 + np.arange(4000.0)
    times[2000:] -= back
    with pytest.raises(InputError, match=said) as caught:
        read_recording(_table(tmp_path, times))
    assert "in order" not in str(caught.value)


def test_rows_in_another_order_are_put_in_order_by_the_user(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="put the rows in order"):
        read_recording(_table(tmp_path, T0 + np.array([*range(20, 40), *range(20)], float)))


def test_leap_seconds_learnt_on_the_way_are_taken_off(tmp_path: Path) -> None:
    times = T0 + np.arange(60.0)
    times[:25] += 18.0
    read = read_recording(_table(tmp_path, times))
    assert read.position is not None
    assert read.position.time_s == pytest.approx(T0 + np.arange(60.0))
    assert any("25 rows before the receiver knew the leap seconds" in told for told in read.warnings)


HEADERS = {
    "unknown names": ("takt,ost,nord\n", "columns found: takt, ost, nord"),
    "in a comment": ("# takt,ost,nord\n", "columns found: takt, ost, nord"),
    "below a title": ("Cruise 12\nship: Polarstern\n\ntakt,ost,nord\n", "columns found: takt, ost"),
    "with units": ("takt,ost,nord\ns,deg,deg\n", "columns found: takt, ost, nord"),
    "none": ("", "has no line with the names of the columns"),
}


@pytest.mark.parametrize("kind", HEADERS)
def test_the_header_is_the_line_before_the_first_row(tmp_path: Path, kind: str) -> None:
    head, said = HEADERS[kind]
    path = tmp_path / "log.csv"
    path.write_text(head + "".join(f"{T0 + k},50.{k},-4.0\n" for k in range(5)))
    with pytest.raises(InputError) as caught:
        read_recording(path)
    assert said in str(caught.value)


def test_the_time_of_a_message_is_taken_before_that_of_its_record(tmp_path: Path) -> None:
    path = tmp_path / "fix.csv"
    head = "%time,field.header.seq,field.header.stamp,field.latitude,field.longitude,field.altitude\n"
    rows = (f"{int(T0 + k)}037000000,{k},{int(T0 + k)}000000000,50.{k},-4.0,12\n" for k in range(5))
    path.write_text(head + "".join(rows))
    position = read_recording(path).position
    assert position is not None
    assert position.time_s == pytest.approx(T0 + np.arange(5.0))
    assert position.values[:, 2] == pytest.approx(np.full(5, 12.0))


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252", "utf-16", "utf-16-le", "utf-8-sig"])
@pytest.mark.parametrize("separator", [";", "\t", "|"])
def test_text_of_german_spreadsheets_is_read_without_a_map(
    tmp_path: Path, encoding: str, separator: str
) -> None:
    path = tmp_path / "log.csv"
    text = separator.join(["time", "heading (°)", "speed (kn)", "Höhe über NN"]) + "\r\n"
    for k in range(20):
        text += (
            separator.join([f"{(T0 + k) / 86400 + 25569:.6f}", f"{60 + k / 10}", "8.1", "1.5"]).replace(
                ".", ","
            )
            + "\r\n"
        )
    path.write_bytes(text.encode(encoding))
    read = read_recording(path)
    assert read.heading is not None
    assert read.heading.values[5, 0] == pytest.approx(np.deg2rad(60.5))
    assert read.heading.time_s == pytest.approx(T0 + np.arange(20.0), abs=0.06)
    assert any("decimal commas" in told for told in read.warnings)


def test_points_and_commas_in_one_column_are_refused_with_the_way_out(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t_s;heading_deg\n0;60,5\n1;60.5\n")
    with pytest.raises(InputError, match="decimal of a map"):
        read_recording(path)
