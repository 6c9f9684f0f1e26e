"""A recorded log as the reference: which speed, which heading, which time, and what is said about it."""

import math

import numpy as np
import pytest

from navcore.foundation.earth import SPHERE
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.motion.static import StaticMotion
from navcore.motion.track import TrackMotion
from navcore.motion.truth import HEADING, Site, Truth
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.log import reference_errors
from navcore.sensors.log_errors.events import LogEvent
from navcore.sensors.recorded import recorded_window, recording_notices
from navcore.sensors.reference import Outage, Reference
from tests.nmea import rmc, ship_files, stamped, vbw, write

SECONDS = 299.0
C30, S30 = math.cos(30.0 * DEG), math.sin(30.0 * DEG)
# The made-up ship runs 60 nautical miles a degree, which are a little more on the sphere.
ON_SPHERE = 6378137.0 * DEG / (60.0 * 1852.0)


@pytest.fixture
def files(tmp_path):
    return {name: str(path) for name, path in ship_files(tmp_path).items()}


def run(files, motion: TrackMotion | None = None, truth: Truth | None = None, **fields) -> ReferenceErrors:
    track = motion or TrackMotion(file=(files["gnss"], files["gyro"]))
    reference = Reference(kind="file", **{"file": files["log"], **fields})
    window = recorded_window(track, reference)
    along = truth or track.truth(
        int(2 * SECONDS) + 1, 0.5, Site(0.0, 0.0, 0.0), SPHERE, start_utc=window.start_s
    )
    return reference_errors(reference, along, SECONDS, 1, start_utc=window.start_s)


def true_velocity(knots: float = 10.0) -> np.ndarray:
    return knots * KNOT * ON_SPHERE * np.array([S30, C30])


def test_ground_speed_minus_the_true_velocity_is_the_error(files):
    found = run(files, speed="ground")
    assert found.time_s[0] == pytest.approx(0.62, abs=1e-6)
    assert np.diff(found.time_s) == pytest.approx(1.1, abs=1e-3)
    expected = 10.0 * KNOT * np.array([S30, C30]) - true_velocity()
    assert found.error == pytest.approx(np.tile(expected, (found.time_s.size, 1)), abs=1e-3)
    assert not found.body_frame
    assert found.valid.all()
    assert found.hold_s == 5.0


def test_water_speed_is_the_default_and_carries_the_stream(files):
    water, ground = run(files).error, run(files, speed="ground").error
    # 1 kn ahead, 0.5 kn to starboard of heading 030.
    stream = KNOT * (1.0 * np.array([S30, C30]) + 0.5 * np.array([C30, -S30]))
    assert water - ground == pytest.approx(np.tile(stream, (water.shape[0], 1)), abs=1e-9)


def test_a_body_frame_log_is_turned_by_the_true_heading_and_says_so(files):
    track = TrackMotion(file=(files["gnss"], files["gyro"]))
    values = track.truth(int(2 * SECONDS) + 1, 0.5, Site(0.0, 0.0, 0.0), SPHERE).values.copy()
    values[:, HEADING] += 0.1
    found = run(files, truth=Truth(0.5, values), speed="ground", frame="body")
    turned = 10.0 * KNOT * np.array([math.sin(30.0 * DEG + 0.1), math.cos(30.0 * DEG + 0.1)])
    assert found.body_frame
    assert found.error[5] == pytest.approx(turned - true_velocity(), abs=1e-3)


def test_an_enu_log_is_turned_by_the_heading_recorded_with_it(files, tmp_path):
    other = write(tmp_path / "other.txt", [stamped(0.5 * k, "HEHDT,90.00,T") for k in range(700)])
    found = run(files, file=(files["log"], str(other)), speed="ground")
    assert found.error[5] == pytest.approx(np.array([10.0 * KNOT, 0.0]) - true_velocity(), abs=1e-3)
    body = run(files, file=(files["log"], str(other)), speed="ground", frame="body")
    assert body.error[5] == pytest.approx(10.0 * KNOT * np.array([S30, C30]) - true_velocity(), abs=1e-3)


def test_course_and_speed_over_ground_serve_as_they_are(files, tmp_path):
    gps = write(tmp_path / "gps.txt", [stamped(k, "GPVTG,90.0,T,,M,4.0,N,,K,A") for k in range(300)])
    found = run(files, file=str(gps), frame="body")
    assert not found.body_frame
    assert found.error[5] == pytest.approx(np.array([4.0 * KNOT, 0.0]) - true_velocity(), abs=1e-3)


def test_invalid_readings_outages_and_events_are_heeded(files, tmp_path):
    flags = ["VV" if 100 <= k < 110 else "AA" for k in range(300)]
    log = write(
        tmp_path / "v.txt", [stamped(k, vbw((0.0, 10.0), (0.0, 10.0), f)) for k, f in enumerate(flags)]
    )
    event = LogEvent(t_h=0.0, duration_s=10.0, accel_mps2=(0.1, 0.0))
    found = run(files, file=str(log), outage=(Outage(t_h=200.0 / 3600.0, duration_s=5.0),), event=(event,))
    assert np.flatnonzero(~found.valid).tolist() == [*range(100, 110), *range(200, 205)]
    assert np.all(found.error[~found.valid] == 0.0)
    assert found.error[50, 0] - run(files, file=str(log)).error[50, 0] == pytest.approx(1.0)


def test_a_longer_run_than_the_log_is_refused(files):
    track = TrackMotion(file=(files["gnss"], files["gyro"]))
    truth = track.truth(601, 0.5, Site(0.0, 0.0, 0.0), SPHERE)
    reference = Reference(kind="file", file=files["log"])
    with pytest.raises(InputError, match=r"file = .*the log lasts"):
        reference_errors(reference, truth, 310.0, 1)


@pytest.mark.parametrize(
    ("file", "said"),
    [(None, "name at least one file"), ("gyro", "holds no speed"), ("nothing", "no such file")],
)
def test_a_file_that_is_no_log_is_refused(files, tmp_path, file, said):
    reference = Reference(kind="file", file=files.get(file, file))
    with pytest.raises(InputError, match=said) as caught:
        recorded_window(StaticMotion(), reference)
    assert caught.value.faults[0].field == "reference.file"


def test_nothing_recorded_has_no_window_and_a_sound_track_no_notices(files):
    assert recorded_window(StaticMotion(), Reference(kind="log")) is None
    assert recording_notices(StaticMotion(), Reference(kind="log", noise_mps=0.1)) == ()
    track = TrackMotion(file=(files["gnss"], files["gyro"]))
    assert recording_notices(track, Reference(kind="file", file=files["log"])) == ()


def test_track_and_log_share_their_zero(files, tmp_path):
    late = ship_files(tmp_path / ".", log_from=50.3)["log"]
    track = TrackMotion(file=(files["gnss"], files["gyro"]))
    window = recorded_window(track, Reference(kind="file", file=str(late)))
    assert window.start_s - track.window().start_s == pytest.approx(49.51, abs=1e-3)


def test_what_the_user_should_know_is_said(files, tmp_path):
    track = TrackMotion(file=(files["gnss"], files["gyro"]))
    same = recording_notices(track, Reference(kind="file", file=files["gnss"], frame="body", noise_mps=0.1))
    assert any("same receiver as the track" in notice for notice in same)
    assert any('reference.frame = "body" has no effect' in notice for notice in same)
    assert 'reference.noise_mps is not used with reference.kind = "file"' in same
    vhw = write(
        tmp_path / "vhw.txt", [stamped(k, "VWVHW,,T,,M,5.0,N,,K") for k in range(300) if not 100 < k < 120]
    )
    other = recording_notices(StaticMotion(), Reference(kind="file", file=str(vhw), speed="ground"))
    assert any("holds no ground speed" in notice for notice in other)
    assert any("without a recorded track" in notice for notice in other)
    assert any("1 gaps (longest 20.0 s), undamped in those longer than 5.0 s" in notice for notice in other)
    unused = recording_notices(StaticMotion(), Reference(kind="log", file=files["log"]))
    assert unused == ('reference.file is not used with reference.kind = "log"',)
    gappy = write(
        tmp_path / "gappy.txt",
        [stamped(k, rmc(k, 48.0, -123.0, 0.0, 0.0)) for k in range(300) if not 100 < k < 120],
    )
    bridged = recording_notices(TrackMotion(file=(str(gappy), files["gyro"])), Reference())
    assert bridged == ("gappy.txt GPRMC: 1 gaps (longest 20.0 s) bridged by the smoothing",)


def test_readings_below_the_speed_of_the_log_are_not_valid(files):
    assert run(files, min_speed_mps=4.0).valid.any()
    assert not run(files, min_speed_mps=40.0).valid.any()
