"""The best setting of a method: a bounded global search with a local finish, by scipy (theory.md 18)."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from navcore.analysis.whole_system import duration
from navcore.design.confirm import Confirmed, confirmed
from navcore.design.default_limits import limits_by_default, own_limits, without_defaults
from navcore.design.measures import (
    TUNING_INTERVALS,
    Objective,
    Requirement,
    Setting,
    Ship,
    in_words,
    measure,
    over_run,
    read_objective,
    read_requirement,
)
from navcore.design.search import (
    ALONG,
    BOUNDLESS,
    EXPLAIN,
    MISSED,
    REFUSED,
    STEADY,
    UNSTABLE,
    Effort,
    Search,
    no_method,
)
from navcore.design.unmodelled import unmodelled_warnings
from navcore.design.vary import Varied, present, read_varied
from navcore.foundation.errors import Fault, InputError, UnstableError
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES, Judged
from navcore.scenario.model import Scenario

_SEARCH_SHARE = 0.8
"""Of the time that a search takes with its confirmation."""
_FLAT = 1.05
_GAIN = 1e-4
"""Relative gain without a requirement from which it counts as holding the optimum back."""


@dataclass(frozen=True)
class Tuned:
    """Result of a search.

    Attributes
    ----------
    best : dict of float
        Value of each varied field.
    objective : float
        At the best setting, SI (of a sum: relative).
    before : float or None
        At the present setting; None where that makes no method or has no finite value.
    floor : float or None
        Least that any damping can reach; None where the objective has none.
    at_end_of_range : tuple of str
        Fields that stand at an end of their range: the true optimum may lie outside.
    active : tuple of str
        Requirements that hold the optimum back.
    cost : dict of float
        Objective without each active requirement.
    flat : dict of (float, float)
        Range of each field, the others held, within which the objective is at most 5 % above the best.
    stopped : bool
        The search was cancelled: the best so far.
    warnings : tuple of str
        What the objective does not see of the best setting: a mode of the whole system that grows, a
        recording that counts as free of error.
    judged : {"steady", "ensemble"}
        What root mean squares are of.
    default_limits : tuple of str
        Limits that were kept because none of their quantity was given.
    confirmed : Confirmed or None
        Both settings in runs; None where that was not asked for.
    scenario : Scenario
        With the best setting in place.
    """

    best: dict[str, float]
    objective: float
    before: float | None
    floor: float | None
    at_end_of_range: tuple[str, ...]
    active: tuple[str, ...]
    cost: dict[str, float]
    flat: dict[str, tuple[float, float]]
    stopped: bool
    warnings: tuple[str, ...]
    judged: Judged
    default_limits: tuple[str, ...]
    scenario: Scenario = field(repr=False)
    confirmed: Confirmed | None = None

    def as_dict(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        return {
            "best": self.best,
            "objective": self.objective,
            "before": self.before,
            "floor": self.floor,
            "at_end_of_range": list(self.at_end_of_range),
            "active": list(self.active),
            "cost": self.cost,
            "flat": {name: list(ends) for name, ends in self.flat.items()},
            "stopped": self.stopped,
            "default_limits": list(self.default_limits),
            "warnings": list(self.warnings),
            **({} if self.confirmed is None else {"confirmed": self.confirmed.as_dict()}),
        }


def tune(
    scenario: Scenario,
    objective: str,
    vary: Sequence[str],
    require: Sequence[str] = (),
    *,
    along: bool = False,
    worst_of: Sequence[Scenario] = (),
    default_limits: bool = True,
    confirm: bool = False,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Tuned:
    """Find the parameters of a method that make an objective least while requirements are kept.

    Parameters
    ----------
    scenario : Scenario
        With the method.
    objective : str
        One of `navcore.quantities.OBJECTIVES`, or a weighted sum, ``tilt_rms + 0.5*velocity_rms``,
        whose terms count relative to their values before.
    vary : sequence of str
        Fields, ``method.1.network.sigma`` or with a range ``method.1.network.sigma=1e-4:0.1``.
    require : sequence of str
        Limits, ``settling_s<=3600``. The scenario's own limits on settling and growth count too.
    along : bool
        Root mean squares over the scenario's run; else in the steady state at rest. Heading and position,
        and a method whose policy re-tunes its network, have no steady state and are always over the run.
    worst_of : sequence of Scenario
        Further scenarios in whose same method the parameters are put too: the worst of all counts.
    default_limits : bool
        Keep `navcore.design.default_limits.DEFAULT_LIMITS` of what nothing limits; where no setting keeps
        them, the search does without them, and says so.
    confirm : bool
        Run the present setting and the proposal on 32 seeds of the scenario.
    progress, cancelled : callable, optional
        Told the fraction done, 0..1; when ``cancelled`` says True the best so far is given.

    Raises
    ------
    InputError
        A field must not vary or is set by the policy, a range or requirement is wrong, or no setting meets
        all requirements.
    UnstableError
        The level loop of every setting is unstable as it is sampled, or the proposal diverges in a run.

    Examples
    --------
    >>> from navcore import load, tune
    >>> found = tune(load("sikuliaq-like"), "tilt_rms", ["method.1.network.xi=0.1:5"]) # doctest: +SKIP
    """
    wanted, limits = read_objective(objective), [read_requirement(text) for text in require]
    limits += own_limits(scenario, limits)
    varied = read_varied(scenario, vary)
    judged = scenario.method[varied[0].method]
    along = along or over_run((*wanted.names, *(one.name for one in limits))) or judged.policy.tunes
    ships = [Ship(one, along, TUNING_INTERVALS) for one in (scenario, *worst_of)]
    _check(ships, varied, wanted)
    defaults = limits_by_default(wanted, limits) if default_limits else []
    part = _SEARCH_SHARE if confirm and progress is not None else 1.0
    told = None if progress is None else lambda fraction: progress(part * fraction)
    search = Search(ships, varied, wanted, [*limits, *defaults], told, cancelled)
    start, before = _begin(search)
    if before == 0.0 and all(QUANTITIES[name].kind for name in wanted.names):
        reason = Text("is 0 as it is: the scenario has no error that a setting could make smaller")
        raise InputError(Fault("", "--objective", wanted.text, reason))
    effort = ALONG if along else STEADY
    stopped = search.run(effort, start)
    left = ()
    if defaults and not stopped and search.best is not None and MISSED <= search.best[0] < UNSTABLE:
        left = (without_defaults(defaults),)
        search.requirements, defaults = tuple(limits), []
        stopped = search.run(effort, start)
    best = search.best
    if best is None or best[0] >= REFUSED:
        if stopped:
            raise InputError(
                Fault("", "--vary", None, Text("the search was stopped before it found a setting"))
            )
        raise InputError(list(no_method(search, ", ".join(vary))))
    if best[0] >= UNSTABLE:
        reason = Text("no setting within these ranges is stable: {unstable}", unstable=search.unstable)
        raise UnstableError(Fault("", "--vary", ", ".join(vary), reason))
    if best[0] >= MISSED:
        raise InputError(list(_nothing_meets(search, ALONG if along else EXPLAIN, start)))
    found = _result(search, best[1], before, effort, stopped)
    found = replace(
        found, default_limits=tuple(one.text for one in defaults), warnings=(*left, *found.warnings)
    )
    if not confirm or stopped:
        return found
    return _confirmed(found, scenario, varied[0].method, wanted, part, progress, cancelled)


def _confirmed(
    found: Tuned,
    scenario: Scenario,
    index: int,
    objective: Objective,
    part: float,
    progress: Callable[[float], None] | None,
    cancelled: Callable[[], bool] | None,
) -> Tuned:
    """Add what runs say of the proposal."""
    told = None if progress is None else lambda fraction: progress(part + (1.0 - part) * fraction)
    pair = scenario.method[index], found.scenario.method[index]
    result = confirmed(scenario, *pair, progress=told, cancelled=cancelled)
    if result is None:
        return replace(found, stopped=True)
    verdicts = (result.verdict(name) for name in objective.names)
    return replace(found, confirmed=result, warnings=(*filter(None, verdicts), *found.warnings))


def _check(ships: Sequence[Ship], varied: Sequence[Varied], objective: Objective) -> None:
    """Refuse a further scenario without the same parameters, and sensors that make every setting alike."""
    for number, ship in enumerate(ships[1:], 1):
        for one in varied:
            try:
                read_varied(ship.scenario, [f"{one.field}={one.low!r}:{one.high!r}"])
            except InputError as error:
                faults = (Text("{value} {allowed}", value=f.value, allowed=f.allowed) for f in error.faults)
                reason = Text.joined("; ", faults)
                raise InputError(
                    Fault("", "--worst-of", Text("scenario {number}", number=number), reason)
                ) from None
    noisy = any(QUANTITIES[name].kind for name in objective.names)
    if noisy and not ships[0].along_run and ships[0].model.silent:
        reason = Text(
            "imu and reference have no random error, so every setting gives 0: ask for the run (along)"
        )
        raise InputError(Fault("", "--objective", objective.text, reason))


def _begin(search: Search) -> tuple[np.ndarray | None, float | None]:
    """Place and objective of the present setting; also fixes the scales of the objective."""
    values = present(search.ships[0].scenario, search.varied)
    try:
        settings = [Setting(ship, ship.scenario.method[search.varied[0].method]) for ship in search.ships]
        search.reference = {
            name: max(measure(setting, name) for setting in settings) for name in search.objective.names
        }
        before = search.value(settings)
    except (InputError, np.linalg.LinAlgError):
        before = math.inf
    if math.isfinite(before) and before > 0.0:
        search.scale = before
    start = None
    if np.all(np.isfinite(values)):
        start = np.array([one.place(value) for one, value in zip(search.varied, values, strict=True)])
    return start, before if math.isfinite(before) else None


def _result(search: Search, places: np.ndarray, before: float | None, effort: Effort, stopped: bool) -> Tuned:
    values = search.values(places)
    settings = search.settings(places)
    objective = search.value(settings)
    active = [one for one in search.requirements if any(one.active(setting) for setting in settings)]
    cost, flat = {}, {}
    if not stopped:
        flat = _flat(search, places, objective)
        for one in active:
            rest = [other for other in search.requirements if other is not one]
            cost[one.text] = _without(search, rest, effort, places)
        # at its limit by chance: without it the optimum would stay where it is
        holding = [one for one in active if cost[one.text] < objective - _GAIN * abs(objective)]
        active = holding or active
        cost = {one.text: cost[one.text] for one in active}
    kind = QUANTITIES[search.objective.names[0]].kind
    floor = None
    if len(search.objective.terms) == 1 and kind is not None:
        floors = [getattr(one.ship.floor(one.method), kind.figure) for one in settings]
        floor = max((value for value in floors if value is not None), default=None)
    scenario = search.ships[0].scenario
    index = search.varied[0].method
    methods = tuple(settings[0].method if i == index else method for i, method in enumerate(scenario.method))
    return Tuned(
        best={one.field: value for one, value in zip(search.varied, values, strict=True)},
        objective=objective,
        before=before,
        floor=floor,
        at_end_of_range=tuple(
            one.field for one, value in zip(search.varied, values, strict=True) if one.at_end(value)
        ),
        active=tuple(one.text for one in active),
        cost=cost,
        flat=flat,
        stopped=stopped,
        warnings=tuple(dict.fromkeys(text for setting in settings for text in _unseen(setting))),
        judged="ensemble" if search.ships[0].along_run else "steady",
        default_limits=(),
        scenario=scenario.model_copy(update={"method": methods}),
    )


def _unseen(setting: Setting) -> Iterator[str]:
    """Whole system and unmodelled errors, of which a measure of one channel says nothing."""
    growth = setting.growth_per_s
    if growth > 0.0 and setting.whole.stable:
        every = duration(1.0 / growth)
        yield Text("whole system: it grows as it is sampled, by e every {every}", every=every)
    yield from (
        *setting.whole.warnings,
        *unmodelled_warnings(setting.ship.scenario, not setting.ship.along_run),
    )


def _without(search: Search, rest: Sequence[Requirement], effort: Effort, start: np.ndarray | None) -> float:
    """Objective that could be reached with fewer requirements."""
    other = Search(search.ships, search.varied, search.objective, rest, None, search.cancelled)
    other.reference, other.scale = search.reference, search.scale
    other.run(effort, start)
    if other.best is None or other.best[0] >= MISSED:  # stopped at once, or nothing meets the rest
        return math.inf
    return other.best[0] * other.scale


def _flat(search: Search, places: np.ndarray, objective: float) -> dict[str, tuple[float, float]]:
    """Range of each field in which the objective stays within 5 % of the best, the others held."""
    quiet = Search(search.ships, search.varied, search.objective, search.requirements)
    quiet.reference, quiet.scale = search.reference, search.scale
    limit = _FLAT * objective / search.scale
    ranges = {}
    for i, one in enumerate(search.varied):
        ends = []
        for end in (0.0, 1.0):
            inside, outside = float(places[i]), end
            trial = places.copy()
            trial[i] = end
            if quiet.cost(trial) <= limit:
                ends.append(one.value(end))
                continue
            for _ in range(9):
                trial[i] = 0.5 * (inside + outside)
                if quiet.cost(trial) <= limit:
                    inside = float(trial[i])
                else:
                    outside = float(trial[i])
            ends.append(one.value(inside))
        ranges[one.field] = (ends[0], ends[1])
    return ranges


def _nothing_meets(search: Search, effort: Effort, start: np.ndarray | None) -> Iterator[Fault]:
    """Yield a fault for each requirement: what is the best of it alone, and what it costs."""
    for one in search.requirements:
        reach = _reach(search, one, effort, start)
        rest = [other for other in search.requirements if other is not one]
        without = _without(search, rest, effort, start)
        if math.isfinite(without):
            least = in_words(search.objective.text, without)
            left = Text("without it {text} comes to {least}", text=search.objective.text, least=least)
        else:
            left = Text("without it the others are not met either")
        reason = Text(
            "nothing within these ranges meets all requirements: alone {name} comes to", name=one.name
        )
        yield Fault(
            "",
            "--require",
            one.text,
            Text("{reason} {in_words}; {left}", reason=reason, in_words=in_words(one.name, reach), left=left),
        )


def _reach(search: Search, one: Requirement, effort: Effort, start: np.ndarray | None) -> float:
    """Least value of a measure alone, or the largest where a requirement asks for at least something."""
    sign = 1.0 if one.sense == "<=" else -1.0

    class _Alone(Search):
        def value(self, settings: Sequence[Setting]) -> float:
            return max(sign * measure(setting, one.name) for setting in settings)

    alone = _Alone(search.ships, search.varied, search.objective, ())
    alone.run(effort, start)
    assert alone.best is not None
    return sign * alone.best[0] if alone.best[0] < BOUNDLESS else math.inf
