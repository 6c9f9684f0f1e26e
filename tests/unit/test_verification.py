"""verify(): the error model beside the strapdown on the same noise, and when it is not to be trusted."""

from typing import Any

import numpy as np
import pytest

from navcore.engine.measures import judged
from navcore.engine.verification import OF_PEAK, verify, why_not
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG
from navcore.mechanization.recorder import NAMES
from navcore.scenario.model import Scenario

METHODS = [
    {"name": "free"},
    {"name": "classic2", "damping": "external", "network": {"id": "classic2"}},
    {"name": "compass", "damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}},
]


def scenario(**blocks: Any) -> Scenario:
    data: dict[str, Any] = {
        "run": {"duration_h": 1.0, "rate_hz": 50.0, "seed": 3} | blocks.pop("run", {}),
        "imu": {"gyro_bias_dph": [0.01, 0.02, 0.0], "gyro_arw_dpsh": 0.01, "accel_vrw_ugpshz": 20.0},
        "reference": {"kind": "log", "noise_mps": 0.2, "bias_mps": [0.1, -0.2]},
        "initial_error": {"attitude_arcmin": [0.5, -0.5, 3.0]},
        "method": METHODS,
    }
    return Scenario.parse(data | blocks)


@pytest.mark.parametrize("log_hz", [1.0, 0.7, 10.0])
def test_on_the_same_noise_both_models_agree(log_hz):
    """Noise dominates these curves: fed with another noise the models would be far apart."""
    found = verify(scenario(reference={"kind": "log", "noise_mps": 0.2, "rate_hz": log_hz}))
    assert found.complete and found.statements == ()
    assert len(found.differences) == len(METHODS)
    for difference in found.differences:
        assert tuple(difference) == NAMES
        for name, d in difference.items():
            assert d.of_peak is not None and d.of_peak < 0.03, (name, d)


def test_the_difference_is_that_of_the_output_rows():
    found = verify(scenario())
    assert np.array_equal(found.strapdown.t_s, found.linear.t_s)
    full, simple = found.strapdown.methods[1], found.linear.methods[1]
    gap = np.abs(full.rows[:, 3] - simple.rows[:, 3]).max()
    assert found.differences[1]["dve_mps"].peak == gap > 0.0
    assert full.navigation is not None and simple.navigation is None
    assert (found.strapdown.scenario.run.fidelity, found.linear.scenario.run.fidelity) == (
        "strapdown",
        "error_model",
    )


def test_an_alignment_gives_both_the_same_start():
    found = verify(
        scenario(
            run={"fidelity": "strapdown"},
            alignment={"kind": "compass", "duration_s": 600.0},
            imu={},
            initial_error={"attitude_arcmin": [6.0, -6.0, 60.0]},
        )
    )
    start = found.linear.methods[0].rows[0]
    np.testing.assert_allclose(start[:3], found.strapdown.methods[0].rows[0, :3], atol=1e-12)
    assert 0.0 < abs(start[2]) < 0.01 * DEG


@pytest.mark.parametrize(
    ("blocks", "said"),
    [
        ({"initial_error": {"attitude_arcmin": [90.0, 0.0, 0.0]}}, "free: the tilt reaches 1.5°"),
        ({"initial_error": {"attitude_arcmin": [0.0, 0.0, 600.0]}}, "the heading errs by up to 10°"),
        ({"site": {"lat_deg": 80.0}}, "The latitude reaches 80.0°"),
        ({"run": {"step_s": 0.1}}, "with steps of 1 s in place of 0.1 s"),
        ({"run": {"duration_h": 73.0, "rate_hz": 10.0}, "method": METHODS[:1]}, "The run is 73 h long"),
    ],
)
def test_why_the_linear_model_is_not_to_be_trusted(blocks, said):
    assert any(said in text for text in verify(scenario(**blocks)).statements)


def test_a_large_difference_is_told_with_its_quantity():
    found = verify(scenario(initial_error={"attitude_arcmin": [600.0, 0.0, 600.0]}))
    assert any("of the peak" in text and text.startswith("free: ") for text in found.statements)


def test_a_cancel_keeps_what_both_have_computed():
    asked: list[int] = []

    def cancelled() -> bool:
        asked.append(1)
        return len(asked) == 4

    found = verify(scenario(run={"duration_h": 10.0}), cancelled=cancelled)
    assert len(asked) == 4 and not found.complete
    assert found.strapdown.status == found.linear.status == "stopped"
    for full, simple in zip(found.strapdown.methods, found.linear.methods, strict=True):
        assert 230.0 == full.t_s[-1] <= simple.t_s[-1] < 400.0
    assert found.differences[0]["dve_mps"].peak < 0.01


def test_progress_rises_to_one():
    seen: list[float] = []
    verify(scenario(), seen.append)
    assert seen == sorted(seen) and seen[-1] == 1.0 and len(seen) > 50


@pytest.mark.parametrize(
    ("blocks", "field"),
    [
        ({"run": {"fidelity": "channel"}}, "run.fidelity"),
        ({"run": {"fidelity": "strapdown"}, "imu": {"file": "x.imu"}}, "imu.file"),
    ],
)
def test_what_cannot_be_verified_is_refused_with_the_reason(blocks, field):
    refused = scenario(**blocks)
    assert why_not(refused)
    with pytest.raises(InputError) as caught:
        verify(refused)
    assert caught.value.faults[0].field == field


def test_what_cannot_be_run_as_strapdown_is_refused():
    motion = {"kind": "swing", "roll": {"amplitude_deg": 3.0, "frequency_hz": 0.25}}
    with pytest.raises(InputError, match="too low for the motion"):
        verify(scenario(motion=motion | {"roll": {"amplitude_deg": 1.0, "frequency_hz": 4.0}}))
    assert not why_not(scenario(motion=motion))


def far_off(**blocks: Any) -> Scenario:
    """A start far off level and north, which leaves a loop that settles with differences of its own size."""
    classic2 = {"damping": "external", "network": {"id": "classic2"}}
    start = {"attitude_arcmin": [40.0, 40.0, 200.0]}
    return scenario(run={"duration_h": 8.0}, initial_error=start, method=[classic2], **blocks)


def test_a_difference_of_the_methods_own_level_is_said_with_an_interval_over_seeds():
    """Below 5 % of the peak, which is that of the start, nothing was said."""
    found = verify(far_off(), seeds=3)
    assert max(d.of_peak or 0.0 for d in found.differences[0].values()) < OF_PEAK
    level = found.levels[0]["phi_e_rad"]
    assert level.share is not None and level.low is not None and level.high is not None
    assert level.low < level.share < level.high and level.seeds == 3
    (told,) = found.statements
    assert f"differs by {100.0 * level.share:.3g} % RMS of its own level in the second half" in told
    assert "over 3 seeds" in told
    rows = [run.methods[0].rows[len(run.t_s) // 2 :, 0] for run in (found.strapdown, found.linear)]
    assert verify(far_off()).levels[0]["phi_e_rad"].share == pytest.approx(
        np.sqrt(np.mean((rows[0] - rows[1]) ** 2) / np.mean(rows[0] ** 2)), rel=1e-12
    )


def test_a_limit_that_one_model_meets_and_the_other_misses_is_said():
    limited = {"quantity": "velocity_rms_mps", "from_h": 4.0, "at_most": 1.0}
    found = verify(far_off(requirement=[limited]))
    runs = found.strapdown, found.linear
    values = [judged(run.scenario.requirement[0], run.methods[0])[0] for run in runs]
    assert None not in values
    between = 0.5 * sum(value or 0.0 for value in values)
    found = verify(far_off(requirement=[limited | {"at_most": between}]))
    assert any("meets the limit" in text and "misses it" in text for text in found.statements)
    clear = verify(far_off(requirement=[limited | {"at_most": 2.0 * max(value or 0.0 for value in values)}]))
    assert not any("limit" in text for text in clear.statements)
