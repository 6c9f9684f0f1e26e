"""A scenario's motion as the covariance sees it: intervals over which the error model hardly changes.

Within an interval the coefficients of the error model and the attitude are replaced by their means, so that
what integrates (a change of speed, a turn) is kept. Intervals that agree to what no error could tell share
one set of matrices: a straight leg is one set, however long.
"""

import math
from dataclasses import dataclass

import numpy as np

from navcore.engine.environment import coefficients_of, truth_of
from navcore.mechanization.trajectory import COLUMNS, named, table_of
from navcore.motion.truth import HEADING, PITCH, ROLL, VE, VN, Truth
from navcore.scenario.model import Scenario
from navcore.sensors.simulated_log import hold_time, log_works, moored

MOST_INTERVALS = 1440
"""Of a run: a minute each of a day. Shorter runs have one an output row."""
_RATE, _FORCE, _SPEED, _ANGLE = 2e-8, 2e-3, 0.1, 2e-3
_TOLERANCES = np.array(
    [*[_RATE] * 3, *[_FORCE] * 3, 3e-12, 3e-12, 1e-3, _RATE, _RATE, *[_SPEED] * 3, 1e-8, 1e-3, 1e9, 1e9]
)
"""Of `navcore.mechanization.trajectory` columns, within which two intervals count as alike."""


@dataclass(frozen=True, eq=False)
class Course:
    """Intervals of a run and their distinct kinds.

    Attributes
    ----------
    step_s : float
        Time between two calls of the damping law, s.
    hold : int
        Calls for which a sample of the log is held.
    edges : ndarray of int, shape (k + 1,)
        Calls at which the intervals begin and the last one ends.
    kind : ndarray of int, shape (k,)
        Which of the kinds each interval is.
    length : ndarray of int, shape (g,)
        Calls in an interval of each kind.
    served : ndarray of bool, shape (g,)
        Whether the log works in it.
    moored : ndarray of bool, shape (g,)
        Whether the velocity zero of a moored ship stands in the place of the log.
    half : ndarray, shape (g, COLUMNS)
        Mean coefficients, columns of `navcore.mechanization.trajectory`.
    turn : ndarray, shape (k, 9)
        Mean C_b^n of each interval, row by row.
    velocity : ndarray, shape (k, 2)
        Mean true velocity of each interval, E and N, m/s.
    metres : ndarray, shape (k + 1, 2)
        Metres of a radian of latitude and longitude at the edges.
    truth : Truth
        The motion itself, on half steps of ``truth_step_s``.
    truth_step_s : float
        s.
    """

    step_s: float
    hold: int
    edges: np.ndarray
    kind: np.ndarray
    length: np.ndarray
    served: np.ndarray
    moored: np.ndarray
    half: np.ndarray
    turn: np.ndarray
    velocity: np.ndarray
    metres: np.ndarray
    truth: Truth
    truth_step_s: float

    @property
    def log_counts(self) -> np.ndarray:
        """1 for each interval in which the log's errors count, 0 while the ship is moored; shape (k, 1)."""
        return 1.0 - self.moored[self.kind][:, None]

    @property
    def t_s(self) -> np.ndarray:
        """Times of the edges, s, shape (k + 1,)."""
        return self.edges * self.step_s

    def means(self, times_s: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Mean of a series of samples, held until the next, over each interval; shape (k, columns)."""
        if len(values) == 1:
            return np.broadcast_to(values, (len(self.kind), values.shape[1]))
        begin = np.searchsorted(times_s, self.t_s[:-1] - 1e-9)
        begin = np.minimum(begin, len(values) - 1)
        counts = np.maximum(np.diff(np.append(begin, len(values))), 1)
        return np.add.reduceat(values, begin, axis=0) / counts[:, None]


def law_steps(scenario: Scenario) -> tuple[float, int]:
    """Time between two calls of the damping law (s), and their number in the run."""
    if not scenario.strapdown:
        return scenario.run.step_s, scenario.steps
    sampling = scenario.sampling
    return sampling.law_step_s, sampling.samples // sampling.law_every


def motion_steps(scenario: Scenario) -> tuple[int, float]:
    """Number of steps in which the motion is made, and their length (s)."""
    step_s, steps = law_steps(scenario)
    truth_step = scenario.run.step_s if not scenario.strapdown else min(scenario.sampling.record_step_s, 1.0)
    return max(1, math.ceil(steps * step_s / truth_step - 1e-9)), truth_step


def course(scenario: Scenario, most: int = MOST_INTERVALS, extra_s: tuple[float, ...] = ()) -> Course:
    """Divide a scenario's run into intervals.

    Parameters
    ----------
    scenario : Scenario
        Its motion, outages and rates.
    most : int
        Intervals that a run is divided into at most, apart from those that outages add.
    extra_s : tuple of float
        Further times at which an interval begins, s.

    Raises
    ------
    InputError
        The motion cannot be carried out.
    """
    step_s, steps = law_steps(scenario)
    hold = _hold(scenario, step_s)
    count, truth_step = motion_steps(scenario)
    truth = truth_of(scenario, count, truth_step)
    served, still = _served(scenario, truth, step_s, steps)
    edges = _edges(scenario, step_s, steps, hold, most, served + 2 * still, extra_s)
    half = table_of(coefficients_of(scenario, count, truth_step).half)
    places = np.minimum(np.rint(edges * (step_s / (0.5 * truth_step))).astype(np.int64), 2 * count)
    level = scenario.run.fidelity == "channel"
    turns = np.eye(3).reshape(1, 9) if level else attitudes(truth.values)
    mean_half, turn = _means(half, places), _means(turns, places)
    works, lies = (
        state[edges[:-1]] if len(state) > 1 else np.full(len(edges) - 1, state[0])
        for state in (served, still)
    )
    kinds, kind = _kinds(mean_half, turn, np.diff(edges), works + 2 * lies)
    at_edges = half[places] if len(half) > 1 else np.broadcast_to(half, (len(edges), COLUMNS))
    return Course(
        step_s=step_s,
        hold=hold,
        edges=edges,
        kind=kind,
        length=np.diff(edges)[kinds],
        served=works[kinds],
        moored=lies[kinds],
        half=_mean_of_kinds(mean_half, kind, len(kinds)),
        turn=turn,
        velocity=_means(truth.values[:, [VE, VN]], places),
        metres=np.column_stack([named(at_edges)["m"], named(at_edges)["n_cos"]]),
        truth=truth,
        truth_step_s=truth_step,
    )


def _hold(scenario: Scenario, step_s: float) -> int:
    log = scenario.reference
    return 1 if log.kind != "log" else max(1, round(1.0 / (log.rate_hz * step_s)))


def _served(scenario: Scenario, truth: Truth, step_s: float, steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Whether the law has a reference at each call, and whether that of a moored ship; one value for all."""
    log = scenario.reference
    if log.kind != "log" or not (log.interrupted or log.zero_below_mps > 0.0):
        return np.full(1, log.kind != "none"), np.zeros(1, dtype=bool)
    interval = max(1.0, log.rate_hz * step_s) / log.rate_hz
    t = np.arange(steps + 1) * step_s
    epoch = np.floor(t / interval + 1e-9) * interval
    still = np.array(np.broadcast_to(moored(log, truth, epoch), epoch.size))
    return (log_works(log, truth, epoch) | still) & (t - epoch <= hold_time(interval)), still


def _edges(
    scenario: Scenario,
    step_s: float,
    steps: int,
    hold: int,
    most: int,
    state: np.ndarray,
    extra_s: tuple[float, ...],
) -> np.ndarray:
    width = max(scenario.run.output_step_s, steps * step_s / most)
    every = max(1, round(width / (step_s * hold))) * hold
    changes = np.flatnonzero(np.diff(state)) + 1 if len(state) > 1 else np.zeros(0, dtype=np.int64)
    extra = np.rint(np.array(extra_s) / step_s).astype(np.int64)
    regular = np.arange(0, steps, every)
    edges = np.unique(np.concatenate([regular, changes, extra[extra < steps], [steps]]))
    return edges.astype(np.int64)


def attitudes(values: np.ndarray) -> np.ndarray:
    """C_b^n = Rz(-heading) Rx(pitch) Ry(roll) of each row of truth, row by row; shape (n, 9)."""
    angles = values[:, [PITCH, ROLL, HEADING]]
    if np.ptp(angles, axis=0).max() == 0.0:
        angles = angles[:1]
    (sp, sr, sh), (cp, cr, ch) = np.sin(angles).T, np.cos(angles).T
    return np.stack(
        [
            *(ch * cr + sh * sp * sr, sh * cp, ch * sr - sh * sp * cr),
            *(-sh * cr + ch * sp * sr, ch * cp, -sh * sr - ch * sp * cr),
            *(-cp * sr, sp, cp * cr),
        ],
        axis=1,
    )


def log_axes(body: bool, turn: np.ndarray) -> np.ndarray:
    """Columns of the log's two axes in E, N, for attitudes C_b^n of shape (g, 3, 3); shape (g, 2, 2)."""
    if not body:
        return np.broadcast_to(np.eye(2), (len(turn), 2, 2))
    # the ship's forward axis over the ground is the second column of C_b^n
    heading = np.arctan2(turn[:, 0, 1], turn[:, 1, 1])
    sine, cosine = np.sin(heading), np.cos(heading)
    return np.stack([cosine, sine, -sine, cosine], axis=1).reshape(-1, 2, 2)


def _means(rows: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Mean of the rows from each place to the next, both ends included by half; one row stands for all."""
    count = len(places) - 1
    if len(rows) == 1:
        return np.broadcast_to(rows, (count, rows.shape[1])).copy()
    begin = np.minimum(places[:-1], len(rows) - 2)
    sums = np.add.reduceat(rows[:-1], begin, axis=0)
    last = len(rows) - 1
    widths = np.diff(np.append(begin, last))[:, None]
    ends = np.minimum(places[1:], last)
    return (sums + 0.5 * (rows[ends] - rows[begin])) / widths


def _kinds(
    half: np.ndarray, turn: np.ndarray, length: np.ndarray, state: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """First interval of each kind, and the kind of each interval."""
    key = np.column_stack([np.rint(half / _TOLERANCES), np.rint(turn / _ANGLE), length, state])
    _, first, kind = np.unique(key.astype(np.int64), axis=0, return_index=True, return_inverse=True)
    return first, kind.reshape(-1)


def _mean_of_kinds(rows: np.ndarray, kind: np.ndarray, count: int) -> np.ndarray:
    sums = np.zeros((count, rows.shape[1]))
    np.add.at(sums, kind, rows)
    return sums / np.bincount(kind, minlength=count)[:, None]
