"""Currents that hold on a leg: what the log makes of them in both fidelities, and in the error budget."""

from typing import Any

import numpy as np
import pytest

from navcore.design.ship import Ship
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.motion.truth import COLUMNS, Truth
from navcore.scenario.model import Scenario
from navcore.sensors.log import reference_errors
from navcore.sensors.reference import Reference

LEGS = [{"duration_s": 1800.0, "speed_kn": 10.0}, {"duration_s": 1800.0, "heading_deg": 90.0}]


def scenario(**reference: Any) -> dict[str, Any]:
    return {
        "run": {"duration_h": 2.0, "rate_hz": 50.0},
        "motion": {"kind": "legs", "leg": LEGS, "repeat": 2},
        "reference": {"kind": "log", **reference},
        "method": [{"damping": "external", "network": {"id": "classic2"}}],
    }


def test_the_log_misses_each_current_while_it_holds():
    current = ({"t_h": 0.5, "duration_s": 1800.0, "repeat": 2, "current_mps": (0.4, -0.1)},)
    reference = Reference(kind="log", current_mps=(0.1, 0.0), current=current)
    error = reference_errors(reference, Truth(0.5, np.zeros((1, COLUMNS))), 7200.0, 1).error
    assert error[[0, 1799, 3600, 5399]] == pytest.approx(np.full((4, 2), (-0.1, 0.0)))
    assert error[[1800, 3599, 5400, 7199]] == pytest.approx(np.full((4, 2), (-0.5, 0.1)))


def test_a_current_over_the_whole_run_is_a_current():
    passing = scenario(current=[{"duration_s": 1e5, "current_mps": [0.3, 0.2]}])
    runs = [simulate(Scenario.parse(s)).methods[0] for s in (scenario(current_mps=[0.3, 0.2]), passing)]
    assert np.abs(runs[0].rows[:, 3]).max() > 0.01
    assert np.array_equal(runs[0].rows, runs[1].rows)


def test_both_fidelities_and_the_budget_agree():
    passing = [{"t_h": 0.5, "duration_s": 1800.0, "repeat": 2, "current_mps": [0.4, -0.1]}]
    data = scenario(current=passing)
    linear = simulate(Scenario.parse(data)).methods[0]
    expected = Ship(Scenario.parse(data)).along(Scenario.parse(data).method[0])
    data["run"]["fidelity"] = "strapdown"
    full = simulate(Scenario.parse(data)).methods[0]
    scale = np.abs(linear.rows[:, :7]).max(axis=0)
    assert scale[3] > 0.1
    assert (np.abs(full.rows[:, :7] - linear.rows[:, :7]).max(axis=0) < 0.02 * scale).all()
    places = np.rint(expected.t_s / 10.0).astype(int)
    assert list(expected.variance) and np.abs(expected.variance["log_current"] - expected.total).max() < 1e-12
    assert np.sqrt(expected.total[:, 3]) == pytest.approx(np.abs(linear.rows[places, 3]), abs=0.02 * scale[3])


def test_a_current_beyond_its_range_is_named():
    with pytest.raises(InputError) as refused:
        Scenario.parse(scenario(current=[{"current_mps": [0.0, 70.0]}]))
    (fault,) = refused.value.faults
    assert fault.field == "reference.current.0.current_mps.1"
    assert "must be >= -50 and <= 50 (m/s)" in str(fault.allowed)
