"""Errors that rounding makes of a reading: one that stands while the reading does, and one like noise.

A reading x with noise of standard deviation sigma is rounded to a resolution q. Its mean error is a sawtooth
of x that the noise smooths,

    m(x) = sum over k >= 1 of (-1)^k q/(pi k) exp(-2 (pi k sigma/q)^2) sin(2 pi k x/q),

which stands as long as the speed does: a ship at 5.03 m/s reads 5.0 for ever on a log of 0.1 m/s. Over
all speeds its mean square is the sum of (q/(pi k))^2 exp(-4 (pi k sigma/q)^2)/2: q^2/12 without noise;
nothing from sigma = q/2 on. What is left of sigma^2 + q^2/12 differs from sample to sample.
"""

import math

import numpy as np

DITHERED = 0.5
"""Noise over resolution from which on rounding averages out."""
_TERMS_TO = 1e-4
"""Size over q of the first term of the series that is left out."""
_SHARP = 0.02
"""Noise over resolution below which a reading is rounded as it is."""


def standing_rounding(lsb: float, sigma: float) -> float:
    """Root mean square over all speeds of the error of rounding that stands.

    Parameters
    ----------
    lsb : float
        Resolution, any unit.
    sigma : float
        Standard deviation of the noise of a reading, in the same unit.

    Examples
    --------
    >>> round(standing_rounding(0.1, 0.0) * 12**0.5, 6), standing_rounding(0.1, 0.05) < 0.001
    (0.1, True)
    """
    if lsb == 0.0:
        return 0.0
    if sigma < _SHARP * lsb:
        return lsb / math.sqrt(12.0)
    k = _terms(sigma / lsb)
    parts = (lsb / (math.pi * k)) ** 2 * np.exp(-4.0 * (math.pi * k * sigma / lsb) ** 2)
    return math.sqrt(0.5 * float(np.sum(parts)))


def mean_rounding(reading: np.ndarray, lsb: float, sigma: float) -> np.ndarray:
    """Mean error m(x) of rounded readings, shape of ``reading``; see the module.

    Parameters
    ----------
    reading : ndarray
        Without noise.
    lsb, sigma : float
        Resolution and standard deviation of the noise, in its unit.
    """
    if lsb == 0.0:
        return np.zeros(reading.shape)
    if sigma < _SHARP * lsb:
        return np.round(reading / lsb) * lsb - reading
    found = np.zeros(reading.shape)
    for k in _terms(sigma / lsb).tolist():
        size = lsb / (math.pi * k) * math.exp(-2.0 * (math.pi * k * sigma / lsb) ** 2)
        found += (-1.0) ** k * size * np.sin(2.0 * math.pi * k * reading / lsb)
    return found


def _terms(ratio: float) -> np.ndarray:
    """Orders of the series that count at a ratio of noise to resolution."""
    most = math.ceil(math.sqrt(-0.5 * math.log(_TERMS_TO)) / (math.pi * ratio))
    return np.arange(1, max(1, most) + 1)
