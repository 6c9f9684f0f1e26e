"""A parked vehicle's ring-laser-gyro IMU: aligned in its quiet window, then navigated with V_r = 0."""

import pytest

from navcore.engine.simulation import simulate
from navcore.foundation.units import DEG
from navcore.motion.truth import HEADING, LAT, LON, Site
from navcore.scenario.model import Scenario
from tests.recordings import imu

SITE = Site(34.246048 * DEG, 108.909664 * DEG, 380.0)


def test_damping_with_zero_velocity_holds_what_runs_away_free():
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
