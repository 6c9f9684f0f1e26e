"""What each sample of the log does to the errors of a linear method: the weights of its worst case.

An error at the time T is the sum of the log's errors, each times its weight. A backward pass over the
intervals of the run gives the weights of all errors at one T.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from navcore.design.along import engaged_at, staged_loops
from navcore.design.course import Course, log_axes
from navcore.design.maps import LOG, LoopModel, call_map, calls_joined
from navcore.design.worst.logs import LogError
from navcore.quantities import COMPONENTS
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import StochasticModel

_STATES = np.array([4, 5, 6, 0, 1, 2, 3])
"""Places of `COMPONENTS` among the states of the error model."""
_MOST_CELLS = 64
"""Of an interval: more samples of the log are taken together, and count as equal."""
_GROUPS = 240
"""Ends of the run's parts at which the time of the largest error is looked for."""


@dataclass(frozen=True, eq=False)
class Weights:
    """Error at one time by the log's error in each cell.

    Attributes
    ----------
    end_s : float
        The time, s.
    begin_s : ndarray, shape (m,)
        Begin of each cell, s: the epoch of its first sample.
    of : ndarray, shape (7, m, 2)
        For `navcore.quantities.COMPONENTS`, in rad, m/s and m per m/s, by the log's own axes.
    """

    end_s: float
    begin_s: np.ndarray
    of: np.ndarray

    def bound(self) -> np.ndarray:
        """Return the largest error for a log within 1 m/s, shape (7,)."""
        return np.abs(self.of).sum(axis=(1, 2))


@dataclass(frozen=True, eq=False)
class LogResponse:
    """A linear method along a run, as the log's errors drive it.

    Attributes
    ----------
    course : Course
        The run's intervals.
    Phi : ndarray, shape (g, n, n)
        Map of an interval of each kind.
    cells : tuple of ndarray, shape (n, c, 2)
        State at the end of an interval of each kind by the log's error in each of its cells.
    starts : tuple of ndarray of int, shape (c,)
        Call at which each cell begins, from that of the interval.
    engaged : ndarray of bool, shape (k,)
        Intervals at whose begin the networks are cleared.
    networks : slice
        States that are cleared then.
    axes : ndarray, shape (k, 2, 2)
        Columns of the log's axes in E and N.
    """

    course: Course
    Phi: np.ndarray
    cells: tuple[np.ndarray, ...]
    starts: tuple[np.ndarray, ...]
    engaged: np.ndarray
    networks: slice
    axes: np.ndarray

    def weights(self, edge: int) -> Weights:
        """Weights of the errors at an edge of the course."""
        course = self.course
        rows = np.eye(self.Phi.shape[-1])[_STATES]
        rows[5:] *= course.metres[edge][:, None]
        found: list[np.ndarray] = []
        for k in range(edge - 1, -1, -1):
            kind = course.kind[k]
            cells = self.cells[kind]
            found.append((rows @ cells.reshape(len(cells), -1)).reshape(len(rows), -1, 2) @ self.axes[k])
            rows = rows @ self.Phi[kind]
            if self.engaged[k]:
                rows[:, self.networks] = 0.0
        kinds, edges = course.kind[:edge].tolist(), course.edges[:edge].tolist()
        begin = np.concatenate([first + self.starts[kind] for first, kind in zip(edges, kinds, strict=True)])
        return Weights(course.t_s[edge], begin * course.step_s, np.concatenate(found[::-1], axis=1))

    def worst_edges(self, within_s: float = 0.0) -> np.ndarray:
        """Edges of the course at which each error can be largest, shape (7, c), the likeliest first.

        At rest that is the end: what a log can do in a time it can do later too. Along a motion the bound is
        found at the ends of groups of intervals, and then around the largest.

        Parameters
        ----------
        within_s : float
            Time that the log takes from one bound to the other, s: weights of other signs within it cancel
            in part.
        """
        last = len(self.course.kind)
        if self.at_rest:
            return np.full((len(COMPONENTS), 1), last)
        found = [self._worst_edges(0)]
        if (width := round(within_s / (self.course.t_s[-1] / _GROUPS))) > 1:
            found = [self._worst_edges(width), *found, np.full(len(COMPONENTS), last)]
        return np.stack(found, axis=1)

    def _worst_edges(self, width: int) -> np.ndarray:
        """Edges of the largest errors for a log that takes ``width`` groups to change; shape (7,)."""
        last = len(self.course.kind)
        ends, bounds = self._grouped_bounds(width)
        best = ends[np.argmax(bounds, axis=0)]
        if width:
            return best
        half = max(1, int(ends[0]) // 2)
        edges = sorted({min(max(int(end) + d, 1), last) for end in best for d in (-half, 0, half)})
        exact = np.array([self.weights(edge).bound() for edge in edges])
        return np.array(edges)[np.argmax(exact, axis=0)]

    @property
    def at_rest(self) -> bool:
        """Whether all intervals are alike."""
        return len(self.Phi) == 1 and not self.engaged.any()

    def errors(self, log: LogError) -> np.ndarray:
        """Errors at the edges of the course under a log, shape (k + 1, 7)."""
        course, x = self.course, np.zeros(self.Phi.shape[-1])
        out = np.zeros((len(course.edges), len(COMPONENTS)))
        for k, kind in enumerate(course.kind.tolist()):
            if self.engaged[k]:
                x[self.networks] = 0.0
            given = log.at((course.edges[k] + self.starts[kind]) * course.step_s) @ self.axes[k].T
            x = self.Phi[kind] @ x + np.tensordot(self.cells[kind], given, 2)
            out[k + 1] = x[_STATES]
        out[:, 5:] *= course.metres
        return out

    def _grouped_bounds(self, width: int) -> tuple[np.ndarray, np.ndarray]:
        """Ends of groups of intervals, and the bounds there for a log that is constant in each group.

        With a ``width`` the weights are means over so many groups: what a slow log cannot follow cancels.
        """
        course, n, last = self.course, self.Phi.shape[-1], len(self.course.kind)
        every = -(-last // _GROUPS)
        held = np.stack([cells.sum(axis=1) for cells in self.cells])
        columns, ends, bounds = np.zeros((n, 0)), [], []
        group = np.zeros((n, 2))
        for k in range(last):
            kind = course.kind[k]
            if self.engaged[k]:
                columns[self.networks], group[self.networks] = 0.0, 0.0
            columns, group = self.Phi[kind] @ columns, self.Phi[kind] @ group + held[kind] @ self.axes[k]
            if (k + 1) % every == 0 or k + 1 == last:
                columns, group = np.concatenate([columns, group], axis=1), np.zeros((n, 2))
                rows = columns[_STATES].reshape(len(_STATES), -1, 2)
                if width:
                    sums = np.cumsum(np.pad(rows, ((0, 0), (width, 0), (0, 0))), axis=1)
                    rows = (sums[:, width:] - sums[:, :-width]) / width
                bound = np.abs(rows).sum(axis=(1, 2))
                bound[5:] *= course.metres[k + 1]
                ends.append(k + 1)
                bounds.append(bound)
        return np.array(ends), np.array(bounds)


def log_response(scenario: Scenario, method: Method, course: Course, model: StochasticModel) -> LogResponse:
    """Make the response of a method whose law is known in advance.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    method : Method
        Of a kind of damping whose loop has a covariance, that reads the log.
    course : Course
        Of `navcore.design.course.course`.
    model : StochasticModel
        Of the scenario.
    """
    course, stage, loops = staged_loops(scenario, method, course, model)
    last = loops[-1]
    g, n = len(course.length), last.states
    Phi = np.zeros((g, n, n))
    cells: list[np.ndarray] = [np.zeros(0)] * g
    starts: list[np.ndarray] = [np.zeros(0, dtype=np.int64)] * g
    alike = np.column_stack([course.length, course.served, stage])
    for calls, works, of_law in np.unique(alike, axis=0).tolist():
        of = np.flatnonzero((alike == (calls, works, of_law)).all(axis=1))
        whole, columns, begin = _interval(loops[of_law], course.half[of], calls, bool(works))
        Phi[of] = whole
        for place, kind in enumerate(of.tolist()):
            counts = 0.0 if course.moored[kind] else 1.0
            cells[kind], starts[kind] = columns[place] * counts, begin
    axes = log_axes(last.body_frame, course.turn.reshape(-1, 3, 3))
    served = course.served[course.kind]
    return LogResponse(course, Phi, tuple(cells), tuple(starts), engaged_at(served), last.networks, axes)


def _interval(
    loop: LoopModel, half: np.ndarray, calls: int, works: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Map of intervals, their states by the log's error in each cell, (g, n, c, 2), and the cells' begins."""
    fresh, hold = call_map(loop, half, works, fresh=True), loop.hold
    later = call_map(loop, half, works, fresh=False) if hold > 1 else fresh
    in_cell = hold * -(-calls // (hold * _MOST_CELLS))
    lengths = [in_cell] * (calls // in_cell) + [calls % in_cell] * bool(calls % in_cell)
    maps = {length: calls_joined(fresh, lambda: later, length, hold) for length in {*lengths}}
    left = np.broadcast_to(np.eye(loop.states), (len(half), loop.states, loop.states))
    columns = []
    for length in reversed(lengths):
        one = maps[length]
        columns.append(left @ one.B[:, :, LOG])
        left = left @ one.Phi
    begin = np.cumsum([0, *lengths[:-1]])
    return left, np.stack(columns[::-1], axis=2), begin
