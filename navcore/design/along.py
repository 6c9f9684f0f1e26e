"""The transient error budget along a scenario's motion: errors of every source by discretised steps.

The random processes are carried as covariances, one matrix a source; constants and errors of a known shape as
responses, one column each. What the scenario gives as a number adds up with its sign; what it gives by a
standard deviation adds up in variance. The law must be known in advance: `constant` or `schedule`, with
outages of the log (theory.md 15).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from navcore.design.azimuth import AzimuthForm, azimuth_form, up_rate
from navcore.design.constants import Column, own_columns, shared_columns
from navcore.design.course import Course, log_axes
from navcore.design.form import LawForm
from navcore.design.maps import (
    ACCEL,
    ERRORS,
    GYRO,
    INPUTS,
    LOG,
    MOTION,
    UP,
    LoopModel,
    interval_map,
    loop_model,
    mean_coefficients,
)
from navcore.design.noise import AXES, INPUTS_OF, interval_noise
from navcore.design.scheduled import law_stages
from navcore.quantities import COMPONENTS
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import RANDOM_SOURCES, StochasticModel

_LOG_WHITE, _LOG_DRIFT = (RANDOM_SOURCES.index(source) for source in ("log_white", "log_drift"))
_STATES = np.array([4, 5, 6, 0, 1, 2, 3])


@dataclass(frozen=True, eq=False)
class Along:
    """Errors of one method along the run, by source, for `COMPONENTS`; each array has the shape (k + 1, 7).

    Attributes
    ----------
    t_s : ndarray, shape (k + 1,)
        Times, s.
    random : dict of ndarray
        Variances of the sources that are known by a standard deviation, in the components' units squared.
    given : dict of ndarray
        Errors that follow from the sources that the scenario gives as numbers.
    """

    t_s: np.ndarray
    random: dict[str, np.ndarray]
    given: dict[str, np.ndarray]

    @property
    def variance(self) -> dict[str, np.ndarray]:
        """Mean square of each source by itself."""
        with np.errstate(over="ignore", invalid="ignore"):
            squares = {source: error**2 for source, error in self.given.items()}
            return self.random | {
                source: square + self.random.get(source, 0.0) for source, square in squares.items()
            }

    @property
    def total(self) -> np.ndarray:
        """Mean square of all sources together."""
        return self.scaled({})

    @property
    def given_total(self) -> np.ndarray | None:
        """Mean square of what follows from all given numbers together; None where fewer than two act."""
        if len(self.given) < 2:
            return None
        with np.errstate(over="ignore", invalid="ignore"):
            return np.sum(list(self.given.values()), axis=0) ** 2

    def scaled(self, sizes: Mapping[str, float]) -> np.ndarray:
        """Mean square of all sources together when some have another size.

        Parameters
        ----------
        sizes : mapping from str to float
            Size of a source over its present one; 1 for a source that is not named.
        """
        none = np.zeros((len(self.t_s), len(COMPONENTS)))
        with np.errstate(over="ignore", invalid="ignore"):
            error = sum((sizes.get(source, 1.0) * one for source, one in self.given.items()), none)
            return sum((sizes.get(source, 1.0) ** 2 * one for source, one in self.random.items()), error**2)


def along(
    scenario: Scenario,
    method: Method,
    course: Course,
    model: StochasticModel,
    columns: tuple[Column, ...] | None = None,
) -> Along:
    """Errors of each source along the scenario's motion.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    method : Method
        Of a kind of damping whose loop has a covariance, with a law that is known in advance.
    course : Course
        Of `navcore.design.course.course`.
    model : StochasticModel
        The sources.
    columns : tuple of Column, optional
        Of `navcore.design.constants.shared_columns`, which are the same for all methods.
    """
    course, stage, loops = staged_loops(scenario, method, course, model)
    loop = loops[-1]
    shared = shared_columns(scenario, course, model) if columns is None else columns
    with np.errstate(over="ignore", invalid="ignore"):  # an unstable loop: told by who reads the variances
        tables = _tables(loops, stage, model, course)
        random = _random(loop, model, course, tables)
        columns = (*shared, *own_columns(method, course, loop))
        responses = _responses(loop, course, tables, columns)
        scale = np.ones((len(course.edges), len(COMPONENTS)))
        scale[:, 5:] = course.metres
        variances = {source: random[:, k] * scale**2 for k, source in enumerate(RANDOM_SOURCES)}
        given: dict[str, np.ndarray] = {}
        for column, response in zip(columns, responses, strict=True):
            if column.given:
                given[column.source] = given.get(column.source, 0.0) + response * scale
            else:
                variances[column.source] = variances.get(column.source, 0.0) + (response * scale) ** 2
    return Along(course.t_s, variances, given)


def staged_loops(
    scenario: Scenario, method: Method, course: Course, model: StochasticModel
) -> tuple[Course, np.ndarray, list[LoopModel]]:
    """Loops that a method closes one after the other along a course.

    Parameters
    ----------
    scenario, method, course, model
        As of `along`.

    Returns
    -------
    course : Course
        With intervals told apart by the loop too.
    stage : ndarray of int, shape (g,)
        Place in ``loops`` of each kind of interval.
    loops : list of LoopModel
    """
    forms, stage = law_stages(method, scenario.omega_s, course)
    course, stage = _with_stages(course, stage)
    kind = method.kind
    azimuth = azimuth_form(kind.azimuth(method, scenario.omega_s), kind.uses_log, course.step_s)
    return course, stage, [loop_of(scenario, form, course, model, azimuth) for form in forms]


def engaged_at(served: np.ndarray) -> np.ndarray:
    """Mark the intervals at whose beginning the networks are cleared, shape (k,).

    Parameters
    ----------
    served : ndarray of bool, shape (k,)
        Whether each interval has what the law reads.
    """
    return served & ~np.concatenate([served[:1], served[:-1]])


def _with_stages(course: Course, stage: np.ndarray) -> tuple[Course, np.ndarray]:
    """Tell intervals apart by the stage of the law too; the stage of each kind."""
    if not stage.any():
        return course, np.zeros(len(course.length), dtype=np.int64)
    pairs, kind = np.unique(np.column_stack([course.kind, stage]), axis=0, return_inverse=True)
    old = pairs[:, 0]
    apart = replace(
        course,
        kind=kind.reshape(-1),
        length=course.length[old],
        served=course.served[old],
        moored=course.moored[old],
        half=course.half[old],
    )
    return apart, pairs[:, 1]


def loop_of(
    scenario: Scenario,
    form: LawForm,
    course: Course,
    model: StochasticModel,
    azimuth: AzimuthForm | None = None,
) -> LoopModel:
    """Collect what the maps of a method need."""
    return loop_model(
        form,
        course,
        scenario.omega_s,
        body_frame=scenario.reference.frame == "body",
        heading=scenario.run.fidelity != "channel",
        taus=(model.gyro_drift.tau_s, model.accel_drift.tau_s, model.log_drift.tau_s),
        azimuth=azimuth,
    )


@dataclass(frozen=True, eq=False)
class _Tables:
    """Matrices of every kind of interval.

    Attributes
    ----------
    Phi : ndarray, shape (g, n, n)
    B, G : ndarray, shape (g, n, INPUTS)
    decay : ndarray, shape (g, INPUTS)
    Q : ndarray, shape (g, 6, n + 3, n + 3)
        Added covariance of the random sources in navigation axes.
    engaged : ndarray of bool, shape (k,)
        Intervals at whose beginning the networks are cleared.
    """

    Phi: np.ndarray
    B: np.ndarray
    G: np.ndarray
    decay: np.ndarray
    Q: np.ndarray
    engaged: np.ndarray


def _tables(loops: list[LoopModel], stage: np.ndarray, model: StochasticModel, course: Course) -> _Tables:
    loop = loops[-1]
    g, n = len(course.length), loop.states
    Phi, decay = np.zeros((g, n, n)), np.zeros((g, INPUTS))
    B, G = np.zeros((2, g, n, INPUTS))
    Q = np.zeros((g, len(RANDOM_SOURCES), n + AXES, n + AXES))
    needs_log = loop.form.uses_log
    served = course.served | (not needs_log)
    mean = mean_coefficients(course)
    alike = np.column_stack([course.length, served, stage])
    for calls, damped, of_law in np.unique(alike, axis=0).tolist():
        of = np.flatnonzero((alike == (calls, damped, of_law)).all(axis=1))
        loop = loops[of_law]
        interval = interval_map(loop, course.half[of], calls, bool(damped))
        Phi[of], B[of], G[of], decay[of] = interval.Phi, interval.B, interval.G, interval.decay
        Q[of] = interval_noise(loop, model, mean, calls, bool(damped)).Q
    for k in (_LOG_WHITE, _LOG_DRIFT):  # a moored ship does not read its log
        Q[course.moored, k, :n, :] = 0.0
        Q[course.moored, k, :, :n] = 0.0
    return _Tables(Phi, B, G, decay, Q, engaged_at(served[course.kind]))


def _random(loop: LoopModel, model: StochasticModel, course: Course, tables: _Tables) -> np.ndarray:
    """Variances of the random sources, shape (k + 1, 6, 7), in radians for the position."""
    n, sources = loop.states, len(RANDOM_SOURCES)
    turns, turn_of = _turns(loop, course)
    P = np.zeros((sources, n + AXES, n + AXES))
    for k, drift in ((1, model.gyro_drift), (3, model.accel_drift), (5, model.log_drift)):
        P[k, range(n, n + AXES), range(n, n + AXES)] = drift.sigma**2
    out = np.empty((len(course.edges), sources, len(_STATES)))
    out[0] = P[:, _STATES, _STATES]
    A, Q, places = _joint(loop, course, tables, turns, turn_of)
    for k, at in enumerate(places.tolist()):
        if tables.engaged[k]:
            P[:, loop.networks] = 0.0
            P[:, :, loop.networks] = 0.0
        P = A[at] @ P @ A[at].mT + Q[at]
        out[k + 1] = P[:, _STATES, _STATES]
    return out


def _turns(loop: LoopModel, course: Course) -> tuple[np.ndarray, np.ndarray]:
    """Distinct attitudes to which the drifts of the sensors are turned, and which each interval has."""
    rows = np.rint(course.turn / 1e-3).astype(np.int64)
    _, first, which = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    return course.turn[first].reshape(-1, 3, 3), which.reshape(-1)


def _joint(
    loop: LoopModel, course: Course, tables: _Tables, turns: np.ndarray, turn_of: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Joint matrices of errors and body-fixed drifts for each pair of kind and attitude that occurs."""
    n = loop.states
    pairs, places = np.unique(np.column_stack([course.kind, turn_of]), axis=0, return_inverse=True)
    kind, turn = pairs[:, 0], turns[pairs[:, 1]]
    A = np.zeros((len(pairs), len(RANDOM_SOURCES), n + AXES, n + AXES))
    Q = tables.Q[kind].copy()
    A[:, :, :n, :n] = tables.Phi[kind][:, None]
    own = slice(n, n + AXES)
    log = np.zeros((len(turn), 2, AXES))  # nothing hangs on the third axis
    log[:, :, :2] = log_axes(loop.body_frame, turn)
    axes = {GYRO.start: turn, ACCEL.start: turn[:, :2], LOG.start: log}
    for s in (1, 3, 5):
        inputs = INPUTS_OF[s]
        to_navigation, width = axes[inputs.start], inputs.stop - inputs.start
        A[:, s, :n, own] = tables.G[kind][:, :, inputs] @ to_navigation
        if s == _LOG_DRIFT:
            A[course.moored[kind], s, :n, own] = 0.0
        left = tables.decay[kind, inputs.start]
        A[:, s, range(n, n + AXES), range(n, n + AXES)] = left[:, None]
        # the drift lives in body axes: x stays, the covariance with the drift is turned back
        cross = Q[:, s, :n, n : n + width] @ to_navigation
        variance = Q[:, s, n, n].copy()
        Q[:, s, :n, own], Q[:, s, own, :n] = cross, cross.mT
        Q[:, s, own, own] = variance[:, None, None] * np.eye(AXES)
    return A, Q, places.reshape(-1)


def _responses(
    loop: LoopModel, course: Course, tables: _Tables, columns: tuple[Column, ...]
) -> list[np.ndarray]:
    """Errors that follow from each column, shape (k + 1, 7) each; in radians for the position."""
    if not columns:
        return []
    count, k = len(columns), len(course.kind)
    W = np.empty((k, INPUTS, count))
    X = np.zeros((loop.states, count))
    for j, column in enumerate(columns):
        W[:, :, j] = column.drive
        X[:ERRORS, j] = column.start
    if loop.form.self_referenced:
        _rest(loop, X, W[0], up_rate(course.half[course.kind[:1]]))
    drive = tables.B[course.kind] @ W
    out = np.empty((k + 1, len(_STATES), count))
    out[0] = X[_STATES]
    for i, kind in enumerate(course.kind.tolist()):
        if tables.engaged[i]:
            X[loop.networks] = 0.0
        X = tables.Phi[kind] @ X + drive[i]
        out[i + 1] = X[_STATES]
    return [out[:, :, j] for j in range(count)]


def _rest(loop: LoopModel, X: np.ndarray, first: np.ndarray, by_error: np.ndarray) -> None:
    """Internal damping starts at rest for the velocity and omega_U at t = 0 (theory.md 3, 3.7)."""
    n = loop.order
    steady = np.linalg.solve(loop.form.A, -loop.form.B) if n else np.zeros(0)
    for channel in (0, 1):
        u = first[MOTION.start + channel] - X[channel]
        X[ERRORS + n * channel : ERRORS + n * (channel + 1)] = steady[:, None] * u
    if loop.azimuth is not None:
        X[ERRORS + 2 * n : loop.networks.stop] = loop.azimuth.rest(first[UP] - (by_error @ X[:ERRORS])[0])
