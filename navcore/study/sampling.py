"""Draws of the factors: points of the unit cube, and their values by the inverse distribution."""

import math
from functools import lru_cache

import numpy as np

from navcore.study.model import Factor, Sample

_CHUNK = 1024


def unit_point(sample: Sample, dimensions: int, number: int) -> np.ndarray:
    """Return one point of a sample in the unit cube, shape (dimensions,); the others need no memory."""
    if sample.method == "saltelli":
        return _saltelli_point(sample, dimensions, number)
    chunk, place = divmod(number, _CHUNK)
    return _chunk(sample, dimensions, chunk)[place]  # pyright: ignore[reportArgumentType]


def _saltelli_point(sample: Sample, dimensions: int, number: int) -> np.ndarray:
    """Of each row of two samples A and B: A, B, and A with one factor after the other from B.

    Saltelli et al. 2010, table 1, as `scipy.stats.sobol_indices` takes it.
    """
    row, place = divmod(number, dimensions + 2)
    both = unit_point(_plain(sample), 2 * dimensions, row)  # pyright: ignore[reportArgumentType]
    first, second = both[:dimensions], both[dimensions:]
    if place < 2:
        return (first, second)[place]
    point = first.copy()
    point[place - 2] = second[place - 2]
    return point


@lru_cache(maxsize=8)
def _plain(sample: Sample) -> Sample:
    return sample.model_copy(update={"method": "sobol"})


@lru_cache(maxsize=8)
def _chunk(sample: Sample, dimensions: int, chunk: int) -> np.ndarray:
    """Points chunk * 1024 and after; shape (1024, dimensions), of a Latin hypercube at most so many."""
    first = chunk * _CHUNK
    if sample.method == "random":
        bits = np.random.PCG64(sample.seed)
        bits.advance(first * dimensions)  # one step a number
        return np.random.Generator(bits).random((_CHUNK, dimensions))
    if sample.method == "latin_hypercube":
        cube = _hypercube(sample, dimensions)  # pyright: ignore[reportArgumentType]
        return cube[first : first + _CHUNK]
    from scipy.stats import qmc

    sobol = qmc.Sobol(dimensions, bits=31, rng=sample.seed)
    return (sobol.fast_forward(first) if first else sobol).random(_CHUNK)


@lru_cache(maxsize=1)
def _hypercube(sample: Sample, dimensions: int) -> np.ndarray:
    from scipy.stats import qmc

    return qmc.LatinHypercube(dimensions, rng=sample.seed).random(sample.points)


def drawn_value(factor: Factor, part: float) -> float:
    """Value of a factor below which a part of its distribution lies.

    Parameters
    ----------
    factor : Factor
        With a distribution, complete.
    part : float
        0..1; of a normal distribution the part between ``low`` and ``high``.

    Examples
    --------
    >>> drawn_value(Factor(field="site.lat_deg", low=10.0, high=30.0), 0.25)
    15.0
    """
    low, high = factor.low, factor.high
    if factor.distribution == "normal":
        from scipy.special import ndtr, ndtri

        assert factor.mean is not None and factor.deviation is not None  # `Factor.faults`
        ends = (
            -math.inf if low is None else (low - factor.mean) / factor.deviation,
            math.inf if high is None else (high - factor.mean) / factor.deviation,
        )
        below, above = ndtr(ends)
        inner = min(max(below + part * (above - below), 1e-300), 1.0 - 1e-16)
        return factor.mean + factor.deviation * float(ndtri(inner))
    assert low is not None and high is not None
    if factor.distribution == "log_uniform":
        return low * (high / low) ** part
    return low + part * (high - low)
