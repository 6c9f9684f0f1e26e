"""The worst case of a log whose error also changes no faster than a given rate: a linear program.

The unknowns are the log's errors at some of its epochs, linear in between: evenly spaced ones, those at which
the weight changes its sign and, once a first solution is there, further ones along its ramps.
"""

import math

import numpy as np

_EVEN = 300
"""Epochs of the first solution that are evenly spaced."""
_LATE = 40
"""Epochs before the end whose distances grow in equal ratios: what fast modes have not yet forgotten."""
_FINER = 4
"""Parts into which the second solution divides each piece of a ramp."""
_SIGNS = 200
"""Changes of sign that are epochs of the first solution, at most."""


def worst_within_rate(weights: np.ndarray, begin_s: np.ndarray, rate: float) -> tuple[np.ndarray, np.ndarray]:
    """Find the error of the log that makes the largest sum with the weights.

    Parameters
    ----------
    weights : ndarray, shape (m,)
        Of the log's error in each cell.
    begin_s : ndarray, shape (m,)
        Begin of each cell, s.
    rate : float
        Largest change in a second of an error that stays within 1, 1/s.

    Returns
    -------
    time_s : ndarray, shape (n,)
        Begins of some of the cells, the first and the last among them.
    error : ndarray, shape (n,)
        Error there, between -1 and 1, and no two further apart than the rate allows; linear in between.
    """
    if not weights.any():
        return begin_s[[0, -1]], np.zeros(2)
    nodes = _first_nodes(weights)
    first = _solved(_on_nodes(weights, begin_s, nodes), begin_s[nodes], rate)
    nodes = _along_ramps(nodes, first)
    return begin_s[nodes], _solved(_on_nodes(weights, begin_s, nodes), begin_s[nodes], rate)


def _first_nodes(weights: np.ndarray) -> np.ndarray:
    last = len(weights) - 1
    even = np.linspace(0, last, min(_EVEN, last + 1))
    late = last - np.geomspace(1.0, max(last, 1), _LATE)
    turns = np.flatnonzero(np.diff(np.signbit(weights)))
    turns = turns[:: -(-len(turns) // _SIGNS) or 1]
    return np.unique(np.clip(np.rint(np.concatenate([even, late, turns])), 0, last).astype(np.int64))


def _along_ramps(nodes: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Add nodes within the pieces that are not constant at a bound."""
    ramps = np.flatnonzero((np.abs(values[:-1]) < 1.0 - 1e-9) | (np.abs(values[1:]) < 1.0 - 1e-9))
    shares = np.arange(1, _FINER) / _FINER
    more = nodes[ramps][:, None] + shares * np.diff(nodes)[ramps][:, None]
    return np.unique(np.concatenate([nodes, np.rint(more.reshape(-1)).astype(np.int64)]))


def _on_nodes(weights: np.ndarray, begin_s: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """Weights of the nodes for errors that are linear between them."""
    if len(nodes) == 1:
        return np.array([weights.sum()])
    sums, moments = np.add.reduceat(np.stack([weights, weights * begin_s]), nodes[:-1], axis=1)
    later = (moments - sums * begin_s[nodes[:-1]]) / np.diff(begin_s[nodes])
    return np.append(sums - later, 0.0) + np.append(0.0, later)


def _solved(weights: np.ndarray, time_s: np.ndarray, rate: float) -> np.ndarray:
    """Values of the nodes that make the largest sum: the linear program, solved exactly from node to node.

    Up to a node the largest sum is a concave function of the value there, linear between breakpoints. What
    the rate allows moves those on either side of its maximum outwards. A weight adds a slope: breakpoints
    pass to the other side until their changes of slope make up for it, and there is the new maximum.
    Backwards, each value is as near to the maximum of its node as the rate allows.
    """
    steps = [*(rate * np.diff(time_s)).tolist(), 0.0]
    below: list[tuple[float, float]] = []  # distance outwards from 0 less ``moved``, change of slope
    above: list[tuple[float, float]] = []  # of both sides the innermost is the last
    moved, best = 0.0, []
    for weight, step in zip(weights.tolist(), steps, strict=True):
        near, far, sign = (below, above, 1.0) if weight >= 0.0 else (above, below, -1.0)
        left = abs(weight)
        while left > 0.0:
            stored, change = far.pop() if far else (math.inf, left)
            outwards = min(stored + moved, 1.0)
            part = min(left, change) if outwards < 1.0 else left
            near.append((-outwards - moved, part))
            if part < change and outwards < 1.0:
                far.append((stored, change - part))
            left -= part
        best.append(min(max(-sign * (near[-1][0] + moved), -1.0), 1.0) if near else -sign)
        moved += step
    values = best[-1:]
    for one, step in zip(best[-2::-1], steps[-2::-1], strict=True):
        values.append(min(max(one, values[-1] - step), values[-1] + step))
    return np.array(values[::-1])
