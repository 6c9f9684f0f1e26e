"""theory.md section 4: what the switching methods make of passing and of lasting changes of the log."""

from typing import Any

import numpy as np
import pytest

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE
from navcore.law.law import prepare_law
from navcore.law.policy.variation import Variation
from navcore.law.switching import SWITCHINGS
from navcore.mechanization.error_model import ErrorModelRun
from navcore.mechanization.recorder import DV_N, make_recorder
from navcore.mechanization.trajectory import coefficients
from navcore.motion.truth import COLUMNS, Truth
from navcore.networks.complementary import ComplementaryNetwork
from navcore.scenario.model import Scenario
from navcore.sensors.base import ReferenceErrors, SensorErrors

DAY = 86_400
BLOCKS: dict[str, dict[str, Any]] = {
    "hard": {"id": "hard"},
    "ramp": {"id": "ramp"},
    "ramp as printed": {"id": "ramp", "form": "as_printed"},
    "bumpless": {"id": "bumpless"},
}


def daily_rms(switching: dict[str, Any], days: int = 5) -> np.ndarray:
    """RMS of dV_N on each day: dV_r = 0.5 m/s, +1 m/s for 300 s every 30 min; dV_N = 0.5 m/s at the start.

    One channel; more episodes than a scenario's list of events may hold.
    """
    steps, omega_s = days * DAY, SPHERE.schuler_frequency(0.0)
    t = np.arange(steps + 1.0)
    dv_r = np.full((steps + 1, 2), 0.5)
    dv_r[(t >= 1800.0) & (t % 1800.0 < 300.0), 1] += 1.0
    network = ComplementaryNetwork(zeta=0.5)
    block = SWITCHINGS[switching["id"]].model_validate(switching)
    none = SensorErrors(np.zeros((1, 3)), np.zeros((1, 3)))
    run = ErrorModelRun(
        1.0,
        steps,
        coefficients(Truth(0.5, np.zeros((1, COLUMNS))), SPHERE, False),
        none,
        ReferenceErrors(t, dv_r, np.ones(steps + 1, bool), False, 5.0),
        prepare_law("external", network, network.transfer(omega_s), Variation(), block, 1.0),
        np.array([0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0]),
        make_recorder(steps, 1.0, 60.0),
    )
    while not run.advance(100_000):
        pass
    v = run.recorder.rows[:-1, DV_N].reshape(days, -1)
    return np.sqrt(np.mean(v * v, axis=1))


@pytest.mark.parametrize("name", ["hard", "bumpless"])
def test_five_days_of_episodes_do_not_shake_up_the_loop(name):
    rms = daily_rms(BLOCKS[name])
    assert rms[0] < 0.3
    assert rms[-1] < 0.25 * rms[0]
    assert np.all(np.diff(rms) < 1e-3)


def test_bumpless_is_not_worse_than_hard_on_passing_episodes():
    assert np.all(daily_rms(BLOCKS["bumpless"]) < daily_rms(BLOCKS["hard"]))


def test_the_ramp_as_printed_throws_the_damping_away_each_time():
    """Liu 19 with rising zeta is a restart at rest (test_control_switching): 0.5 -> 3 m/s in five days."""
    rms = daily_rms(BLOCKS["ramp as printed"])
    assert np.all(np.diff(rms) > 0.0)
    assert 2.0 < rms[-1] < 5.0


def eight_lasting_changes(seed: int, blocks: dict[str, dict[str, Any]] = BLOCKS) -> Run:
    """36 h, one channel; dV_r = 0.5 m/s, eight times +-0.5..1.5 m/s for 0.5..2 h; log noise 0.1 m/s."""
    rng = np.random.default_rng(seed)
    events = []
    for i in range(8):
        size, begin = rng.uniform(0.5, 1.5) * rng.choice([-1, 1]), 1.0 + 4.3 * i + rng.uniform(0.0, 1.5)
        for at, sign in ((begin, 1.0), (begin + rng.uniform(0.5, 2.0), -1.0)):
            events.append({"t_h": at, "duration_s": 10.0, "accel_mps2": [0.0, sign * size / 10.0]})
    methods = [
        {
            "name": name,
            "damping": "external",
            "network": {"id": "complementary", "zeta": 0.5},
            "policy": {"id": "variation"},
            "switching": block,
        }
        for name, block in blocks.items()
    ]
    return simulate(
        Scenario.parse(
            {
                "run": {"fidelity": "channel", "duration_h": 36.0, "output_step_s": 600.0, "seed": seed},
                "reference": {"kind": "log", "bias_mps": [0.0, 0.5], "noise_mps": 0.1, "event": events},
                "method": methods,
            }
        )
    )


@pytest.mark.parametrize("seed", range(4))
def test_bumpless_takes_lasting_changes_five_times_better(seed):
    run = eight_lasting_changes(seed)
    velocity = {m.method.name: m.errors["dvn_mps"]["rms"] for m in run.methods}
    tilt = {m.method.name: np.degrees(m.errors["phi_e_rad"]["rms"]) * 3600.0 for m in run.methods}
    for other in ("hard", "ramp"):
        assert velocity[other] > 5.0 * velocity["bumpless"], (other, velocity)
        assert velocity[other] > 0.1
        assert tilt[other] > 2.0 > 0.5 > tilt["bumpless"]
    assert velocity["bumpless"] < 0.024
    # as printed it never sees the standing difference, so it lies between
    assert velocity["bumpless"] < velocity["ramp as printed"] < velocity["ramp"]
