"""Liu's direct form (Liu 17 to 19) with its coefficients rounded as a computer stores them.

What is judged is the filter that the rounded coefficients make, not the noise of evaluating it: the
polynomials in z are moved to z - 1 exactly, in fractions, before anything is computed with them.
"""

from fractions import Fraction
from math import comb

import numpy as np

from navcore.networks.base import LinearNetwork
from navcore.networks.discrete import discretise
from schuler_bench.misprints.base import OMEGA_S

_OMEGA = np.geomspace(1e-2, 1e2, 200) * OMEGA_S


def direct_form(
    zeta: float, step_s: float, dtype: type[np.floating]
) -> tuple[list[np.floating], list[np.floating]]:
    """Coefficients of Q(z), descending powers of z, the denominator's first one 1 (Liu 17 to 19, eta = 0.5).

    Parameters
    ----------
    zeta : float
        Damping coefficient.
    step_s : float
        Step T, s.
    dtype : numpy floating type
        What they are computed and kept in.
    """
    u, one, z = dtype(1.0) / np.tan(dtype(0.5 * OMEGA_S * step_s)), dtype(1.0), dtype(zeta)
    u4, d1, d2, d3 = u * u * u * u, (one + z) * u * u * u, (3 + 4 * z) * u * u, (2 * z + one) * u
    den = [
        u4 + 2 * d1 + d2 + 2 * d3 + one,
        -4 * (u4 + d1 - d3 - one),
        2 * (3 * u4 - d2 + 3),
        -4 * (u4 - d1 + d3 - one),
        u4 - 2 * d1 + d2 - 2 * d3 + one,
    ]
    num = [2 * z * u * factor for factor in (1, 2, 0, -2, -1)]
    return [dtype(c / den[0]) for c in num], [dtype(c / den[0]) for c in den]


def about_one(coefficients: list[np.floating]) -> np.ndarray:
    """Coefficients in z - 1 of a polynomial in z (descending powers), moved exactly."""
    ascending = [Fraction(float(c)) for c in reversed(coefficients)]
    top = len(ascending)
    moved = [sum(ascending[k] * comb(k, j) for k in range(j, top)) for j in range(top)]
    return np.array([float(c) for c in reversed(moved)])


def _warped(step_s: float) -> np.ndarray:
    return OMEGA_S * np.tan(0.5 * _OMEGA * step_s) / np.tan(0.5 * OMEGA_S * step_s)


def _largest_error(response: np.ndarray, network: LinearNetwork, step_s: float) -> float:
    exact = network.response(_warped(step_s))
    return float(np.max(np.abs(response - exact) / np.abs(exact)))


def direct_form_error(network: LinearNetwork, step_s: float, dtype: type[np.floating]) -> float:
    """Largest relative error of H = 1 - Q from 0.01 to 100 omega_s.

    Parameters
    ----------
    network : LinearNetwork
        A `complementary` network with eta = 0.5 at the sphere's omega_s.
    step_s : float
        Step, s.
    dtype : numpy floating type
        Precision of the coefficients.
    """
    # zeta from 1 - H = 2 zeta p / D
    zeta = 0.5 * float(network.den_p[3] - network.num_p[3])
    num, den = (about_one(c) for c in direct_form(zeta, step_s, dtype))
    delta = np.expm1(1j * _OMEGA * step_s)
    return _largest_error(1.0 - np.polyval(num, delta) / np.polyval(den, delta), network, step_s)


def state_space_error(network: LinearNetwork, step_s: float) -> float:
    """Return the same error of the form that the bench runs (`navcore.networks.discrete.discretise`)."""
    return _largest_error(discretise(network, step_s).response(_OMEGA), network, step_s)


def direct_form_growth(zeta: float, step_s: float, dtype: type[np.floating]) -> float | None:
    """Time in which the direct form grows e-fold, s; None when it is stable."""
    roots = np.roots(about_one(direct_form(zeta, step_s, dtype)[1]))
    # |1 + r| - 1 without the loss that adding 1 would bring
    growth = float(np.max(0.5 * np.log1p(2.0 * roots.real + np.abs(roots) ** 2)))
    return step_s / growth if growth > 1e-13 else None
