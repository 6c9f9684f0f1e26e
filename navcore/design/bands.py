"""The standard deviation of every method's errors along a run: what a band under its error curves shows.

By covariance where the law is known in advance, by the filter's own covariance for a Kalman filter, and not
at all where the law looks at the data (theory.md 15, 16).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from navcore.design.along import along
from navcore.design.constants import shared_columns
from navcore.design.course import Course, course
from navcore.design.filter import filter_variance
from navcore.design.scheduled import scheduled_times
from navcore.design.seeds import no_covariance
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import StochasticModel, stochastic_model

Kind = Literal["covariance", "filter", "none"]


@dataclass(frozen=True, eq=False)
class Band:
    """Standard deviation of one method along the run.

    Attributes
    ----------
    kind : {"covariance", "filter", "none"}
        Covariance of all sources together, a Kalman filter's own covariance, or no band.
    sigma : ndarray, shape (m, 7), or None
        For `navcore.design.along.QUANTITIES`, in rad, m/s and m; None without a band.
    reason : str
        Why there is no band; empty when there is one.
    """

    kind: Kind
    sigma: np.ndarray | None = None
    reason: str = ""


@dataclass(frozen=True, eq=False)
class Bands:
    """Bands of all methods of a scenario.

    Attributes
    ----------
    t_s : ndarray, shape (m,)
        Times, s.
    methods : tuple of Band
        In the scenario's order.
    """

    t_s: np.ndarray
    methods: tuple[Band, ...]


def covariance_bands(
    scenario: Scenario,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Bands | None:
    """Standard deviations of every method along the scenario's motion.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked; a strapdown scenario is taken by the error model along its motion.
    progress : callable, optional
        Told the fraction done, 0..1, after each method.
    cancelled : callable, optional
        Asked before each method.

    Returns
    -------
    Bands or None
        None when it was cancelled.

    Raises
    ------
    InputError
        The motion cannot be carried out.
    """
    model = stochastic_model(scenario)
    times = tuple(time for method in scenario.method for time in scheduled_times(method))
    way = course(scenario, extra_s=times)
    columns = shared_columns(scenario, way, model)
    found: list[Band] = []
    for method in scenario.method:
        if cancelled is not None and cancelled():
            return None
        if method.damping == "kalman":
            found.append(_own(scenario, way, model))
        else:
            reason = no_covariance(scenario, method)
            found.append(
                Band("none", reason=reason)
                if reason
                else _band("covariance", along(scenario, method, way, model, columns).total)
            )
        if progress is not None:
            progress(len(found) / len(scenario.method))
    return Bands(way.t_s, tuple(found))


def _own(scenario: Scenario, way: Course, model: StochasticModel) -> Band:
    if model.silent or not model.log:
        return Band("none", reason="the filter is told of no random error, or has no log")
    return _band("filter", filter_variance(scenario, way, model))


def _band(kind: Kind, variance: np.ndarray) -> Band:
    if not np.all(np.isfinite(variance)):
        return Band("none", reason="the loop is unstable: its variance overflows")
    return Band(kind, np.sqrt(np.maximum(variance, 0.0)))
