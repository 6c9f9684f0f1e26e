"""Limits in words, as the page writes them: label, sign, value and unit."""

from navcore.design.measures import read_requirement
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from schuler_bench.plots.units import number

SIGNS = {"<=": "≤", ">=": "≥"}


def requirement_words(text: str) -> str:
    """Limit of a search as the tab Requirements has it.

    Examples
    --------
    >>> requirement_words("settling_s<=3600")
    'settling ≤ 60 min'
    """
    requirement = read_requirement(text)
    return limit_words(requirement.name, requirement.limit)


def limit_words(key: str, limit: float) -> str:
    """Limit (SI) of a quantity as the tab Requirements has it."""
    quantity = QUANTITIES[key]
    return Text(
        "{label} {sign} {amount}",
        label=quantity.label,
        sign=SIGNS[quantity.sense],
        amount=amount(key, limit),
    )


def amount(key: str, value: float) -> str:
    """Value (SI) of a quantity with the unit in which it is shown."""
    shown, in_unit = QUANTITIES[key].shown, number(value / QUANTITIES[key].size, 4)
    return Text("{value} {unit}", value=in_unit, unit=shown) if shown else in_unit
