"""Faults that a mutation run left unnoticed, of refusals, turned attitudes and kept networks."""

import math
from typing import Any

import numpy as np
import pytest

from navcore.averaging.strapdown import _turn_attitude
from navcore.design.worst.played import silent
from navcore.foundation.compiled import plain
from navcore.foundation.errors import InputError
from navcore.scenario.model import Scenario

UNITY: dict[str, Any] = {"id": "unity2"}


def ship(step_s: float = 1.0, **method: Any) -> Scenario:
    block = {"damping": "external", "network": UNITY, **method}
    run = {"duration_h": 1.0, "step_s": step_s}
    return Scenario.parse({"run": run, "reference": {"kind": "log", "noise_mps": 0.1}, "method": [block]})


@pytest.mark.parametrize("gain", ["k1", "k4"])
@pytest.mark.parametrize(("step_s", "fastest"), [(1.0, 0.2), (10.0, 0.02)])
def test_a_gain_of_a_gyrocompass_is_no_faster_than_a_slow_law_samples_it(
    gain: str, step_s: float, fastest: float
) -> None:
    def of(rate: float) -> Scenario:
        return ship(step_s, gyrocompass={"sigma": 0.001, gain: rate})

    assert of(0.99 * fastest).method[0].gyrocompass is not None
    with pytest.raises(
        InputError, match=rf"must be <= {fastest:g} 1/s at a law step of {step_s:g} s"
    ) as told:
        of(1.01 * fastest)
    assert told.value.faults[0].field == f"method.0.gyrocompass.{gain}"


@pytest.mark.parametrize(("pole", "refused"), [(1.0, True), (0.0, True), (-1.0, False)])
def test_an_azimuth_network_has_poles_that_decay_however_slowly_they_would_grow(
    pole: float, refused: bool
) -> None:
    """A pole of p = s/Omega at 1 grows by e in 3.8 h: 7e-5 1/s, little beside any Schuler frequency."""
    slow = {"id": "custom", "num": [1.0, 1.0], "den": [1.0, -pole]}
    if not refused:
        assert ship(azimuth=slow).method[0].azimuth.id == "custom"
        return
    with pytest.raises(InputError, match="must have poles with a negative real part only"):
        ship(azimuth=slow)


def turned(pitch: float, roll: float, heading: float) -> np.ndarray:
    """C_b^n of theory.md 1, in E, N, U from x right, y forward, z up."""
    sp, cp, sr, cr = math.sin(pitch), math.cos(pitch), math.sin(roll), math.cos(roll)
    sh, ch = math.sin(heading), math.cos(heading)
    about_up = np.array([[ch, sh, 0.0], [-sh, ch, 0.0], [0.0, 0.0, 1.0]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cp, -sp], [0.0, sp, cp]])
    about_y = np.array([[cr, 0.0, sr], [0.0, 1.0, 0.0], [-sr, 0.0, cr]])
    return about_up @ about_x @ about_y


@pytest.mark.parametrize("phi", [(0.02, 0.0, 0.0), (0.0, -0.03, 0.0), (0.0, 0.0, 0.2), (0.02, -0.03, 0.2)])
@pytest.mark.parametrize("attitude", [(0.0, 0.0, 0.0), (0.2, -0.3, 2.2), (-0.1, 0.25, 4.0)])
def test_a_further_misalignment_turns_any_attitude(
    attitude: tuple[float, float, float], phi: tuple[float, float, float]
) -> None:
    """C' = exp(-[phi x]) C, by Rodrigues' formula."""
    found = plain(_turn_attitude)(np.array([attitude]), np.array([phi]))[0]
    angle = float(np.linalg.norm(phi))
    x, y, z = np.array(phi) / angle
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation = np.eye(3) - math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross
    assert turned(*found) == pytest.approx(rotation @ turned(*attitude), abs=1e-12)


def test_a_scenario_without_errors_keeps_the_network_of_its_sensors_where_it_is_written() -> None:
    """What plays a worst log has no sensor errors left, for which `optimal` would be designed anew."""
    imu = {"gyro_arw_dpsh": 0.05, "accel_vrw_ugpshz": 100.0}
    data = {
        "run": {"duration_h": 1.0},
        "imu": imu,
        "reference": {"kind": "log", "noise_mps": 0.5},
        "method": [{"damping": "external", "network": {"id": "optimal"}}],
    }
    scenario = Scenario.parse(data)
    read = Scenario.parse(silent(scenario).canonical())
    poles = [one.method[0].network.transfer(one.omega_s).poles for one in (scenario, read)]
    assert not read.imu.gyro_arw_dpsh and poles[1] == pytest.approx(poles[0], rel=1e-9)
