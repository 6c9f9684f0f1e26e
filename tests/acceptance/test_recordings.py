"""The recordings of R/V Sikuliaq, 2018-12-06, and of a parked IMU: contents, licences, the runs on them."""

import tomllib
from pathlib import Path

import numpy as np
import pytest

from navcore.alignment.fine import coarse_alignment
from navcore.checks.file import check_file
from navcore.checks.imu import IMU_CHECKER
from navcore.engine.simulation import simulate
from navcore.fitting.along_track import log_along_track
from navcore.fitting.log import fit_log
from navcore.foundation.earth import WGS84
from navcore.foundation.units import DEG, DEG_PER_HOUR, HOUR, KNOT
from navcore.io.recording import load, shared_window
from navcore.mechanization.strapdown.attitude import angles_of
from navcore.motion.track import TrackMotion
from navcore.motion.truth import HEADING, LAT, LON, VE, VN, Site
from navcore.scenario.file import load as load_scenario
from navcore.scenario.file import read_toml
from navcore.scenario.model import Scenario
from navcore.sensors.log import reference_errors
from navcore.sensors.recorded import recorded_window, recording_notices
from navcore.sensors.recorded_imu import check_rest, read_imu
from navcore.sensors.reference import Reference
from tests.recordings import OWN_SHIP, imu, ship

SHARED_S = 714.0
"""714 fixes of the GNSS receiver, one a second; gyro and log last longer."""
NO_HEIGHT = "empty cells, missing samples: height_m 1"


SHIP = ship()
EACH_SHIP = pytest.mark.parametrize(
    "files", dict.fromkeys((SHIP, OWN_SHIP)), ids=lambda files: "raw" if files.raw else "own"
)
"""Both, where the raw recordings are at hand."""
STREAMS = (
    [
        (SHIP.log, 5000, "VDVBW", 2500, 0.911, 2744.07),
        (SHIP.track[1], 5000, "HEHDT", 2000, 1.999, 999.51),
        (SHIP.track[0], 5000, "GNRMC", 714, 1.0, 713.0),
        (SHIP.track[0], 5000, "GNGGA", 713, 1.0, 712.0),
        (SHIP.log.replace("speedlog", "ins_seapath_position"), 5000, "GPRMC", 500, 1.0, 499.0),
    ]
    if SHIP.raw
    else [(SHIP.log, 2500, "rows", 2500, 0.909, 2744.1), (SHIP.track[0], 714, "rows", 714, 1.0, 713.0)]
)
"""File, lines, sentence, how many, rate and span."""


@pytest.fixture(scope="module")
def track() -> TrackMotion:
    return TrackMotion(file=SHIP.track)


@pytest.mark.parametrize(("file", "lines", "address", "count", "rate_hz", "span_s"), STREAMS)
def test_check_tells_what_the_files_hold(file, lines, address, count, rate_hz, span_s):
    report = check_file(file)
    assert report.ok
    # The receiver's first fix has no height: a cell of the CSV is empty.
    assert report.warnings == (() if SHIP.raw or file == SHIP.log else (NO_HEIGHT,))
    found = report.as_dict()
    assert (found["lines"], found["checksum_faults"], found["unparsable_lines"]) == (lines, 0, 0)
    stream = found["sentences"][address]
    assert stream["count"] == count
    assert stream["rate_hz"] == pytest.approx(rate_hz, abs=2e-3)
    assert stream["span_s"] == pytest.approx(span_s, abs=0.01)
    assert stream["gaps"] == 0
    assert any(f"{count} {address}" in line for line in report.lines())


def test_check_tells_the_speeds_of_the_log():
    quantities = check_file(SHIP.log).as_dict()["quantities"]
    assert quantities["water"]["forward_kn"] == [7.8, 10.6]
    assert quantities["ground"]["forward_kn"] == [8.1, 9.3]
    assert quantities["water"]["start_utc"] == "2018-12-06T00:00:00.6Z"


@EACH_SHIP
def test_the_log_has_a_resolution_of_a_tenth_of_a_knot(files):
    log = load(files.log)
    assert log.water.time_s.size == log.ground.time_s.size == 2500
    tenths = log.ground.values / (0.1 * KNOT)
    assert tenths == pytest.approx(np.rint(tenths), abs=1e-9)
    assert log.water.values[:, 1].min() == pytest.approx(7.8 * KNOT)


def test_all_streams_share_714_s_from_the_first_fix():
    recording = load([*SHIP.track, SHIP.log])
    window = shared_window([recording.position, recording.heading, recording.water])
    assert window.start_s % 86400.0 == 0.0
    assert window.span_s == pytest.approx(SHARED_S, abs=1e-6)


def test_the_track_moves_as_the_receiver_says(track):
    values = track.truth(714, 1.0, Site(0.0, 0.0, 0.0), WGS84).values
    recorded = _velocity_of_the_receiver()
    # Course is printed to 0.1 deg and speed to 0.01 kn; the smoothing takes the roll of the antenna out.
    assert np.std(values[:, [VE, VN]] - recorded, axis=0).max() < (0.06 if SHIP.raw else 0.12)
    assert np.mean(values[:, [VE, VN]] - recorded, axis=0) == pytest.approx([0.0, 0.0], abs=0.01)
    assert values[0, HEADING] == pytest.approx(92.3 * DEG, abs=0.2 * DEG)


@EACH_SHIP
def test_ground_speed_agrees_with_the_track_as_stated_with_the_data(files):
    track = TrackMotion(file=files.track)
    reference = Reference(kind="file", file=files.log, speed="ground", frame="body")
    window = recorded_window(track, reference)
    truth = track.truth(1429, 0.5, Site(0.0, 0.0, 0.0), WGS84, start_utc=window.start_s)
    found = reference_errors(reference, truth, SHARED_S, 1, start_utc=window.start_s)
    assert found.time_s.size == 650
    heading = np.interp(found.time_s, 0.5 * np.arange(1429), truth.values[:, HEADING])
    forward = found.error[:, 0] * np.sin(heading) + found.error[:, 1] * np.cos(heading)
    # The data's own description: ground minus GNSS speed -0.05 +- 0.07 kn.
    assert forward.mean() / KNOT == pytest.approx(-0.05, abs=0.02)
    assert forward.std() / KNOT == pytest.approx(0.07, abs=0.02)
    notices = [text for text in recording_notices(track, reference) if NO_HEIGHT not in text]
    assert notices == []


def test_water_speed_differs_by_the_tidal_stream(track):
    errors = {}
    for speed in ("water", "ground"):
        reference = Reference(kind="file", file=SHIP.log, speed=speed)
        window = recorded_window(track, reference)
        truth = track.truth(1429, 0.5, Site(0.0, 0.0, 0.0), WGS84, start_utc=window.start_s)
        errors[speed] = reference_errors(reference, truth, SHARED_S, 1, start_utc=window.start_s).error
    stream = errors["water"] - errors["ground"]
    assert np.hypot(*stream.mean(axis=0)) > 0.3
    assert stream.std() > 0.3


def test_a_run_along_the_recordings_by_all_three_methods(repo_root):
    data = read_toml(repo_root / "examples" / "ship_log.toml", "ship_log.toml")
    data["motion"]["file"] = list(SHIP.track)
    data["reference"]["file"] = SHIP.log
    data["run"]["duration_h"] = SHARED_S / HOUR
    run = simulate(Scenario.parse(data))
    assert [m.method.name for m in run.methods] == ["free", "classic2", "complementary"]
    assert [m.status for m in run.methods] == ["ok"] * 3
    warnings = [text for text in run.warnings if NO_HEIGHT not in text]
    assert ["of a Schuler period" in warning for warning in warnings] == [False, True]
    assert warnings[0].startswith("beside the recording")
    assert run.t_s[-1] == SHARED_S
    for method in run.methods:
        assert np.abs(method.rows).max() < 1e4
        assert len(method.t_s) == 715


def _velocity_of_the_receiver() -> np.ndarray:
    """Its own velocity; the CSV holds positions only, of which it is the slope."""
    recording = load(list(SHIP.track))
    if SHIP.raw:
        return recording.velocity.values
    lat, lon = recording.position.values[:, 0], recording.position.values[:, 1]
    m, n = WGS84.radii(float(lat[0]))
    return np.column_stack([np.gradient(lon) * n * np.cos(lat), np.gradient(lat) * m])


# ---------------------------------------------------------------- the fit of the log


REFERENCE = Reference(kind="file", file=SHIP.log, speed="ground")


@pytest.fixture(scope="module")
def preset(repo_root: Path) -> dict:
    return tomllib.loads(
        (repo_root / "assets" / "presets" / "sikuliaq-like.toml").read_text(encoding="utf-8")
    )


@pytest.fixture(scope="module")
def log():
    return log_along_track(REFERENCE, TrackMotion(file=SHIP.track))


def test_the_numbers_of_the_preset_lie_within_the_intervals_of_the_fit(preset, log):
    fit = fit_log(log, through_water=False)
    stated = preset["reference"]
    for one, value in (
        (fit.delay_s, stated["delay_s"]),
        *zip(fit.bias, stated["bias_mps"], strict=True),
        (fit.noise, stated["noise_mps"]),
        (fit.drift, stated["drift_mps"]),
        (fit.drift_tau_s, stated["drift_tau_s"]),
    ):
        assert one.low <= value <= one.high
    assert fit.delay_s.value == pytest.approx(12.2, abs=0.4) and fit.delay_s.deviation < 0.5
    assert fit.bias[0].value == pytest.approx(-0.051, abs=0.002)
    assert fit.noise.value == pytest.approx(0.005, abs=0.002)
    assert fit.drift.value == pytest.approx(0.021, abs=0.002)
    assert 695.0 < fit.span_s < 714.0


def test_the_delay_is_real_both_axes_err_less_with_it(log):
    plain, delayed = log.error()[1][20:], log.error(12.6)[1]
    assert np.all(delayed.std(axis=0) < 0.7 * plain.std(axis=0))


def test_the_fit_does_not_hang_on_the_smoothing_of_the_track():
    for smoothing in (2.0, 10.0):
        other = log_along_track(REFERENCE, TrackMotion(file=SHIP.track, smoothing_s=smoothing))
        fit = fit_log(other, through_water=False)
        assert fit.delay_s.value == pytest.approx(12.2, abs=0.8)
        assert fit.bias[0].value == pytest.approx(-0.051, abs=0.003)
        # What is left beside the bias is 0.02 m/s: how much of it is noise the smoothing decides.
        assert np.hypot(fit.noise.value, fit.drift.value) == pytest.approx(0.023, abs=0.006)


def test_the_preset_names_where_its_error_comes_from(preset):
    assert "fitted to the R/V Sikuliaq Doppler speed log of 2018-12-06, 714 s" in preset["source"]
    assert preset["run"]["duration_h"] == 10.0
    assert [method["name"] for method in preset["method"]] == ["free", "classic2", "complementary"]


# ---------------------------------------------------------------- the recordings that come along


@pytest.fixture(scope="module")
def recordings(repo_root: Path) -> Path:
    return repo_root / "assets" / "recordings"


def test_the_recordings_are_small_understood_and_licensed(recordings: Path) -> None:
    files = sorted(recordings.glob("*.csv"))
    assert sorted(file.stem for file in files) == [
        "lasergyro-1s",
        "own-ins",
        "own-ins-gnss",
        "own-ins-log",
        "sikuliaq-log",
        "sikuliaq-track",
    ]
    assert sum(file.stat().st_size for file in files) < 500_000
    assert all(check_file(file, [IMU_CHECKER]).ok for file in files)
    licences = (recordings / "LICENCES.md").read_text(encoding="utf-8")
    assert "David Pablo Cohn" in licences and "Gongmin Yan" in licences
    assert all(file.name in licences for file in files)


def test_the_example_runs_on_them(repo_root: Path) -> None:
    run = simulate(load_scenario(str(repo_root / "examples" / "sikuliaq.toml")))
    assert [m.method.name for m in run.methods] == ["free", "classic2", "complementary"]
    assert [m.status for m in run.methods] == ["ok"] * 3
    assert run.t_s[-1] == pytest.approx(SHARED_S, abs=1.0)
    assert any("of a Schuler period" in warning for warning in run.warnings)


def test_the_parked_imu_measures_gravity_the_earths_rate_and_its_heading(recordings: Path) -> None:
    record = read_imu(recordings / "lasergyro-1s.csv", "frd")
    lat, quiet = 34.246048 * DEG, record.increments[570:950]
    check_rest(record, WGS84.gravity(lat, 380.0), 570.0, 950.0)
    mean = quiet.mean(axis=0) * record.rate_hz
    assert np.linalg.norm(mean[3:]) == pytest.approx(9.7955, abs=1e-3)
    assert np.linalg.norm(mean[:3]) / DEG_PER_HOUR == pytest.approx(14.94, abs=0.1)
    pitch, roll, heading = np.array(angles_of(*coarse_alignment(quiet, record.rate_hz, lat))) / DEG
    # The file's own heading is -90.6 deg, counted counter-clockwise.
    assert heading == pytest.approx(90.6, abs=1.0)
    assert abs(pitch) < 2.0 and abs(roll) < 2.0


# ---------------------------------------------------------------- a parked vehicle


PARKED = Site(34.246048 * DEG, 108.909664 * DEG, 380.0)


def test_damping_with_zero_velocity_holds_what_runs_away_free():
    """``imu.file``: 570 s left out, aligned until 950 s, then navigated with V_r = 0."""
    # the raw recording gives its place itself
    own_site = {"lat_deg": PARKED.lat / DEG, "lon_deg": PARKED.lon / DEG, "height_m": PARKED.height}
    run = simulate(
        Scenario.parse(
            {
                "run": {"fidelity": "strapdown", "duration_h": 0.24},
                "site": {} if imu().raw else own_site,
                "imu": {"file": str(imu().path), "axes": imu().axes, "begin_s": 570.0},
                "alignment": {"kind": "compass", "duration_s": 380.0},
                "reference": {"kind": "log"},
                "method": [
                    {"name": "free"},
                    {
                        "name": "compass",
                        "damping": "external",
                        "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7},
                    },
                ],
            }
        )
    )
    assert run.truth[0, HEADING] / DEG == pytest.approx(90.7, abs=0.3)
    assert run.truth[0, [LAT, LON]] / DEG == pytest.approx([34.246048, 108.909664], abs=1e-6)
    free, compass = (method.errors["dve_mps"]["max_abs"] for method in run.methods)
    assert free < 1.0 and compass < 0.3 * free
    if imu().raw:
        assert any("gives its place" in text for text in run.warnings)
