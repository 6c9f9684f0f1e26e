"""Whether a value sent by a browser fits its control."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.bridge.controls import Control

_LONGEST_SHOWN = 60


def why_not(control: Control, value: object, longest_text: int) -> str | None:
    """Say what is wrong with a value; None when it fits.

    viser casts with the type of the held value, so that 7.9 would become 7 in a whole-number control and any
    text would become True in a checkbox: types are compared before that.

    Parameters
    ----------
    control : Control
        The control and the value it holds.
    value : object
        As decoded from the message.
    longest_text : int
        Characters a text may have.

    Returns
    -------
    str or None
        A phrase that follows "must": ``be from 0 to 1``.
    """
    held = control.value
    if isinstance(held, tuple):
        return _why_not_tuple(control, held, value, longest_text)
    return _why_not_scalar(control, held, value, longest_text)


def shown(value: object) -> str:
    """Return a value for a message to the visitor, shortened."""
    text = value if isinstance(value, str) else repr(value)
    return text if len(text) <= _LONGEST_SHOWN else text[: _LONGEST_SHOWN - 3] + "..."


def _why_not_tuple(control: Control, held: Sequence[object], value: object, longest_text: int) -> str | None:
    if not isinstance(value, (list, tuple)) or len(value) != len(held):
        return f"have {len(held)} values"
    reasons = (_why_not_scalar(control, old, new, longest_text) for old, new in zip(held, value, strict=True))
    return next((reason for reason in reasons if reason is not None), None)


def _why_not_scalar(control: Control, held: object, value: object, longest_text: int) -> str | None:
    if isinstance(held, bool):
        return None if isinstance(value, bool) else "be on or off"
    if isinstance(held, str):
        return _why_not_text(control, value, longest_text)
    if isinstance(held, (int, float)):
        return _why_not_number(control, isinstance(held, int), value)
    return "not be set in this way"


def _why_not_text(control: Control, value: object, longest_text: int) -> str | None:
    if not isinstance(value, str):
        return "be text"
    if control.options is not None and value not in control.options:
        return "be one of the choices offered"
    return None if len(value) <= longest_text else f"have at most {longest_text} characters"


def _why_not_number(control: Control, whole: bool, value: object) -> str | None:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        return "be a number"
    if whole and value != math.floor(value):
        return "be a whole number"
    if control.bounds is not None:
        low, high = control.bounds
        # Browsers compute min + k * step in binary: the last step may lie a rounding error beyond the end.
        slack = 1e-9 * (abs(low) + abs(high))
        if not low - slack <= value <= high + slack:
            return f"be from {low:g} to {high:g}"
    return None
