"""A number of ours: exact, or a mean over independent seeds with its 95 % confidence interval."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

CONFIDENCE = 0.95


def interval(samples: Sequence[float] | np.ndarray, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Mean of independent samples and half the width of its confidence interval (Student)."""
    from scipy.stats import t

    x = np.asarray(samples, dtype=float)
    half = t.ppf(0.5 + confidence / 2.0, x.size - 1) * np.std(x, ddof=1) / np.sqrt(x.size)
    return float(np.mean(x)), float(half)


@dataclass(frozen=True)
class Estimate:
    """A number with half the width of its 95 % interval; ``seeds`` = 1: noise does not decide it."""

    value: float
    half: float = 0.0
    seeds: int = 1

    @property
    def span(self) -> tuple[float, float]:
        """Ends of the interval."""
        return self.value - self.half, self.value + self.half

    def position(self, low: float, high: float) -> int:
        """1: the whole interval lies in the range, -1: none of it does, 0: a part."""
        least, most = self.span
        if low <= least and most <= high:
            return 1
        return 0 if math.isfinite(self.half) and least <= high and most >= low else -1


def rms_estimate(samples: np.ndarray) -> Estimate:
    """RMS of independent samples; its interval is that of the mean of the squares, to first order."""
    mean, half = interval(np.square(samples))
    return Estimate(math.sqrt(mean), half / (2.0 * math.sqrt(mean)), samples.size)


def estimate(found: float | np.ndarray | Estimate) -> Estimate:
    """Estimate from what a claim computes: one number, one for each seed, or an estimate."""
    if isinstance(found, Estimate):
        return found
    samples = np.atleast_1d(np.asarray(found, dtype=float))
    if samples.size == 1:
        return Estimate(float(samples[0]))
    mean, half = interval(samples)
    return Estimate(mean, half, samples.size)
