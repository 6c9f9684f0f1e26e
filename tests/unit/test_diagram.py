"""Block diagrams: every kind of damping, values in force, the switch over time, what a click opens."""

import re
from itertools import combinations
from typing import Any

import numpy as np
import pytest

from navcore.damping import KINDS
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.law.policy.variation import Variation
from navcore.mechanization.recorder import DAMPED_COLUMN
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.plots import style
from schuler_bench.views import load as load_views
from schuler_bench.views.diagram.blocks import diagram
from schuler_bench.views.diagram.membership import memberships as memberships_of
from schuler_bench.views.diagram.parts import WIDTH, Block, Diagram, State, Switch
from schuler_bench.views.diagram.svg import diagram_svg
from schuler_bench.views.diagram.view import beneath, state_at
from tools.diagrams import FOLDER, METHODS, drawn, memberships


def scenario(method: dict[str, Any], **blocks: Any) -> Scenario:
    return Scenario.parse(
        {"imu": {"gyro_arw_dpsh": 0.003}, "reference": {"kind": "log"}, "method": [method], **blocks}
    )


def blocks_of(found: Diagram) -> list[Block]:
    return [part for part in found.parts if isinstance(part, Block)]


def words_of(found: Diagram) -> str:
    return "\n".join(line for block in blocks_of(found) for line in block.lines)


def test_every_kind_of_damping_is_among_the_documented_ones() -> None:
    assert {str(method["damping"]) for method in METHODS.values()} == set(KINDS)


@pytest.mark.parametrize("name", METHODS)
def test_the_documentation_shows_what_the_page_shows(name: str) -> None:
    assert (FOLDER / f"{name}.svg").read_text(encoding="utf-8") == drawn(name)


def test_the_documentation_shows_the_membership_functions_of_the_page() -> None:
    assert (FOLDER / "membership.svg").read_text(encoding="utf-8") == memberships()


@pytest.mark.parametrize("name", METHODS)
def test_blocks_lie_within_the_picture_and_not_over_each_other(name: str) -> None:
    found = diagram(scenario(METHODS[name]), 0)
    for one in blocks_of(found):
        assert 0 <= one.x and one.x + one.width <= WIDTH
        assert 0 <= one.y and one.y + one.height <= found.height
        assert max(len(re.sub(r"_", "", line)) for line in one.lines) * 6.3 <= one.width + 4
    for one, other in combinations(blocks_of(found), 2):
        apart = one.x + one.width <= other.x or other.x + other.width <= one.x
        assert apart or one.y + one.height <= other.y or other.y + other.height <= one.y, (one, other)


def test_a_block_opens_a_tab_that_there_is() -> None:
    titles = {kind.title for kind in load_views()}
    for method in METHODS.values():
        opens = {block.opens for block in blocks_of(diagram(scenario(method), 0))} - {""}
        assert opens and opens <= titles
    svg = diagram_svg(diagram(scenario(METHODS["whole"]), 0), style.method_color(0), State())
    assert svg.count('data-command="tab Method"') == 2
    assert svg.count('role="button" tabindex="0"') == svg.count("data-command=")


def test_the_log_enters_where_it_is_used_and_nowhere_else() -> None:
    entering = {name: "log" in words_of(diagram(scenario(method), 0)) for name, method in METHODS.items()}
    assert entering == {
        "free": False, "internal": False, "external": True, "feedback": True,
        "averaging": False, "kalman": True, "whole": True, "gyrocompass": True,
    }  # fmt: skip


def test_the_values_are_those_in_force() -> None:
    words = words_of(diagram(scenario(METHODS["external"] | {"network": {"id": "unity2", "zeta": 0.31}}), 0))
    assert "ζ 0.31" in words and "variation" in words and "ramp" in words
    gains = load("zha-fast")
    compass = next(i for i, method in enumerate(gains.method) if method.network.id == "compass")
    values = gains.method[compass].network.values(gains.omega_s)
    assert f"{values['k1']:.3g}" in words_of(diagram(gains, compass))
    own = METHODS["gyrocompass"] | {"gyrocompass": {"k3": 4e-12}}
    assert "K_U3 4×10⁻¹²" in words_of(diagram(scenario(own), 0))
    assert "K_U4 " not in words_of(diagram(scenario(own), 0))
    slow = words_of(diagram(scenario(METHODS["whole"] | {"azimuth": {"id": "unity2", "zeta": 0.77}}), 0))
    assert "1 − Y(s)" in slow and "ζ 0.77" in slow and "ζ 0.5" in slow


def test_the_switch_stands_as_the_law_had_it_at_the_time() -> None:
    run = simulate(load("liu-switching"))
    index, method = next(
        (i, one) for i, one in enumerate(run.methods) if 0.05 < one.rows[:, DAMPED_COLUMN].mean() < 0.95
    )
    damped = method.rows[:, DAMPED_COLUMN] > 0.5
    for row in (int(damped.argmax()), int((~damped).argmax())):
        state = state_at(method, float(method.t_s[row]))
        assert state.damped is bool(damped[row])
        svg = diagram_svg(diagram(run.scenario, index, state), style.method_color(index), state)
        assert (">damped<" in svg) is state.damped and (">undamped<" in svg) is not state.damped


def test_a_coefficient_that_a_policy_sets_is_shown_as_it_is_now() -> None:
    run = simulate(load("sun-ship"))
    index = next(i for i, one in enumerate(run.methods) if one.method.name == "table 1")
    states = {state_at(run.methods[index], t).coefficient for t in run.methods[index].t_s}
    assert len(states) > 2
    for coefficient in list(states)[:3]:
        state = State(True, coefficient)
        assert f"ζ {coefficient:.3g} now" in words_of(diagram(run.scenario, index, state))


@pytest.mark.parametrize("frame", ["enu", "body"])
@pytest.mark.parametrize("name", METHODS)
def test_a_strapdown_system_shows_its_mathematical_platform(name: str, frame: str) -> None:
    """Deng, figures 3 and 4, and Sun, figure 9: C_b^n turns the force, and the log of the ship's axes."""
    strapdown = {"run": {"fidelity": "strapdown"}, "reference": {"kind": "log", "frame": frame}}
    level, full = (diagram(scenario(METHODS[name], **blocks), 0) for blocks in ({}, strapdown))
    assert "C_b^n" not in words_of(level)
    words = words_of(full)
    assert "turns C_b^n by" in words and "f^b" in words and "ω_ib − ω_in" in words
    assert words.count("\nC_b^n") == (2 if frame == "body" and "log" in words_of(level) else 1)
    assert ("ω_en(V*)" in words) is (level.parts != full.parts and "Switch" in str(level.parts))
    assert ("ω_en(V_c)" in words) is not ("ω_en(V*)" in words)
    for one, other in combinations(blocks_of(full), 2):
        apart = one.x + one.width <= other.x or other.x + other.width <= one.x
        assert apart or one.y + one.height <= other.y or other.y + other.height <= one.y, (one, other)
    assert max(one.y + one.height for one in blocks_of(full)) <= full.height
    assert 'dy="-4.5" font-size="75%">n<' in diagram_svg(full, style.method_color(0), State())


@pytest.mark.parametrize(
    ("averaging", "told"),
    [
        ({}, ("copy C, begun 42.3 min ahead", "copy D, begun 11.97 h ahead", "½ (B + C)", "½ (B + D)")),
        ({"earth": False}, ("copy C, begun 42.3 min ahead", "½ (B + C)")),
        ({"variant": "cascade", "earth": False}, ("copy C, begun", "copy E, begun 84.5 min ahead", "1/4 Σ")),
        ({"variant": "cascade"}, ("copy F, begun 11.97 h ahead", "copy I, begun 13.38 h ahead", "1/8 Σ")),
    ],
)
def test_each_copy_of_an_averaging_method_is_drawn_with_its_lead(averaging, told: tuple[str, ...]) -> None:
    """Zhao, figure 2: C is half a Schuler period ahead, D half a sidereal day."""
    words = words_of(diagram(scenario({"damping": "averaging", "averaging": averaging}), 0))
    assert [each for each in told if each not in words] == []
    count = {(): 2, ("earth",): 1, ("variant", "earth"): 3, ("variant",): 7}[tuple(averaging)]
    assert words.count("copy ") == count, "one block a copy"


def test_a_method_without_a_switch_draws_none() -> None:
    kinds = {
        name: [p for p in diagram(scenario(m), 0).parts if isinstance(p, Switch)]
        for name, m in METHODS.items()
    }
    assert {name for name, switches in kinds.items() if not switches} == {"free", "averaging", "kalman"}
    assert len(kinds["whole"]) == 2


# ---------------------------------------------------------------- beneath the loop: figures of the papers


def run_of(name: str, *methods: dict[str, Any], **blocks: Any) -> Run:
    data = load(name).canonical()
    data["run"] |= {"duration_h": 0.1, "fidelity": "error_model"}
    return simulate(Scenario.parse({**data, **blocks, "method": list(methods) or data["method"]}))


def test_the_membership_functions_are_those_of_liu_and_share_every_variation() -> None:
    """Figure 8: small falls from a to b, medium peaks at b, large rises from b to c; their sum is 1."""
    policy = Variation(a=0.1, b=0.2, c=0.5)
    s = np.array([0.0, 0.1, 0.15, 0.2, 0.35, 0.5, 9.0])
    found = memberships_of(policy, s)
    np.testing.assert_allclose(found.sum(axis=0), 1.0)
    np.testing.assert_allclose(found[0], [1, 1, 0.5, 0, 0, 0, 0])
    np.testing.assert_allclose(found[2], [0, 0, 0, 0, 0.5, 1, 1])


def test_the_membership_functions_stand_beneath_the_loop_of_their_policy() -> None:
    variation = {"damping": "external", "network": {"id": "unity2"}, "policy": {"id": "variation", "b": 0.4}}
    run = run_of("liu-switching", variation, METHODS["feedback"], motion={"kind": "static"})
    assert "b = 0.4" in beneath(run, 0) and "do not damp" in beneath(run, 0)
    assert beneath(run, 1) == ""


@pytest.mark.parametrize(
    ("method", "told"),
    [
        (
            {"policy": {"id": "variation", "count": 7, "n_s": 30.0}, "switching": {"id": "ramp"}},
            ("n = 30 s, t₀ = 80 s", "s ≤ 0.25: damp", "m = 7?", "clear the states", "ζ = ξ exp(m - 49)"),
        ),
        (
            {"policy": {"id": "adaptive", "law": "as_printed"}, "switching": {"id": "step", "size": 0.2}},
            ("low-pass 100 s", "(9) as printed", "by at most 0.2", "every 120 s"),
        ),
        ({"policy": {"id": "variation"}, "switching": {"id": "hard"}}, ("s ≥ 0.45: do not damp",)),
        (
            {"policy": {"id": "states", "settled_s": 900.0}, "switching": {"id": "hard"}},
            ("≤ 0.01 m/s²?", "≤ 1 m/s for 60 s?", "for 900 s?", "internal damping", "undamped"),
        ),
    ],
    ids=["Liu 9 and 10", "Sun 8", "Liu 9", "five states"],
)
def test_the_flow_chart_of_a_decision_has_the_values_of_the_method(
    method: dict, told: tuple[str, ...]
) -> None:
    external = {"damping": "external", "network": {"id": "unity2"}, **method}
    run = run_of("liu-switching", external, METHODS["feedback"], motion={"kind": "static"})
    svg = beneath(run, 0)
    assert [words for words in told if words not in svg] == []
    assert ("clear the states" in svg) is (method["switching"]["id"] == "ramp")
    assert beneath(run, 1) == ""


def test_no_box_of_a_flow_chart_reaches_beyond_its_picture() -> None:
    external = {"damping": "external", "network": {"id": "unity2"}, "policy": {"id": "variation"}}
    svg = beneath(run_of("liu-switching", external, motion={"kind": "static"}), 0)
    ends = [float(x) + float(w) for x, w in re.findall(r'<rect x="([\d.]+)"[^>]* width="([\d.]+)"', svg)]
    assert ends and max(ends) <= 780.0


def test_the_forecast_stands_beneath_the_loop_of_averaging() -> None:
    """A mean is drawn as a level line over half a sidereal day, a fit of order 1 as a sloping one."""
    averaging = {"damping": "averaging"}
    run = run_of("zhao-turntable", averaging, {"damping": "free"}, motion={"kind": "static"})
    svg = beneath(run, 0)
    assert "18 s of 600 s left out" in svg and beneath(run, 1) == ""
    lines = [points.split() for points in re.findall(r'polyline points="([^"]+)"', svg)]
    assert len(lines) == 6 and {len(points) for points in lines} == {71}
    assert all(len({point.split(",")[1] for point in points}) == 1 for points in lines)
    assert "forecast less what came" in svg
    assert "more than 5 σ off its median, and 2 s around it" in svg
    assert "run ahead on this forecast by 42.2 min, 11.97 h" in svg
    sloping = beneath(run_of("zhao-turntable", averaging | {"averaging": {"order": 1}}), 0)
    first = re.findall(r'polyline points="([^"]+)"', sloping)[0].split()
    assert len({point.split(",")[1] for point in first}) > 30


def test_a_record_without_motion_is_used_as_a_whole() -> None:
    run = run_of("zhao-sensors", {"damping": "averaging"})
    assert "all 600 s used" in beneath(run, 0)


def test_a_network_with_two_outputs_shows_both() -> None:
    """`optimal` with velocity feedback has G(s) in the place of a gain; it stopped diagram and report."""
    method = {"damping": "external", "network": {"id": "optimal", "realisation": "feedback"}}
    figures = {"gyro_bias_std_dph": 0.01, "accel_bias_std_ug": 20.0, "gyro_arw_dpsh": 0.003}
    found = diagram(scenario(method, reference={"kind": "log", "noise_mps": 0.1}, imu=figures), 0)
    lines = [block.lines for block in blocks_of(found)]
    assert ("G(s)",) in lines and any(line[:2] == ("1 − H(s)", "optimal") for line in lines)
