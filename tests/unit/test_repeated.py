"""Legs, outages and events that are repeated: the same as written out, and what is refused."""

from typing import Any

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.mechanization.recorder import DAMPED_COLUMN
from navcore.motion.legs import LegsMotion
from navcore.motion.truth import Site
from navcore.scenario.model import Scenario
from navcore.sensors.log_errors.events import LogEvent, event_velocity
from navcore.sensors.reference import Outage, in_service

SITE = Site(0.9, 0.2, 0.0)
CROSSING = (
    {"duration_s": 700.0, "speed_kn": 18.0, "heading_deg": 20.0},
    {"duration_s": 300.0, "speed_kn": 0.0, "accel_mps2": 0.05},
    {"duration_s": 700.0, "speed_kn": 18.0, "heading_deg": 200.0},
    {"duration_s": 300.0, "speed_kn": 0.0, "accel_mps2": 0.05},
)


def rows(**fields: Any) -> np.ndarray:
    return LegsMotion(**fields).truth(9001, 1.0, SITE, WGS84).values


def test_repeated_legs_are_those_written_out():
    written = rows(leg=CROSSING + CROSSING + CROSSING)
    assert np.array_equal(rows(leg=CROSSING, repeat=3), written)
    assert not np.array_equal(rows(leg=CROSSING), written)


def test_rounds_begin_at_their_leg_and_at_their_time():
    approach = ({"duration_s": 600.0, "speed_kn": 9.0, "heading_deg": 90.0},)
    waiting = ({"duration_s": 1180.0, "speed_kn": 0.0, "accel_mps2": 0.05},)  # 300 s and the wait
    found = rows(leg=approach + CROSSING, repeat=3, repeat_from=1, every_h=0.8)
    written = rows(leg=approach + (CROSSING[:3] + waiting) * 3)
    assert found[:, :8] == pytest.approx(written[:, :8], abs=1e-9)


def test_repeated_outages_and_events_are_those_written_out():
    t = np.arange(0.0, 40_000.0, 1.0)
    assert np.array_equal(
        in_service([Outage(t_h=0.8333, duration_s=600.0, repeat=8, every_h=1.0)], t),
        in_service([Outage(t_h=0.8333 + k, duration_s=600.0) for k in range(8)], t),
    )
    for sine_hz in (0.0, 0.004):
        fields = {"duration_s": 600.0, "accel_mps2": (1e-3, -2e-3), "sine_hz": sine_hz}
        once = [LogEvent(t_h=0.5 + 1.5 * k, **fields) for k in range(5)]
        again = [LogEvent(t_h=0.5, repeat=5, every_h=1.5, **fields)]
        assert event_velocity(again, t) == pytest.approx(event_velocity(once, t), abs=1e-12)


@pytest.mark.parametrize(
    ("data", "field", "allowed"),
    [
        ({"reference": {"outage": [{"repeat": 0}]}}, "reference.outage.0.repeat", "must be >= 1"),
        (
            {"reference": {"outage": [{"duration_s": 900.0, "repeat": 2, "every_h": 0.2}]}},
            "reference.outage.0.every_h",
            "must be >= 0.25 (h)",
        ),
        (
            {"reference": {"event": [{"duration_s": 900.0, "repeat": 2, "every_h": 0.2}]}},
            "reference.event.0.every_h",
            "must be >= 0.25 (h)",
        ),
        ({"motion": {"kind": "legs", "repeat": 0}}, "motion.repeat", "must be >= 1"),
        ({"motion": {"kind": "legs", "repeat": 2, "every_h": 0.5}}, "motion.every_h", "must be >= 1 (h)"),
        ({"motion": {"kind": "legs", "repeat_from": 1}}, "motion.repeat_from", "must be <= 0"),
        (
            {"motion": {"kind": "legs", "leg": [{}, {}, {}], "repeat": 4000}},
            "motion.repeat",
            "must be <= 3333",
        ),
    ],
)
def test_what_cannot_be_repeated_is_refused(data: dict[str, Any], field: str, allowed: str):
    with pytest.raises(InputError) as refused:
        Scenario.parse(data)
    (fault,) = refused.value.faults
    assert fault.field == field
    assert allowed in str(fault.allowed)


def test_a_misfit_is_named_once_for_all_rounds():
    leg = [{"duration_s": 120.0, "speed_mps": 9.0}, {"duration_s": 10.0, "speed_mps": 0.0}]
    with pytest.raises(InputError) as refused:
        Scenario.parse({"motion": {"kind": "legs", "leg": leg, "repeat": 50}})
    assert [fault.field for fault in refused.value.faults] == ["motion.leg.1.speed_mps"]


def test_both_fidelities_agree_on_repeated_legs_and_outages():
    data: dict[str, Any] = {
        "run": {"duration_h": 1.5, "rate_hz": 50.0},
        "motion": {"kind": "legs", "leg": list(CROSSING), "repeat": 3},
        "imu": {"gyro_bias_dph": [0.01, -0.02, 0.01]},
        "reference": {"kind": "log", "bias_mps": [0.2, 0.1]}
        | {"outage": [{"t_h": 0.2, "duration_s": 300.0, "repeat": 5, "every_h": 0.25}]},
        "method": [{"damping": "external", "network": {"id": "classic2"}}],
    }
    linear = simulate(Scenario.parse(data)).methods[0]
    data["run"]["fidelity"] = "strapdown"
    full = simulate(Scenario.parse(data)).methods[0]
    scale = np.abs(linear.rows[:, :7]).max(axis=0)
    assert (np.abs(full.rows[:, :7] - linear.rows[:, :7]).max(axis=0) < 0.02 * scale).all()
    switched = np.abs(np.diff(linear.rows[:, DAMPED_COLUMN])).sum()
    assert switched == np.abs(np.diff(full.rows[:, DAMPED_COLUMN])).sum() == 10
