"""No preset's metrics change silently.

Tolerances: 1e-6 of a quantity's largest magnitude for every statistic (compilers may order sums differently,
which is some 1e-12), 1e-9 for the loop. Where half-period averaging leaves nothing of a quantity, what is
compared is rounding: see `ROUNDING`. When a change is meant: ``python -m tools.golden``.
"""

import json

import numpy as np
import pytest

from navcore.scenario.file import presets
from tools.golden import FOLDER, present

ROUNDING = {"rad": 1e-7, "mps": 1e-4, "m": 1.0}
"""Magnitude below which a quantity is compared as if it were so large."""


def test_every_preset_has_its_golden_file_and_no_file_is_left_over():
    assert sorted(path.stem for path in FOLDER.glob("*.json")) == sorted(presets())


@pytest.mark.known(
    "golden",
    [
        "tilt_max_arcsec",
        "tilt_rms_arcsec",
        "velocity_max_mps",
        "velocity_rms_mps",
        "heading_max_arcmin",
        "heading_rms_arcmin",
        "position_max_m",
        "position_rms_m",
        "position_final_m",
        "settling_s",
        "damping_ratio",
        "h0",
        "growth_per_s",
    ],
    kinds=["free", "internal", "external", "averaging", "kalman", "whole", "gyrocompass"],
    fidelities=["error_model", "strapdown", "loop"],
    source="metrics of every preset",
)
@pytest.mark.parametrize("name", sorted(presets()))
def test_metrics_are_the_golden_ones(name):
    golden = json.loads((FOLDER / f"{name}.json").read_text("utf-8"))
    now = present(name)
    assert [(m["name"], m["status"]) for m in now] == [(m["name"], m["status"]) for m in golden]
    for then, method in zip(golden, now, strict=True):
        assert_same_loop(then["loop"], method["loop"])
        assert method["errors"].keys() == then["errors"].keys()
        for quantity, statistics in then["errors"].items():
            scale = max(abs(statistics["max_abs"]), ROUNDING[quantity.rsplit("_", 1)[1]])
            for key, value in statistics.items():
                found = method["errors"][quantity][key]
                where = (method["name"], quantity, key)
                assert found == pytest.approx(value, abs=1e-6 * scale, rel=0.0), where


def assert_same_loop(then, now):
    assert now["stable"] == then["stable"]
    scale = np.max(np.abs(then["poles"]))
    np.testing.assert_allclose(now["poles"], then["poles"], atol=1e-9 * scale)
    for key in ("h0", "damping_ratio"):
        assert now[key] == pytest.approx(then[key], rel=1e-9, abs=1e-12)
    # found by stepping along the response
    settling = then["settling_s"]
    assert now["settling_s"] == (None if settling is None else pytest.approx(settling, rel=1e-6))
