"""A number of ours: exact, or a mean over independent seeds with its 95 % confidence interval."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

CONFIDENCE = 0.95
_SMALLEST = 1e-6
"""Size below which a difference is rounding in most places, and not the same on every processor."""


def interval(samples: Sequence[float] | np.ndarray, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Mean of independent samples and half the width of its confidence interval (Student)."""
    from scipy.stats import t

    x = np.asarray(samples, dtype=float)
    half = t.ppf(0.5 + confidence / 2.0, x.size - 1) * np.std(x, ddof=1) / np.sqrt(x.size)
    return float(np.mean(x)), float(half)


@dataclass(frozen=True)
class Estimate:
    """A number with half the width of its 95 % interval; ``seeds`` = 1: noise does not decide it.

    ``ends`` are those of an interval that is not symmetric.
    """

    value: float
    half: float = 0.0
    seeds: int = 1
    ends: tuple[float, float] | None = None

    @property
    def span(self) -> tuple[float, float]:
        """Ends of the interval."""
        if self.ends is not None:
            return self.ends
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


def ratio_estimate(samples: np.ndarray) -> Estimate:
    """Geometric mean of independent ratios, which are skewed; its interval is Student's of the logarithms."""
    mean, half = interval(np.log(samples))
    ends = math.exp(mean - half), math.exp(mean + half)
    return Estimate(math.exp(mean), 0.5 * (ends[1] - ends[0]), samples.size, ends)


def estimate(found: float | np.ndarray | Estimate) -> Estimate:
    """Estimate from what a claim computes: one number, one for each seed, or an estimate."""
    if isinstance(found, Estimate):
        return found
    samples = np.atleast_1d(np.asarray(found, dtype=float))
    if samples.size == 1:
        return Estimate(float(samples[0]))
    mean, half = interval(samples)
    return Estimate(mean, half, samples.size)


def number(value: float, digits: int = 3) -> str:
    """Text of a number with a fixed count of significant digits; no exponent within 1e-4 .. 1e6.

    With 0 digits it is a count: rounded to a whole number.
    """
    if not math.isfinite(value):
        return "-" if math.isnan(value) else "infinite"
    if digits == 0:
        return f"{value:.0f}"
    if 0.0 < abs(value) < _SMALLEST:
        return "< 1e-6"
    text = f"{value:.{digits - 1}e}"
    mantissa, exponent = text.split("e")
    power = int(exponent)
    if float(mantissa) == 0.0:
        return "0"
    if -4 <= power < 6:
        return f"{float(text):.{max(digits - 1 - power, 0)}f}"
    return f"{mantissa}e{power}"
