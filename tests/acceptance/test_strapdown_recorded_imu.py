"""A parked vehicle's ring-laser-gyro IMU: aligned in its quiet window, then navigated with V_r = 0."""

import numpy as np
import pytest

from navcore.alignment.fine import coarse_alignment, fine_alignment
from navcore.engine.simulation import simulate
from navcore.foundation.earth import WGS84
from navcore.foundation.units import DEG
from navcore.mechanization.strapdown import Settings, Start, start_run
from navcore.mechanization.strapdown.attitude import angles_of
from navcore.motion.base import COLUMNS, HEADING, HEIGHT, LAT, LON, PITCH, ROLL, Site
from navcore.networks.compass import CompassNetwork
from navcore.networks.undamped import UndampedNetwork
from navcore.scenario.model import Scenario
from navcore.sensors.recorded_imu import check_rest, read_imu
from tests.recordings import imu
from tests.strapdown import law, reference

BEGIN_S, END_S, COARSE_S = 570, 950, 120
SITE = Site(34.246048 * DEG, 108.909664 * DEG, 380.0)


@pytest.fixture(scope="module")
def record():
    """At 100 Hz where the raw recording is, else as the means of a second."""
    file = imu()
    return read_imu(file.path, file.axes)


@pytest.fixture(scope="module")
def aligned(record):
    rate = round(record.rate_hz)
    quiet = record.increments[BEGIN_S * rate : END_S * rate]
    check_rest(record, WGS84.gravity(SITE.lat, SITE.height), BEGIN_S, END_S)
    start = coarse_alignment(quiet[: COARSE_S * rate], record.rate_hz, SITE.lat)
    # The vehicle is parked: the coarse attitude serves again at the window's start.
    return fine_alignment(quiet, record.rate_hz, start, SITE.lat, SITE.height, WGS84)


def test_heading_of_the_parked_vehicle(aligned):
    pitch, roll, heading = np.array(angles_of(*aligned.quaternion)) / DEG
    assert heading == pytest.approx(90.7, abs=0.3)
    assert abs(pitch) < 2.0 and abs(roll) < 2.0


def test_damping_with_zero_velocity_holds_what_runs_away_free(record, aligned):
    rate = round(record.rate_hz)
    rest = record.increments[END_S * rate :]
    seconds = len(rest) // rate
    truth = np.zeros((1, COLUMNS))
    truth[0, [LAT, LON, HEIGHT]] = SITE.lat, SITE.lon, SITE.height
    truth[0, [PITCH, ROLL, HEADING]] = angles_of(*aligned.quaternion)
    start = Start(SITE.lat, SITE.lon, SITE.height, np.zeros(3), aligned.quaternion)
    worst = {}
    for damping, network in (("free", UndampedNetwork()), ("external", CompassNetwork(sigma=0.0088, xi=0.7))):
        run = start_run(
            start,
            Settings(record.rate_hz, seconds * rate, rate, rate, 1.0),
            WGS84,
            law(damping, network, 1.0),
            truth,
            reference((0, 0), seconds),
            record.increments[END_S * rate - 1],
        )
        run.advance(rest)
        worst[damping] = np.abs(run.recorder.rows[:, 3:5]).max()
    assert worst["free"] < 1.0
    assert worst["external"] < 0.3 * worst["free"]


def test_the_same_as_a_scenario():
    """``imu.file``: 570 s left out, aligned until 950 s, then navigated with V_r = 0."""
    # the raw recording gives its place itself
    own_site = {"lat_deg": SITE.lat / DEG, "lon_deg": SITE.lon / DEG, "height_m": SITE.height}
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
