"""Limits that a search keeps although nobody gave them to it: of the scenario, and by default."""

import math
from collections.abc import Sequence

from navcore.design.measures import Objective, Requirement, Setting, read_requirement
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.quantities import searched
from navcore.scenario.requirement import Requirement as Limit

DEFAULT_LIMITS = {
    "settling_s<=4h": ("settling_s", "damping_ratio"),
    "growth_per_s<=1.2e-5": ("growth_per_s",),
}
"""Limits, each unless one of the quantities beside it is limited or made small.

An initial tilt is gone after three Schuler periods, and no mode grows by e within a day.
"""


_NO_LONGER, _AT_LEAST_S = 2.0, 4.0 * HOUR
"""Times that the heading may take longer to settle than it does now, and how long it may take in any case."""


def heading_limit(settings: Sequence[Setting]) -> list[Requirement]:
    """Limit the heading's settling to twice what it is, where an azimuth loop holds it; else nothing.

    Parameters
    ----------
    settings : sequence of Setting
        The present setting on each ship: the longest settling counts.
    """
    now = max(setting.heading_settling_s for setting in settings)
    if not math.isfinite(now):
        return []
    limit = max(_NO_LONGER * now, _AT_LEAST_S)
    name = "heading_settling_s"
    text = Text("heading_settling_s<={hours:.3g}h", hours=limit / HOUR, limited=name, si=limit)
    return [Requirement(text, name, "<=", limit)]


def own_limits(requirements: Sequence[Limit], given: Sequence[Requirement]) -> list[Requirement]:
    """Limits of a scenario that a search can keep and that are not given anew.

    A limit of one run is kept as that of the ensemble of runs, where there is one.
    """
    again = {one.name for one in given}
    rows = ((searched(one.quantity), one) for one in requirements)
    return [
        Requirement.of(row.key, one.sense, one.limit_si)
        for row, one in rows
        if row is not None and row.key not in again
    ]


def left_to_runs(requirements: Sequence[Limit]) -> tuple[str, ...]:
    """Quantities that the scenario limits and no search can measure: runs alone judge them."""
    return tuple(one.quantity for one in requirements if searched(one.quantity) is None)


def require_consistent(limits: Sequence[Requirement]) -> None:
    """Refuse two limits of one quantity that no value keeps; raises `InputError`."""
    for upper in limits:
        for lower in limits:
            opposed = upper.name == lower.name and (upper.sense, lower.sense) == ("<=", ">=")
            if opposed and lower.limit > upper.limit:
                reason = Text("contradicts {other}: leave one of the two out", other=upper.text)
                raise InputError(Fault("", "--require", lower.text, reason))


def limits_by_default(objective: Objective, limits: Sequence[Requirement]) -> list[Requirement]:
    """Those of `DEFAULT_LIMITS` whose quantities are neither limited nor made small."""
    names = {*objective.names, *(one.name for one in limits)}
    return [read_requirement(text) for text, others in DEFAULT_LIMITS.items() if not names & {*others}]


def without_defaults(defaults: Sequence[Requirement]) -> str:
    """Say that a search did without its default limits."""
    texts = ", ".join(one.text for one in defaults)
    return Text("no setting within these ranges keeps {texts}: searched without", texts=texts)
