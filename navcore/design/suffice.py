"""Which sensors suffice: the largest gyro bias and log bias with which a method still meets its limits.

The same seeds are run for every pair of biases, so that more of a bias is never better by chance. The edge of
what suffices is found by bisection: first each bias by itself, then the log's for several of the gyros'.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.design.run_shares import run_shares
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.errors import Fault, InputError, StoppedError
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from navcore.sensors.data_sheets import data_sheets

_LARGEST = (100.0, 10.0)
"""Biases up to which is searched, deg/h and m/s."""
_SMALLEST = 1e-5
"""Part of the largest from which on a bias is told from none."""
_STEPS, _FINE = 11, 6
"""Bisections of a bias by itself (of its logarithm), and of the log's beside one of the gyros'."""
_SHARES = (0.4, 0.7, 0.9)
"""Of the largest gyro bias, at which the log's is looked for."""
_RUNS = 3 + 2 * _STEPS + len(_SHARES) * _FINE


@dataclass(frozen=True)
class Sufficing(Answer):
    """Pairs of biases at the edge of what suffices.

    Attributes
    ----------
    method : str
        Name of the method.
    share : float
        Part of the seeds that must meet all limits.
    seeds : int
        Number of seeds.
    without : float
        Share with neither bias.
    family : tuple of (float, float)
        Standard deviations of gyro bias (deg/h) and log bias (m/s), from none of the first to none of the
        second; empty where even without them the share is missed.
    """

    method: str
    share: float
    seeds: int
    without: float
    family: tuple[tuple[float, float], ...]

    def log_bias(self, gyro_bias: float) -> float | None:
        """Largest log bias (m/s) beside a gyro bias (deg/h); None where no log suffices."""
        if not self.family or gyro_bias > self.family[-1][0]:
            return None
        gyro, log = np.array(self.family).T
        return float(np.interp(gyro_bias, gyro, log))

    def parts(self) -> list[tuple[str, float, float | None, list[str]]]:
        """Give each IMU of the list, its gyro bias, the log bias that it leaves, and the logs within it."""
        sheets = data_sheets().values()
        logs = {one.name: bias for one in sheets if (bias := one.values.get("bias_std_mps")) is not None}
        found: list[tuple[str, float, float | None, list[str]]] = []
        for one in sheets:
            gyro = one.values.get("gyro_bias_std_dph")
            if gyro is not None:
                left = self.log_bias(gyro)
                inside = [name for name, bias in logs.items() if left is not None and bias <= left]
                found.append((one.name, gyro, left, inside))
        return found

    def document(self) -> dict[str, Any]:
        """Return what ``--json`` prints."""
        return {
            "method": self.method,
            "share": self.share,
            "seeds": self.seeds,
            "share_without_biases": self.without,
            "family": [{"gyro_bias_dph": gyro, "log_bias_mps": log} for gyro, log in self.family],
            "parts": [
                {"imu": name, "gyro_bias_dph": gyro, "log_bias_mps": left, "logs": inside}
                for name, gyro, left, inside in self.parts()
            ],
        }

    def rows(self) -> Iterator[Table | str]:
        """Give the family, and the parts that fall in it."""
        yield Text(
            "{method}: biases (standard deviations) with which {share:g} % of {seeds} seeds meet all limits",
            method=self.method,
            share=100.0 * self.share,
            seeds=self.seeds,
        )
        if not self.family:
            yield Text(
                "none: without gyro bias and log bias {without:g} % meet them, for the other errors",
                without=100.0 * self.without,
            )
            return
        yield Table((Column(Text("gyro bias"), "°/h"), Column(Text("log bias up to"), "m/s")), self.family)
        heads = Column("IMU"), Column(Text("gyro bias"), "°/h"), Column(Text("log bias up to"), "m/s")
        rows = [
            (name, gyro, Text("none suffices") if left is None else left, ", ".join(inside))
            for name, gyro, left, inside in self.parts()
        ]
        yield Table((*heads, Column(Text("logs within it"))), tuple(rows))
        yield Text("Of a part only its bias counts here; choose it to see what its other figures do.")


def suffice(
    scenario: Scenario,
    method: int,
    share: float,
    seeds: int,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Sufficing:
    """Find the pairs of biases at the edge of what suffices.

    Parameters
    ----------
    scenario : Scenario
        With limits; all its other errors stay as they are.
    method : int
        Which of its methods.
    share : float
        Part of the seeds that must meet all limits.
    seeds : int
        Number of seeds.
    progress : callable, optional
        Told the fraction done, 0..1.
    cancelled : callable, optional
        Asked between runs.

    Raises
    ------
    InputError
        There is no such method, or there are no limits.
    StoppedError
        It was cancelled.
    """
    if method >= len(scenario.method):
        allowed = Text("must be < {methods}, the number of methods", methods=len(scenario.method))
        raise InputError(Fault("--method", "", method, allowed))
    one = scenario.model_copy(update={"method": (scenario.method[method],)})
    done = 0

    def share_of(gyro: float, log: float) -> float:
        nonlocal done
        found = run_shares(with_biases(one, gyro, log), seeds, cancelled=cancelled)
        if not found or (cancelled is not None and cancelled()):
            raise StoppedError(Fault("", "", None, Text("stopped")))
        done += 1
        if progress is not None:
            progress(min(done / _RUNS, 1.0))
        return float(found[0].as_dict()["met"])

    def largest(meets: Callable[[float], bool], high: float, steps: int, *, by_ratio: bool) -> float:
        low = high * _SMALLEST if by_ratio else 0.0
        if by_ratio and meets(high):
            return high
        for _ in range(steps):
            middle = float(np.sqrt(low * high)) if by_ratio else 0.5 * (low + high)
            low, high = (middle, high) if meets(middle) else (low, middle)
        return low

    without = share_of(0.0, 0.0)
    name = one.method[0].name
    if without < share:
        return Sufficing(name, share, seeds, without, ())
    gyro = largest(lambda bias: share_of(bias, 0.0) >= share, _LARGEST[0], _STEPS, by_ratio=True)
    log = largest(lambda bias: share_of(0.0, bias) >= share, _LARGEST[1], _STEPS, by_ratio=True)
    family = [(0.0, log)]
    for part in _SHARES:
        own = part * gyro
        beside = largest(lambda bias, own=own: share_of(own, bias) >= share, log, _FINE, by_ratio=False)
        family.append((own, beside))
    return Sufficing(name, share, seeds, without, (*family, (gyro, 0.0)))


def with_biases(scenario: Scenario, gyro_dph: float, log_mps: float) -> Scenario:
    """Return a scenario whose gyro biases and log biases have other standard deviations."""
    return scenario.model_copy(
        update={
            "imu": scenario.imu.model_copy(update={"gyro_bias_std_dph": gyro_dph}),
            "reference": scenario.reference.model_copy(update={"bias_std_mps": log_mps}),
        }
    )
