"""How well damped the loop is at each moment of a run whose law switches or re-tunes its network."""

import numpy as np

from navcore.analysis.loop import closed_loop_poles
from navcore.foundation.errors import InputError
from navcore.law.policy.schedule import Schedule
from navcore.networks.base import LinearNetwork, NetworkParameters
from navcore.networks.compass import CompassNetwork
from navcore.scenario.method import Method

_GRID = 65
"""Coefficients at which the poles are computed; between them the damping is interpolated."""
_DAMPED, _XI = 1, 2
_LEAST_XI = 1e-9


def least_damping(network: LinearNetwork) -> float:
    """Smallest damping ratio -Re/|p| of the closed-loop poles, those at zero left out; negative: unstable."""
    poles = closed_loop_poles(network)
    size = np.abs(poles)
    moving = size > 1e-9 * np.max(size)
    return float(np.min(-poles[moving].real / size[moving])) if np.any(moving) else 0.0


def damping_in_force(
    method: Method, network: LinearNetwork, t_s: np.ndarray, law_series: np.ndarray
) -> np.ndarray:
    """Smallest damping ratio of the loop in force, as if each moment's loop stayed.

    Parameters
    ----------
    method : Method
        As configured.
    network : LinearNetwork
        Its H(s), as in `navcore.engine.run.MethodRun`.
    t_s : ndarray, shape (m,)
        Times, s.
    law_series : ndarray, shape (m, 4)
        Wish, damped (0/1), xi, measure, as in `navcore.engine.run.MethodRun`.

    Returns
    -------
    ndarray, shape (m,)
        0 while the loop is not damped; NaN where the coefficient in force makes no network.
    """
    damped = law_series[:, _DAMPED] > 0.5
    if isinstance(method.policy, Schedule):
        damping = _scheduled(method.policy, network.omega_s, t_s, damped)
    elif method.network.tuning(network.omega_s) is None:
        damping = np.full(len(t_s), least_damping(network))
    else:
        damping = _tuned(method.network, network.omega_s, law_series[:, _XI])
    return np.where(damped, damping, 0.0)


def _tuned(parameters: NetworkParameters, omega_s: float, xi: np.ndarray) -> np.ndarray:
    values = np.unique(np.maximum(xi, _LEAST_XI))
    if len(values) > _GRID:
        values = np.geomspace(values[0], values[-1], _GRID)
    at = [_damping(parameters.with_damping(float(value)), omega_s) for value in values]
    return np.interp(np.maximum(xi, _LEAST_XI), values, at)


def _scheduled(policy: Schedule, omega_s: float, t_s: np.ndarray, damped: np.ndarray) -> np.ndarray:
    """Each start of the damping begins the passage of the gains anew."""
    starts = damped & ~np.concatenate([[False], damped[:-1]])
    begun = np.maximum.accumulate(np.where(starts, t_s, t_s[0] if len(t_s) else 0.0))
    share = np.clip((t_s - begun) / policy.duration_s, 0.0, 1.0)
    first, last = np.array(getattr(policy, "from")), np.array(policy.to)
    grid = np.linspace(0.0, 1.0, _GRID)
    at = []
    for part in grid:
        k1, k2, k3 = (first + part * (last - first)).tolist()
        at.append(_damping(CompassNetwork.model_validate({"k1": k1, "k2": k2, "k3": k3}), omega_s))
    return np.interp(share, grid, at)


def _damping(parameters: NetworkParameters, omega_s: float) -> float:
    try:
        return least_damping(parameters.transfer(omega_s))
    except (InputError, ZeroDivisionError):
        return float("nan")
