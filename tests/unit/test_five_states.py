"""Sun's five states of damping: a ship passes through them, and each is the loop that bears its name."""

from typing import Any

import numpy as np
import pytest

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from tests.unit.test_whole_damping import UNITY2, columns, made

CALM_STATES = {"id": "states", "limit_mps2": 0.02, "return_s": 60.0, "settled_s": 3600.0}
"""Of a ship whose level errors leave |a| well below the limit."""


def five_states(fidelity: str, *others: dict[str, Any]) -> Run:
    """Run a ship that manoeuvres at 3 h; its log is wrong by 2 m/s from 1 to 2 h and from 5 h on."""
    legs = [
        {"duration_s": 10800.0, "speed_mps": 3.0, "heading_deg": 45.0},
        {"duration_s": 18000.0, "speed_mps": 9.0, "heading_deg": 45.0, "accel_mps2": 0.05},
    ]
    wrong = ((1.0, 0.1), (2.0, -0.1), (5.0, 0.1))
    events = [{"t_h": at, "duration_s": 20.0, "accel_mps2": [rate, 0.0]} for at, rate in wrong]
    return simulate(
        made(
            {"azimuth": UNITY2, "policy": CALM_STATES},
            *others,
            hours=8.0,
            run={"fidelity": fidelity, "rate_hz": 10.0},
            motion={"kind": "legs", "leg": legs},
            reference={"event": events},
            initial_error={"attitude_arcmin": [0.1, 0.1, 1.0]},
        )
    )


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_a_ship_passes_through_the_five_states(fidelity: str) -> None:
    """Sun 2017, section 1: first horizontal, then whole; internal on a bad log, undamped in a manoeuvre."""
    run = five_states(fidelity)
    state, damped = run.methods[0].law_series[:, 3], run.methods[0].law_series[:, 1]
    t_h = run.methods[0].t_s / 3600.0
    wanted = [(0.5, 3), (1.5, 2), (2.9, 4), (3.015, 0), (3.5, 3), (4.5, 4), (5.5, 2)]
    assert [(at, int(state[np.argmin(np.abs(t_h - at))])) for at, _ in wanted] == wanted
    assert np.array_equal(damped > 0.5, state > 0.0)
    assert set(np.unique(state)) == {0.0, 2.0, 3.0, 4.0}  # 1: internal before it has settled
    short = {"azimuth": UNITY2, "policy": {**CALM_STATES, "settled_s": 1e6}}
    assert set(np.unique(five_states(fidelity, short).methods[1].law_series[:, 3])) == {0.0, 1.0, 3.0}


def test_each_of_the_five_states_is_the_loop_that_bears_its_name() -> None:
    """With a policy that stays in one state the run is that of the kind of damping itself."""
    stays = {"limit_mps2": 100.0, "settled_s": 1e6}
    external, whole = ({"azimuth": UNITY2, "policy": {"id": "states", **one}}
                       for one in (stays, {**stays, "settled_s": 0.1, "difference_mps": 1000.0}))  # fmt: skip
    internal = {"azimuth": UNITY2, "policy": {"id": "states", **stays, "difference_mps": 1e-3}}
    own = {"reference": {"bias_mps": [0.3, -0.2]}, "initial_error": {"attitude_arcmin": [0.1, 0.1, 5.0]}}
    run = simulate(
        made(external, {}, whole, {"azimuth": UNITY2}, internal, {"damping": "internal"}, hours=12.0, **own)
    )
    position = columns(run, "position_m")
    for i in (0, 2, 4):
        assert position[i] == pytest.approx(position[i + 1], rel=1e-9, abs=1e-9)
        assert np.max(np.abs(position[i] - position[(i + 2) % 6])) > 100.0
