"""Rounding of a log's readings: what noise makes of it, and what is left where there is too little noise.

A reading x with noise of deviation sigma is rounded to steps of lsb. Its mean error is that of a saw-tooth
smoothed by the noise, of known shape along the motion; the rest is white. With sigma >= lsb / 2 the mean
error is below lsb / 400 and all of lsb^2 / 12 is white; without noise none of it is (theory.md 15).
"""

import math

import numpy as np

DITHER = 0.5
"""Noise over resolution from which on rounding counts as white noise of lsb / sqrt(12)."""
_FINEST_LSB = 1e-9
_TERMS = np.arange(1.0, 2000.0)
_REACH = 3
"""Steps to either side of a reading that noise below `DITHER` steps can reach."""


def rounded(reading: np.ndarray, lsb: float, noise: float = 0.0) -> np.ndarray:
    """Mean of a reading that is rounded after noise is added.

    Parameters
    ----------
    reading : ndarray
        Before rounding, m/s.
    lsb : float
        Resolution, m/s; readings as they are when below 1e-9.
    noise : float
        Standard deviation of the noise, m/s, less than ``lsb``; 0 gives the rounded reading itself.
    """
    if lsb < _FINEST_LSB:
        return reading
    nearest = np.round(reading / lsb)
    if noise == 0.0:
        return nearest * lsb
    from scipy.special import ndtr

    inside = reading / lsb - nearest
    edges = np.arange(-_REACH, _REACH) + 0.5
    above = sum(ndtr((inside - edge) * (lsb / noise)) for edge in edges)
    return (nearest - _REACH + above) * lsb


def deviations(lsb: float, noise: float) -> tuple[float, float]:
    """Deviation over all readings of the mean error of `rounded`, and of the white error beside the noise.

    Their squares add up to lsb^2 / 12. Without noise the first is lsb / sqrt(12) and the second 0.

    Parameters
    ----------
    lsb, noise : float
        m/s.

    Returns
    -------
    held, white : float
        m/s.
    """
    if lsb == 0.0:
        return 0.0, 0.0
    if noise == 0.0:
        return lsb / math.sqrt(12.0), 0.0
    left = np.exp(-((2.0 * math.pi * _TERMS * noise / lsb) ** 2)) / _TERMS**2
    share = min(float(np.sum(left)) * 6.0 / math.pi**2, 1.0)
    return lsb * math.sqrt(share / 12.0), lsb * math.sqrt((1.0 - share) / 12.0)
