"""A method with ``damping = "kalman"`` among the others of a scenario: its model and its run."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from navcore.damping.kalman import KalmanSettings
from navcore.engine.drivers.common import law_of, network_of, seen_by
from navcore.engine.environment import Environment
from navcore.foundation.earth import Earth, attitude_matrix
from navcore.foundation.text import Text
from navcore.foundation.units import PPM
from navcore.mechanization.kalman.error_model import FilteredErrorModel
from navcore.mechanization.kalman.filter import (
    ACCEL,
    GYRO,
    LOG,
    SCALE,
    WATER,
    FilterModel,
    FilterState,
    filter_state,
)
from navcore.mechanization.recorder import make_recorder
from navcore.mechanization.trajectory import coefficients
from navcore.motion.truth import HEADING, PITCH, ROLL, Truth
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.start import ERRORS, aligned_errors, independent_errors
from navcore.scenario.stochastic import Drift, StochasticModel, stochastic_model

if TYPE_CHECKING:
    from navcore.engine.strapdown_environment import StrapdownEnvironment
    from navcore.mechanization.kalman.strapdown import FilteredStrapdown
    from navcore.mechanization.strapdown import Settings


@dataclass
class Gains:
    """Gains of a filter at each epoch of the log, shared by runs on the same truth with other noise.

    Attributes
    ----------
    values : ndarray, shape (epochs, 2, n), or None
        None until a run begins to fill them.
    """

    values: np.ndarray | None = None


LEAST_NOISE_MPS = 1e-5
"""Standard deviation of a sample that counts as free of noise, m/s: the gain needs some."""
NOTHING_RANDOM = Text(
    "the scenario gives sensors and start no error that the filter knows of: it corrects nothing"
)


def filter_model(
    scenario: Scenario, method: Method, step_s: float, true_row: np.ndarray, moored: np.ndarray
) -> tuple[FilterModel, np.ndarray, tuple[str, ...]]:
    """Return the filter's model and its covariance at t = 0: the stochastic model of the scenario.

    Scale factors of the IMU, delay and events are not in it; the water and the scale of the log are where the
    method states how large they may be (theory.md 16).

    Parameters
    ----------
    scenario : Scenario
        With a simulated log and IMU.
    method : Method
        With a Kalman filter.
    step_s : float
        Time between two steps of the filter, s.
    true_row : ndarray, shape (15,)
        Truth at t = 0: its attitude turns what an alignment makes of the sensors' biases.
    moored : ndarray of bool
        Of `navcore.sensors.base.ReferenceErrors`.

    Returns
    -------
    model : FilterModel
    P : ndarray, shape (n, n)
        Covariance at t = 0, SI.
    notices : tuple of str
        What the user should know.
    """
    known = stochastic_model(scenario)
    axis, left, drive, start = _sensor_states(known, method.settings, step_s)
    figures = known.figures
    model = FilterModel(
        axis=np.array(axis, dtype=np.int64),
        left=np.array(left, dtype=float),
        drive=np.array(drive, dtype=float),
        gyro_white=figures.gyro_white**2 / step_s,
        accel_white=figures.accel_white**2 / step_s,
        log_white=max(figures.log_noise**2 / max(1.0, figures.log_rate_hz * step_s), LEAST_NOISE_MPS**2),
        body_frame=scenario.reference.frame == "body",
        moored=moored,
        moored_white=scenario.reference.zero_below_mps**2,
    )
    spread = np.diag([*independent_errors(scenario, known.initial), *start])
    turn = attitude_matrix(true_row[PITCH], true_row[ROLL], true_row[HEADING])
    for i, (which, share) in enumerate(zip(axis, left, strict=True)):
        if share == 1.0 and which < LOG:  # what an alignment makes of a bias is correlated with it
            error = turn[:, which % ACCEL] * start[i]
            sides = (error, np.zeros(3)) if which < ACCEL else (np.zeros(3), error)
            spread[:ERRORS, ERRORS + i] = aligned_errors(scenario, *sides)
    silent = not spread.any() and not model.gyro_white and not model.accel_white
    return model, spread @ spread.T, (NOTHING_RANDOM,) if silent else ()


def _sensor_states(
    known: StochasticModel, told: KalmanSettings, step_s: float
) -> tuple[list[int], list[float], list[float], list[float]]:
    """Axis, share left by a step, variance added by it and standard deviation at t = 0 of each state."""
    axis: list[int] = []
    left: list[float] = []
    drive: list[float] = []
    start: list[float] = []

    def add(first: int, deviations: np.ndarray, drift: Drift | None) -> None:
        for i in np.flatnonzero(deviations):
            share = math.exp(-step_s / drift.tau_s) if drift else 1.0
            axis.append(first + int(i))
            left.append(share)
            drive.append(float(deviations[i]) ** 2 * (1.0 - share * share))
            start.append(float(deviations[i]))

    water = Drift(told.current_std_mps, told.current_tau_s)
    for first, drift, bias in (
        (GYRO, known.gyro_drift, known.gyro_bias),
        (ACCEL, known.accel_drift, known.accel_bias),
        (LOG, known.log_drift, known.log_bias),
        (WATER, water, np.zeros(2)),
        (SCALE, Drift(0.0, 1.0), np.array([told.scale_std_ppm * PPM])),
    ):
        add(first, np.full(len(bias), drift.sigma), drift)
        add(first, bias, None)
    return axis, left, drive, start


def filtered_linear(
    scenario: Scenario,
    method: Method,
    env: Environment,
    state: np.ndarray,
    gains: Gains | None = None,
) -> tuple[FilteredErrorModel, tuple[str, ...]]:
    """Run of the filter on the error model, and what to tell the user.

    Runs that are given the same ``gains``, one after the other, share those that the first one computes.
    """
    run, truth = scenario.run, env.truth_half.values
    model, P, notices = filter_model(scenario, method, run.step_s, truth[0], env.reference.moored)
    recorder = make_recorder(env.steps, run.step_s, run.output_step_s, env.coefficients.axes)
    kept, known = None, False
    if gains is not None:
        known = gains.values is not None
        if gains.values is None:
            gains.values = np.zeros((len(env.reference.time_s), 2, len(P)))
        kept = gains.values
    filtered = FilteredErrorModel(
        step_s=run.step_s,
        steps=env.steps,
        coefficients=env.coefficients,
        sensors=env.sensors,
        reference=seen_by(method, env.reference),
        truth=truth,
        law=law_of(method, network_of(scenario, method), run.step_s),
        x=state.copy(),
        recorder=recorder,
        model=model,
        filter=filter_state(P, len(recorder.row_steps), kept, known),
    )
    return filtered, notices


def filtered_strapdown(
    scenario: Scenario, method: Method, env: StrapdownEnvironment, settings: Settings
) -> tuple[FilteredStrapdown, tuple[str, ...]]:
    """Run of the filter on the full mechanization, and what to tell the user."""
    # Only now: the strapdown kernels are slow to import, and most runs are linear.
    from navcore.mechanization.kalman.strapdown import filtered_run
    from navcore.mechanization.strapdown import start_run, velocity_reference

    interval_s, truth = env.sampling.law_step_s, env.truth.values
    model, P, notices = filter_model(scenario, method, interval_s, truth[0], env.reference.moored)
    law = law_of(method, network_of(scenario, method), interval_s)
    free = start_run(env.start, settings, scenario.earth, law, truth, before=env.imu.before())
    log = velocity_reference(seen_by(method, env.reference), env.truth)
    state = filter_state(P, len(free.recorder.row_steps))
    return filtered_run(free, log, model, state), notices


def own_sigma(run: object, truth: np.ndarray, earth: Earth) -> np.ndarray | None:
    """Standard deviations that a filter gives itself at the output rows; None of a run without a filter.

    Parameters
    ----------
    run : object
        A run that is over; rows that it did not reach are zero.
    truth : ndarray, shape (rows, 15)
        True motion at the output rows.
    earth : Earth
        Earth model.

    Returns
    -------
    ndarray, shape (rows, 7)
        In the order of `navcore.quantities.NAMES`: rad, m/s, m.
    """
    state: FilterState | None = getattr(run, "filter", None)
    if state is None:
        return None
    half = coefficients(Truth(1.0, np.ascontiguousarray(truth)), earth, True).half
    metres = np.column_stack([half["m"], half["n_cos"]])
    return np.hstack([state.sigma[:, [4, 5, 6, 0, 1]], state.sigma[:, 2:4] * metres])
