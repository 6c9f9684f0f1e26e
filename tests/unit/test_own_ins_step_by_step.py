"""Damping laid on an INS's output as it comes is that of a run on the whole recording."""

from pathlib import Path

import numpy as np
import pytest

from navcore.engine.drivers.common import law_of, network_of
from navcore.engine.drivers.outside import prepared
from navcore.engine.simulation import simulate
from navcore.mechanization.outside import Output, OutsideDamping
from navcore.motion.truth import HEADING, HEIGHT, LAT, LON, VE, VN
from navcore.quantities import COMPONENTS
from tests.own_ins import on_ins
from tests.unit.test_own_ins_faults import recorded

SECONDS = 3600


@pytest.mark.parametrize("azimuth", ["none", "unity2"])
def test_step_by_step_is_as_at_once(tmp_path: Path, azimuth: str) -> None:
    method = {"damping": "external", "network": "unity2", "azimuth": {"id": azimuth}}
    scenario = on_ins(recorded(tmp_path), [method], truth=False, run={"duration_h": SECONDS / 3600.0})
    whole = simulate(scenario).methods[0]
    placed, env, _ = prepared(scenario)
    law = law_of(placed.method[0], network_of(placed, placed.method[0]), 1.0)
    box = OutsideDamping(law, 1.0, env.reference.hold_s, env.reference.body_frame)
    rows = env.truth_half.values[::2]
    outputs = [Output(*row) for row in rows[:, [LAT, LON, HEIGHT, VE, VN, HEADING]].tolist()]
    for k in range(SECONDS):
        own, error = outputs[k], env.reference.error[k]
        box.step(own, outputs[k + 1], (own.v_e + error[0], own.v_n + error[1]))
    last = whole.rows[-1]
    found = box.x[[4, 5, 6, 0, 1]]
    for value, name in zip(found, COMPONENTS[:5], strict=True):
        peak = whole.errors[name]["max_abs"]
        assert value == pytest.approx(last[COMPONENTS.index(name)], abs=2e-3 * peak)
    damped, output = box.damped(outputs[-1]), whole.output
    assert output is not None
    assert np.allclose([damped.lat, damped.lon, damped.v_e, damped.v_n], output[-1, :4], rtol=0, atol=2e-3)


def test_a_log_that_falls_silent_leaves_the_ins_undamped(tmp_path: Path) -> None:
    method = {"damping": "external", "network": "classic2"}
    scenario = on_ins(recorded(tmp_path), [method], truth=False, run={"duration_h": 0.1})
    placed, env, _ = prepared(scenario)
    law = law_of(placed.method[0], network_of(placed, placed.method[0]), 1.0)
    box = OutsideDamping(law, 1.0, 5.0)
    now = Output(*env.truth_half.values[0, [LAT, LON, HEIGHT, VE, VN, HEADING]].tolist())
    box.step(now, now, None)
    assert not law.s["damped"]
    for _ in range(3):
        box.step(now, now, (now.v_e + 0.1, now.v_n))
    assert law.s["damped"] and law.s["difference"][0] == pytest.approx(0.1, abs=1e-2)
    for _ in range(8):
        box.step(now, now, None)
    assert not law.s["damped"]
