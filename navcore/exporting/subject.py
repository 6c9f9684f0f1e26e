"""What is exported: one method of a scenario at one rate."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from navcore.analysis.held_log import held_log
from navcore.engine.drivers.common import law_of, network_of
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR
from navcore.law.law import Law
from navcore.networks.base import LinearNetwork
from navcore.scenario.file import names_files
from navcore.scenario.frozen import frozen
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

REPLAYED_H = 24.0
MOST_ROWS = 86_400
"""Calls in the vectors: 24 h at 1 Hz; a faster law replays a shorter time."""


@dataclass(frozen=True)
class Subject:
    """A method that is exported.

    Attributes
    ----------
    scenario : Scenario
        With this method alone; its steps are calls of the law, it lasts as long as the vectors.
    index : int
        Place of the method in the scenario as given.
    rate_hz : float
        Calls a second.
    """

    scenario: Scenario
    index: int
    rate_hz: float

    @property
    def method(self) -> Method:
        """The method."""
        return self.scenario.method[0]

    @property
    def step_s(self) -> float:
        """Time between two calls, s."""
        return self.scenario.law_step_s

    @property
    def calls(self) -> int:
        """Calls in the vectors."""
        return self.scenario.steps + 1

    @cached_property
    def network(self) -> LinearNetwork:
        """H(s) in force."""
        return network_of(self.scenario, self.method)

    def law(self) -> Law:
        """Return the law, ready for its first call."""
        return law_of(self.method, self.network, self.step_s)


def chosen(scenario: Scenario, wanted: str) -> int:
    """Return the place of a method that is given by its name or number.

    Raises
    ------
    InputError
        There is none of that name or number, or none was given where the scenario has several.
    """
    names = [method.label() for method in scenario.method]
    if not wanted and len(names) == 1:
        return 0
    if wanted in names:
        return names.index(wanted)
    if wanted.isdecimal() and int(wanted) < len(names):
        return int(wanted)
    listed = ", ".join(f'{i}: "{name}"' for i, name in enumerate(names))
    allowed = Text("must be the name or the number of a method: {listed}", listed=listed)
    raise InputError(Fault("", "--method", wanted or None, allowed))


def subject_of(
    scenario: Scenario, wanted: str = "", rate_hz: float | None = None, hours: float = REPLAYED_H
) -> Subject:
    """Make the subject of an export.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    wanted : str
        Name or number of the method; may be empty where there is only one.
    rate_hz : float, optional
        Calls a second; default that of the scenario's law.
    hours : float
        Time that the vectors replay, h; recordings last as long as they last.

    Raises
    ------
    InputError
        There is no such method, or it cannot run at this rate.
    """
    index = chosen(scenario, wanted)
    step_s = scenario.law_step_s if rate_hz is None else 1.0 / rate_hz
    if names_files(scenario):
        hours = min(scenario.run.duration_h, hours)
    duration_h = min(hours, MOST_ROWS * step_s / HOUR)
    one = frozen(scenario).canonical()
    method = one["method"][index]
    one["method"], one["view"] = [method], {}
    one.pop("requirement", None)
    one["run"] |= {"step_s": step_s, "output_step_s": step_s, "duration_h": duration_h}
    try:
        made = Scenario.parse(one)
    except InputError as error:
        raise InputError(_at_this_rate(fault, rate_hz, index) for fault in error.faults) from None
    subject = Subject(made, index, 1.0 / made.law_step_s)
    _require_stable(subject)
    return subject


def _at_this_rate(fault: Fault, rate_hz: float | None, index: int) -> Fault:
    """A fault that the rate has made is told of the rate."""
    if rate_hz is None:
        return fault
    if fault.field in ("run.step_s", "run.duration_h"):
        return Fault("", "--rate", rate_hz, Text("must be >= 0.1 and <= 200 (Hz)"))
    field = fault.field.replace("method.0", f"method.{index}", 1)
    allowed = Text(
        "is a rate that the method cannot run at: {field} {allowed}", field=field, allowed=fault.allowed
    )
    return Fault("", "--rate", rate_hz, allowed)


def _require_stable(subject: Subject) -> None:
    """Refuse a law whose sampled level loop is unstable at its rate.

    Raises
    ------
    InputError
        Names the rate from which it is stable, where there is one.
    """
    kind = subject.method.kind
    if not kind.uses_network:
        return
    acting, scenario, step_s = kind.acting(subject.network), subject.scenario, subject.step_s
    lat, period_s = scenario.site.lat_deg * DEG, step_s
    if kind.referenced and scenario.reference.kind == "log":
        period_s = max(1.0 / scenario.reference.rate_hz, step_s)

    sampled = held_log(acting, period_s, step_s, lat, scenario.earth)
    if sampled.stable or not sampled.warnings:  # a loop that is unstable at any rate is told, not refused
        return
    remedy = Text("choose a slower network")
    if sampled.stable_up_to_s is not None and sampled.stable_up_to_s >= 1.0 / period_s:
        remedy = Text("give at least {rate:.3g} Hz", rate=1.0 / sampled.stable_up_to_s)
    allowed = Text(
        "is a rate that the network cannot carry: called every {step_s:g} s with a log every {period_s:g} s "
        "the loop is unstable; {remedy}",
        step_s=step_s,
        period_s=sampled.log_period_s,
        remedy=remedy,
    )
    raise InputError(Fault("", "--rate", subject.rate_hz, allowed))


def hold_calls(hold_s: float, step_s: float) -> int:
    """Calls for which a sample counts while none comes."""
    return max(0, math.floor(hold_s / step_s + 1e-9))
