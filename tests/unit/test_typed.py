"""Values typed with a unit."""

import math

import pytest

from app.editing.typed import read_typed, unit_of


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("30 min", "h", 0.5),
        ("2 kn", "m/s", 2 * 1852 / 3600),
        ("2kn", "kn", 2.0),
        ("0.5 deg", "arcmin", 30.0),
        ("1e-2 deg/h", "deg/h", 0.01),
        ("3″", "arcsec", 3.0),
        ("50 µg", "ug", 50.0),
        ("-7", "m", -7.0),
        ("1.5", "", 1.5),
    ],
)
def test_units_are_understood(text: str, unit: str, value: float) -> None:
    assert read_typed(text, unit) == pytest.approx(value, rel=1e-13)


@pytest.mark.parametrize(
    ("text", "unit", "told"),
    [
        ("30 furlongs", "h", "one of s, min, h, d, not in 'furlongs'"),
        ("30 min", "", "a number without a unit"),
        ("2 kn", "deg", "one of rad, mrad, °"),
        ("half", "h", "must be a number"),
        ("", "h", "must be a number"),
        ("1e999", "h", "finite"),
    ],
)
def test_what_does_not_fit_is_refused_in_words(text: str, unit: str, told: str) -> None:
    with pytest.raises(ValueError, match=told):
        read_typed(text, unit)


def test_the_unit_stands_in_the_label() -> None:
    assert (unit_of("settling ≤ (min)"), unit_of("gyro bias x (°/h)"), unit_of("r")) == (
        "min",
        "°/h",
        "",
    )
    assert math.isclose(read_typed("90 min", unit_of("duration (h)")), 1.5)
