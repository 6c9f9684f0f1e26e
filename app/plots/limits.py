"""Limits in words, as the page writes them: label, sign, value and unit."""

from navcore.foundation.text import Text
from navcore.foundation.units import UNITS
from navcore.quantities import QUANTITIES
from navcore.scenario.requirement import Requirement
from schuler_bench.plots.units import number

SIGNS = {"<=": "≤", ">=": "≥"}
_KINDS = {
    "tilt": Text("tilt"),
    "velocity": Text("velocity error"),
    "heading": Text("heading error"),
    "position": Text("position error"),
    "seclat": Text("heading error × cos L"),
    "roll": Text("roll error"),
    "pitch": Text("pitch error"),
}
"""By kind, or by the axis of the ship."""


def short_label(key: str) -> str:
    """Name of a limited quantity without what it is judged of: over seeds it is not of one run.

    Examples
    --------
    >>> short_label("tilt_max_arcsec"), short_label("settling_s")
    ('largest tilt', 'settling')
    """
    row = QUANTITIES[key]
    if row.kind is None or "seeds" in row.names:
        return row.label
    what = _KINDS[row.axes if row.axes in _KINDS else row.kind.name]
    if row.statistic == "max_abs":
        return Text("largest {what}", what=what)
    return Text("{what} at the end", what=what) if row.statistic == "final" else Text("{what} RMS", what=what)


def limit_words(key: str, limit: float, label: str = "") -> str:
    """Limit (SI) of a quantity as Requirements (tab Limits) has it, with its own label or another one."""
    quantity = QUANTITIES[key]
    return Text(
        "{label} {sign} {amount}",
        label=label or quantity.label,
        sign=SIGNS[quantity.sense],
        amount=amount(key, limit),
    )


def requirement_words(one: Requirement) -> str:
    """Limit as Requirements (tab Limits) has it, with its share and times."""
    limit = limit_words(one.quantity, one.limit_si, short_label(one.quantity))
    if isinstance(one.at_most, str):
        words = {"label": short_label(one.quantity), "sign": SIGNS[one.sense], "amount": one.at_most}
        limit = Text("{label} {sign} {amount}", **words)
    parts = [limit]
    if one.share is not None:
        parts.append(Text("for {share:g} % of the seeds", share=100.0 * one.share))
    if one.at_h is not None:
        parts.append(Text("at {hours:g} h", hours=one.at_h))
    if one.from_h and QUANTITIES[one.quantity].kind is not None:
        parts.append(Text("from {hours:g} h", hours=one.from_h))
    return Text.joined(" ", parts)


def amount(key: str, value: float) -> str:
    """Limit (SI) of a quantity with the unit in which it is shown."""
    shown = QUANTITIES[key].limit_shown
    in_unit = number(value / UNITS[shown], 4)
    return Text("{value} {unit}", value=in_unit, unit=shown) if shown else in_unit
