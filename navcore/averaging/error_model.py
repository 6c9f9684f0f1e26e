"""Half-period averaging on the linear error model.

The model of an undamped navigation is linear, and all copies feel the same truth and sensor errors from t = 0
on: the mean of the copies is *one* run that starts from the mean of their states. So a group of eight copies
costs no more than one free method, and what the method can do is plain: it changes the state at t = 0 and
nothing after it.
"""

import math
from dataclasses import dataclass

import numpy as np

from navcore.averaging.combine import averaged_rows, captured, capturing, gather
from navcore.averaging.copies import Copies
from navcore.averaging.forecast import Forecast
from navcore.averaging.plan import Plan
from navcore.averaging.record import standing_signals
from navcore.foundation.earth import Earth, attitude_matrix
from navcore.law.law import Law
from navcore.mechanization.error_model import STATES, ErrorModelRun
from navcore.mechanization.recorder import Recorder, make_recorder
from navcore.mechanization.trajectory import Coefficients, coefficients
from navcore.motion.truth import HEADING, PITCH, ROLL, Truth
from navcore.sensors.base import ReferenceErrors, SensorErrors

FORECAST_STEP_S = 5.0
"""Longest step on the forecast, s: RK4 errs by 1e-13 of the Schuler oscillation a step."""


def forecast_errors(
    forecast: Forecast, standing: np.ndarray, earth: Earth, begin_s: float, step_s: float, steps: int
) -> SensorErrors:
    """Error of a forecast against what perfect sensors feel at rest, in the navigation frame.

    A row for each of ``steps`` steps from ``begin_s`` on; a constant forecast has one.
    """
    wrong = forecast.means(begin_s, step_s, steps) - standing_signals(standing, earth)
    turn = attitude_matrix(standing[PITCH], standing[ROLL], standing[HEADING])
    return SensorErrors(wrong[:, :3] @ turn.T, wrong[:, 3:] @ turn.T)


def states_ahead(
    start: np.ndarray, ahead_s: tuple[float, ...], forecast: Forecast, standing: np.ndarray,
    earth: Earth, law: Law,
) -> np.ndarray:  # fmt: skip
    """Error states of the copies at t = 0: the free model at rest, run ahead from the state after alignment.

    Parameters
    ----------
    start : ndarray, shape (7,)
        State after alignment, SI.
    ahead_s : tuple of float
        How far each copy runs, s.
    forecast : Forecast
        What the copies feel.
    standing : ndarray, shape (15,)
        Row of truth of the vehicle at rest.
    earth : Earth
        WGS-84 or the sphere.
    law : Law
        Of a free method.

    Returns
    -------
    ndarray, shape (copies, 7)
    """
    at_rest = coefficients(Truth(1.0, standing[None, :]), earth, coupled=True)
    out = np.empty((len(ahead_s), STATES))
    x, now = np.array(start, dtype=float), 0.0
    for i in np.argsort(ahead_s):
        wait = ahead_s[i] - now
        steps = math.ceil(wait / FORECAST_STEP_S)
        if steps > 0:
            h = wait / steps
            recorder = make_recorder(steps, h, wait)
            sensors = forecast_errors(forecast, standing, earth, now, h, steps)
            run = ErrorModelRun(h, steps, at_rest, sensors, _no_reference(), law, x, recorder)
            while not run.advance(steps + 1):
                pass
        now = ahead_s[i]
        out[i] = x
    return out


def _no_reference() -> ReferenceErrors:
    return ReferenceErrors(np.zeros(0), np.zeros((0, 2)), np.zeros(0, bool), False, 0.0)


@dataclass
class AveragedErrorModel:
    """One averaging method under way; advanced, stopped and read like an `ErrorModelRun`.

    Attributes
    ----------
    runs : tuple of ErrorModelRun
        One for each group of copies: level and slow; one run when both groups are the same.
    recorder : Recorder
        What is kept of the averages.
    position : int
        Steps done.
    """

    runs: tuple[ErrorModelRun, ...]
    recorder: Recorder
    position: int = 0

    @property
    def steps(self) -> int:
        """Steps of the run."""
        return self.runs[0].steps

    @property
    def diverged(self) -> bool:
        """Whether the linear model left its range."""
        return any(run.diverged for run in self.runs)

    def advance(self, steps: int) -> bool:
        """Integrate up to ``steps`` further steps; return True when the run is complete or has diverged."""
        if len(self.runs) == 1:
            over = self.runs[0].advance(steps)
            self.position = self.runs[0].position
            return over
        for run in self.runs:
            room = min(steps, run.steps + 1 - self.position)
            run.recorder = capturing(run.recorder, self.position, room)
        over = any([run.advance(steps) for run in self.runs])
        rows = averaged_rows([captured(run.recorder) for run in self.runs], Copies((0.0, 0.0), (0,), (1,)))
        gather(self.recorder, self.position, rows)
        self.position = min(run.position for run in self.runs)
        return over


def start_error_model(
    plan: Plan,
    start: np.ndarray,
    earth: Earth,
    step_s: float,
    steps: int,
    output_step_s: float,
    along: Coefficients,
    sensors: SensorErrors,
    law: Law,
) -> AveragedErrorModel:
    """Prepare an averaging method on the error model.

    Parameters
    ----------
    plan : Plan
        From `navcore.averaging.plan.prepare_averaging`.
    start : ndarray, shape (7,)
        Error state after alignment, SI.
    earth : Earth
        WGS-84 or the sphere.
    step_s : float
        Step of the run, s.
    steps : int
        Steps of the run.
    output_step_s : float
        Interval of the output rows, s.
    along : Coefficients
        Of the true motion from t = 0 on.
    sensors : SensorErrors
        Of the run.
    law : Law
        Of a free method.
    """
    copies = plan.copies
    states = states_ahead(start, copies.ahead_s, plan.forecast, plan.standing, earth, law)
    groups = [copies.level] if copies.level == copies.slow else [copies.level, copies.slow]
    runs = tuple(
        ErrorModelRun(
            step_s, steps, along, sensors, _no_reference(), law, states[list(group)].mean(axis=0),
            make_recorder(steps, step_s, output_step_s, along.axes),
        )
        for group in groups
    )  # fmt: skip
    recorder = runs[0].recorder if len(runs) == 1 else make_recorder(steps, step_s, output_step_s, along.axes)
    return AveragedErrorModel(runs, recorder)
