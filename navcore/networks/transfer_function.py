"""Polynomials in s as an object of python-control, which is imported only when one is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from control import TransferFunction


def transfer_function(num: np.ndarray, den: np.ndarray, omega_s: float | None = None) -> TransferFunction:
    """Make a `control.TransferFunction` of polynomials in s (rad/s).

    Parameters
    ----------
    num, den : ndarray
        Coefficients in descending powers of s.
    omega_s : float, optional
        When given, the function of p = s / omega_s is returned.
    """
    import control

    if omega_s is not None:
        top = float(len(den) - 1)
        num = num * omega_s ** (np.arange(len(num) - 1, -1, -1) - top)
        den = den * omega_s ** (np.arange(len(den) - 1, -1, -1) - top)
    return control.TransferFunction(num, den)
