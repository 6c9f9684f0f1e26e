"""Half-period averaging with the full strapdown algorithm: each copy is a free run on the same increments."""

import math
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

import numpy as np

from navcore.averaging.combine import averaged_rows, captured, capturing, gather
from navcore.averaging.copies import Copies
from navcore.averaging.forecast import Forecast
from navcore.averaging.plan import Plan
from navcore.foundation.compiled import kernel
from navcore.foundation.earth import Earth
from navcore.law.law import Law
from navcore.mechanization.recorder import PHI_E, PHI_U, Recorder, axes_along, make_recorder
from navcore.mechanization.strapdown import records as at
from navcore.mechanization.strapdown.attitude import angles_of, quaternion_of
from navcore.mechanization.strapdown.run import Settings, Start, StrapdownRun, start_run

FORECAST_RATE_HZ = 2.0
"""Rate at which the copies run on the forecast: the signals are constant."""
_LAT, _LON, _V_E, _V_N, _PITCH, _HEADING = 0, 1, 3, 4, 6, 8
_FORECAST_CHUNK = 20_000


def starts_ahead(
    start: Start,
    ahead_s: tuple[float, ...],
    forecast: Forecast,
    standing: np.ndarray,
    earth: Earth,
    law: Callable[[float], Law],
) -> list[Start]:
    """Navigation states of the copies at t = 0, each run ahead on the forecast by its own time.

    Parameters
    ----------
    start : Start
        State after alignment.
    ahead_s : tuple of float
        How far each copy runs, s.
    forecast : Forecast
        Rate and specific force in body axes.
    standing : ndarray, shape (1, 15)
        Row of truth of the vehicle at rest.
    earth : Earth
        WGS-84 or the sphere.
    law : callable
        Makes the law of a free method for an interval in seconds.
    """
    starts: list[Start] = [start] * len(ahead_s)
    now = 0.0
    for i in np.argsort(ahead_s):
        wait = ahead_s[i] - now
        samples = math.ceil(wait * FORECAST_RATE_HZ)
        if samples > 0:
            start = _run_ahead(start, now, wait, samples, forecast, standing, earth, law(wait / samples))
        now, starts[i] = ahead_s[i], start
    return starts


def _run_ahead(
    start: Start,
    now_s: float,
    wait_s: float,
    samples: int,
    forecast: Forecast,
    standing: np.ndarray,
    earth: Earth,
    law: Law,
) -> Start:
    settings = Settings(samples / wait_s, samples, 1, samples, wait_s)
    step_s = wait_s / samples
    before = forecast.means(now_s - step_s, step_s, 1)[0] * step_s
    increments = forecast.means(now_s, step_s, samples) * step_s
    run = start_run(start, settings, earth, law, standing, before=before)
    if len(increments) == 1:  # a constant forecast: the same chunk again and again
        increments = np.tile(increments, (min(samples, _FORECAST_CHUNK), 1))
    while not run.advance(increments):
        pass
    return state_of(run)


def state_of(run: StrapdownRun) -> Start:
    """Present navigation state of a run, from which another can start."""
    x = run.x
    return Start(
        float(run.con["lat0"] + x["d_lat"]),
        float(run.con["lon0"] + x["d_lon"]),
        float(x["height"]),
        x["v"].copy(),
        x["q"] / np.linalg.norm(x["q"]),
    )


@dataclass
class AveragedStrapdown:
    """One averaging method under way; advanced and read like a `StrapdownRun`.

    Attributes
    ----------
    copies : Copies
        Which copies there are and what they give.
    runs : tuple of StrapdownRun
        The copies.
    recorder : Recorder
        What is kept of the averages.
    navigation : ndarray, shape (rows, 11)
        Averaged navigation solution at the output rows, columns `records.NAVIGATION`.
    """

    copies: Copies
    runs: tuple[StrapdownRun, ...]
    recorder: Recorder
    navigation: np.ndarray
    _pool: ThreadPoolExecutor = field(default_factory=lambda: ThreadPoolExecutor(2), repr=False)

    @property
    def settings(self) -> Settings:
        """How the run is made."""
        return self.runs[0].settings

    @property
    def position(self) -> int:
        """Samples done."""
        return min(run.position for run in self.runs)

    @property
    def diverged(self) -> bool:
        """Whether a copy left the range in which it means anything."""
        return any(run.diverged for run in self.runs)

    @property
    def reason(self) -> str:
        """Why the run ended early; empty otherwise."""
        return next((run.reason for run in self.runs if run.reason), "")

    def advance(self, increments: np.ndarray) -> bool:
        """Integrate a chunk; return True when the run is complete or has diverged.

        Parameters
        ----------
        increments : ndarray, shape (n, 6)
            Angle (rad) and velocity increments (m/s) in body axes, the sample after the last one first.
        """
        every = self.settings.record_every
        first = -(-self.position // every)
        room = len(increments) // every + 2
        for run in self.runs:
            run.recorder = capturing(run.recorder, first, room)
            run.navigation = np.empty((room, len(at.NAVIGATION)))
        over = list(self._pool.map(lambda run: run.advance(increments), self.runs))
        rows = [captured(run.recorder) for run in self.runs]
        averaged = averaged_rows(rows, self.copies)
        if len(averaged):
            self._navigate(first, rows[0], averaged)
            gather(self.recorder, first, averaged)
        return any(over)

    def _navigate(self, first: int, main: np.ndarray, averaged: np.ndarray) -> None:
        """Averaged navigation solution at the output rows among the states first, first + 1, ..."""
        steps = self.recorder.row_steps
        begin, end = np.searchsorted(steps, [first, first + len(averaged)])
        at_rows = steps[begin:end] - first
        solutions = [run.navigation[at_rows] for run in self.runs]
        out = solutions[0].copy()
        for group, columns in ((self.copies.level, (_V_E, _V_N)), (self.copies.slow, (_LAT, _LON))):
            for column in columns:
                steps_off = [solutions[i][:, column] - solutions[0][:, column] for i in group]
                if column == _LON:
                    steps_off = [np.remainder(off + math.pi, 2.0 * math.pi) - math.pi for off in steps_off]
                out[:, column] += sum(steps_off) / len(group)
        angles = slice(PHI_E, PHI_U + 1)
        attitude = slice(_PITCH, _HEADING + 1)
        further = averaged[:, angles] - main[: len(averaged), angles]
        out[:, attitude] = _turn_attitude(out[:, attitude].copy(), further[at_rows])
        self.navigation[begin:end] = out


@kernel
def _turn_attitude(attitude, phi):
    """Pitch, roll, heading (n, 3) after a further misalignment phi (n, 3), C~' = exp(-[phi x]) C~."""
    out = np.empty_like(attitude)
    for i in range(attitude.shape[0]):
        q0, q1, q2, q3 = quaternion_of(attitude[i, 0], attitude[i, 1], attitude[i, 2])
        x, y, z = -phi[i, 0], -phi[i, 1], -phi[i, 2]
        angle = math.sqrt(x * x + y * y + z * z)
        c, s = math.cos(0.5 * angle), (0.5 if angle < 1e-12 else math.sin(0.5 * angle) / angle)
        x, y, z = s * x, s * y, s * z
        out[i, 0], out[i, 1], out[i, 2] = angles_of(
            c * q0 - x * q1 - y * q2 - z * q3,
            c * q1 + x * q0 + y * q3 - z * q2,
            c * q2 - x * q3 + y * q0 + z * q1,
            c * q3 + x * q2 - y * q1 + z * q0,
        )
    return out


def start_strapdown(
    plan: Plan,
    start: Start,
    settings: Settings,
    earth: Earth,
    law: Callable[[float], Law],
    truth: np.ndarray,
    before: np.ndarray | None = None,
) -> AveragedStrapdown:
    """Prepare an averaging method on the strapdown algorithm.

    Parameters
    ----------
    plan : Plan
        From `navcore.averaging.plan.prepare_averaging`.
    start : Start
        Navigation state after alignment.
    settings : Settings
        Of the run.
    earth : Earth
        WGS-84 or the sphere.
    law : callable
        Makes the law of a free method for an interval in seconds.
    truth : ndarray, shape (records + 1, 15) or (1, 15)
        True states at the recorded times.
    before : ndarray, shape (6,), optional
        Increment of the interval that ends at t = 0.
    """
    interval = settings.law_every / settings.rate_hz
    runs = tuple(
        start_run(begin, settings, earth, law(interval), truth, before=before)
        for begin in starts_ahead(start, plan.copies.ahead_s, plan.forecast, truth[:1], earth, law)
    )
    records = settings.samples // settings.record_every
    recorder = make_recorder(records, settings.record_step_s, settings.output_step_s, axes_along(truth))
    navigation = np.zeros((len(recorder.row_steps), len(at.NAVIGATION)))
    return AveragedStrapdown(plan.copies, runs, recorder, navigation)
