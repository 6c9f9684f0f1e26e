"""Blocks ``[[requirement]]``: read, judged on every step of a run, and refused."""

import math
from dataclasses import replace

import numpy as np
import pytest

from navcore.engine.measures import judged, metrics
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCMIN, ARCSEC
from navcore.scenario.file import scenario_hash, to_toml
from navcore.scenario.model import Scenario

LIMITS = [
    {"quantity": quantity, "at_most": 1.0, "from_h": from_h}
    for from_h in (0.0, 0.5, 0.7123)
    for quantity in (
        "tilt_max_arcsec",
        "tilt_rms_arcsec",
        "velocity_max_mps",
        "velocity_rms_mps",
        "heading_max_arcmin",
        "heading_rms_arcmin",
    )
]
OF_POSITION = [
    {"quantity": "position_max_m", "at_most": 1e6, "from_h": 0.5},
    {"quantity": "position_final_m", "at_most": 1e6},
]
BLOCKS = {
    "run": {"duration_h": 1.0, "output_step_s": 1.0},
    "imu": {"gyro_bias_dph": [0.01, -0.02, 0.01], "gyro_arw_dpsh": 0.003, "accel_bias_ug": [50.0, 30.0, 0.0]},
    "initial_error": {"attitude_arcmin": [1.0, -2.0, 5.0]},
    "reference": {"kind": "log", "noise_mps": 0.1},
    "method": [{"damping": "external", "network": {"id": "classic2"}}],
}


def parsed(*requirements: dict[str, object], **more: object) -> Scenario:
    """The scenario with requirements."""
    return Scenario.parse({**BLOCKS, "requirement": list(requirements), **more})


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_values_are_those_of_every_recorded_step(fidelity: str) -> None:
    """All steps are output rows here; from 0.7123 h on the first step is 2565 s."""
    scenario = parsed(*LIMITS, *OF_POSITION, run={**BLOCKS["run"], "fidelity": fidelity, "rate_hz": 20.0})
    run = simulate(scenario)
    (method,) = run.methods
    values = iter(judged(one, method)[0] for one in scenario.requirement)
    for begin in (0, 1800, 2565):
        phi_e, phi_n, phi_u, dv_e, dv_n = method.rows[begin:, :5].T
        tilt, velocity = np.hypot(phi_e, phi_n) / ARCSEC, np.hypot(dv_e, dv_n)
        heading = np.abs(phi_u) / ARCMIN
        for length, share in ((tilt, 0.5), (velocity, 0.5), (heading, 1.0)):
            assert next(values) == pytest.approx(length.max(), rel=1e-12)
            assert next(values) == pytest.approx(math.sqrt(share * np.mean(length**2)), rel=1e-9)
    assert next(values) == pytest.approx(method.rows[1800:, 7].max(), rel=1e-12)
    assert next(values) == pytest.approx(method.rows[-1, 7], rel=1e-12)


def test_metrics_say_what_is_met() -> None:
    """Equal to the limit is met; null is not; what diverged meets nothing; no requirement, no key."""
    free = {"name": "free", "damping": "free"}
    settling = {"quantity": "settling_s", "at_most": 1e6}
    late = {"quantity": "tilt_max_arcsec", "at_most": 1e6, "from_h": 2.0}
    scenario = parsed(settling, late, OF_POSITION[1], method=[*BLOCKS["method"], free])
    run = simulate(scenario)
    damped, undamped = (method["requirements"] for method in metrics(run)["methods"])
    assert [one["met"] for one in damped] == [True, False, True]
    assert [one["met"] for one in undamped] == [False, False, True]
    assert damped[1]["value"] is None and undamped[0]["value"] is None
    at = judged(scenario.requirement[2], run.methods[0])[0]
    equal = scenario.requirement[2].model_copy(update={"at_most": at})
    assert judged(equal, run.methods[0])[1]
    assert not judged(equal, replace(run.methods[0], status="diverged"))[1]
    assert "requirements" not in metrics(simulate(Scenario.parse(BLOCKS)))["methods"][0]


def test_blocks_are_part_of_the_file() -> None:
    """Written and read again; a scenario without any has the hash that it had."""
    scenario = parsed(*LIMITS[:2])
    assert "[[requirement]]" in to_toml(scenario)
    assert "requirement" not in Scenario.parse(BLOCKS).canonical()
    assert scenario_hash(scenario) != scenario_hash(Scenario.parse(BLOCKS))


@pytest.mark.parametrize(
    ("block", "words"),
    [
        ({"quantity": "tilt_max", "at_most": 1.0}, "requirement.0.quantity = 'tilt_max': must be one of"),
        ({"quantity": "tilt_max_arcsec", "at_most": -1.0}, "requirement.0.at_most = -1.0: must be >= 0"),
        (
            {"quantity": "tilt_max_arcsec", "at_most": 1.0, "from_h": -1.0},
            "requirement.0.from_h = -1.0: must be >= 0",
        ),
        ({"quantity": "tilt_max_arcsec"}, "requirement.0.at_most"),
        (
            {"quantity": "tilt_max_arcsec", "at_most": "20 kn"},
            "requirement.0.at_most = '20 kn': must be in one of rad, mrad, °, arcmin, arcsec, not in",
        ),
        (
            {"quantity": "settling_s", "at_most": "90 deg"},
            "requirement.0.at_most = '90 deg': must be in one of s, min, h, d, not in",
        ),
        (
            {"quantity": "tilt_max_arcsec", "at_least": 30.0},
            "requirement.0.at_least = 30.0: is not for tilt_max_arcsec: give at_most",
        ),
        (
            {"quantity": "damping_ratio", "at_most": 0.5, "at_least": 0.3},
            "requirement.0.at_most = 0.5: is not for damping_ratio: give at_least",
        ),
    ],
)
def test_bad_blocks_are_refused(block: dict[str, object], words: str) -> None:
    """One line that names field, value and what is allowed."""
    with pytest.raises(InputError) as error:
        parsed(block)
    assert words in str(error.value)
