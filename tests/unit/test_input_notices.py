"""What a run says of its inputs: what is simulated beside a recording, and waves that change nothing."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.scenario.file import load
from navcore.scenario.model import Scenario


def warnings_of(**blocks: Any) -> str:
    data = {"run": {"duration_h": 0.25}, "reference": {"kind": "log"}, "method": [{"name": "free"}]}
    return "\n".join(simulate(Scenario.parse(data | blocks)).warnings)


def test_a_recorded_log_says_which_errors_are_simulated_beside_it(tmp_path: Path) -> None:
    rows = (f"{t},45.0,-30.0,10.0,90.0" for t in range(1000))
    (tmp_path / "log.csv").write_text("time_s,lat_deg,lon_deg,speed_kn,heading_deg\n" + "\n".join(rows))
    recorded = {"kind": "file", "file": str(tmp_path / "log.csv")}
    told = warnings_of(
        reference=recorded,
        imu={"gyro_bias_dph": [0.01, 0.0, 0.02]},
        initial_error={"velocity_mps": [0.5, 0.0]},
    )
    assert "imu.gyro_bias_dph = [0.01, 0, 0.02]" in told
    assert "initial_error.velocity_mps = [0.5, 0]" in told
    assert "gyro_arw" not in told
    assert "taken as free of error" in warnings_of(reference=recorded)
    assert "beside the recording" not in warnings_of(imu={"gyro_bias_dph": [0.01, 0.0, 0.02]})


def test_the_recorded_preset_says_so() -> None:
    assert any("beside the recording" in text for text in simulate(load("sikuliaq-recorded")).warnings)


@pytest.mark.parametrize(
    ("blocks", "told"),
    [
        ({}, True),
        ({"imu": {"gyro_bias_dph": [0.01, 0.0, 0.0]}}, False),
        ({"initial_error": {"attitude_arcmin": [1.0, 0.0, 0.0]}}, False),
        ({"reference": {"kind": "log", "noise_mps": 0.1}}, False),
        ({"method": [{"damping": "internal", "network": {"id": "classic2"}}]}, True),
        ({"run": {"duration_h": 0.1, "fidelity": "strapdown"}}, False),
    ],
    ids=str,
)
def test_waves_that_change_nothing_say_why(blocks: dict[str, Any], told: bool) -> None:
    waves = {"kind": "waves", "height_m": 3.0}
    assert ("the waves change nothing" in warnings_of(motion=waves, **blocks)) is told
    if told:
        data = {"run": {"duration_h": 0.25}, "reference": {"kind": "log"}, "method": [{"name": "free"}]}
        rough, calm = (
            simulate(Scenario.parse(data | blocks | motion)).methods[0].rows
            for motion in ({"motion": waves}, {})
        )
        np.testing.assert_array_equal(rough[:, :7], calm[:, :7])


@pytest.mark.parametrize(
    ("blocks", "told"),
    [
        ({}, True),
        ({"imu": {"gyro_bias_dph": [0.01, 0.02, 0.01], "accel_scale_ppm": [500.0, 500.0, 500.0]}}, False),
    ],
    ids=str,
)
def test_waves_in_a_channel_run_say_why_they_change_nothing(blocks: dict[str, Any], told: bool) -> None:
    """Where an error depends on the motion nothing is claimed."""
    data: dict[str, Any] = {
        "run": {"duration_h": 1.0, "fidelity": "channel"},
        "imu": {"gyro_bias_dph": [0.01, 0.02, 0.01], "accel_vrw_ugpshz": 10.0},
        "reference": {"kind": "log", "noise_mps": 0.1},
        "method": [{"damping": "external", "network": {"id": "complementary"}}],
    }
    waves = {"motion": {"kind": "waves", "height_m": 3.0}}
    assert ("the waves change nothing" in warnings_of(**(data | blocks | waves))) is told
    rough, calm = (
        simulate(Scenario.parse(data | blocks | motion)).methods[0].rows[:, :5] for motion in (waves, {})
    )
    apart = np.abs(rough - calm).max(axis=0) / np.maximum(np.abs(calm).max(axis=0), 1e-30)
    assert apart.max() < 1e-8 or not told


@pytest.mark.parametrize(("output_s", "told"), [(3.3, True), (3.0, False), (0.3, False), (2.5, True)])
def test_rows_that_cannot_stand_at_their_interval_are_told(output_s: float, told: bool) -> None:
    said = warnings_of(run={"duration_h": 0.01, "step_s": 1.0, "output_step_s": output_s})
    assert ("no multiple of the step of 1 s" in said) is told
    if output_s == 3.3:
        assert "3 to 4 s apart" in said
