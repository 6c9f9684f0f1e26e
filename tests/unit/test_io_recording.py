"""Joining recorded streams: which file gives what, the time they share, the cache."""

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.io.recording import load, require_cover, shared_window
from navcore.io.series import Series
from tests.nmea import START, sentence, ship_files, stamped, write

T0 = START.timestamp()


def series(times, dated: bool = True) -> Series:
    time_s = np.asarray(times, dtype=float)
    return Series(time_s, np.zeros((time_s.size, 1)), np.ones(time_s.size, dtype=bool), "f", "HDT", dated)


def test_each_quantity_comes_from_the_first_file_that_holds_it(tmp_path):
    files = ship_files(tmp_path)
    other = write(tmp_path / "other.txt", [stamped(k, "HEHDT,77.00,T") for k in range(5)])
    recording = load([files["gnss"], other, files["gyro"]])
    assert recording.position.file == "gnss.txt"
    assert recording.heading.file == "other.txt"
    assert [source.name for source in recording.sources] == ["gnss.txt", "other.txt", "gyro.txt"]


def test_a_single_path_is_a_list_of_one(tmp_path):
    assert load(ship_files(tmp_path)["log"]).water.time_s.size == 273


def test_an_edited_file_is_read_again(tmp_path):
    path = write(tmp_path / "gyro.txt", [stamped(0, "HEHDT,10.0,T")])
    assert load(path).heading.time_s.size == 1
    write(path, [stamped(k, "HEHDT,10.0,T") for k in range(2)])
    assert load(path).heading.time_s.size == 2


def test_an_unchanged_file_is_read_once(tmp_path):
    path = ship_files(tmp_path)["gyro"]
    assert load(path).heading is load([path]).heading


def test_all_wrong_files_are_named(tmp_path):
    empty = write(tmp_path / "empty.txt", [])
    nonsense = write(tmp_path / "nonsense.txt", ["nonsense"])
    with pytest.raises(InputError) as caught:
        load([empty, nonsense], "scenario.toml", "motion.file")
    assert [str(f) for f in caught.value.faults] == [
        f"scenario.toml: motion.file = {str(empty)!r}: the file is empty"
    ]
    with pytest.raises(InputError) as caught:
        load([nonsense, nonsense], "scenario.toml", "motion.file")
    assert [f.field for f in caught.value.faults] == ["motion.file", "motion.file"]


@pytest.mark.parametrize("paths", [[], "", [""]])
def test_no_file_is_a_fault(paths):
    with pytest.raises(InputError, match="name at least one file"):
        load(paths, "", "file")


def test_dated_and_undated_files_are_not_joined(tmp_path):
    table = tmp_path / "a.csv"
    table.write_text("t_s,heading_deg\n0,1\n1,2\n")
    with pytest.raises(InputError, match="cannot be joined"):
        load([ship_files(tmp_path)["gnss"], table])


@pytest.mark.parametrize(
    ("times", "start_s", "end_s"),
    [
        ([np.arange(714.0), 0.0117 + 0.5 * np.arange(2000), 0.62 + 1.1 * np.arange(2500)], 0.0, 714.0),
        ([np.arange(100.0), 50.3 + 0.5 * np.arange(200)], 50.0, 100.0),
        ([np.arange(0.0, 601.0, 60.0)], 0.0, 602.0),
    ],
    ids=["the first epoch that all cover", "one begins late", "slow: two seconds beyond its samples at most"],
)
def test_time_zero_and_the_end_are_shared(times, start_s, end_s):
    window = shared_window([series(each) for each in times])
    assert (window.start_s, window.end_s) == (start_s, end_s)
    assert window.covers(start_s, end_s - start_s)
    assert not window.covers(start_s, end_s - start_s + 0.1)
    assert not window.covers(start_s - 3.0, 10.0)


def test_streams_without_common_time_are_refused_with_their_spans(tmp_path):
    early = write(tmp_path / "early.txt", [stamped(k, "HEHDT,1.0,T") for k in range(5)])
    gnss = ship_files(tmp_path)["gnss"]
    late = write(tmp_path / "late.txt", [stamped(1000 + k, "VWVHW,,T,,M,5.0,N,,K") for k in range(5)])
    recording = load([early, late, gnss])
    with pytest.raises(InputError, match="share no time: early.txt HEHDT 2024-02-28T23:58:00.0Z to"):
        shared_window([recording.heading, recording.water])


def test_dated_and_undated_streams_share_no_time():
    with pytest.raises(InputError, match="without a date"):
        shared_window([series([0.0, 1.0]), series([0.0, 1.0], dated=False)])


def test_a_longer_run_than_the_record_names_what_there_is():
    window = shared_window([series(T0 + np.arange(714.0))])
    require_cover(window, window.start_s, 714.0, "the track", "gnss.txt")
    with pytest.raises(InputError) as caught:
        require_cover(window, window.start_s, 720.0, "the track", "gnss.txt")
    fault = caught.value.faults[0]
    assert fault.field == "file"
    assert "lasts 714.0 s = 0.1983 h" in fault.allowed
    assert "run.duration_h must be <= 0.1983" in fault.allowed


def test_readings_of_one_second_are_spread_over_it(tmp_path):
    lines = [stamped(0, "HEHDT,10.0,T"), stamped(0, "HEHDT,20.0,T"), stamped(1, "HEHDT,30.0,T")]
    heading = load(write(tmp_path / "gyro.txt", [*lines, sentence("GPZDA,1,2")])).heading
    assert np.rad2deg(heading.values[:, 0]) == pytest.approx([10.0, 20.0, 30.0])
    assert np.diff(heading.time_s) == pytest.approx([0.5, 0.5])
