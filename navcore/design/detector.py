"""A policy judged as a detector of a log that cannot be trusted: missed and false switches, delay, ROC.

The truth is known in a simulation: an event of the log is under way, or its error exceeds a bound. A policy
sees neither. What it does is counted over many seeds (Fawcett 2006, "An introduction to ROC analysis", for
the words and the curve).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from navcore.engine.ensemble import drawn
from navcore.engine.environment import environment
from navcore.engine.verdicts import wilson
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.errors import Fault, InputError, StoppedError
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR

if TYPE_CHECKING:
    from navcore.engine.run import Run
    from navcore.scenario.method import Method
    from navcore.scenario.model import Scenario

_DAMPED = 1
_FACTORS = 0.1, 10.0
"""Range by which the thresholds of a policy are multiplied for its curve."""


@dataclass(frozen=True)
class Counts:
    """How often a detector was right and wrong; counts of several runs add up.

    Attributes
    ----------
    events, missed : int
        Intervals in which the log was wrong, and those in which damping was never off.
    false_switches : int
        Times at which damping went off while the log was right.
    delays_s : tuple of float
        From the beginning of each event that was found until damping was off, s; 0 where it was off already.
    wrong_s, off_wrong_s : float
        Time in which the log was wrong, and the part of it in which damping was off, s.
    right_s, off_right_s : float
        The same for the time in which it was right.
    """

    events: int = 0
    missed: int = 0
    false_switches: int = 0
    delays_s: tuple[float, ...] = ()
    wrong_s: float = 0.0
    off_wrong_s: float = 0.0
    right_s: float = 0.0
    off_right_s: float = 0.0

    def __add__(self, other: Counts) -> Counts:
        """Counts of both."""
        mine, theirs = vars(self), vars(other)
        return Counts(**{name: mine[name] + theirs[name] for name in mine})

    @property
    def hit_rate(self) -> float:
        """Part of the time with a wrong log in which damping is off; NaN where there is no such time."""
        return self.off_wrong_s / self.wrong_s if self.wrong_s else math.nan

    @property
    def false_rate(self) -> float:
        """Part of the time with a right log in which damping is off; NaN where there is no such time."""
        return self.off_right_s / self.right_s if self.right_s else math.nan

    @property
    def false_per_h(self) -> float:
        """False switches an hour of right log; NaN where there is no such time."""
        return self.false_switches * HOUR / self.right_s if self.right_s else math.nan

    @property
    def delay_s(self) -> float:
        """Median of the delays, s; NaN where nothing was found."""
        return float(np.median(self.delays_s)) if self.delays_s else math.nan


def count_switches(
    t_s: np.ndarray, off: np.ndarray, wrong: np.ndarray, used: np.ndarray | None = None, after_s: float = 0.0
) -> Counts:
    """Compare the switches of any detector with the truth.

    Parameters
    ----------
    t_s : ndarray, shape (m,)
        Times, s, increasing.
    off : ndarray of bool, shape (m,)
        Whether the detector has taken the log out: damping is off.
    wrong : ndarray of bool, shape (m,)
        Whether the log is wrong in truth.
    used : ndarray of bool, shape (m,), optional
        Times that count; all by default. Without a log there is nothing to detect.
    after_s : float
        A time after each event, s, that belongs to neither side: a detector may still be off.

    Returns
    -------
    Counts

    Examples
    --------
    >>> t = np.arange(6.0)
    >>> found = count_switches(t, t >= 3.0, t >= 2.0)
    >>> found.missed, found.delays_s, found.false_switches
    (0, (1.0,), 0)
    """
    used = np.ones(len(t_s), bool) if used is None else used
    steps = np.diff(t_s, append=t_s[-1:])
    begins, ends = _stretches(wrong)
    late = np.zeros(len(t_s), bool)
    delays, missed, events = [], 0, 0
    for begin, end in zip(begins, ends, strict=True):
        late |= (t_s >= t_s[min(end, len(t_s) - 1)]) & (t_s < t_s[end - 1] + steps[end - 1] + after_s)
        if not used[begin:end].any():
            continue
        events += 1
        found = np.flatnonzero(off[begin:end] & used[begin:end])
        missed += not found.size
        delays += [float(t_s[begin + found[0]] - t_s[begin])] if found.size else []
    right = used & ~wrong & ~late
    went_off = np.flatnonzero(off[1:] & ~off[:-1]) + 1
    return Counts(
        events=events,
        missed=missed,
        false_switches=int(np.count_nonzero(right[went_off] & used[went_off - 1])),
        delays_s=tuple(delays),
        wrong_s=float(steps[used & wrong].sum()),
        off_wrong_s=float(steps[used & wrong & off].sum()),
        right_s=float(steps[right].sum()),
        off_right_s=float(steps[right & off].sum()),
    )


def _stretches(holds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Begins and ends (behind the last place) of the stretches in which something holds."""
    edges = np.diff(np.concatenate([[0], holds.astype(int), [0]]))
    return np.flatnonzero(edges > 0), np.flatnonzero(edges < 0)


@dataclass(frozen=True)
class Point:
    """One point of the curve: the thresholds multiplied by ``factor``, and what comes of it."""

    factor: float
    hit_rate: float
    false_rate: float


@dataclass(frozen=True)
class Detector:
    """One method whose policy decides.

    Attributes
    ----------
    name, policy : str
        Of the method, and of its policy.
    counts : Counts
        Over all seeds.
    curve : tuple of Point
        By growing thresholds; empty for a policy that has none.
    """

    name: str
    policy: str
    counts: Counts
    curve: tuple[Point, ...] = ()

    @property
    def area(self) -> float | None:
        """Area under the curve: 1 for a perfect detector, 0.5 for chance; None without a curve."""
        if not self.curve:
            return None
        ends = {(0.0, 0.0), (1.0, 1.0)}
        places = sorted(ends | {(one.false_rate, one.hit_rate) for one in self.curve})
        x, y = np.array(places).T
        return float(np.trapezoid(np.maximum.accumulate(y), x))

    def document(self) -> dict[str, Any]:
        """Entry of ``methods``."""
        counts = self.counts
        return {
            "name": self.name,
            "policy": self.policy,
            "events": counts.events,
            "missed": counts.missed,
            "false_switches": counts.false_switches,
            "false_per_h": _finite(counts.false_per_h),
            "delay_median_s": _finite(counts.delay_s),
            "delay_max_s": max(counts.delays_s, default=None),
            "hit_rate": _finite(counts.hit_rate),
            "false_rate": _finite(counts.false_rate),
            "area": self.area,
            "curve": [vars(one) for one in self.curve],
        }


@dataclass(frozen=True)
class Detectors(Answer):
    """Every policy of a scenario as a detector of a wrong log.

    Attributes
    ----------
    wrong_mps : float or None
        The log counts as wrong while its error exceeds this, m/s; None: while an event is under way.
    seeds : int
        Over which was counted.
    methods : tuple of Detector
        Those whose policy decides, in the scenario's order.
    """

    wrong_mps: float | None
    seeds: int
    methods: tuple[Detector, ...]

    def document(self) -> dict[str, Any]:
        """Return what ``--json`` prints."""
        methods = [one.document() for one in self.methods]
        return {"wrong_mps": self.wrong_mps, "seeds": self.seeds, "methods": methods}

    def rows(self) -> Iterator[Table | str]:
        """Give a row a method, then the points of each curve."""
        if self.wrong_mps is None:
            yield Text("the log counts as wrong during its events; {seeds} seeds", seeds=self.seeds)
        else:
            yield Text(
                "the log counts as wrong while its error exceeds {limit:g} m/s; {seeds} seeds",
                limit=self.wrong_mps,
                seeds=self.seeds,
            )
        heads = (
            Column(Text("method")),
            Column(Text("policy"), left=True),
            Column(Text("events")),
            Column(Text("missed")),
            Column(Text("missed, 95 %"), left=True),
            Column(Text("delay"), "s"),
            Column(Text("largest"), "s"),
            Column(Text("false switches"), "1/h"),
            Column(Text("off while wrong"), "%"),
            Column(Text("off while right"), "%"),
            Column(Text("area under ROC")),
        )
        yield Table(heads, tuple(_row(one) for one in self.methods))
        for one in self.methods:
            if one.curve:
                yield Table(
                    (
                        Column(Text("thresholds")),
                        Column(Text("off while right"), "%"),
                        Column(Text("off while wrong"), "%"),
                    ),
                    tuple((f"x {p.factor:.3g}", 100.0 * p.false_rate, 100.0 * p.hit_rate) for p in one.curve),
                    Text("ROC of {name}", name=one.name),
                )


def _row(one: Detector) -> tuple[Any, ...]:
    counts = one.counts
    low, high = wilson(counts.missed, counts.events)
    return (
        one.name,
        one.policy,
        counts.events,
        counts.missed,
        f"{100.0 * low:.0f} - {100.0 * high:.0f} %",
        _finite(counts.delay_s),
        max(counts.delays_s, default=None),
        _finite(counts.false_per_h),
        _finite(100.0 * counts.hit_rate),
        _finite(100.0 * counts.false_rate),
        one.area,
    )


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None


def detectors(
    scenario: Scenario,
    seeds: int,
    points: int,
    wrong_mps: float | None = None,
    after_s: float = 0.0,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Detectors:
    """Judge the policies of a scenario as detectors of a wrong log.

    Parameters
    ----------
    scenario : Scenario
        With a log, and methods whose policy switches.
    seeds : int
        Runs, each with the noise of another seed.
    points : int
        Of each curve; 0 for none.
    wrong_mps : float, optional
        The log is wrong while its error exceeds this, m/s; by default while an event is under way.
    after_s : float
        See `count_switches`.
    progress, cancelled : callable, optional
        Told the fraction done; asked often.

    Raises
    ------
    InputError
        No policy of the scenario switches, or the log is never wrong.
    StoppedError
        It was stopped.
    """
    from navcore.engine.simulation import simulate

    judged = [one for one in scenario.method if _switches(one)]
    if not judged:
        raise InputError(Fault("", "method", None, Text("no method has a policy that switches damping off")))
    if wrong_mps is None and not scenario.reference.event:
        never = Text("the log has no event: give one, or --wrong-mps, the error from which it is wrong")
        raise InputError(Fault("", "reference.event", None, never))
    factors = tuple(np.geomspace(*_FACTORS, points).tolist()) if points else ()
    families = [[(1.0, one), *_with_thresholds(one, factors)] for one in judged]
    methods = tuple(one for family in families for _, one in family)
    found = [Counts() for _ in methods]
    for k in range(seeds):
        run = simulate(_on_every_step(scenario, methods, k), None, cancelled)
        if cancelled is not None and cancelled():
            raise StoppedError(Fault("", "", None, Text("stopped")))
        found = [a + b for a, b in zip(found, _counts(run, wrong_mps, after_s), strict=True)]
        if progress is not None:
            progress((k + 1) / seeds)
    if not found[0].events:
        never = Text("the error of the log never exceeds it")
        raise InputError(Fault("", "--wrong-mps", wrong_mps, never))
    at, gathered = 0, []
    for family in families:
        own, at = found[at : at + len(family)], at + len(family)
        curve = [
            Point(factor, counts.hit_rate, counts.false_rate)
            for (factor, _), counts in zip(family[1:], own[1:], strict=True)
        ]
        gathered.append(Detector(family[0][1].label(), family[0][1].policy.id, own[0], tuple(curve)))
    return Detectors(wrong_mps, seeds, tuple(gathered))


def _switches(method: Method) -> bool:
    """Whether the policy can switch damping off, and does not only tune a loop that stays damped."""
    return not (method.undamped or method.policy.always or method.policy.tunes)


def _with_thresholds(method: Method, factors: Sequence[float]) -> Iterator[tuple[float, Method]]:
    """Give the method with all thresholds of its policy multiplied, where the policy accepts them."""
    policy = method.policy
    for factor in factors if policy.limits() else ():
        block = policy.model_dump(mode="json", exclude_none=True)
        block |= {one.name: factor * getattr(policy, one.name) for one in policy.limits()}
        with suppress(ValueError):  # beyond the range of a threshold
            yield factor, method.model_copy(update={"policy": type(policy).model_validate(block)})


def _on_every_step(scenario: Scenario, methods: tuple[Method, ...], number: int) -> Scenario:
    """Scenario of a seed with these methods, and output rows at every step, without its requirements."""
    one = drawn(scenario, number, stated_only=True)
    run = one.run.model_copy(update={"output_step_s": one.run.step_s})
    return one.model_copy(update={"run": run, "method": methods, "requirement": ()})


def _counts(run: Run, wrong_mps: float | None, after_s: float) -> Iterator[Counts]:
    """Counts of every method of a run."""
    reference, log = run.scenario.reference, environment(run.scenario).reference
    for method in run.methods:
        t = method.t_s
        latest = np.clip(np.searchsorted(log.time_s, t, side="right") - 1, 0, None)
        used = log.valid[latest] & (t - log.time_s[latest] <= log.hold_s)
        if wrong_mps is None:
            wrong = np.any([event.holds(t) for event in reference.event], axis=0)
        else:
            wrong = np.hypot(*log.error[latest].T) > wrong_mps
        yield count_switches(t, method.law_series[:, _DAMPED] < 0.5, wrong, used, after_s)
