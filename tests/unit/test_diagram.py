"""Block diagrams: every kind of damping, values in force, the switch over time, what a click opens."""

import re
from itertools import combinations
from typing import Any

import pytest

from navcore.damping import KINDS
from navcore.engine.simulation import simulate
from navcore.mechanization.recorder import DAMPED_COLUMN
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.plots import style
from schuler_bench.views import load as load_views
from schuler_bench.views.diagram.blocks import WIDTH, Block, Diagram, State, Switch, diagram
from schuler_bench.views.diagram.svg import diagram_svg
from schuler_bench.views.diagram.view import state_at
from tools.diagrams import FOLDER, METHODS, drawn


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
    index = next(i for i, one in enumerate(run.methods) if one.method.policy.tunes)
    states = {state_at(run.methods[index], t).coefficient for t in run.methods[index].t_s}
    assert len(states) > 2
    for coefficient in list(states)[:3]:
        state = State(True, coefficient)
        assert f"ζ {coefficient:.3g} now" in words_of(diagram(run.scenario, index, state))


def test_a_method_without_a_switch_draws_none() -> None:
    kinds = {
        name: [p for p in diagram(scenario(m), 0).parts if isinstance(p, Switch)]
        for name, m in METHODS.items()
    }
    assert {name for name, switches in kinds.items() if not switches} == {"free", "averaging", "kalman"}
    assert len(kinds["whole"]) == 2
