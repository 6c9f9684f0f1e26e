"""Curves of a method: the recorded errors, and the lengths of their vectors, about which limits are."""

import math

import numpy as np

from navcore.engine.run import MethodRun
from navcore.quantities import LENGTHS, NAMES, VECTORS, components


def with_lengths(errors: np.ndarray) -> np.ndarray:
    """Add the lengths of `navcore.quantities.VECTORS` to errors.

    Parameters
    ----------
    errors : ndarray, shape (m, 7) or (m, 8)
        Columns of `navcore.quantities.NAMES`.

    Returns
    -------
    ndarray, shape (m, 9) or (m, 10)
    """
    pairs = ([NAMES.index(name) for name in components(vector.kind)] for vector in VECTORS)
    return np.column_stack([errors, *(np.hypot(*errors[:, pair].T) for pair in pairs)])


def curves_of(method: MethodRun) -> np.ndarray:
    """Curves of a method, shape (m, 10): the recorded errors, then the lengths of `VECTORS`.

    The curves keep the extremes of each error in a bin, not the moments at which they come: a length that is
    made of them may be larger than any that there was, and pass a limit that is met. So each span's largest
    length, which the run measures at every step and by which limits are judged, is the largest of the curve.
    """
    t_s, curves = method.plot.t_s, with_lengths(method.plot.values)
    for drawn, vector in zip(curves.T[len(NAMES) :], VECTORS, strict=True):
        for span in method.spans:
            inside, largest = t_s >= span.from_s - 1e-6, span.largest[LENGTHS.index(vector.kind.name)]
            if math.isfinite(largest) and np.any(np.isfinite(drawn[inside])):
                np.minimum(drawn, largest, out=drawn, where=inside)
                drawn[np.flatnonzero(inside)[np.nanargmax(drawn[inside])]] = largest
    return curves


def on_times(time_s: np.ndarray, own_s: np.ndarray, own: np.ndarray) -> np.ndarray:
    """Values of a run with other plot bins at the times of this one: each point the nearest one.

    Of a bin's two extremes the first goes to a first one, so that noise keeps its width on the screen.
    """
    if not len(own_s) or not len(time_s):
        return np.full((len(time_s), own.shape[1]), np.nan)
    pairs = 2 if own_s[0] > 0.0 and len(own_s) > 2 else 1
    places = np.empty(len(time_s), np.int64)
    for place in range(pairs):
        mine, wanted = own_s[place::pairs], time_s[place::pairs]
        later = np.clip(np.searchsorted(mine, wanted), 1, max(len(mine) - 1, 1)) if len(mine) > 1 else 0
        nearer = np.where(wanted - mine[later - 1] < mine[later] - wanted, later - 1, later)
        places[place::pairs] = pairs * nearer + place
    spacing = (own_s[-1] - own_s[0]) / max(len(own_s) - 1, 1)
    ended = time_s > own_s[-1] + pairs * spacing
    return np.where(ended[:, None], np.nan, own[places])
