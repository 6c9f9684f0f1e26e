"""How late one stream of a recording is against another, by the fast changes that both show.

Both are freed of what changes more slowly than a few minutes: tide, current and the drift of an instrument
go, and manoeuvres stay. At each shift the stream is then regressed on the other at its full rate. The shift
that explains most of it is the lag; the likelihood ratio of two shifts says how sure that is. The number of
independent samples in it is that of Bartlett: n / sum(rho_residual rho_stream) (Box and Jenkins, Time Series
Analysis, ch. 11.1).
"""

from typing import NamedTuple

import numpy as np

from navcore.io.series import median_interval

HIGH_PASS_S = 300.0
LONGEST_LAG_S = 3700.0
_SHARE = 1.0 / 3.0
"""Of the time that two streams share, by which they are shifted at most."""
_STEP_S = 1.0
_MOST_STEPS = 1 << 19
_FEWEST = 60
_GAP = 5.0
"""Intervals; nothing is put between samples farther apart."""
_NEVER_BY_CHANCE = 40.0
"""Twice the logarithm of the likelihood ratio; the best of 10,000 shifts of noise has about 25."""
_NINETY_FIVE = 3.84
_COLOURED = 3.0
"""The interval is widened by this: drift that looks like a manoeuvre shifts the peak too."""
_RIDGE = 1e-9
_LEAST_SHARE = 0.1
"""Of the stream's fast changes that the others explain; less is chance, or no sign of a clock."""


class Lag(NamedTuple):
    """Time by which a stream is late.

    Attributes
    ----------
    late_s : float
        Best shift, s; negative for a stream that is early.
    reach_s : float
        Half of its interval, s, widened for drift that looks like a manoeuvre.
    related : bool
        Whether the streams change together at that shift by more than chance.
    against_none : float
        Twice the logarithm of the likelihood ratio of this shift to none.
    """

    late_s: float
    reach_s: float
    related: bool
    against_none: float

    @property
    def shifted(self) -> bool:
        """Whether the shift is there beyond chance."""
        return self.related and self.against_none > _NEVER_BY_CHANCE


def lag_between(
    time_s: np.ndarray, values: np.ndarray, other_s: np.ndarray, others: np.ndarray
) -> Lag | None:
    """Time by which a stream is late against others that explain it.

    Parameters
    ----------
    time_s : ndarray, shape (n,)
        Increasing epochs, s.
    values : ndarray, shape (n,)
        The stream.
    other_s : ndarray, shape (m,)
        Epochs of the others, of the same zero.
    others : ndarray, shape (m, k)
        What the stream is regressed on, at each shift anew.

    Returns
    -------
    Lag or None
        None where they share too little time for a shift.
    """
    if min(time_s.size, other_s.size) < _FEWEST:
        return None
    begin, end = min(time_s[0], other_s[0]), max(time_s[-1], other_s[-1])
    shared_s = min(time_s[-1], other_s[-1]) - max(time_s[0], other_s[0])
    step_s = max(_STEP_S, (end - begin) / _MOST_STEPS)
    grid = np.arange(begin, end + 0.5 * step_s, step_s)
    window = max(int(HIGH_PASS_S / step_s), 3)
    most = int(min(LONGEST_LAG_S, _SHARE * shared_s) / step_s)
    if shared_s <= 0.0 or most < 2 or grid.size < _FEWEST:
        return None
    stream, there = _fast(time_s, values[:, None], grid, window)
    regressors, known = _fast(other_s, others, grid, window)
    found = _best(stream[:, 0], there, regressors, known, most)
    if found is None:
        return None
    ratio = found.ratio
    return Lag(
        late_s=(found.place + _vertex(ratio, found.place + most)) * step_s,
        reach_s=max(_half_width(ratio, found.place + most), 0.1) * _COLOURED * step_s,
        related=found.against_nothing > _NEVER_BY_CHANCE and found.share > _LEAST_SHARE,
        against_none=float(ratio[most]),
    )


class _Shift(NamedTuple):
    """Best shift in steps; twice the log likelihood ratio to each shift and to no relation; its share."""

    place: int
    ratio: np.ndarray
    against_nothing: float
    share: float


def _best(
    stream: np.ndarray, there: np.ndarray, regressors: np.ndarray, known: np.ndarray, most: int
) -> _Shift | None:
    explained, count = _explained(stream, there, regressors, known, most)
    if not np.isfinite(explained).any() or np.nanmax(explained) <= 0.0:
        return None
    best = int(np.nanargmax(explained))
    left = np.log1p(-np.clip(explained, 0.0, 1.0 - 1e-9))
    independent = _independent(stream, there, regressors, known, best - most) * count[best]
    ratio = np.where(np.isfinite(left), independent * (left - left[best]), np.inf)
    return _Shift(best - most, ratio, float(-independent * left[best]), float(explained[best]))


def _rest(
    stream: np.ndarray, there: np.ndarray, regressors: np.ndarray, known: np.ndarray, place: int
) -> tuple[np.ndarray, np.ndarray]:
    """What the regressors leave when the stream is shifted by ``place``, and where both are."""
    moved = np.roll(regressors, place, axis=0)
    both = there & np.roll(known, place)
    fitted, *_ = np.linalg.lstsq(moved[both], stream[both], rcond=None)
    return np.where(both, stream - moved @ fitted, 0.0), both


def _fast(
    time_s: np.ndarray, values: np.ndarray, grid: np.ndarray, window: int
) -> tuple[np.ndarray, np.ndarray]:
    """Values on the grid without their moving mean, (g, k), zero where there are none; and where they are."""
    step_s, interval = grid[1] - grid[0], median_interval(time_s)
    if interval <= 0.5 * step_s:
        place = np.rint((time_s - grid[0]) / step_s).astype(np.int64)
        counts = np.bincount(place, minlength=grid.size)[: grid.size]
        sums = [np.bincount(place, column, grid.size)[: grid.size] for column in values.T]
        there = counts > 0
        on_grid = np.column_stack(sums) / np.maximum(counts, 1)[:, None]
    else:
        after = np.clip(np.searchsorted(time_s, grid), 1, time_s.size - 1)
        apart = time_s[after] - time_s[after - 1]
        there = (grid >= time_s[0]) & (grid <= time_s[-1]) & (apart <= _GAP * max(interval, step_s))
        on_grid = np.column_stack([np.interp(grid, time_s, column) for column in values.T])
    on_grid[~there] = 0.0
    near = _moving_sum(there.astype(float)[:, None], window)
    mean = _moving_sum(
        on_grid - (level := on_grid[there].mean(axis=0)) * there[:, None], window
    ) / np.maximum(near, 1.0)
    return (on_grid - level - mean) * there[:, None], there


def _moving_sum(columns: np.ndarray, window: int) -> np.ndarray:
    half = window // 2
    sums = np.concatenate([np.zeros((1, columns.shape[1])), np.cumsum(columns, axis=0)])
    places = np.arange(columns.shape[0])
    return sums[np.minimum(places + half + 1, columns.shape[0])] - sums[np.maximum(places - half, 0)]


def _explained(
    stream: np.ndarray, there: np.ndarray, regressors: np.ndarray, known: np.ndarray, most: int
) -> tuple[np.ndarray, np.ndarray]:
    """Share of the stream's variance that is explained at shifts -most to most, and samples in it."""
    size = _length(stream.size + most)

    def turned(values: np.ndarray) -> np.ndarray:
        return np.fft.rfft(values, size)

    def over_shifts(left: np.ndarray, right: np.ndarray) -> np.ndarray:
        """Sum over t of left(t) right(t - shift)."""
        found = np.fft.irfft(left * np.conj(right), size)
        return np.concatenate([found[size - most :], found[: most + 1]])

    mask, own, square = turned(there.astype(float)), turned(stream), turned(stream**2)
    count = over_shifts(mask, turned(known.astype(float)))
    total = over_shifts(square, turned(known.astype(float)))
    k = regressors.shape[1]
    cross = np.column_stack([over_shifts(own, turned(regressors[:, i])) for i in range(k)])
    gram = np.empty((cross.shape[0], k, k))
    for i in range(k):
        for j in range(i + 1):
            gram[:, i, j] = gram[:, j, i] = over_shifts(mask, turned(regressors[:, i] * regressors[:, j]))
    size_of = np.sqrt(np.maximum(np.einsum("sii->si", gram), 0.0)) + 1e-30
    gram = gram / size_of[:, :, None] / size_of[:, None, :] + _RIDGE * np.eye(k)
    cross = cross / size_of
    usable = (count > max(_FEWEST, 0.3 * count.max())) & (total > 0.0)
    shares = np.full(cross.shape[0], np.nan)
    solved = np.linalg.solve(gram[usable], cross[usable, :, None])[..., 0]
    shares[usable] = np.einsum("si,si->s", solved, cross[usable]) / total[usable]
    return shares, count


def _independent(
    stream: np.ndarray, there: np.ndarray, regressors: np.ndarray, known: np.ndarray, place: int
) -> float:
    """Share of the samples that counts as independent when the stream is shifted by ``place``."""
    rest, both = _rest(stream, there, regressors, known, place)
    alike = 1.0 + 2.0 * float(np.sum(_own_correlation(rest) * _own_correlation(np.where(both, stream, 0.0))))
    return 1.0 / max(alike, 1.0)


def _own_correlation(values: np.ndarray, most: int = 300) -> np.ndarray:
    """Autocorrelation at 1 to ``most`` steps."""
    size = _length(values.size + most + 1)
    found = np.fft.irfft(np.abs(np.fft.rfft(values, size)) ** 2, size)[: most + 1]
    return found[1:] / found[0] if found[0] > 0.0 else np.zeros(most)


def _vertex(ratio: np.ndarray, best: int) -> float:
    """Where the parabola through the best shift and its neighbours is least, in steps from it."""
    if not 0 < best < ratio.size - 1 or not np.isfinite(ratio[best - 1 : best + 2]).all():
        return 0.0
    left, middle, right = ratio[best - 1 : best + 2]
    bend = left - 2.0 * middle + right
    return 0.5 * float(left - right) / float(bend) if bend > 0.0 else 0.0


def _half_width(ratio: np.ndarray, best: int) -> float:
    """Half of the span of shifts that the data do not refuse, in steps."""
    outside = np.flatnonzero(ratio > _NINETY_FIVE)
    before, after = outside[outside < best], outside[outside > best]
    first = int(before[-1]) + 1 if before.size else 0
    last = int(after[0]) - 1 if after.size else ratio.size - 1
    if last > first:
        return 0.5 * float(last - first) + 0.5
    near = ratio[max(best - 1, 0) : best + 2]
    if near.size < 2:
        return 0.0
    beside = np.sort(near[np.isfinite(near)])[1:]
    bend = float(beside.mean()) if beside.size else 0.0
    return float(np.sqrt(_NINETY_FIVE / bend)) if bend > 0.0 else 1.0


def _length(least: int) -> int:
    """A power of two, which is fast to transform."""
    return 1 << (least - 1).bit_length()
