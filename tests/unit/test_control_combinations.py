"""What does not go together is refused in one line; the adaptive law never leaves the stable region."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from navcore.analysis import analyse
from navcore.foundation.compiled import kernel
from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.law.combination import combination_faults, combination_warnings
from navcore.law.law import law_step, prepare_law
from navcore.law.policy import POLICIES
from navcore.law.policy.adaptive import LOWEST, Adaptive, law_coefficient
from navcore.law.policy.constant import Constant
from navcore.law.records import Sensed
from navcore.law.switching.bumpless import Bumpless
from navcore.law.switching.hard import Hard
from navcore.networks import parse_network
from navcore.networks.pole2 import Pole2Network
from navcore.scenario.model import Scenario
from tests.law_run import OMEGA_S, LawRun, sampled_radius

SITES = [WGS84.schuler_frequency(32.06 * DEG), WGS84.schuler_frequency(45.7796 * DEG)]
BAND = "must be pole2 or unity2, in network or policy.network"


def scenario(method: dict[str, Any], **run: Any) -> Scenario:
    blocks = {"run": {"duration_h": 1.0, **run}, "reference": {"kind": "log"}}
    return Scenario.parse({**blocks, "method": [{"damping": "external", **method}]}, "x.toml")


@pytest.mark.parametrize(
    ("method", "line"),
    [
        (
            {"network": {"id": "classic3"}, "policy": {"id": "adaptive"}},
            f"policy.id = 'adaptive': cannot re-tune network \"classic3\": {BAND}",
        ),
        (
            {"network": {"id": "pole2"}, "policy": {"id": "adaptive", "network": "unity2"}},
            "network.id = 'pole2': differs from the policy's own network \"unity2\": give only one of them",
        ),
        (
            {"policy": {"id": "adaptive", "network": "classic2"}},
            "policy.network = 'classic2': must be one of unity2, pole2",
        ),
        (
            {"policy": {"id": "adaptive", "table": [[0.0, 0.5]]}},
            "policy.table = [[0.0, 0.5]]: must have 2 to 500 rows",
        ),
        (
            {"policy": {"id": "adaptive", "table": [[1.0, 0.5], [1.0, 0.4]]}},
            "policy.table = [[1.0, 0.5], [1.0, 0.4]]: must have rows 0.001 kn apart, not 1 and 1 kn",
        ),
        (
            {"network": {"id": "classic2"}, "switching": {"id": "ramp"}},
            "switching.id = 'ramp': moves the damping ratio, which network \"classic2\" has not or "
            "cannot change while it runs: needs network complementary, pole2 or unity2",
        ),
        (
            {"network": {"id": "compass"}, "switching": {"id": "step"}},
            "switching.id = 'step': moves the damping ratio, which network \"compass\" has not or "
            "cannot change while it runs: needs network complementary, pole2 or unity2",
        ),
        (
            {"network": {"id": "pole2", "variant": "as_printed"}, "switching": {"id": "ramp"}},
            "switching.id = 'ramp': passes damping ratios below 0.104, at which the loop of \"pole2\" "
            "as printed is unstable",
        ),
        (
            {"network": {"id": "compass"}, "switching": {"id": "bumpless"}},
            "switching.id = 'bumpless': needs a network that comes to rest with a standing difference: "
            'network.realisation must be "network" with compass',
        ),
        (
            {"network": {"id": "unity2"}, "policy": {"id": "schedule"}},
            "policy.id = 'schedule': changes the gains K₁, K₂, K₃: needs network.id = \"compass\", "
            'not "unity2"',
        ),
        (
            {"network": {"id": "compass"}, "policy": {"id": "schedule"}, "switching": {"id": "bumpless"}},
            "switching.id = 'bumpless': must be hard or keep with policy \"schedule\", which sets the "
            "gains",
        ),
        (
            {"network": {"id": "compass"}, "policy": {"id": "schedule", "from": [50.0, 1.0, 1.0]}},
            "policy.from.0 = 50.0: K₁ must be >= -10 and <= 10 (1/s)",
        ),
        (
            {"network": {"id": "unity2"}, "policy": {"id": "variation", "a": 0.4}},
            "policy.b = 0.35: must be > a = 0.4 (m/s)",
        ),
    ],
)  # fmt: skip
def test_what_makes_no_sense_together_is_refused_in_one_line(method, line):
    with pytest.raises(InputError) as caught:
        scenario(method)
    assert str(caught.value) == f"x.toml: method.0.{line}"


def test_a_history_too_long_for_the_step_is_refused():
    with pytest.raises(InputError, match="would look back 180001 steps of 0.02 s: at most 100000"):
        scenario(
            {"policy": {"id": "yaw_rate", "window_s": 3600.0}, "network": {"id": "classic2"}}, step_s=0.02
        )


def test_a_printed_form_that_is_unstable_everywhere_is_refused():
    with pytest.raises(
        InputError, match=r"policy.network.variant = 'as_printed': is unstable up to ζ = 1.73"
    ):
        scenario({"policy": {"id": "adaptive", "network": {
            "id": "pole2", "n1": 0.1, "n2": 0.1, "variant": "as_printed"}}})  # fmt: skip


def test_free_asks_nothing_of_the_rest():
    Scenario.parse({"method": [{"switching": {"id": "ramp"}, "policy": {"id": "schedule"}}]})


def test_adaptive_without_a_network_runs_unity2_and_schedule_ends_at_its_gains():
    from navcore.engine.simulation import simulate

    run = simulate(scenario({"policy": {"id": "adaptive"}}))
    assert run.methods[0].network.id == "unity2"
    run = simulate(scenario({"network": {"id": "compass"}, "policy": {"id": "schedule"}}))
    assert run.methods[0].network.num[0] == pytest.approx(7.68)


def test_flaws_of_a_choice_are_told_with_the_result():
    from navcore.engine.simulation import simulate

    policy = {"id": "adaptive", "law": "quadratic", "network": {"id": "pole2", "variant": "as_printed"}}
    warnings = simulate(scenario({"policy": policy})).methods[0].warnings
    assert any("between 0.95 and 2.77 kn, where it is negative" in text for text in warnings)
    assert any("below ζ = 0.104 the printed form is unstable" in text for text in warnings)
    exact, bumpless = parse_network({"id": "pole2"}), Bumpless()
    told = combination_warnings(exact, Constant(), bumpless)
    assert told == ("bumpless: H(0) differs from 1, so a change of the log acts for good",)


@given(st.floats(0.1, 100.0), st.floats(0.1, 100.0))
@settings(max_examples=200, deadline=None)
def test_least_coefficient_is_where_the_printed_form_becomes_stable(n1, n2):
    try:
        network = Pole2Network(n1=n1, n2=n2, variant="as_printed")
    except ValueError:
        assume(False)
        return
    least = network.least_coefficient()
    assert network.model_copy(update={"variant": "exact"}).least_coefficient() == 0.0
    for factor in (1.001, 1.1, 3.0, 30.0):
        assert analyse(network.with_damping(max(least, 1e-3) * factor).transfer(OMEGA_S)).stable


def test_suns_own_form_is_unstable_for_four_of_his_ten_entries():
    network = Pole2Network(variant="as_printed")
    assert network.least_coefficient() == pytest.approx(0.104, abs=5e-4)
    assert not analyse(network.with_damping(0.999 * network.least_coefficient()).transfer(OMEGA_S)).stable
    table = Adaptive().table
    assert sum(row.xi < network.least_coefficient() for row in table) == 4


rates = st.floats(1.01, 10.0)
unity2 = st.fixed_dictionaries({"id": st.just("unity2"), "r": rates}) | st.fixed_dictionaries(
    {"id": st.just("unity2"), "r": rates, "zeta2": st.floats(0.01, 5.0)}
)
unity2 |= st.fixed_dictionaries({"id": st.just("unity2"), "r": rates, "alpha": st.floats(1e-5, 10.0)})
pole2 = st.fixed_dictionaries(
    {
        "id": st.just("pole2"),
        "n1": st.floats(0.1, 100.0),
        "n2": st.floats(0.1, 100.0),
        "variant": st.sampled_from(["exact", "as_printed"]),
    }
)
tables = st.lists(
    st.tuples(st.floats(0.0, 1000.0), st.floats(0.0, 5.0)),
    min_size=2,
    max_size=12,
    unique_by=lambda row: row[0],
)
laws = st.just({}) | st.just({"law": "quadratic"}) | st.fixed_dictionaries({"table": tables})


@given(
    unity2 | pole2, laws, st.sampled_from(SITES), st.sampled_from([0.01, 0.1, 1.0, 5.0, 10.0]),
    st.lists(st.floats(0.0, 1e3), min_size=1, max_size=6),
)  # fmt: skip
@settings(max_examples=150, deadline=None)
def test_the_adaptive_law_never_leaves_the_stable_region(network, law, omega_s, step_s, knots):
    """Whole parameter box: what the law can reach is stable, continuous and as it is sampled, or refused."""
    try:
        policy = POLICIES["adaptive"].model_validate({"id": "adaptive", "network": network, **law})
        block = parse_network(network)
    except ValueError:
        assume(False)
        raise
    none, hard = parse_network({"id": "none"}), Hard()
    assume(not list(combination_faults("external", none, policy, hard, step_s)))
    law_arrays = prepare_law("external", none, none.transfer(omega_s), policy, hard, step_s)
    p = law_arrays.p
    own, low = p["policies"]["adaptive"], float(p["tuning"]["low"])
    for difference in [*knots, 0.0, 0.3, 1.86, 3.0]:
        xi = law_coefficient(own, low, difference * KNOT)
        assert max(LOWEST, block.least_coefficient()) <= xi <= max(0.99, 1.05 * block.least_coefficient())
        running = block.with_damping(xi).transfer(omega_s)
        loop = analyse(running)
        assert loop.stable and loop.damping_ratio > 0.0
        assert sampled_radius(block.with_damping(xi), omega_s, step_s) < 1.0


@kernel
def closed_channel(law, log, omega_s):
    """Largest velocity error of a channel that the law damps at 1 Hz, and the range of its coefficient."""
    cos, sin = math.cos(omega_s), math.sin(omega_s)
    v, w, largest, low, high = 0.0, 0.0, 0.0, math.inf, -math.inf
    law.s.valid = True
    for reading in log:
        law.s.difference[0], law.s.difference[1] = reading - v, 0.0
        c = law_step(law, Sensed(0.0, 0.0, 0.0))[0]
        v, w = cos * (v + c) - c + sin * w, cos * w - sin * (v + c)
        largest, low, high = max(largest, abs(v)), min(low, law.s.xi), max(high, law.s.xi)
    return largest, low, high


@pytest.mark.parametrize(
    "network", [{"id": "unity2"}, {"id": "pole2"}, {"id": "pole2", "variant": "as_printed"}]
)
@pytest.mark.parametrize("switching", ["hard", "step", "bumpless"])
def test_a_wild_log_does_not_shake_an_adaptive_loop_to_pieces(network, switching):
    """One channel closed by hand under a difference that drives xi through its range for eleven hours."""
    run = LawRun(network, {"id": "adaptive"}, {"id": switching})
    rng = np.random.default_rng(8)
    log = [rng.choice([0.0, 0.1, 0.4, 1.5]) + rng.normal(0.0, 0.1, 700) for _ in range(57)]
    largest, low, high = closed_channel(run.law, np.concatenate(log), OMEGA_S)
    assert largest < 3.0
    assert switching == "bumpless" or 0.04 <= low <= high <= 0.99
    assert np.all(np.isfinite(run.s["x"][0]))
