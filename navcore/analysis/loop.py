"""The closed Schuler loop s^2 + omega_s^2 H(s) of one level channel: stability, damping, settling."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from navcore.analysis.settling import last_exceedance
from navcore.foundation.text import Text
from navcore.networks.base import ComplexArray, LinearNetwork
from navcore.networks.roots import sorted_roots
from navcore.networks.state_space import state_space

_ON_AXIS = 1e-9
H0_TOLERANCE = 1e-3
"""H(0) is called different from 1 beyond this (theory.md 3.6)."""


@dataclass(frozen=True, eq=False)
class Loop:
    """Verdict on the closed loop.

    Attributes
    ----------
    stable : bool
        No pole in the right half plane, none repeated on the imaginary axis. The free loop counts as stable.
    poles : ndarray of complex, shape (n + 2,)
        Roots of s^2 D + omega_s^2 N, rad/s.
    h0 : float
        H(0); inf for a pole at zero.
    damping_ratio, natural_frequency : float
        Of the least damped pair: -Re/|p| and |p| (rad/s). With real poles only: 1 and the slowest pole's
        rate; negative when unstable. Poles at zero are left out.
    settling_s : float or None
        Last time at which the response to a unit initial tilt exceeds 2 %; None when it never comes to rest,
        or not within months (damping below 2.5e-4).
    warnings : tuple of str
        In plain words.
    """

    stable: bool
    poles: ComplexArray
    h0: float
    damping_ratio: float
    natural_frequency: float
    settling_s: float | None
    warnings: tuple[str, ...]


def closed_loop_polynomial(network: LinearNetwork) -> np.ndarray:
    """Coefficients of p^2 D(p) + N(p), p = s / omega_s, descending powers, monic; with G: `loop_num_p`."""
    return np.polyadd(np.append(network.den_p, [0.0, 0.0]), network.loop_num_p)


def closed_loop_poles(network: LinearNetwork) -> ComplexArray:
    """Closed-loop poles / omega_s, shape (n + 2,); as designed where the design gives them exactly."""
    if network.closed_loop_p is not None:
        return network.closed_loop_p
    return sorted_roots(np.roots(closed_loop_polynomial(network)))


@lru_cache(maxsize=256)
def analyse(network: LinearNetwork) -> Loop:
    """Judge the closed loop of one level channel: poles, damping, settling.

    The response to an initial tilt phi_0 is phi(s)/phi_0 = s/(s^2 + omega_s^2 H(s)) (Zha 15 for `compass`).
    It decays to zero in every stable loop, whatever H(0) is. Whether the ship is stable as a whole is another
    question: `navcore.analysis.whole_system`.

    Parameters
    ----------
    network : LinearNetwork
        H(s).

    Returns
    -------
    Loop
        An unstable loop does not raise: it has ``stable = False``, and a warning says so.

    Examples
    --------
    >>> from navcore import parse_network
    >>> loop = analyse(parse_network('id = "compass", sigma = 0.0088, xi = 0.7').transfer(1.24e-3))
    >>> f"{loop.damping_ratio:.2f}, settles in {loop.settling_s:.0f} s"
    '0.70, settles in 544 s'
    """
    poles = closed_loop_poles(network)
    size = np.abs(poles)
    zero = size <= _ON_AXIS * np.max(size)
    moving, moving_size = poles[~zero], size[~zero]
    ratios = -moving.real / moving_size
    growing = bool(np.any(ratios < -_ON_AXIS)) or int(np.count_nonzero(zero)) > 1
    unstable = growing or _repeated_on_axis(moving)
    undamped = not unstable and bool(np.any(ratios <= _ON_AXIS))
    damping, frequency = _least_damped(ratios, moving_size)
    if undamped:
        damping = 0.0
    settling = None if unstable or undamped else _settling(network, poles, zero)
    return Loop(
        stable=not unstable,
        poles=poles * network.omega_s,
        h0=network.h0,
        damping_ratio=damping,
        natural_frequency=frequency * network.omega_s,
        settling_s=settling,
        warnings=_warnings(network, unstable, undamped, bool(np.any(zero))),
    )


def _least_damped(ratios: np.ndarray, size: np.ndarray) -> tuple[float, float]:
    """Smallest damping ratio and its frequency; of several pairs with the same one, the slowest."""
    if len(ratios) == 0:
        return -1.0, 0.0
    least = float(np.min(ratios))
    return least, float(np.min(size[ratios <= least + 1e-9]))


def _repeated_on_axis(poles: ComplexArray) -> bool:
    on_axis = poles[np.abs(poles.real) <= _ON_AXIS * np.abs(poles)]
    frequencies = np.sort(on_axis.imag)
    return bool(np.any(np.diff(frequencies) <= 1e-6 * np.abs(frequencies[1:])))


def _settling(network: LinearNetwork, poles: ComplexArray, zero: np.ndarray) -> float | None:
    numerator = np.append(network.den_p, 0.0)
    if network.feedback_p is not None:
        numerator = np.polyadd(numerator, network.feedback_p)
    if np.any(zero):
        # a closed-loop pole at zero (H(0) = 0) cancels against the s of s D/(s^2 D + omega_s^2 N)
        if numerator[-1] != 0.0:
            return None
        numerator = numerator[:-1]
    moving = poles[~zero]
    tau = last_exceedance(state_space(numerator, moving), moving)
    return None if tau is None else float(tau / network.omega_s)


@lru_cache(maxsize=64)
def velocity_settling(network: LinearNetwork, loop: Loop) -> float | None:
    """Return the last time at which the velocity error after an initial tilt exceeds 2 % of its swing, s.

    The swing is that of the undamped loop, phi_0 sqrt(g R); its transform is D/(s^2 D + omega_s^2 N).

    Parameters
    ----------
    network : LinearNetwork
        H(s).
    loop : Loop
        Its closed loop; None is returned where that does not settle, or keeps a velocity error.
    """
    poles = loop.poles / network.omega_s
    if loop.settling_s is None or np.any(np.abs(poles) < 1e-9):
        return None
    tau = last_exceedance(state_space(network.den_p, poles), poles)
    return None if tau is None else float(tau / network.omega_s)


def _warnings(network: LinearNetwork, unstable: bool, undamped: bool, zero: bool) -> tuple[str, ...]:
    warnings = []
    if unstable:
        warnings.append(Text("unstable: the errors grow without bound"))
    if undamped:
        warnings.append(Text("undamped"))
    if zero and not unstable:
        warnings.append(
            Text("H(0) = 0: a closed-loop pole at zero, what constant errors do is never worked off")
        )
    elif abs(network.h0 - 1.0) > H0_TOLERANCE:
        warnings.append(
            Text(
                "H(0) = {h0:.4g} differs from 1: the loop is not Schuler-tuned, it needs the reference",
                h0=network.h0,
            )
        )
    return tuple(warnings)
