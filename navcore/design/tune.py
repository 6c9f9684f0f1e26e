"""The best setting of a method: a bounded global search with a local finish, by scipy (theory.md 18)."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from navcore.design.confirm import confirmed
from navcore.design.default_limits import (
    heading_limit,
    limits_by_default,
    own_limits,
    require_consistent,
    without_defaults,
)
from navcore.design.limits_cost import flat_ranges, nothing_meets, without_limits
from navcore.design.measures import (
    TUNING_INTERVALS,
    Objective,
    Requirement,
    Setting,
    Ship,
    growing,
    over_run,
    read_objective,
    read_requirement,
)
from navcore.design.search import (
    ALONG,
    EXPLAIN,
    MISSED,
    REFUSED,
    STEADY,
    UNSTABLE,
    Effort,
    Search,
    no_method,
)
from navcore.design.stated import assumed_zero
from navcore.design.tuned import Tuned
from navcore.design.unmodelled import unmodelled_warnings
from navcore.design.vary import Varied, present, read_varied
from navcore.foundation.errors import Fault, InputError, StoppedError, UnstableError
from navcore.foundation.progress import part_of
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES, components
from navcore.scenario.model import Scenario

_GAIN = 1e-4
"""Relative gain without a requirement from which it counts as holding the optimum back."""


def tune(
    scenario: Scenario,
    objective: str,
    vary: Sequence[str],
    require: Sequence[str | Requirement] = (),
    *,
    along: bool = False,
    whole: bool = False,
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
        Limits, ``settling_s<=3600``. The scenario's own limits count too, where none is given of their
        quantity: those of one run as limits of what the objective is judged of.
    along : bool
        Root mean squares over the scenario's run; else in the steady state at rest. Heading and position,
        and a method whose policy re-tunes its network, have no steady state and are always over the run.
    whole : bool
        Fields without a range are searched in all that they allow, not only what their sliders reach.
    worst_of : sequence of Scenario
        Further scenarios in whose same method the parameters are put too: the worst of all counts.
    default_limits : bool
        Keep `navcore.design.default_limits.DEFAULT_LIMITS` of what nothing limits; where no setting keeps
        them, the search does without them, and says so.
    confirm : bool
        Run the present setting and the proposal on 32 seeds of the scenario. A proposal of the steady state
        that is no better there, or diverges, gives way to one that is searched over the run and is better.
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
    wanted = read_objective(objective)
    limits = [read_requirement(one) if isinstance(one, str) else one for one in require]
    limits += own_limits(scenario.requirement, limits)
    require_consistent(limits)
    if scenario.on_ins:
        scenario = _on_ins(scenario, wanted, limits)
    varied = read_varied(scenario, vary, whole)
    index = varied[0].method
    along = along or over_run((*wanted.names, *(one.name for one in limits)))
    along = along or scenario.method[index].policy.tunes or scenario.on_ins
    confirm = confirm and not scenario.on_ins
    defaults = limits_by_default(wanted, limits) if default_limits else []

    def searched(over_the_run: bool, begin: float, end: float) -> Tuned:
        ships = [Ship(one, over_the_run, TUNING_INTERVALS) for one in (scenario, *worst_of)]
        _check(ships, varied, wanted)
        return _searched(
            Search(ships, varied, wanted, limits, part_of(progress, begin, end), cancelled), defaults
        )

    def in_runs(found: Tuned, begin: float, end: float) -> Tuned:
        return (
            found
            if found.stopped
            else _confirmed(found, scenario, index, wanted, part_of(progress, begin, end), cancelled)
        )

    def offered(found: Tuned) -> Tuned:
        return _offered(found, scenario, varied)

    if not confirm:
        return searched(along, 0.0, 1.0)
    if along:
        return offered(in_runs(searched(True, 0.0, 0.8), 0.8, 1.0))
    steady, diverging = searched(False, 0.0, 0.3), None
    try:
        steady = in_runs(steady, 0.3, 0.4)
    except UnstableError as error:
        diverging = error
    if diverging is None and (steady.stopped or _gains(steady)):
        return steady
    try:
        over = in_runs(searched(True, 0.4, 0.9), 0.9, 1.0)
    except InputError as error:
        if diverging is not None:
            raise diverging from None
        return offered(replace(steady, stopped=isinstance(error, StoppedError)))
    if diverging is None and (over.stopped or _after(over, wanted) >= _after(steady, wanted)):
        return offered(replace(steady, stopped=over.stopped))
    note = Text(
        "the best setting of the steady state is no better in the runs; this is the best over the run"
    )
    return offered(replace(over, warnings=(note, *over.warnings)))


def _on_ins(scenario: Scenario, objective: Objective, limits: Sequence[Requirement]) -> Scenario:
    """Return a scenario on a recorded INS as a search takes it; refuse errors that no reference tells.

    Every setting is run on the recording itself, and there are no seeds to confirm it on.
    """
    from navcore.engine.drivers.outside import settled, unknown_errors

    placed = settled(scenario)
    unknown = unknown_errors(placed)
    for name in (*objective.names, *(one.name for one in limits)):
        kind = QUANTITIES[name].kind
        if kind is not None and unknown.intersection(components(kind)):
            told = Text("is not known on this recording: a [truth] that holds it is needed")
            raise InputError(Fault("", "--objective", name, told))
    return placed


def _searched(search: Search, defaults: Sequence[Requirement]) -> Tuned:
    """Search under the limits of a search and those by default, or without these where nothing keeps them."""
    wanted, limits = search.objective, search.requirements
    start, before = _begin(search)
    settings = search.now()
    missed = bool(settings) and search.excess(settings) > 0.0
    asked = {one.name for one in limits} | {*wanted.names}
    if any(one.name == "settling_s" for one in defaults) and "heading_settling_s" not in asked:
        defaults = (*defaults, *heading_limit(settings))
    search.requirements = (*limits, *defaults)
    if before == 0.0 and all(QUANTITIES[name].kind for name in wanted.names):
        reason = Text("is 0 as it is: the scenario has no error that a setting could make smaller")
        raise InputError(Fault("", "--objective", wanted.text, reason))
    along = search.ships[0].along_run
    effort = ALONG if along else STEADY
    stopped = search.run(effort, start)
    left = ()
    if defaults and not stopped and search.best is not None and MISSED <= search.best[0] < UNSTABLE:
        left = (without_defaults(defaults),)
        search.requirements, defaults = limits, ()
        stopped = search.run(effort, start)
    best, vary = search.best, ", ".join(one.field for one in search.varied)
    if stopped and (best is None or best[0] >= MISSED):
        reason = Text("the search was stopped before it found a setting that meets all limits")
        raise StoppedError(Fault("", "--vary", vary, reason))
    if best is None or best[0] >= REFUSED:
        raise InputError(list(no_method(search, vary)))
    if best[0] >= UNSTABLE:
        reason = Text("no setting within these ranges is stable: {unstable}", unstable=search.unstable)
        raise UnstableError(Fault("", "--vary", vary, reason))
    if best[0] >= MISSED:
        raise InputError(list(nothing_meets(search, ALONG if along else EXPLAIN, start)))
    found = _result(search, best[1], before, effort, stopped)
    kept = tuple(one.text for one in defaults)
    every = (*limits, *defaults)
    warnings = (*left, *found.warnings)
    return replace(found, default_limits=kept, limits=every, warnings=warnings, repairs=missed)


def _confirmed(
    found: Tuned,
    scenario: Scenario,
    index: int,
    objective: Objective,
    progress: Callable[[float], None] | None,
    cancelled: Callable[[], bool] | None,
) -> Tuned:
    """Add what runs say of the proposal."""
    pair = scenario.method[index], found.scenario.method[index]
    result = confirmed(scenario, *pair, terms=objective.terms, progress=progress, cancelled=cancelled)
    if result is None:
        return replace(found, stopped=True)
    said = dict.fromkeys((*filter(None, map(result.verdict, objective.names)), *result.worse()))
    return replace(found, confirmed=result, warnings=(*said, *found.warnings))


def _offered(found: Tuned, scenario: Scenario, varied: Sequence[Varied]) -> Tuned:
    """Take a proposal back that is no proven gain: the setting stays as it is.

    A gain is an objective that is smaller in the runs beyond chance, a given limit that is kept and was
    missed, or, of an objective that runs do not measure, a smaller value.
    """
    if found.stopped or found.confirmed is None or found.repairs or _gains(found):
        return found
    now = present(scenario, varied)
    best = {one.field: float(x) for one, x in zip(varied, now, strict=True) if math.isfinite(x)}
    refused = found.best
    note = Text("no proposal: none has a proven gain in the runs; the setting stays as it is")
    objective = found.objective if found.before is None else found.before
    return replace(
        found, best=best, refused=refused, objective=objective, scenario=scenario, offered=False,
        at_end_of_range=(), active=(), cost={}, flat={}, warnings=(note, *found.warnings),
    )  # fmt: skip


def _gains(found: Tuned) -> bool:
    """Whether the objective is smaller after a proposal: in the runs beyond chance, else by its own value."""
    assert found.confirmed is not None
    proven = found.confirmed.gains
    if proven is None:
        return found.before is None or found.objective < found.before * (
            1.0 - math.copysign(_GAIN, found.before)
        )
    return proven


def _after(found: Tuned, objective: Objective) -> float:
    """Objective in the runs after a proposal, each term over its value before."""
    assert found.confirmed is not None
    changes = found.confirmed.changes
    terms = ((changes[name], weight) for name, weight in objective.terms if name in changes)
    return sum(weight * one.after / one.before for one, weight in terms if one.after and one.before)


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
    model = ships[0].model
    constant = any(np.any(bias) for bias in (model.gyro_bias, model.accel_bias, model.log_bias))
    if noisy and not ships[0].along_run and model.silent and not constant:
        reason = Text(
            "imu and reference have no random error and no bias, so every setting gives 0: "
            "ask for the run (along)"
        )
        raise InputError(Fault("", "--objective", objective.text, reason))


def _begin(search: Search) -> tuple[np.ndarray | None, float | None]:
    """Place and objective of the present setting; also fixes the scales of the objective."""
    values = present(search.ships[0].scenario, search.varied)
    try:
        settings = search.now()
        search.reference = search.objective.reference(settings)
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
        flat = flat_ranges(search, places, objective)
        for one in active:
            rest = [other for other in search.requirements if other is not one]
            cost[one.text] = without_limits(search, rest, effort, places)
        # at its limit by chance: without it the optimum would stay where it is
        holding = [one for one in active if cost[one.text] < objective - _GAIN * abs(objective)]
        active = holding or active
        cost = {one.text: cost[one.text] for one in active}
    kind = QUANTITIES[search.objective.names[0]].kind
    floor = None
    if len(search.objective.terms) == 1 and kind is not None:
        floors = [getattr(one.ship.floor(one.method), kind.figure) for one in settings]
        floor = max((value for value in floors if value is not None), default=None)
    scenario = search.ships[0].given
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
        assumed_zero=assumed_zero(scenario, not search.ships[0].along_run),
        of=search.objective.text,
    )


def _unseen(setting: Setting) -> Iterator[str]:
    """Whole system and unmodelled errors, of which a measure of one channel says nothing."""
    yield from growing(setting)
    yield from setting.ship.recordings.notes
    yield from unmodelled_warnings(setting.ship.scenario, not setting.ship.along_run)
