"""Sun's double loop: superposition against direct runs, determinism, cancel, and the table in a scenario."""

from typing import Any

import numpy as np
import pytest

from navcore.design.sun import TuningSettings, sun_scenario, tune_table, with_table
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.units import HOUR, KNOT
from navcore.networks import parse_network
from navcore.scenario.model import Scenario

COARSE = TuningSettings(differences_kn=(0.0, 0.5, 3.0), smallest=0.1, step=0.3)


def scenario(**blocks: Any) -> Scenario:
    data = {
        "run": {"duration_h": 6.0, "step_s": 10.0, "output_step_s": 600.0},
        "imu": {"gyro_bias_dph": [0.006, 0.006, 0.001]},
        "reference": {"kind": "log", "rate_hz": 0.1},
    }
    return Scenario.parse({**data, **blocks})


def direct_cost(base: Scenario, bias: tuple[float, float], zeta: float) -> float:
    """J of one run with the log off by a constant, m^2/s."""
    data = base.canonical()
    data["reference"]["bias_mps"] = list(bias)
    data["method"] = [{"damping": "external", "network": {"id": "unity2", "zeta": zeta}}]
    errors = simulate(Scenario.parse(data)).methods[0].errors
    return base.run.duration_h * HOUR * (errors["dve_mps"]["rms"] ** 2 + errors["dvn_mps"]["rms"] ** 2)


MOVING = {
    "motion": {"kind": "legs", "leg": [{"speed_mps": 8.0, "heading_deg": 40.0}]},
    "reference": {"kind": "log", "rate_hz": 0.1, "frame": "body"},
}


@pytest.mark.parametrize("blocks", [{}, MOVING], ids=["at rest", "a moving ship with a body log"])
def test_the_double_loop_equals_the_mean_of_direct_runs(blocks: dict[str, Any]):
    base = scenario(**blocks)
    found = tune_table(base, COARSE)
    np.testing.assert_allclose(found.coefficients, [0.1, 0.4, 0.7, 1.0])
    for row, knots in enumerate(COARSE.differences_kn):
        size = knots * KNOT
        for column, zeta in enumerate(found.coefficients):
            biases = [(size, 0.0), (-size, 0.0), (0.0, size), (0.0, -size)]
            mean = np.mean([direct_cost(base, bias, float(zeta)) for bias in biases])
            assert found.cost[row, column] == pytest.approx(mean, rel=1e-9)
    np.testing.assert_array_equal(found.best, found.coefficients[np.argmin(found.cost, axis=1)])


def test_same_input_same_table():
    settings = TuningSettings(
        differences_kn=(0.0, 1.0), step=0.2, error="drift", realisations=2, network={"id": "complementary"}
    )
    first, second = tune_table(scenario(), settings), tune_table(scenario(), settings)
    np.testing.assert_array_equal(first.cost, second.cost)
    assert first.pairs() == second.pairs()


def test_drift_has_the_asked_rms_over_both_axes():
    # far slower than the run it is a constant: the mean over many drifts then is that over all directions
    slow = TuningSettings(
        differences_kn=(0.0, 3.0), smallest=0.5, largest=0.5, error="drift", drift_tau_s=1e6, realisations=64
    )
    constant = slow.model_copy(update={"error": "constant"})
    drift_cost, constant_cost = (np.diff(tune_table(scenario(), s).cost[:, 0])[0] for s in (slow, constant))
    # 64 drifts of 2 axes: the mean square of 128 normal numbers is within 12.5 % (1 sigma) of 1
    assert drift_cost == pytest.approx(constant_cost, rel=0.4)


def test_unstable_loops_are_never_the_best():
    network = parse_network('id = "pole2", variant = "as_printed"')
    settings = TuningSettings(
        differences_kn=(0.0, 3.0), smallest=0.02, largest=0.2, step=0.02, network=network, error="drift"
    )
    found = tune_table(scenario(), settings)
    # theory.md 3.3: unstable for xi <= 0.104
    np.testing.assert_array_equal(np.isinf(found.cost[1]), found.coefficients <= 0.104)
    assert np.all(found.best > 0.104)
    assert any("5 of 10" in warning for warning in found.warnings)


def test_progress_rises_to_one_and_cancel_stops():
    seen: list[float] = []
    found = tune_table(scenario(), COARSE, progress=seen.append)
    assert found.status == "ok" and seen == sorted(seen) and seen[-1] == pytest.approx(1.0)
    stopped = tune_table(scenario(), COARSE, cancelled=lambda: True)
    assert stopped.status == "stopped" and stopped.pairs() == [] and np.all(np.isnan(stopped.best))
    with pytest.raises(InputError, match="stopped"):
        with_table(scenario(), stopped)


def test_the_table_goes_into_the_scenario():
    base = scenario(method=[{"name": "free"}])
    found = tune_table(base, COARSE)
    made = with_table(base, found)
    assert [m.name for m in made.method] == ["free", "adaptive (tuned)"]
    policy = made.method[1].policy
    assert policy.id == "adaptive"
    assert policy.model_dump(mode="json")["table"] == found.pairs()
    assert made.method[1].network.id == "unity2"
    run = simulate(made)
    assert run.methods[1].status == "ok"
    replaced = with_table(made, found, method=1)
    assert len(replaced.method) == 2
    assert with_table(made, found).method[2].name == "adaptive (tuned 2)"
    with pytest.raises(InputError, match="must be 0 to 1"):
        with_table(made, found, method=7)


def test_a_scenario_without_reference_is_tuned_with_a_perfect_log():
    with_log, without = scenario(), scenario(reference={"kind": "none"})
    # 1 Hz instead of 0.1 Hz, averaged to the step: both are perfect
    np.testing.assert_allclose(
        tune_table(without, COARSE).cost[0], tune_table(with_log, COARSE).cost[0], rtol=1e-12
    )
    assert with_table(without, tune_table(without, COARSE)).reference.kind == "log"


def test_a_strapdown_scenario_is_tuned_on_the_error_model():
    plain = scenario(site={"lat_deg": 40.0})
    run = {**plain.canonical()["run"], "fidelity": "strapdown"}
    strapdown = scenario(site={"lat_deg": 40.0}, run=run, alignment={"kind": "compass"})
    np.testing.assert_array_equal(tune_table(strapdown, COARSE).cost, tune_table(plain, COARSE).cost)


@pytest.mark.parametrize(
    ("fields", "match"),
    [
        ({"differences_kn": (0.5, 0.1)}, "ascend"),
        ({"smallest": 0.5, "largest": 0.1}, "smallest"),
        ({"network": {"id": "classic2"}}, "damping ratio"),
        ({"network": {"id": "compass", "k1": 0.03, "k2": 200.0, "k3": 0.9}}, "damping ratio"),
    ],
)
def test_settings_that_cannot_be_searched(fields, match):
    with pytest.raises(ValueError, match=match):
        TuningSettings(**fields)


def test_default_grid_is_suns():
    settings = TuningSettings()
    np.testing.assert_allclose(settings.coefficients(), np.arange(1, 101) / 100.0, rtol=1e-12)
    assert sun_scenario().run.duration_h == 24.0
    assert sun_scenario().imu.gyro_bias_dph == (0.006, 0.006, 0.001)
