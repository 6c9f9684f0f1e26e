"""Quantities of a closed loop: one function for each row of `navcore.quantities` that is judged of a loop."""

import math
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from navcore.analysis.loop import Loop, closed_loop_poles
from navcore.analysis.transfers import Output, Source, time_response
from navcore.analysis.whole_system import WholeSystem
from navcore.analysis.worst_step import WorstStep, worst_step
from navcore.foundation.units import HOUR
from navcore.networks.base import LinearNetwork

_POINTS = 400
_SPANS, _SHORTER = 4, 20.0
"""Spans over which a response is searched, and how many times shorter each is than the one before."""
_SETTLINGS, _LONGEST_S = 2.0, 200.0 * HOUR
_DECAYS = 8.0
"""Time constants of the slowest mode after which it is gone."""
_PERIODS = 6.0
"""Schuler periods over which the response of a loop that never settles is searched."""


class JudgedLoop(NamedTuple):
    """A loop in force.

    Attributes
    ----------
    network : LinearNetwork
        H(s) in force at the site.
    loop : Loop
        Closed loop of one level channel.
    uses_log : bool
        The log drives the loop.
    whole : callable or None
        Returns both channels with heading and latitude at the site; None where nothing of them is asked.
    growth : callable or None
        Returns the growth of the whole system as its law is sampled, 1/s; None where there is none.
    heading_settling : callable or None
        Returns how long the heading takes to settle, s; infinite where nothing holds it.
    """

    network: LinearNetwork
    loop: Loop
    uses_log: bool
    whole: Callable[[], WholeSystem] | None = None
    growth: Callable[[], float | None] | None = None
    heading_settling: Callable[[], float] | None = None


def loop_value(key: str, judged: JudgedLoop) -> float:
    """Value of a quantity of a loop, SI; infinite where there is none.

    Parameters
    ----------
    key : str
        A row of `navcore.quantities.QUANTITIES` that is judged of a loop.
    judged : JudgedLoop
        The loop in force.
    """
    value = _VALUES[key](judged)
    return math.inf if value is None or math.isnan(value) else float(value)


def _extremes(judged: JudgedLoop, source: Source, output: Output) -> tuple[float, float]:
    if not judged.loop.stable:
        return -math.inf, math.inf
    return _searched(judged.network, judged.loop.settling_s, source, output)


@lru_cache(maxsize=256)
def _searched(
    network: LinearNetwork, settling_s: float | None, source: Source, output: Output
) -> tuple[float, float]:
    """Least and largest value of a response (SI): over spans of several lengths, each looked at more finely.

    A slow loop's first peaks lie within Schuler periods, those of its fast modes within seconds, and a log's
    step may excite a slow mode that an initial tilt does not.
    """
    period_s = 2.0 * math.pi / network.omega_s
    slowest = network.omega_s * float(np.min(np.abs(closed_loop_poles(network).real)))
    settled_s = max(_SETTLINGS * settling_s, _DECAYS / slowest) if settling_s and slowest else 0.0
    longest_s = min(settled_s or _PERIODS * period_s, _LONGEST_S)
    spans_s = [longest_s * _SHORTER**-k for k in range(_SPANS)]
    least, largest = zip(
        *(
            _extremes_within(network, source, output, span)
            for span in (*spans_s, min(longest_s, 2.0 * period_s))
        ),
        strict=True,
    )
    return min(least), max(largest)


def _extremes_within(
    network: LinearNetwork, source: Source, output: Output, span_s: float
) -> tuple[float, float]:
    """Least and largest value within a span, each looked at again next to its sample."""
    time_s = np.linspace(0.0, span_s, _POINTS)
    sampled = time_response(network, source, output, time_s)

    def near(at: int) -> np.ndarray:
        ends = time_s[max(at - 1, 0)], time_s[min(at + 1, _POINTS - 1)]
        return time_response(network, source, output, np.linspace(*ends, _POINTS))

    return float(np.min(near(int(np.argmin(sampled))))), float(np.max(near(int(np.argmax(sampled)))))


def _after_log_step(judged: JudgedLoop, output: Output) -> float:
    """Largest magnitude after a step of the log's error by 1 m/s."""
    low, high = _extremes(judged, "dv_r", output)
    return 0.0 if judged.loop.stable and not judged.uses_log else max(-low, high)


def _worst(judged: JudgedLoop) -> WorstStep:
    """Largest errors for a log within 1 m/s."""
    return worst_step(judged.network) if judged.uses_log else WorstStep(0.0, 0.0)


_VALUES: dict[str, Callable[[JudgedLoop], float | None]] = {
    "settling_s": lambda judged: judged.loop.settling_s,
    "overshoot": lambda judged: _after_log_step(judged, "dv"),
    "log_tilt": lambda judged: _after_log_step(judged, "phi"),
    "worst_tilt": lambda judged: _worst(judged).tilt_rad,
    "worst_velocity": lambda judged: _worst(judged).velocity_mps,
    "tilt_overshoot": lambda judged: max(0.0, -_extremes(judged, "initial_tilt", "phi")[0]),
    "damping_ratio": lambda judged: judged.loop.damping_ratio,
    "h0": lambda judged: judged.network.h0,
    "h0_deviation": lambda judged: abs(judged.network.h0 - 1.0),
    "h_slope_s": lambda judged: judged.network.h_slope,
    "earth_mode_growth_per_s": lambda judged: judged.whole().earth_growth if judged.whole else None,
    "growth_per_s": lambda judged: judged.growth() if judged.growth else None,
    "heading_settling_s": lambda judged: judged.heading_settling() if judged.heading_settling else None,
}
