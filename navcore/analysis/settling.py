"""When the response to an initial tilt has come to rest."""

import math

import numpy as np

from navcore.analysis.response import ExponentialLadder
from navcore.networks.base import ComplexArray
from navcore.networks.state_space import StateSpace

LEVEL = 0.02
"""Settled: |phi/phi_0| stays below this (theory.md 3.6)."""

_NEAR_LEVEL = 0.97 * LEVEL
_PHASE_STEP = 0.25
_DEAD = 18.0
_MARGIN = 8.0
_COARSEST, _FINEST = 7, 18
_LEAST_DAMPING = 2.5e-4
_ZOOM = 5
_ZOOMS = 2


def last_exceedance(system: StateSpace, poles: ComplexArray) -> float | None:
    """Last normalised time at which |C e^(A tau) B| exceeds `LEVEL`.

    The time axis is searched backwards in octaves; in each the grid resolves the oscillations still alive,
    peaks close to the level are looked at more finely, and the last crossing is zoomed in on. All steps are
    the horizon over a power of two, so that one ladder of squarings serves them all.

    Parameters
    ----------
    system : StateSpace
        Response C e^(A tau) B, normalised time.
    poles : ndarray of complex
        Its poles, all with a negative real part.

    Returns
    -------
    float or None
        Normalised time; 0 when the level is never exceeded, None when no end was found or a pair is damped by
        less than 2.5e-4 (at Schuler frequency that is months, and the grid could not resolve them).
    """
    if np.any(-poles.real < _LEAST_DAMPING * np.abs(poles)):
        return None
    end = (_MARGIN - math.log(LEVEL)) / float(np.min(-poles.real))
    for _ in range(4):
        crossing = _Search(system, poles, end).run()
        if crossing < 0.999 * end:
            return crossing
        end *= 16.0  # a large transient hid behind the margin
    return None


class _Search:
    def __init__(self, system: StateSpace, poles: ComplexArray, end: float) -> None:
        self.system, self.end = system, end
        self.octaves = max(1, math.ceil(math.log2(end * 100.0 * float(np.max(np.abs(poles))))))
        self.rates = [(-pole.real, abs(pole.imag)) for pole in poles.tolist()]
        grids = [self._grid(j) for j in range(self.octaves + 1)]
        deepest = max(level + grid for level, grid in grids) + _ZOOMS * _ZOOM
        self.ladder = ExponentialLadder(system.A, end, deepest)
        self.grids = grids

    def _grid(self, octave: int) -> tuple[int, int]:
        """Level of the octave's length, and the power of two of its number of steps."""
        level = min(octave + 1, self.octaves)
        length = self.end / 2.0**level
        lower = length if octave < self.octaves else 0.0
        fastest = max([swing for decay, swing in self.rates if decay * lower < _DEAD], default=0.0)
        wanted = length * fastest / _PHASE_STEP
        return level, min(max(_COARSEST, math.ceil(math.log2(max(wanted, 1.0)))), _FINEST)

    def run(self) -> float:
        """Search from the end backwards."""
        start = self.system.B
        for octave, (level, grid) in enumerate(self.grids):
            lower = self.end / 2.0**level if octave < self.octaves else 0.0
            state = start + self.ladder.minus_identity(level) @ start if lower > 0.0 else start
            crossing = self._last(state, level + grid, grid, 0)
            if crossing is not None:
                return lower + crossing
        return 0.0

    def _last(self, state: np.ndarray, level: int, grid: int, depth: int) -> float | None:
        """Time after ``state`` of the last crossing within 2^grid steps of length end/2^level."""
        states = self.ladder.states(state, level, grid)
        size = np.abs(states @ self.system.C)
        step = self.end / 2.0**level
        over = np.flatnonzero(size > LEVEL)
        last = int(over[-1]) if len(over) else -1
        if depth == 0:
            peak = self._hidden_peak(states, size, level, last)
            if peak is not None:
                return peak
        if last < 0:
            return None
        if last == len(size) - 1:
            return last * step
        if depth < _ZOOMS:
            inner = self._last(states[last], level + _ZOOM, _ZOOM, depth + 1)
            return last * step + (inner or 0.0)
        return (last + (size[last] - LEVEL) / (size[last] - size[last + 1])) * step

    def _hidden_peak(self, states: np.ndarray, size: np.ndarray, level: int, last: int) -> float | None:
        """Look between the samples around later maxima that come close to the level."""
        middle = size[1:-1]
        close = (middle > _NEAR_LEVEL) & (middle >= size[:-2]) & (middle >= size[2:])
        close[: max(0, last)] = False  # maxima at sample last + 1 and later
        for k in (np.flatnonzero(close) + 1)[::-1]:
            for cell in (k, k - 1):
                crossing = self._last(states[cell], level + _ZOOM, _ZOOM, 1)
                if crossing is not None:
                    return cell * self.end / 2.0**level + crossing
        return None
