"""R/V Sikuliaq, 2018-12-06: what the recordings hold, what they share, and the run on them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.foundation.units import DEG, HOUR, KNOT
from navcore.io.recording import load, shared_window
from navcore.motion.base import HEADING, VE, VN, Site
from navcore.motion.track import TrackMotion
from navcore.sensors.recorded import recorded_window, recording_notices
from navcore.sensors.reference import Reference, reference_errors

SHARED_S = 714.0
"""714 fixes of the GNSS receiver, one a second; gyro and log last longer."""


@pytest.fixture(scope="module")
def ship(shared_data: Path) -> dict[str, str]:
    folder = shared_data / "ship"
    names = {"log": "speedlog", "gyro": "gyro_1", "gnss": "gnss_cnav", "seapath": "ins_seapath_position"}
    return {name: str(folder / f"SKQ_{stem}.txt") for name, stem in names.items()}


@pytest.fixture(scope="module")
def track(ship) -> TrackMotion:
    return TrackMotion(file=(ship["gnss"], ship["gyro"]))


@pytest.mark.parametrize(
    ("name", "address", "count", "rate_hz", "span_s"),
    [
        ("log", "VDVBW", 2500, 0.911, 2744.07),
        ("gyro", "HEHDT", 2000, 1.999, 999.51),
        ("gnss", "GNRMC", 714, 1.0, 713.0),
        ("gnss", "GNGGA", 713, 1.0, 712.0),
        ("seapath", "GPRMC", 500, 1.0, 499.0),
    ],
)
def test_check_tells_what_the_files_hold(ship, name, address, count, rate_hz, span_s):
    report = check_file(ship[name])
    assert report.ok
    assert report.warnings == ()
    found = report.as_dict()
    assert (found["lines"], found["checksum_faults"], found["unparsable_lines"]) == (5000, 0, 0)
    stream = found["sentences"][address]
    assert stream["count"] == count
    assert stream["rate_hz"] == pytest.approx(rate_hz, abs=2e-3)
    assert stream["span_s"] == pytest.approx(span_s, abs=0.01)
    assert stream["gaps"] == 0
    assert any(f"{count} {address}" in line for line in report.lines())


def test_check_tells_the_speeds_of_the_log(ship):
    quantities = check_file(ship["log"]).as_dict()["quantities"]
    assert quantities["water"]["forward_kn"] == [7.8, 10.6]
    assert quantities["ground"]["forward_kn"] == [8.1, 9.3]
    assert quantities["water"]["start_utc"] == "2018-12-06T00:00:00.6Z"


def test_the_log_has_a_resolution_of_a_tenth_of_a_knot(ship):
    tenths = load(ship["log"]).ground.values / (0.1 * KNOT)
    assert tenths == pytest.approx(np.rint(tenths), abs=1e-9)


def test_all_streams_share_714_s_from_the_first_fix(ship):
    recording = load([ship["gnss"], ship["gyro"], ship["log"]])
    window = shared_window([recording.position, recording.heading, recording.water])
    assert window.start_s % 86400.0 == 0.0
    assert window.span_s == pytest.approx(SHARED_S, abs=1e-6)


def test_the_track_moves_as_the_receiver_says(ship, track):
    values = track.truth(714, 1.0, Site(0.0, 0.0, 0.0), _earth()).values
    recorded = load(ship["gnss"]).velocity.values
    # Course is printed to 0.1 deg and speed to 0.01 kn; the smoothing takes the roll of the antenna out.
    assert np.std(values[:, [VE, VN]] - recorded, axis=0).max() < 0.06
    assert np.mean(values[:, [VE, VN]] - recorded, axis=0) == pytest.approx([0.0, 0.0], abs=0.01)
    assert values[0, HEADING] == pytest.approx(92.3 * DEG, abs=0.2 * DEG)


def test_ground_speed_agrees_with_the_track_as_stated_with_the_data(ship, track):
    reference = Reference(kind="file", file=ship["log"], speed="ground", frame="body")
    window = recorded_window(track, reference)
    truth = track.truth(1429, 0.5, Site(0.0, 0.0, 0.0), _earth(), start_utc=window.start_s)
    found = reference_errors(reference, truth, SHARED_S, 1, start_utc=window.start_s)
    assert found.time_s.size == 650
    heading = np.interp(found.time_s, 0.5 * np.arange(1429), truth.values[:, HEADING])
    forward = found.error[:, 0] * np.sin(heading) + found.error[:, 1] * np.cos(heading)
    # The data's own description: ground minus GNSS speed -0.05 +- 0.07 kn.
    assert forward.mean() / KNOT == pytest.approx(-0.05, abs=0.02)
    assert forward.std() / KNOT == pytest.approx(0.07, abs=0.02)
    assert recording_notices(track, reference) == ()


def test_water_speed_differs_by_the_tidal_stream(ship, track):
    errors = {}
    for speed in ("water", "ground"):
        reference = Reference(kind="file", file=ship["log"], speed=speed)
        window = recorded_window(track, reference)
        truth = track.truth(1429, 0.5, Site(0.0, 0.0, 0.0), _earth(), start_utc=window.start_s)
        errors[speed] = reference_errors(reference, truth, SHARED_S, 1, start_utc=window.start_s).error
    stream = errors["water"] - errors["ground"]
    assert np.hypot(*stream.mean(axis=0)) > 0.3
    assert stream.std() > 0.3


def test_a_run_along_the_recordings_by_all_three_methods(ship, repo_root):
    from navcore.engine.simulation import simulate
    from navcore.scenario.file import read_toml
    from navcore.scenario.model import Scenario

    data = read_toml(repo_root / "examples" / "ship_log.toml", "ship_log.toml")
    data["motion"]["file"] = [ship["gnss"], ship["gyro"]]
    data["reference"]["file"] = ship["log"]
    data["run"]["duration_h"] = SHARED_S / HOUR
    run = simulate(Scenario.parse(data))
    assert [m.method.name for m in run.methods] == ["free", "classic2", "complementary"]
    assert [m.status for m in run.methods] == ["ok"] * 3
    assert ["of a Schuler period" in warning for warning in run.warnings] == [True]
    assert run.t_s[-1] == SHARED_S
    for method in run.methods:
        assert np.abs(method.rows).max() < 1e4
        assert len(method.t_s) == 715


def _earth():
    from navcore.foundation.earth import WGS84

    return WGS84
