"""Likelihood of a regression whose errors are white noise and a first-order Gauss-Markov drift.

The data are means over blocks of equal length, several axes with the same noise. A Kalman filter, run for a
whole grid of correlation times and variance ratios at once, makes them independent; it takes the drift's
mean over a block exactly, and blocks without samples as unknown. Coefficients and the size of the noise are
integrated out (restricted likelihood: Harville, Journal of the American Statistical Association 72, 1977).
What is left over the grid is the posterior of the drift, from which the intervals come.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

NINETY_FIVE = 1.96
_ZOOMS = 6
_FIRST, _NEXT, _LAST = 12, 9, 15
"""Points of the grid on each side: at first, while it closes in, and at the end."""
_WITHIN = 12.0
"""Logarithm of the likelihood below its peak that still counts."""
_STEPS = 1500
"""Blocks in a row; a longer record is cut into so long pieces, taken as independent."""
_RATIOS = 1e-5, 1e6
_DRAWS = 4000
_NONE = 1e-12
_LEAST_GAIN = 8.0
"""Logarithm of the likelihood by which a drift must be better than none."""


class Estimate(NamedTuple):
    """A value with the ends of its 95 % interval."""

    value: float
    low: float
    high: float

    @property
    def deviation(self) -> float:
        """Standard deviation, by the width of the interval."""
        return (self.high - self.low) / (2.0 * NINETY_FIVE)

    def document(self, scale: float = 1.0) -> dict[str, float]:
        """Return the three numbers, divided by the size of a unit."""
        return {name: value / scale for name, value in self._asdict().items()}

    def scaled(self, factor: float) -> "Estimate":
        """Return it in another unit."""
        return Estimate(*(value * factor for value in self))


def around(value: float, deviation: float) -> Estimate:
    """Estimate of a normal distribution."""
    return Estimate(value, value - NINETY_FIVE * deviation, value + NINETY_FIVE * deviation)


@dataclass(frozen=True, eq=False)
class Blocks:
    """Means over blocks.

    Attributes
    ----------
    values : ndarray, shape (k, a)
        Means of the data, on each axis.
    design : ndarray, shape (k, a, p)
        Means of the regressors.
    count : ndarray, shape (k,)
        Samples in each block; 0 for none.
    length_s : float
        Length of a block, s.
    prior : ndarray, shape (p,)
        Standard deviations by which the coefficients are known beforehand, with mean 0.
    """

    values: np.ndarray
    design: np.ndarray
    count: np.ndarray
    length_s: float
    prior: np.ndarray


@dataclass(frozen=True, eq=False)
class Posterior:
    """What the data say.

    Attributes
    ----------
    coefficients, deviations : ndarray, shape (p,)
        Mean and standard deviation of each coefficient.
    white, drift, tau_s : Estimate
        Standard deviation of the white noise of a sample and of the drift, and the drift's correlation time.
    growth : Estimate
        By how much the drift grows in the square root of a second, while that is short: sigma sqrt(2 / tau).
    at : tuple of float
        Correlation time and ratio of the variances at the peak, for `coefficients_at`.
    """

    coefficients: np.ndarray
    deviations: np.ndarray
    white: Estimate
    drift: Estimate
    tau_s: Estimate
    growth: Estimate
    at: tuple[float, float]


class _Likelihood(NamedTuple):
    """Of each point of a grid: log likelihood, coefficients, their covariance for unit noise, the noise."""

    log: np.ndarray
    coefficients: np.ndarray
    covariance: np.ndarray
    variance: np.ndarray
    degrees: float


def coefficients_at(blocks: Blocks, tau_s: float, ratio: float) -> tuple[np.ndarray, np.ndarray]:
    """Coefficients and their standard deviations for a known correlation time and ratio of the variances."""
    found = _likelihood(blocks, np.array([tau_s]), np.array([ratio]))
    deviation = np.sqrt(np.diagonal(found.covariance[0]) * found.variance[0])
    return found.coefficients[0], deviation


def posterior(
    blocks: Blocks, taus_s: tuple[float, float], at: tuple[float, float] | None = None
) -> Posterior:
    """Fit coefficients, white noise and drift.

    Parameters
    ----------
    blocks : Blocks
        The data.
    taus_s : tuple of float
        Range in which the correlation time is sought, s.
    at : tuple of float, optional
        Where the peak is about, as in `Posterior.at`: the search begins there.
    """
    least, most = np.log(taus_s), np.log(_RATIOS)
    box = np.array([least, most])
    points = _FIRST
    if at is not None:
        near = np.log(at)[:, None] + np.array([[-1.0, 1.0], [-1.5, 1.5]])
        box, points = np.clip(near, box[:, :1], box[:, 1:]), _NEXT
    for _ in range(_ZOOMS):
        axes = [np.linspace(low, high, points) for low, high in box.tolist()]
        found = _on_grid(blocks, axes)
        closer = _near_peak(found.log, axes, np.array([least, most]))
        shrunk = np.ptp(closer, axis=1) / np.maximum(np.ptp(box, axis=1), 1e-9)
        box, points = closer, _NEXT
        if np.all(shrunk > 0.7):
            break
    axes = [np.linspace(low, high, _LAST) for low, high in box.tolist()]
    return _summed(blocks, axes, _on_grid(blocks, axes))


def without_drift(blocks: Blocks) -> float:
    """Log likelihood of white noise alone."""
    return float(_likelihood(blocks, np.array([blocks.length_s]), np.array([_NONE])).log[0])


def _on_grid(blocks: Blocks, axes: list[np.ndarray]) -> _Likelihood:
    tau, ratio = (np.exp(values.ravel()) for values in np.meshgrid(*axes, indexing="ij"))
    return _likelihood(blocks, tau, ratio)


def _near_peak(log: np.ndarray, axes: list[np.ndarray], limits: np.ndarray) -> np.ndarray:
    """Box around the points whose likelihood counts, a step wider on each side; shape (2, 2)."""
    kept = (log > log.max() - _WITHIN).reshape(axes[0].size, axes[1].size)
    sides = []
    for place, values in enumerate(axes):
        inside = np.flatnonzero(kept.any(axis=1 - place))
        step = values[1] - values[0]
        sides.append([values[inside[0]] - step, values[inside[-1]] + step])
    return np.clip(sides, limits[:, :1], limits[:, 1:])


def _summed(blocks: Blocks, axes: list[np.ndarray], found: _Likelihood) -> Posterior:
    """Means and intervals over the last grid."""
    weight = np.exp(found.log - found.log.max())
    weight /= weight.sum()
    mean = weight @ found.coefficients
    own = np.diagonal(found.covariance, axis1=1, axis2=2) * found.variance[:, None]
    deviation = np.sqrt(weight @ (own + (found.coefficients - mean) ** 2))
    # Drawn within the cells, so that the grid's steps do not show; always the same draws.
    random = np.random.default_rng(0)
    cells = random.choice(weight.size, _DRAWS, p=weight)
    steps = [values[1] - values[0] for values in axes]
    places = np.stack(np.meshgrid(*axes, indexing="ij")).reshape(2, -1)[:, cells]
    moved = places + random.uniform(-0.5, 0.5, places.shape) * np.array(steps)[:, None]
    tau, ratio = np.exp(np.clip(moved, [[a[0]] for a in axes], [[a[-1]] for a in axes]))
    variance = found.variance[cells] * found.degrees / random.chisquare(found.degrees, _DRAWS)
    best = np.unravel_index(int(np.argmax(found.log)), (axes[0].size, axes[1].size))
    at = float(np.exp(axes[0][best[0]])), float(np.exp(axes[1][best[1]]))
    drift = _estimate(np.sqrt(ratio * variance))
    if found.log.max() - without_drift(blocks) < _LEAST_GAIN:
        drift = Estimate(0.0, 0.0, drift.high)
    return Posterior(
        coefficients=mean,
        deviations=deviation,
        white=_estimate(np.sqrt(variance)),
        drift=drift,
        tau_s=_estimate(tau),
        growth=_estimate(np.sqrt(2.0 * ratio * variance / tau)),
        at=at,
    )


def _estimate(draws: np.ndarray) -> Estimate:
    low, middle, high = np.quantile(draws, (0.025, 0.5, 0.975))
    return Estimate(float(middle), float(low), float(high))


def _likelihood(blocks: Blocks, tau_s: np.ndarray, ratio: np.ndarray) -> _Likelihood:
    """Restricted log likelihood at points (g,): correlation time, variance of the drift to the white one."""
    pieces = _pieces(blocks)
    k, lanes, axes, columns = pieces.values.shape
    u = blocks.length_s / tau_s
    rho, over = np.exp(-u), -np.expm1(-u) / u
    of_mean = ratio * 2.0 * (u + np.expm1(-u)) / u**2
    q11, q12, q22 = ratio * -np.expm1(-2.0 * u), over * ratio * (1.0 - rho), of_mean - over**2 * ratio
    rho, over, q11, q12, q22 = (each[:, None] for each in (rho, over, q11, q12, q22))
    state = np.zeros((tau_s.size, lanes, axes, columns))
    spread = np.repeat(ratio[:, None], lanes, axis=1)
    normal = np.zeros((tau_s.size, columns, columns))
    logs, samples = np.zeros(tau_s.size), 0
    wide = (slice(None), slice(None), None, None)
    for i in range(k):
        count = pieces.samples[i]
        there = count > 0
        total = over**2 * spread + q22 + 1.0 / np.maximum(count, 1)
        weight = there / total
        gain = (rho * over * spread + q12) * weight
        new = pieces.values[i] - over[wide] * state
        scaled = (new * np.sqrt(weight)[wide]).reshape(tau_s.size, lanes * axes, columns)
        normal += scaled.transpose(0, 2, 1) @ scaled
        logs -= 0.5 * axes * np.where(there, np.log(total), 0.0).sum(axis=1)
        samples += axes * int(np.count_nonzero(there))
        state = rho[wide] * state + gain[wide] * new
        spread = rho**2 * spread + q11 - gain * (rho * over * spread + q12)
    return _profiled(normal, logs, samples, _known(blocks))


def _profiled(normal: np.ndarray, logs: np.ndarray, samples: int, known: np.ndarray) -> _Likelihood:
    """Integrate the coefficients and the size of the noise out of the normal equations (g, 1 + p, 1 + p)."""
    matrix = normal[:, 1:, 1:] + np.diag(known)
    size = np.sqrt(np.einsum("gii->gi", matrix))
    covariance = np.linalg.inv(matrix / size[:, :, None] / size[:, None, :])
    covariance = covariance / size[:, :, None] / size[:, None, :]
    found = np.einsum("gij,gj->gi", covariance, normal[:, 1:, 0])
    left = np.maximum(normal[:, 0, 0] - np.einsum("gi,gi->g", found, normal[:, 1:, 0]), 1e-300)
    degrees = max(float(samples - known.size), 1.0)
    _, determinant = np.linalg.slogdet(matrix / size[:, :, None] / size[:, None, :])
    logs = logs - 0.5 * (determinant + 2.0 * np.log(size).sum(axis=1)) - 0.5 * degrees * np.log(left)
    return _Likelihood(logs, found, covariance, left / degrees, degrees)


class _Pieces(NamedTuple):
    """Data and regressors side by side, (k, lanes, a, 1 + p), and samples (k, lanes)."""

    values: np.ndarray
    samples: np.ndarray


def _pieces(blocks: Blocks) -> _Pieces:
    total = blocks.count.size
    lanes = -(-total // _STEPS)
    k = -(-total // lanes)
    beside = np.concatenate([blocks.values[:, :, None], blocks.design], axis=2)
    padded = np.concatenate([beside, np.zeros((k * lanes - total, *beside.shape[1:]))])
    count = np.concatenate([blocks.count, np.zeros(k * lanes - total, blocks.count.dtype)])
    values = padded.reshape(lanes, k, *beside.shape[1:]).swapaxes(0, 1)
    return _Pieces(np.ascontiguousarray(values), count.reshape(lanes, k).T)


def _known(blocks: Blocks) -> np.ndarray:
    """Weights of what is known beforehand, for a white noise of about the right size; shape (p,)."""
    steps = np.diff(blocks.values[blocks.count > 0], axis=0)
    mean = float(blocks.count[blocks.count > 0].mean())
    variance = max(0.5 * float(np.mean(steps**2)) * mean, 1e-12) if steps.size else 1.0
    return variance / blocks.prior**2


def blocks_of(
    time_s: np.ndarray, values: np.ndarray, design: np.ndarray, prior: np.ndarray, length_s: float
) -> Blocks:
    """Means over blocks of ``length_s`` from the first epoch on; blocks may be empty.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Increasing epochs, s.
    values, design : ndarray, shapes (n, a) and (n, a, p)
        Data and regressors.
    prior : ndarray, shape (p,)
        As of `Blocks`.
    length_s : float
        Length of a block, s.
    """
    place = ((time_s - time_s[0]) / length_s).astype(np.int64)
    blocks = int(place[-1]) + 1
    count = np.bincount(place, minlength=blocks)
    begins = np.concatenate([[0], np.cumsum(count)[:-1]])
    kept = count > 0

    def means(samples: np.ndarray) -> np.ndarray:
        sums = np.zeros((blocks, *samples.shape[1:]))
        sums[kept] = np.add.reduceat(samples, begins[kept], axis=0)
        return sums / np.maximum(count, 1).reshape(-1, *[1] * (samples.ndim - 1))

    return Blocks(means(values), means(design), count, length_s, prior)
