"""Motion `swing` against its formula; what it and `static` refuse."""

import math
from typing import Any

import numpy as np
import pytest

from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.parameters import Parameters
from navcore.motion.static import StaticMotion
from navcore.motion.swing import Oscillation, SwingMotion
from navcore.motion.truth import (
    AE,
    AU,
    HEADING,
    HEADING_RATE,
    HEIGHT,
    LAT,
    LON,
    PITCH,
    PITCH_RATE,
    ROLL,
    ROLL_RATE,
    VE,
    Site,
)

SITE = Site(math.radians(45.78), math.radians(126.7), 3.0)
DENG: dict[str, Any] = {
    "roll_deg": 6.0,
    "roll": {"amplitude_deg": 12.0, "frequency_hz": 0.125},
    "pitch_deg": 8.0,
    "pitch": {"amplitude_deg": 10.0, "frequency_hz": 0.2},
    "heading_deg": 75.0,
    "heading": {"amplitude_deg": 6.0, "frequency_hz": 0.15, "phase_deg": 30.0},
}


def test_deng_swing_follows_its_formula_for_a_day() -> None:
    values = SwingMotion(**DENG).truth(172_801, 0.5, SITE, WGS84).values
    t = np.arange(172_801) * 0.5
    for column, rate, mean, amplitude, frequency, phase in (
        (PITCH, PITCH_RATE, 8.0, 10.0, 0.2, 0.0),
        (ROLL, ROLL_RATE, 6.0, 12.0, 0.125, 0.0),
        (HEADING, HEADING_RATE, 75.0, 6.0, 0.15, 30.0),
    ):
        # Whole cycles are taken off in integers: 20 cycles of 1/20 Hz are 400 s, and so on.
        angle = 2.0 * np.pi * np.mod(frequency * np.mod(t, 400.0), 1.0) + math.radians(phase)
        expected = np.radians(mean + amplitude * np.sin(angle))
        assert np.all(np.abs(values[:, column] - expected) <= 1e-10)
        w = 2.0 * np.pi * frequency
        assert np.all(np.abs(values[:, rate] - np.radians(amplitude) * w * np.cos(angle)) <= 1e-10)


def test_the_place_does_not_move() -> None:
    values = SwingMotion(**DENG).truth(101, 0.5, SITE, WGS84).values
    for column, value in ((LAT, SITE.lat), (LON, SITE.lon), (HEIGHT, SITE.height)):
        assert (values[:, column] == value).all()
    assert not values[:, VE : AU + 1].any()
    assert AE == VE + 3


def _refused(step_s: float, **fields: Any) -> InputError:
    with pytest.raises(InputError) as caught:
        SwingMotion(**fields).truth(11, step_s, SITE, WGS84)
    return caught.value


def test_a_swing_too_fast_for_the_step_is_refused_by_name() -> None:
    fast = {"amplitude_deg": 1.0, "frequency_hz": 0.26}
    error = _refused(0.5, roll=fast, heading=fast)
    assert [fault.field for fault in error.faults] == ["roll.frequency_hz", "heading.frequency_hz"]
    assert error.faults[0].value == 0.26
    assert "must be <= 0.25 (Hz)" in error.faults[0].allowed


def test_the_fastest_swing_and_a_swing_of_no_size_are_taken() -> None:
    SwingMotion(roll={"amplitude_deg": 1.0, "frequency_hz": 0.25}).truth(11, 0.5, SITE, WGS84)
    SwingMotion(roll={"amplitude_deg": 0.0, "frequency_hz": 50.0}).truth(11, 0.5, SITE, WGS84)
    SwingMotion(roll={"amplitude_deg": 1.0, "frequency_hz": 50.0}).truth(11, 0.0025, SITE, WGS84)


def test_pitch_beyond_the_vertical_is_refused() -> None:
    SwingMotion(pitch_deg=-60.0, pitch={"amplitude_deg": 29.0})
    with pytest.raises(ValueError, match=r"pitch\.amplitude_deg = 30\.0: must be <= 29 \(°\)"):
        SwingMotion(pitch_deg=-60.0, pitch={"amplitude_deg": 30.0})


@pytest.mark.parametrize(
    ("model", "field", "value"),
    [
        *((Oscillation, "amplitude_deg", value) for value in (-1.0, 91.0)),
        (Oscillation, "frequency_hz", -0.1),
        (Oscillation, "phase_deg", 400.0),
        *((StaticMotion, "pitch_deg", value) for value in (89.1, math.nan)),
        (StaticMotion, "roll_deg", -180.1),
        (StaticMotion, "heading_deg", 361.0),
    ],
)
def test_fields_out_of_range_are_refused(model: type[Parameters], field: str, value: float) -> None:
    with pytest.raises(ValueError, match=field):
        model.model_validate({field: value})
