"""Whether a value fits its control: nothing is cast, nothing is cut."""

from __future__ import annotations

import math

import pytest

from app.bridge.controls import Control
from app.http.frames import shown, why_not


def control(held: object, **changes: object) -> Control:
    given = {"disabled": False, "options": None, "bounds": None, "takes_files": False} | changes
    return Control(label="x", value=held, **given)


SLIDER = control(0.5, bounds=(0.0, 1.0))
CHOICE = control("a", options=("a", "b"))


@pytest.mark.parametrize(
    ("held", "value"),
    [
        (SLIDER, 0),
        (SLIDER, 1.0),
        (SLIDER, 1.0 + 1e-12),
        (control(0.5), 1e300),
        (control(0.5), -5),
        (control(3), 7),
        (control(3), 7.0),
        (CHOICE, "b"),
        (control("t"), "<img onerror=1>"),
        (control(True), False),
        (control((1.0, 2.0)), [3, 4.5]),
    ],
)
def test_fits(held: Control, value: object) -> None:
    assert why_not(held, value, 100) is None


@pytest.mark.parametrize(
    ("held", "value", "reason"),
    [
        (SLIDER, 1.001, "be from 0 to 1"),
        (SLIDER, 1e9, "be from 0 to 1"),
        (SLIDER, -5, "be from 0 to 1"),
        (SLIDER, math.nan, "be a number"),
        (control(0.5), math.inf, "be a number"),
        (control(0.5), "0.5", "be a number"),
        (control(0.5), True, "be a number"),
        (control(0.5), None, "be a number"),
        (control(0.5), [0.5], "be a number"),
        (control(3), 7.5, "be a whole number"),
        (control(3), 2**70, None),
        (CHOICE, "c", "be one of the choices offered"),
        (CHOICE, 1, "be text"),
        (control("t"), "x" * 101, "have at most 100 characters"),
        (control(True), 1, "be on or off"),
        (control(True), "yes", "be on or off"),
        (control((1.0, 2.0)), [1.0], "have 2 values"),
        (control((1.0, 2.0)), "12", "have 2 values"),
        (control((1.0, 2.0)), [1.0, math.nan], "be a number"),
        (control(b"file"), b"file", "not be set in this way"),
    ],
)
def test_does_not_fit(held: Control, value: object, reason: str | None) -> None:
    assert why_not(held, value, 100) == reason


def test_long_values_are_shown_short() -> None:
    assert len(shown("x" * 1000)) == 60
    assert shown(math.nan) == "nan"
