"""Figures that would have to be better: applied, they bring the median of runs to its limit."""

from pathlib import Path
from typing import Any

import pytest

from navcore.design.designs import designs
from navcore.design.judged import Designs
from navcore.design.needed import Needed
from navcore.scenario.file import to_toml
from navcore.scenario.model import Scenario
from schuler_bench.cli import main

SEEDS = 60
SHIP: dict[str, Any] = {
    "run": {"duration_h": 6.0, "step_s": 5.0, "seed": 3},
    "imu": {"gyro_bias_std_dph": 0.01, "accel_bias_std_ug": 50.0, "gyro_arw_dpsh": 0.001},
    "reference": {"kind": "log", "noise_mps": 0.1, "bias_std_mps": 0.01},
    "initial_error": {"level_std_arcmin": 0.05},
    "method": [{"name": "damped", "damping": "external", "network": {"id": "complementary"}}],
    "requirement": [
        {"quantity": "tilt_max_arcsec", "at_most": 8.0, "from_h": 2.0},
        {"quantity": "velocity_rms_mps", "at_most": 0.2, "from_h": 2.0},
    ],
}


def judged(**blocks: Any) -> Designs:
    """Method as set, with blocks exchanged."""
    return designs(Scenario.parse({**SHIP, **blocks}), SEEDS, as_set=True)


def of(found: Designs, quantity: str | None, *figures: str) -> Needed:
    """Entry for a limit and these figures."""
    return next(one for one in found.needed if one.quantity == quantity and one.figures == figures)


def test_better_figures_bring_the_median_to_its_limit() -> None:
    """The accelerometers' bias for the tilt, the gyros' for the velocity; neither is enough for both."""
    found = judged()
    assert not found.met
    accel = of(found, "tilt_max_arcsec", "imu.accel_bias_std_ug").factor or 0.0
    gyro = of(found, "velocity_rms_mps", "imu.gyro_bias_std_dph").factor or 0.0
    assert 1.2 < accel < 10.0 and 1.2 < gyro < 10.0
    assert not any(one.quantity is None and len(one.figures) == 1 for one in found.needed)
    none = of(found, None)
    assert none.factor is None and none.before == found.methods[0].met
    better = {**SHIP["imu"], "gyro_bias_std_dph": 0.01 / gyro, "accel_bias_std_ug": 50.0 / accel}
    tilt, velocity = judged(imu=better).methods[0].limits
    assert tilt.ratio == pytest.approx(1.0, abs=0.06)
    assert velocity.ratio == pytest.approx(1.0, abs=0.06)


def test_all_figures_together_are_enough() -> None:
    """Each of them smaller by one factor: the errors of a linear model are so too."""
    found = judged()
    together = max(found.needed, key=lambda one: (one.quantity is None, len(one.figures)))
    worst = max(limit.ratio for limit in found.methods[0].limits)
    assert together.quantity is None and len(together.figures) == 6
    assert together.factor == pytest.approx(worst, rel=0.03)


def test_limits_of_the_setting_are_no_matter_of_sensors() -> None:
    """No figure is enough where the setting itself misses one; nothing is said where the limits are met."""
    settling = [*SHIP["requirement"], {"quantity": "settling_s", "at_most": 10.0}]
    found = judged(requirement=settling)
    assert of(found, "settling_s").factor is None and of(found, None).factor is None
    assert of(found, "tilt_max_arcsec", "imu.accel_bias_std_ug").factor
    wide = [{"quantity": "tilt_max_arcsec", "at_most": 500.0}]
    met = judged(requirement=wide)
    assert met.met and met.needed == ()


TIDAL: dict[str, Any] = {
    **SHIP,
    "imu": {"gyro_bias_std_dph": 0.02, "accel_bias_std_ug": 20.0, "gyro_arw_dpsh": 0.001},
    "reference": {"kind": "log", "noise_mps": 0.1, "tide_mps": [0.4, 0.2]},
    "method": [*SHIP["method"], {"name": "filter", "damping": "kalman"}],
    "requirement": [{"quantity": "velocity_rms_mps", "at_most": 0.12, "from_h": 2.0}],
}


def test_the_filter_is_asked_first_where_it_is_best() -> None:
    """Nobody told it of the tide, which by itself keeps it from its limit: the same factor as by hand."""
    found = designs(Scenario.parse(TIDAL), SEEDS, as_set=True)
    assert found.methods[0].method.label() == "filter" and not found.met
    tide = of(found, None, "reference.tide_mps")
    assert tide.method == "filter" and tide.factor is not None
    assert tide.before == found.methods[0].met and tide.after is not None
    assert tide.before < 0.2 and 0.3 <= tide.after <= 0.7
    better = {**TIDAL["reference"], "tide_mps": [0.4 / tide.factor, 0.2 / tide.factor]}
    again = designs(Scenario.parse({**TIDAL, "reference": better}), SEEDS, as_set=True)
    filtered = next(one for one in again.methods if one.method.label() == "filter")
    assert filtered.limits[0].ratio == pytest.approx(1.0, abs=0.06)
    assert all(one.factor and (one.after or 0.0) > 0.2 for one in found.needed)


def test_the_command_names_figure_factor_and_method(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Beside what each limit is met on by itself."""
    path = tmp_path / "ship.toml"
    path.write_text(to_toml(Scenario.parse(SHIP)))
    assert main(["design", str(path), "--as-set", "--seeds", "20"]) == 0
    text = capsys.readouterr().out
    assert "each limit by itself" in text
    assert "  tilt_max_arcsec: imu.accel_bias_std_ug " in text and "times better (damped): met on 0 %" in text
    assert "  all limits: no single figure is enough, not even 1000 times better (damped)" in text


def test_the_command_writes_a_least_value_with_its_sense(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Damping is limited from below, the other quantities from above."""
    path = tmp_path / "ship.toml"
    least = {"quantity": "damping_ratio", "at_least": 0.9}
    path.write_text(to_toml(Scenario.parse({**SHIP, "requirement": [least]})))
    assert main(["design", str(path), "--as-set", "--seeds", "2"]) == 0
    assert "  damping_ratio >= 0.9: at most 0 % (damped)" in capsys.readouterr().out
