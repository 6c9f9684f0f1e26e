"""Frequencies at which a curve is drawn: even ones miss a resonance that is narrower than their spacing."""

import numpy as np

Ratio = tuple[np.ndarray, np.ndarray]
"""Zeros and poles, rad/s, of a function of s."""

UNDAMPED = 1e-4
"""Damping ratio below which a root counts as one on the imaginary axis: a curve is cut off so near to it."""
_POINTS = 12
_OF_WIDTH, _NEAREST, _FARTHEST = 0.2, 0.02, 0.2
"""Points about a root: the first lies `_OF_WIDTH` of the root's width away, at most `_NEAREST` of its
frequency, the last `_FARTHEST` of its frequency."""


def curve_frequencies(even: np.ndarray, *ratios: Ratio) -> np.ndarray:
    """Return even frequencies, and those about the zeros and poles and at the extremes of each ratio.

    A peak or notch of a ratio is among them exactly, unless it is undamped: then the nearest point lies
    `UNDAMPED` of its frequency beside it, where the curve is finite.

    Parameters
    ----------
    even : ndarray, shape (n,)
        rad/s, ascending; the result stays within them.
    *ratios : tuple of (zeros, poles)
        Of what is drawn, rad/s.

    Returns
    -------
    ndarray, shape (m,)
        rad/s, ascending; a frequency may stand there twice. m depends on the numbers of zeros and poles
        alone, so that a picture whose parameters change keeps its number of points.
    """
    scale = float(np.sqrt(even[0] * even[-1]))
    points = [even]
    for zeros, poles in ratios:
        points += [_around(np.concatenate([zeros, poles])), scale * _extremes(zeros / scale, poles / scale)]
    omega = np.sort(np.clip(np.concatenate(points), even[0], even[-1]))
    for root in (root for ratio in ratios for roots in ratio for root in roots[undamped(roots)]):
        place, gap = abs(root), UNDAMPED * abs(root)
        near = np.abs(omega - place) < gap
        omega[near] = np.where(omega[near] < place, place - gap, place + gap)
    return omega


def undamped(roots: np.ndarray) -> np.ndarray:
    """Whether each zero or pole lies on the imaginary axis, or so near that no picture could tell."""
    return np.abs(np.real(roots)) <= UNDAMPED * np.abs(roots)


def _around(roots: np.ndarray) -> np.ndarray:
    """Frequencies about each root, half of them below for the one of a pair and half above for the other."""
    size = np.abs(roots)
    ratio = np.abs(np.real(roots)) / np.where(size > 0.0, size, 1.0)
    away = np.geomspace(np.clip(_OF_WIDTH * ratio, UNDAMPED, _NEAREST), _FARTHEST, _POINTS)
    return np.ravel(size * np.exp(np.where(np.imag(roots) < 0.0, -away, away)))


def _extremes(zeros: np.ndarray, poles: np.ndarray) -> np.ndarray:
    """Frequencies where |prod(j w - zeros)/prod(j w - poles)| is stationary, and one for each other root.

    With x = w^2 the squared magnitude is A/B = prod(x + zeros^2)/prod(x + poles^2): x (A' B - A B') = 0.
    """
    above, below = (np.atleast_1d(np.real(np.poly(-(roots**2)))) for roots in (zeros, poles))
    by_power = [part * np.arange(len(part) - 1, -1, -1) for part in (above, below)]
    slope = np.convolve(by_power[0], below) - np.convolve(above, by_power[1])
    places = np.roots(slope)  # rounding decides whether one at infinity is left out
    return np.sqrt(np.abs(np.pad(places, (0, len(slope) - 1 - len(places)))))
