"""Random numbers of the sensors: unit white noise, drawn once a seed and sensor, and what is shaped from it.

A sensor's numbers depend on the scenario's seed and the sensor's name only: not on which other sensors are
on, on the order of calls or on the amplitude. So a slider on an amplitude scales numbers already drawn.
"""

import hashlib
import math
import threading
from collections import OrderedDict

import numpy as np

from navcore.foundation.compiled import kernel

CACHE_BYTES = 32 * 1024 * 1024
"""Memory for drawn numbers: 24 h at 1 s take 1 MB a three-axis sensor."""


class _Drawn:
    """Numbers already drawn, which depend on their key only; the least recently used are dropped first."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._held: OrderedDict[tuple[int, str, int], np.ndarray] = OrderedDict()
        self._lock = threading.Lock()

    def find(self, key: tuple[int, str, int], count: int) -> np.ndarray | None:
        """First ``count`` rows when at least so many are held."""
        with self._lock:
            held = self._held.get(key)
            if held is None or held.shape[0] < count:
                return None
            self._held.move_to_end(key)
            return held[:count]

    def keep(self, key: tuple[int, str, int], numbers: np.ndarray) -> None:
        """Hold numbers, unless they alone are too many."""
        if numbers.nbytes > self._limit:
            return
        with self._lock:
            held = self._held.get(key)
            if held is None or held.shape[0] < numbers.shape[0]:
                self._held[key] = numbers
            self._held.move_to_end(key)
            while sum(array.nbytes for array in self._held.values()) > self._limit:
                self._held.popitem(last=False)

    def nbytes(self) -> int:
        """Memory held."""
        with self._lock:
            return sum(array.nbytes for array in self._held.values())


_DRAWN = _Drawn(CACHE_BYTES)


def stream_generator(seed: int, stream: str) -> np.random.Generator:
    """Generator of one sensor's numbers; streams of different names or seeds are independent.

    Parameters
    ----------
    seed : int
        Seed of the scenario, >= 0.
    stream : str
        Name of the sensor's noise, e.g. ``"gyro.white"``.
    """
    name = np.frombuffer(hashlib.sha256(stream.encode()).digest(), dtype="<u4")
    return np.random.Generator(np.random.SFC64(np.random.SeedSequence([seed, *(int(word) for word in name)])))


def unit_noise(seed: int, stream: str, count: int, width: int) -> np.ndarray:
    """Independent normal numbers of zero mean and unit standard deviation.

    A longer draw begins with the numbers of a shorter one. Draws are kept (up to 32 MB over all streams).

    Parameters
    ----------
    seed : int
        Seed of the scenario, >= 0.
    stream : str
        Name of the sensor's noise, e.g. ``"gyro.white"``.
    count, width : int
        Number of rows (times) and columns (axes).

    Returns
    -------
    ndarray of float32, shape (count, width), read-only
    """
    key = (seed, stream, width)
    numbers = _DRAWN.find(key, count)
    if numbers is None:
        numbers = stream_generator(seed, stream).standard_normal((count, width), dtype=np.float32)
        numbers.flags.writeable = False
        _DRAWN.keep(key, numbers)
    return numbers


def gauss_markov(unit: np.ndarray, decay: float) -> np.ndarray:
    """First-order Gauss-Markov process of unit standard deviation, stationary from the start.

    x_0 = n_0, x_k = decay x_(k-1) + sqrt(1 - decay^2) n_k.

    Parameters
    ----------
    unit : ndarray of float32, shape (n, m)
        From `unit_noise`; each column makes its own process.
    decay : float
        exp(-step / correlation time).

    Returns
    -------
    ndarray of float32, shape (n, m)
    """
    out = np.empty_like(unit)
    _gauss_markov(unit, float(decay), math.sqrt(1.0 - decay * decay), out)
    return out


@kernel
def _gauss_markov(unit, decay, drive, out):
    for j in range(unit.shape[1]):
        state = float(unit[0, j]) if unit.shape[0] else 0.0
        for k in range(unit.shape[0]):
            if k:
                state = decay * state + drive * unit[k, j]
            out[k, j] = state
