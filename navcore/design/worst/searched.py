"""The worst log that a search finds for a method whose law looks at the data: found, not proven.

It begins with logs of a known structure: the worst of the loop while it is damped, in several sizes, steps,
and square waves. Then it varies the best log of each error: times, signs and sizes of its pieces.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from navcore.design.seeds import alone
from navcore.design.worst.logs import Axis, LogError, steps
from navcore.design.worst.weights import Weights
from navcore.engine.drivers.kalman import Gains
from navcore.engine.drivers.linear import carried_out
from navcore.engine.environment import environment
from navcore.mechanization.recorder import MAX_ABS
from navcore.quantities import COMPONENTS
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.sensors.true_state import horizontal_state, to_navigation

_STEPS = 16_000_000
"""Of all runs of a search together; it has at least `_LEAST` runs and at most `_MOST`."""
_LEAST, _MOST = 120, 1000
_FORMS = ((1.0, math.inf), (1.0, 1e-3), (1.0, 3e-4), (0.5, math.inf), (0.5, 1e-3))
"""Sizes of the worst logs of the damped loop, and rates at which they change, 1/s: a smaller or slower one
may keep the loop damped for longer."""
_TOGETHER = 2
"""Logs that are played at the same time."""
_PERIODS = (0.5, 1.0, 2.0, 4.0)
"""Of square waves, over the Schuler period."""
_SEED = 58
_SHIFTS_S = (30.0, 300.0, 1500.0)
_LONGEST_S = 7200.0
"""Of a new piece."""


@dataclass(frozen=True, eq=False)
class Pattern:
    """A log of pieces: times at which each axis goes to another level, and the levels, -1 to 1.

    Attributes
    ----------
    times, levels : (ndarray, ndarray)
        One a piece, the first at 0, s.
    rate : float
        At which a level is left for the next one, 1/s; infinite: at once.
    """

    times: tuple[np.ndarray, np.ndarray]
    levels: tuple[np.ndarray, np.ndarray]
    rate: float = math.inf

    def error(self, log_max: float, log_rate: float | None) -> LogError:
        """Return the log's error: levels times ``log_max`` (m/s), reached within ``log_rate`` (m/s^2)."""
        rate = min(log_max * self.rate, math.inf if log_rate is None else log_rate)
        bound = rate if math.isfinite(rate) else None
        axes: list[Axis] = []
        for times, levels in zip(self.times, self.levels, strict=True):
            axes.append(steps(times, log_max * levels, bound))
        return LogError((axes[0], axes[1]), bound is not None)

    def with_axis(self, axis: int, times: np.ndarray, levels: np.ndarray) -> Pattern:
        """Return it with another axis; pieces are put in order, and of equal times the last one stays."""
        order = np.argsort(times, kind="stable")
        times, levels = times[order], levels[order]
        kept = np.append(np.diff(times) > 0.0, True)
        both = [*self.times], [*self.levels]
        both[0][axis], both[1][axis] = times[kept], levels[kept]
        return Pattern((both[0][0], both[0][1]), (both[1][0], both[1][1]), self.rate)


@dataclass(frozen=True, eq=False)
class Found:
    """Largest magnitude of each error and the log that makes it, for `navcore.quantities.COMPONENTS`.

    Attributes
    ----------
    largest : ndarray, shape (7,)
        rad, m/s, m; infinite where the method diverges.
    logs : tuple of LogError
    runs : int
        Of the search.
    """

    largest: np.ndarray
    logs: tuple[LogError, ...]
    runs: int


class Player:
    """Plays logs to a method on the linear error model, in a scenario where nothing else errs.

    Parameters
    ----------
    scenario : Scenario
        Of `navcore.design.worst.played.silent`.
    method : Method
        One of its methods.
    told : Scenario
        What a Kalman filter knows of: the scenario with its errors.
    """

    def __init__(self, scenario: Scenario, method: Method, told: Scenario) -> None:
        self._scenario, self._method = alone(scenario, method), method
        self._told = alone(told, method)
        self._environment = environment(self._scenario)
        self._gains = Gains() if method.kind.carrying == "filter" else None
        log, truth = self._environment.reference, self._environment.truth_half
        self._heading = horizontal_state(truth, log.time_s)[1] if log.body_frame else None
        counts = np.ones(len(log.time_s), dtype=bool)
        counts[log.moored if log.moored.size else slice(0)] = False
        self._counts = counts[:, None]
        self.time_s = log.time_s

    @property
    def steps(self) -> int:
        """Steps of a run."""
        return self._environment.steps

    def largest(self, error: np.ndarray) -> np.ndarray:
        """Largest magnitude of each error in a run, shape (7,); infinite where it diverges.

        Parameters
        ----------
        error : ndarray, shape (m, 2)
            Of the log at its epochs ``time_s``, in its own axes, m/s.
        """
        if self._heading is not None:
            error = to_navigation(error, self._heading)
        env, log = self._environment, self._environment.reference
        played = np.ascontiguousarray(log.error + error * self._counts)
        env = replace(env, reference=replace(log, error=played))
        run, _, status, _ = carried_out(
            self._told, self._method, env, np.zeros(7), lambda _: None, None, self._gains
        )
        if status != "ok":
            return np.full(len(COMPONENTS), math.inf)
        return run.recorder.stats[: len(COMPONENTS), MAX_ABS].copy()


def searched(
    player: Player,
    known: Sequence[Weights],
    period_s: float,
    log_max: float,
    log_rate: float | None,
    progress: Callable[[float], None],
    cancelled: Callable[[], bool],
) -> Found:
    """Search for the worst log of each error.

    Parameters
    ----------
    player : Player
        Plays a log.
    known : sequence of Weights
        Of the loop while it is damped, at several times; none where there is no such loop.
    period_s : float
        Schuler period, s.
    log_max, log_rate
        As of `navcore.design.worst.logs.worst_log`.
    progress, cancelled : callable
        Told the fraction done; asked between runs.
    """
    runs = int(np.clip(_STEPS / max(player.steps, 1), _LEAST, _MOST))
    largest = np.zeros(len(COMPONENTS))
    none = Pattern((np.zeros(1), np.zeros(1)), (np.zeros(1), np.zeros(1)))
    best = [none] * len(COMPONENTS)
    end_s = float(player.time_s[-1])
    generator = np.random.default_rng(_SEED)
    structured = _structured(known, period_s, end_s)
    done = 0

    def play(pattern: Pattern) -> np.ndarray:
        return player.largest(pattern.error(log_max, log_rate).at(player.time_s))

    with ThreadPoolExecutor(_TOGETHER) as pool:
        while done < runs and not cancelled():
            some = [
                next(structured, None) or _varied(best[(done + j) % len(best)], end_s, generator)
                for j in range(_TOGETHER if done else 1)  # the first alone: a filter's gains are kept
            ]
            for pattern, values in zip(some, pool.map(play, some), strict=True):
                for k in np.flatnonzero(values > largest).tolist():
                    largest[k], best[k] = values[k], pattern
            done += len(some)
            progress(min(done / runs, 1.0))
    return Found(largest, tuple(pattern.error(log_max, log_rate) for pattern in best), done)


def _structured(known: Sequence[Weights], period_s: float, end_s: float) -> Iterator[Pattern]:
    zero = np.zeros(1)
    for place, weights in enumerate(known):
        for size, rate in _FORMS if place == 0 else _FORMS[:2]:
            for of in weights.of:
                yield _by_signs(of, weights.begin_s, size, rate)
    for e, n in ((1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, -1.0)):
        yield Pattern((zero, zero), (np.array([e]), np.array([n])))
    for share in _PERIODS:
        half = 0.5 * share * period_s
        at = np.arange(0.0, end_s, half)
        levels = np.where(np.arange(len(at)) % 2, -1.0, 1.0)
        for later in (0.0, 0.5 * half):
            yield Pattern((at, np.append(0.0, at[1:] - later)), (levels, levels))


def _by_signs(weights: np.ndarray, begin_s: np.ndarray, size: float, rate: float) -> Pattern:
    """Return the worst log of a sum as pieces."""
    times, levels = [], []
    for axis in weights.T:
        sign = np.sign(axis)
        kept = np.concatenate([[True], np.diff(sign) != 0.0])
        times.append(begin_s[kept])
        levels.append(size * sign[kept])
    return Pattern((times[0], times[1]), (levels[0], levels[1]), rate)


def _varied(pattern: Pattern, end_s: float, generator: np.random.Generator) -> Pattern:
    """Return a pattern with some pieces of one axis changed."""
    axis = int(generator.integers(2))
    times, levels = pattern.times[axis].copy(), pattern.levels[axis].copy()
    way, place = int(generator.integers(7)), int(generator.integers(len(times)))
    if way == 0:
        times[place] += generator.normal() * float(generator.choice(_SHIFTS_S))
    elif way == 1:
        levels[place] = float(generator.choice([-levels[place], 0.0, generator.uniform(-1.0, 1.0)]))
    elif way == 2:
        begin = generator.uniform(0.0, end_s)
        end = begin + min(_LONGEST_S, end_s) ** generator.uniform(0.5, 1.0)
        after = levels[np.searchsorted(times, end, side="right") - 1]
        inside = (times > begin) & (times <= end)
        level = float(generator.choice([-1.0, 1.0, generator.uniform(-1.0, 1.0)]))
        times = np.concatenate([times[~inside], [begin, end]])
        levels = np.concatenate([levels[~inside], [level, after]])
    elif way == 3 and len(times) > 1:
        times, levels = np.delete(times, place), np.delete(levels, place)
    elif way == 4:
        levels = np.clip(levels * generator.uniform(0.3, 2.0), -1.0, 1.0)
    elif way == 5:
        rate = min(pattern.rate, 1e-2) * float(generator.uniform(0.3, 3.0))
        pattern = replace(pattern, rate=math.inf if rate > 1e-2 else rate)
    else:
        times[times >= times[place]] += generator.normal() * float(generator.choice(_SHIFTS_S))
    within = np.clip(times, 0.0, end_s)
    within[np.argmin(within)] = 0.0
    return pattern.with_axis(axis, within, levels)
