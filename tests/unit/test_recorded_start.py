"""`imu.file` in a scenario: alignment, then navigation, on a record made here; what cannot serve is told."""

from typing import Any

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG
from navcore.motion.base import HEADING, Site
from navcore.motion.static import StaticMotion
from navcore.scenario.model import Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation

RATE, SECONDS = 20.0, 900
SITE = Site(32.06 * DEG, 118.8 * DEG, 0.0)
HEADER = "t_s,dax_rad,day_rad,daz_rad,dvx_mps,dvy_mps,dvz_mps"
METHODS = [{"name": "free"}, {"name": "compass", "damping": "external", "network": {"id": "compass"}}]


@pytest.fixture(scope="module")
def record(tmp_path_factory) -> str:
    """A level vehicle at rest, heading 40 deg, 0.05 deg/h and 50 ug, as a CSV of increments."""
    imu = Imu(gyro_bias_dph=(0.0, 0.05, 0.0), accel_bias_ug=(50.0, 0.0, 0.0))
    simulation = ImuSimulation(StaticMotion(heading_deg=40.0), SITE, WGS84, imu, RATE, int(RATE * SECONDS), 1)
    samples = np.concatenate([chunk.copy() for chunk, _ in simulation.chunks()])
    table = np.column_stack([np.arange(1, len(samples) + 1) / RATE, samples])
    path = tmp_path_factory.mktemp("imu") / "parked.csv"
    np.savetxt(path, table, fmt="%.17g", delimiter=",", header=HEADER, comments="")
    return str(path)


def _run(record: str, **blocks: Any):
    merged = {
        "run": {"fidelity": "strapdown", "duration_h": 0.05} | blocks.pop("run", {}),
        "imu": {"file": record} | blocks.pop("imu", {}),
        "alignment": {"kind": "compass", "duration_s": 700.0} | blocks.pop("alignment", {}),
        "reference": {"kind": "log"},
        "method": METHODS,
    }
    return simulate(Scenario.parse(merged | blocks))


def test_it_is_aligned_and_then_navigated(record):
    run = _run(record)
    assert [m.status for m in run.methods] == ["ok", "ok"]
    assert run.sampling is not None and run.sampling.rate_hz == pytest.approx(RATE)
    # phi_U = -eps_E / (Omega cos L) + tan L nabla_E / g, with eps_E = eps_y sin 40 deg: the heading error.
    eps_e = np.radians(0.05 / 3600.0) * np.sin(40.0 * DEG)
    nabla_e = 50e-6 * np.cos(40.0 * DEG)
    phi_u = -eps_e / (7.292115e-5 * np.cos(SITE.lat)) + np.tan(SITE.lat) * nabla_e
    assert run.truth[0, HEADING] / DEG == pytest.approx(40.0 + phi_u / DEG, abs=0.01)
    assert np.abs(run.methods[0].rows[0, :5]).max() < 1e-15
    free, compass = run.methods
    assert compass.errors["dve_mps"]["max_abs"] < free.errors["dve_mps"]["max_abs"]
    assert any("true attitude of a recorded IMU is not known" in text for text in run.warnings)


def test_without_alignment_it_starts_at_the_attitude_of_the_motion(record):
    run = _run(record, alignment={"kind": "none"}, motion={"kind": "static", "heading_deg": 40.0})
    assert run.truth[0, HEADING] == pytest.approx(40.0 * DEG)
    # At rest the free errors grow from zero: the acceleration's bias, and the tilt that the gyro's makes.
    nabla = 50e-6 * np.cos(40.0 * DEG) * 9.8
    tilting = 9.8 * np.radians(0.05 / 3600.0) * np.cos(40.0 * DEG)
    expected = nabla * 180.0 + tilting * 180.0**2 / 2.0
    assert run.methods[0].errors["dve_mps"]["final"] == pytest.approx(expected, rel=0.02)
    assert any("taken from motion.pitch_deg" in text for text in run.warnings)


def test_settings_that_a_record_leaves_unused_are_told(record):
    run = _run(record, imu={"gyro_bias_dph": [1.0, 0.0, 0.0], "accel_vrw_ugpshz": 1.0})
    assert any("imu.gyro_bias_dph, imu.accel_vrw_ugpshz not used" in text for text in run.warnings)


def test_a_cancel_keeps_what_was_navigated(record):
    run = simulate(
        Scenario.parse(
            {
                "run": {"fidelity": "strapdown", "duration_h": 0.2},
                "imu": {"file": record},
                "motion": {"kind": "static", "heading_deg": 40.0},
            }
        ),
        cancelled=lambda: True,
    )
    assert run.status == "stopped" and 0 < len(run.methods[0].t_s) < len(run.t_s)


@pytest.mark.parametrize(
    ("blocks", "line"),
    [
        (
            {"run": {"duration_h": 0.5}},
            "run.duration_h = 0.5: is longer than the recorded IMU: of its 900 s, 700 s are left out or used "
            "for the alignment, so that 0.05556 h remain",
        ),
        ({"imu": {"begin_s": 5000.0}}, "so that 0 h remain"),
        ({"imu": {"file": "/nowhere.imu"}}, "/nowhere.imu: imu.file: No such file or directory"),
        ({"imu": {"axes": "frd"}}, "the -z axis looks like up, but z must point up"),
        ({"alignment": {"sigma": 1.9, "duration_s": 100.0}}, "alignment.sigma = 2.68"),
    ],
)
def test_what_cannot_serve_is_one_clear_line(record, blocks, line):
    with pytest.raises(InputError) as caught:
        _run(record, **blocks)
    assert len(caught.value.faults) == 1 and line in str(caught.value)
