"""How much of an error swings with the Schuler, Foucault and 24 h periods: least squares on known lines.

At rest the lines of the free model are omega_s' + Omega sin L, omega_s' - Omega sin L and Omega (theory.md
section 1): what is called the Foucault oscillation is the beat of the first two. A vehicle that travels
changes them; the fit follows the phase along the true motion instead of a frequency.
"""

from dataclasses import dataclass

import numpy as np

from navcore.averaging.copies import coupled_lines
from navcore.foundation.earth import EARTH_RATE, Earth
from navcore.mechanization.trajectory import coefficients
from navcore.motion.truth import Truth

LINES = ("schuler_plus_foucault", "schuler_minus_foucault", "earth")
_RCOND = 1e-6


@dataclass(frozen=True)
class LineAmplitudes:
    """Amplitudes of the lines in some curves.

    Attributes
    ----------
    amplitude : ndarray, shape (curves, lines)
        Amplitude of each line that was fitted, of `LINES`, in the curve's unit.
    offset, slope : ndarray, shape (curves,)
        Constant (at the first time) and trend (unit a second).
    residual_rms : ndarray, shape (curves,)
        What the fit leaves.
    """

    amplitude: np.ndarray
    offset: np.ndarray
    slope: np.ndarray
    residual_rms: np.ndarray


def line_phases(time_s: np.ndarray, truth: np.ndarray, earth: Earth) -> np.ndarray:
    """Phase of each of `LINES` along a true motion, rad.

    The level lines follow gravity, the radii and the rate (Omega + dlambda/dt) sin L of the navigation frame
    about the vertical; the 24 h line follows Omega + dlambda/dt.

    Parameters
    ----------
    time_s : ndarray, shape (m,)
        Times, s.
    truth : ndarray, shape (m, 15) or (1, 15)
        True states, columns of `navcore.motion.truth`.
    earth : Earth
        WGS-84 or the sphere.

    Returns
    -------
    ndarray, shape (m, 3)
    """
    c = coefficients(Truth(1.0, np.ascontiguousarray(truth)), earth, coupled=True).half
    east, north = np.sqrt(c["f_u"] * c["inv_n"]), np.sqrt(c["f_u"] * c["inv_m"])
    about_axis = EARTH_RATE + c["v_e"] * c["inv_n"] * c["sec_lat"]
    rates = np.column_stack([*coupled_lines(east, north, c["w_u"]), about_axis])
    rates = np.broadcast_to(rates, (len(time_s), len(LINES)))
    steps = 0.5 * (rates[1:] + rates[:-1]) * np.diff(time_s)[:, None]
    return np.concatenate([np.zeros((1, len(LINES))), np.cumsum(steps, axis=0)])


def line_amplitudes(time_s: np.ndarray, curves: np.ndarray, phases: np.ndarray) -> LineAmplitudes:
    """Fit constant, trend, and a sine and cosine of each line to curves.

    Lines that the record cannot tell apart (a run much shorter than a day, a place near the equator) share
    what they have in common: the solution of least norm is taken.

    Parameters
    ----------
    time_s : ndarray, shape (m,)
        Times, s.
    curves : ndarray, shape (m, curves)
        Say, the eight quantities of a method's rows.
    phases : ndarray, shape (m, lines)
        From `line_phases`, or some of its columns.
    """
    span = max(float(time_s[-1] - time_s[0]), 1e-9)
    ramp = (time_s - time_s[0]) / span
    design = np.column_stack([np.ones(len(time_s)), ramp, np.cos(phases), np.sin(phases)])
    solution, *_ = np.linalg.lstsq(design, curves, rcond=_RCOND)
    count = phases.shape[1]
    amplitude = np.hypot(solution[2 : 2 + count], solution[2 + count :]).T
    left = curves - design @ solution
    return LineAmplitudes(amplitude, solution[0], solution[1] / span, np.sqrt(np.mean(left**2, axis=0)))
