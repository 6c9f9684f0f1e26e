"""Limits that a search keeps although nobody gave them to it: of the scenario, and by default."""

from collections.abc import Sequence

from navcore.design.measures import Objective, Requirement, read_requirement
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from navcore.scenario.requirement import OF_THE_SETTING

DEFAULT_LIMITS = {
    "settling_s<=4h": ("settling_s", "damping_ratio"),
    "growth_per_s<=1.2e-5": ("growth_per_s", "earth_mode_growth_per_s", "h_slope_s"),
}
"""Limits, each unless one of the quantities beside it is limited or made small.

An initial tilt is gone after three Schuler periods, and no mode grows by e within a day.
"""


def own_limits(scenario: Scenario, given: Sequence[Requirement]) -> list[Requirement]:
    """Limits of the scenario on settling and growth that are not given anew."""
    known = {*OF_THE_SETTING} - {one.name for one in given}
    own = [one for one in scenario.requirement if one.quantity in known]
    return [read_requirement(f"{one.quantity}{one.sense}{one.limit_si!r}") for one in own]


def limits_by_default(objective: Objective, limits: Sequence[Requirement]) -> list[Requirement]:
    """Those of `DEFAULT_LIMITS` whose quantities are neither limited nor made small."""
    names = {*objective.names, *(one.name for one in limits)}
    return [read_requirement(text) for text, others in DEFAULT_LIMITS.items() if not names & {*others}]


def without_defaults(defaults: Sequence[Requirement]) -> str:
    """Say that a search did without its default limits."""
    texts = ", ".join(one.text for one in defaults)
    return Text("no setting within these ranges keeps {texts}: searched without", texts=texts)
