"""Motion `static` and the registry of motions."""

import math
from typing import get_args

import numpy as np
import pytest
from pydantic import ValidationError

from navcore.foundation.earth import WGS84
from navcore.motion import MOTIONS, Motion, ProfileMotion, StaticMotion, WavesMotion
from navcore.motion.truth import HEADING, HEADING_RATE, HEIGHT, LAT, LON, PITCH, ROLL, VE, Site

SITE = Site(math.radians(32.06), math.radians(118.8), 12.0)


def test_one_row_stands_for_all_times() -> None:
    truth = StaticMotion(pitch_deg=6.0, roll_deg=8.0, heading_deg=75.0).truth(1001, 0.5, SITE, WGS84)
    assert truth.values.shape == (1, 15)
    assert truth.constant
    assert truth.step_s == 0.5
    row = truth.values[0]
    assert tuple(row[[LAT, LON, HEIGHT]]) == (SITE.lat, SITE.lon, SITE.height)
    assert row[[PITCH, ROLL, HEADING]] == pytest.approx(np.radians([6.0, 8.0, 75.0]), rel=1e-15)
    assert not row[VE:PITCH].any()
    assert not row[HEADING + 1 : HEADING_RATE + 1].any()


@pytest.mark.parametrize(
    ("field", "value"),
    [("pitch_deg", 89.1), ("roll_deg", -180.1), ("heading_deg", 361.0), ("pitch_deg", math.nan)],
)
def test_attitude_out_of_range_is_refused(field: str, value: float) -> None:
    with pytest.raises(ValidationError, match=field):
        StaticMotion(**{field: value})


def test_the_registry_holds_the_union() -> None:
    members = get_args(get_args(Motion)[0])
    assert set(MOTIONS.values()) == set(members)
    for kind, model in MOTIONS.items():
        assert model.model_fields["kind"].default == kind
        assert get_args(model.model_fields["kind"].annotation) == (kind,)


def test_every_number_carries_its_range_unit_label_and_help() -> None:
    from navcore.foundation.parameters import allowed_range, extra_of
    from navcore.motion.legs import Leg
    from navcore.motion.profile import Point
    from navcore.motion.swing import Oscillation

    words = {"kind", "shape", "bow", "point", "spectrum"}
    for model in (StaticMotion, Oscillation, Leg, ProfileMotion, Point, WavesMotion):
        for name, info in model.model_fields.items():
            if name in words or name == "velocity_mps":
                continue
            extra = extra_of(info)
            assert extra["unit"], name
            assert extra["label"], name
            assert info.description, name
            assert ">" in allowed_range(info), name
            assert "<" in allowed_range(info), name
            low, high = extra["slider"]
            assert low < high
            if info.default is not None:
                assert low <= info.default <= high
