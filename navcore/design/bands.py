"""The standard deviation of every method's errors along a run: what a band under its error curves shows.

By covariance where the law is known in advance, by the filter's own covariance for a Kalman filter, and not
at all where the law looks at the data (theory.md 15, 16).
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from navcore.damping.base import Covering
from navcore.design.seeds import no_covariance
from navcore.design.ship import Ship
from navcore.foundation.text import Text
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import require_sensors

Kind = Literal["covariance", "filter", "none"]


@dataclass(frozen=True, eq=False)
class Band:
    """Standard deviation of one method along the run.

    Attributes
    ----------
    kind : {"covariance", "filter", "none"}
        Covariance of all sources together, a Kalman filter's own covariance, or no band.
    sigma : ndarray, shape (m, 7), or None
        For `navcore.quantities.COMPONENTS`, in rad, m/s and m; None without a band.
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
        The motion cannot be carried out, or the scenario runs on ``[ins]``, whose sensors are not known.
    """
    require_sensors(scenario)
    ship, bands = Ship(scenario), []
    for method in scenario.method:
        if cancelled is not None and cancelled():
            return None
        bands.append(_BANDS[method.kind.covering](ship, method))
        if progress is not None:
            progress(len(bands) / len(scenario.method))
    return Bands(ship.course.t_s, tuple(bands))


def _of_loop(ship: Ship, method: Method) -> Band:
    if reason := no_covariance(ship.scenario, method):
        return Band("none", reason=reason)
    variance = ship.along(method).total
    if not np.all(np.isfinite(variance)):
        return Band("none", reason=Text("the loop is unstable: its variance overflows"))
    return Band("covariance", _deviation(variance))


def _of_filter(ship: Ship, method: Method) -> Band:
    del method
    own = ship.floor_series
    if own is None:
        return Band("none", reason=Text("the filter is told of no random error, or has no log"))
    return Band("filter", _deviation(own.total))


def _deviation(variance: np.ndarray) -> np.ndarray:
    return np.sqrt(np.maximum(variance, 0.0))


_BANDS: dict[Covering, Callable[[Ship, Method], Band]] = {
    "covariance": _of_loop,
    "seeds": _of_loop,  # which says why there is none
    "filter": _of_filter,
}
"""Band of a method, by where its budget comes from."""
