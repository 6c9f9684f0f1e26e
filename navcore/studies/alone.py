"""What one error source does to one method: its RMS alone, at the pace of the method's loop.

The shares of the sources are told in per cent. A loop with the Schuler period does not need steps of a
second for that: sensor errors and log are averaged over longer steps, which are short against the fastest
pole of the loop. Truth, coefficients and law are made once for all sources.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import replace
from functools import cached_property

import numpy as np

from navcore.analysis.loop import closed_loop_poles
from navcore.engine.drivers.common import law_of, network_of, seen_by
from navcore.engine.environment import Environment, environment
from navcore.engine.simulation import simulate
from navcore.foundation.stage_cache import kept
from navcore.law.law import Law
from navcore.mechanization.error_model import ErrorModelRun
from navcore.mechanization.recorder import NAMES, SUM_SQUARES, make_recorder
from navcore.mechanization.trajectory import Coefficients, named, table_of
from navcore.networks.base import LinearNetwork
from navcore.scenario.model import Method, Scenario
from navcore.sensors.base import ReferenceErrors, SensorErrors

_PHASE = 0.04
"""Phase of the fastest pole in one step, rad: what the hold of the correction delays is half of it."""
_FEWEST_STEPS, _LONGEST_STRIDE = 1500, 32
_CHUNK = 50_000

Cancelled = Callable[[], bool]


class Alone:
    """One method, ready to be run with one source after another.

    Parameters
    ----------
    scenario : Scenario
        Of fidelity ``channel`` or ``error_model``, as set.
    method : Method
        One of its methods.
    """

    def __init__(self, scenario: Scenario, method: Method) -> None:
        self._scenario, self._method = scenario, method
        self._network: LinearNetwork | None = None
        self._laws: dict[int, Law] = {}
        if method.damping not in ("averaging", "kalman"):
            self._network = network_of(scenario, method)

    def rms(self, part: Scenario, key: Hashable, cancelled: Cancelled) -> np.ndarray:
        """RMS over the run with the errors of ``part`` alone, shape (8,), rad, m/s, m.

        Parameters
        ----------
        part : Scenario
            The scenario with one source (`navcore.studies.sources.only`).
        key : hashable or None
            What the errors depend on; None: they are not kept.
        cancelled : callable
            When it says True, the run stops and the RMS is of what was reached.
        """
        method = next(one for one in part.method if one.name == self._method.name)
        if self._network is None:
            (run,) = simulate(part.model_copy(update={"method": (method,)}), cancelled=cancelled).methods
            return np.array([run.errors[name]["rms"] for name in NAMES])
        stride = self._stride
        if stride == 1:
            env = environment(part)
            log = seen_by(method, env.reference)
        elif key is None or method.event:
            env, log = _coarse(part, method, stride)
        else:
            env, log = kept(("alone", key, stride), lambda: _coarse(part, method, stride))
        return self._run(env, log, np.array(part.initial_error.state()), stride, cancelled)

    @cached_property
    def _stride(self) -> int:
        """Steps of the scenario in one step here: 1 where the law decides by what it measures."""
        assert self._network is not None
        law = self._law(1)
        if self._method.damping == "internal" or not (self._method.undamped or law.p["steady"]):
            return 1
        poles = np.abs(closed_loop_poles(self._network))
        fastest = self._network.omega_s * float(np.max(poles, initial=1.0))
        fitting = int(_PHASE / (fastest * self._scenario.run.step_s))
        return max(1, min(fitting, self._scenario.steps // _FEWEST_STEPS, _LONGEST_STRIDE))

    def _law(self, stride: int) -> Law:
        assert self._network is not None
        if stride not in self._laws:
            self._laws[stride] = law_of(self._method, self._network, stride * self._scenario.run.step_s)
        p, s, ring = self._laws[stride]
        return Law(p, s.copy(), ring.copy())

    def _run(
        self, env: Environment, log: ReferenceErrors, x: np.ndarray, stride: int, cancelled: Cancelled
    ) -> np.ndarray:
        step_s = stride * self._scenario.run.step_s
        recorder = make_recorder(env.steps, step_s, max(env.steps * step_s, step_s))
        run = ErrorModelRun(
            step_s=step_s, steps=env.steps, coefficients=env.coefficients, sensors=env.sensors,
            reference=log, law=self._law(stride), x=x, recorder=recorder,
        )  # fmt: skip
        while not run.advance(_CHUNK) and not cancelled():
            pass
        count = max(int(recorder.cursor["count"]), 1)
        return np.sqrt(recorder.stats[:, SUM_SQUARES] / count)


def _coarse(part: Scenario, method: Method, stride: int) -> tuple[Environment, ReferenceErrors]:
    """Inputs for steps that are ``stride`` times as long: means over each."""
    env, step_s = environment(part), part.run.step_s
    steps = env.steps // stride
    sensors = SensorErrors(*(_means(a, steps, stride) for a in (env.sensors.gyro, env.sensors.accel)))
    c = env.coefficients
    half = c.half if len(c.half) == 1 else _smooth(c.half, steps, stride)
    law = c.law if len(c.law) == 1 else np.ascontiguousarray(c.law[: steps * stride + 1 : stride])
    coarse = replace(env, steps=steps, sensors=sensors, coefficients=Coefficients(half, law))
    return coarse, _log_means(seen_by(method, env.reference), steps, stride * step_s)


def _means(values: np.ndarray, steps: int, stride: int) -> np.ndarray:
    if len(values) == 1:
        return values
    return values[: steps * stride].reshape(steps, stride, -1).mean(axis=1)


def _smooth(half: np.ndarray, steps: int, stride: int) -> np.ndarray:
    """Coefficients each half of the longer steps: means around them, so that a swing is not sampled."""
    table = table_of(half)
    total = np.concatenate([np.zeros((1, table.shape[1])), np.cumsum(table, axis=0)])
    middle = np.arange(2 * steps + 1) * stride
    low = np.maximum(middle - stride // 2, 0)
    high = np.minimum(middle + stride // 2 + 1, len(table))
    return named((total[high] - total[low]) / (high - low)[:, None])


def _log_means(log: ReferenceErrors, steps: int, step_s: float) -> ReferenceErrors:
    """The log at the longer steps: mean of its valid epochs within each; a slower log stays as it is."""
    if len(log.time_s) < 2 or float(np.median(np.diff(log.time_s))) >= 0.5 * step_s:
        return log
    at = np.floor(log.time_s / step_s + 1e-9).astype(np.int64)
    count = np.bincount(at, weights=log.valid, minlength=steps + 1)[: steps + 1]
    sums = [np.bincount(at, weights=log.error[:, i] * log.valid, minlength=steps + 1) for i in (0, 1)]
    error = np.column_stack([part[: steps + 1] for part in sums]) / np.maximum(count, 1.0)[:, None]
    times = np.arange(steps + 1) * step_s
    return ReferenceErrors(times, error, count > 0.0, log.body_frame, max(log.hold_s, step_s))
