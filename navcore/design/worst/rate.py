"""The worst case of a log whose error also changes no faster than a given rate: a linear program.

The unknowns are the log's errors at some of its epochs, linear in between: evenly spaced ones, those at which
the weight changes its sign and, once a first solution is there, further ones along its ramps.
"""

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
    place = np.clip(np.searchsorted(nodes, np.arange(len(weights)), side="right") - 1, 0, len(nodes) - 2)
    left, right = begin_s[nodes[place]], begin_s[nodes[place + 1]]
    share = (begin_s - left) / (right - left)
    before = np.bincount(place, weights * (1.0 - share), len(nodes))
    return before + np.bincount(place + 1, weights * share, len(nodes))


def _solved(weights: np.ndarray, time_s: np.ndarray, rate: float) -> np.ndarray:
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import eye

    count = len(weights)
    if count == 1:
        return np.sign(weights)
    change = eye(count - 1, count, 1, format="csc") - eye(count - 1, count, format="csc")
    step = rate * np.diff(time_s)
    # without whole numbers it is the linear program, with rows that are bounded on both sides
    found = milp(
        -weights / np.max(np.abs(weights)),
        constraints=LinearConstraint(change, -step, step),  # pyright: ignore[reportArgumentType]
        bounds=Bounds(-1.0, 1.0),
    )
    assert found.x is not None, found.message
    return np.clip(found.x, -1.0, 1.0)
