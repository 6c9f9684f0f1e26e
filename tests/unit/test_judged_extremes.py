"""Largest tilt and velocity after a step of the log, of slow loops and of loops with slow and fast modes."""

from typing import Any, Literal

import numpy as np
import pytest

from navcore.analysis import analyse
from navcore.analysis.judged import JudgedLoop, loop_value
from navcore.analysis.transfers import time_response
from navcore.foundation.earth import SPHERE
from navcore.networks import parse_network


@pytest.mark.known(
    "twin", ["log_tilt", "overshoot"], kinds=["external"], fidelities=["loop"], source="fine grids"
)
@pytest.mark.parametrize(
    ("block", "key", "output"),
    [
        # settles after 145 h, and its highest peak is the first one
        ({"id": "complementary", "zeta": 0.006115, "eta": 0.14925}, "log_tilt", "phi"),
        # a slow mode that an initial tilt, which settles after 1.1 h, hardly excites
        ({"id": "optimal", "rho": 2.87e-5, "q": 0.0281}, "overshoot", "dv"),
    ],
)
def test_largest_values_after_a_log_step_are_those_of_fine_grids(
    block: dict[str, Any], key: str, output: Literal["phi", "dv"]
) -> None:
    """Over all times at which something can happen."""
    network = parse_network(block).transfer(SPHERE.schuler_frequency(0.0))
    grids = (np.linspace(0.0, end_s, 4001) for end_s in (1e3, 1e4, 4e4, 4e5))
    fine = max(float(np.abs(time_response(network, "dv_r", output, grid)).max()) for grid in grids)
    assert loop_value(key, JudgedLoop(network, analyse(network), True)) == pytest.approx(fine, rel=2e-3)
