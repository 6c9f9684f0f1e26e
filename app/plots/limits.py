"""Limits in words, as the page writes them: label, sign, value and unit."""

from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from schuler_bench.plots.units import number

SIGNS = {"<=": "≤", ">=": "≥"}
_KINDS = {
    "tilt": Text("tilt"),
    "velocity": Text("velocity error"),
    "heading": Text("heading error"),
    "position": Text("position error"),
}


def short_label(key: str) -> str:
    """Name of a limited quantity without what it is judged of: over seeds it is not of one run.

    Examples
    --------
    >>> short_label("tilt_max_arcsec"), short_label("settling_s")
    ('largest tilt', 'settling')
    """
    row = QUANTITIES[key]
    if row.kind is None:
        return row.label
    what = _KINDS[row.kind.name]
    if row.statistic == "max_abs":
        return Text("largest {what}", what=what)
    return Text("{what} at the end", what=what) if row.statistic == "final" else Text("{what} RMS", what=what)


def limit_words(key: str, limit: float, label: str = "") -> str:
    """Limit (SI) of a quantity as the tab Requirements has it, with its own label or another one."""
    quantity = QUANTITIES[key]
    return Text(
        "{label} {sign} {amount}",
        label=label or quantity.label,
        sign=SIGNS[quantity.sense],
        amount=amount(key, limit),
    )


def amount(key: str, value: float) -> str:
    """Value (SI) of a quantity with the unit in which it is shown."""
    shown, in_unit = QUANTITIES[key].shown, number(value / QUANTITIES[key].size, 4)
    return Text("{value} {unit}", value=in_unit, unit=shown) if shown else in_unit
