"""Damping from outside: a law laid on the output of an INS whose sensors nobody sees (theory.md 22).

The difference between a damped and a recorded solution, e = damped - recorded, has no sensor errors in it. It
obeys the error model along the recorded output, driven by the law alone:

    e' = F(recorded) e + G c,    c = law(V_r - (V_recorded + e_V)),    e = 0 where damping is switched on.

An INS that was damped itself had a correction c_own, which follows from V_r - V_recorded: an open loop. Then
e' = F e + G (c - c_own).
"""

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from navcore.foundation.compiled import kernel
from navcore.foundation.earth import WGS84, Earth
from navcore.law.law import Law
from navcore.law.records import Sensed
from navcore.mechanization.error_model import ErrorModelRun, LogErrors, correction, read_log
from navcore.mechanization.recorder import Errors, make_recorder
from navcore.mechanization.trajectory import Coefficients, coefficients
from navcore.motion.truth import AE, AN, COLUMNS, HEADING, HEIGHT, LAT, LON, VE, VN, Truth
from navcore.sensors.base import ReferenceErrors, SensorErrors

CORRECTION = 5
"""Columns of c: c_E, c_N (m/s), a_E, a_N (m/s^2), c_U (rad/s)."""
WATCHED = 4
"""Columns after them: the policy's wish, damped (0/1), xi in force, the policy's measure."""


@kernel
def _open_loop(h, half, law_input, log, law, out):
    """Ask a law at each step what it makes of the recorded output: its own corrections move nothing."""
    x = Errors(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    s = law.s
    for k in range(out.shape[0]):
        motion = law_input[k]
        read_log(k * h, x, motion.v_e, motion.v_n, log, s)
        c, c_u = correction(law, Sensed(motion.v_e, motion.v_n, motion.heading), half[2 * k], x)
        row = out[k]
        row[0], row[1], row[2], row[3], row[4] = c.c_e, c.c_n, c.a_e, c.a_n, c_u
        row[5], row[6], row[7], row[8] = float(s.wanted), 1.0 if s.damped else 0.0, s.xi, s.measure


def own_corrections(
    law: Law, coefficients: Coefficients, log: ReferenceErrors, steps: int, step_s: float
) -> np.ndarray:
    """Corrections that an INS's own law made while it was recorded.

    Parameters
    ----------
    law : Law
        That of the INS, fresh; it is used up.
    coefficients : Coefficients
        Of the error model along the output, at steps 0..``steps``.
    log : ReferenceErrors
        The log minus the output's velocity.
    steps : int
        Steps of the run.
    step_s : float
        Their length, s.

    Returns
    -------
    ndarray, shape (steps + 1, 9)
        `CORRECTION` columns, then `WATCHED` ones.
    """
    out = np.zeros((steps + 1, CORRECTION + WATCHED))
    of_log = LogErrors(log.time_s, log.error, log.valid, log.body_frame, float(log.hold_s))
    _open_loop(step_s, coefficients.half, coefficients.law, of_log, law, out)
    return out


def taken_off(own: np.ndarray, coefficients: Coefficients) -> SensorErrors:
    """Sensor errors that take an INS's own corrections off again, -G c_own in the places where G stands.

    Parameters
    ----------
    own : ndarray, shape (steps + 1, 9)
        From `own_corrections`.
    coefficients : Coefficients
        As given there.
    """
    begins = coefficients.half[: 2 * len(own) : 2]
    c_e, c_n, a_e, a_n, c_u = own[:, :CORRECTION].T
    gyro = np.column_stack([-c_n * begins["inv_m"], c_e * begins["inv_n"], c_u])
    return SensorErrors(gyro, np.column_stack([-a_e, -a_n, np.zeros(len(own))]))


def carry_on(
    law: Law,
    x: np.ndarray,
    coefficients: Coefficients,
    log: ReferenceErrors,
    steps: int,
    step_s: float,
    sensors: SensorErrors | None = None,
) -> tuple[np.ndarray, bool]:
    """Carry damped minus recorded on by some steps, with the kernel of a run on the whole recording.

    Parameters
    ----------
    law : Law
        Goes on from call to call; its place among the log's epochs is the caller's.
    x : ndarray, shape (7,)
        Errors of `ErrorModelRun`; they go on in place.
    coefficients : Coefficients
        Along the output, at steps 0..``steps``.
    log : ReferenceErrors
        By times from the first step.
    steps : int
        Steps, at least one.
    step_s : float
        Their length, s.
    sensors : SensorErrors, optional
        What an INS's own damping did (`taken_off`).

    Returns
    -------
    rows : ndarray, shape (steps, 12)
        At the begin of each step, columns of `navcore.mechanization.recorder`.
    diverged : bool
        The errors have left the range of the linear model.
    """
    run = ErrorModelRun(
        step_s=step_s,
        steps=steps + 1,
        coefficients=coefficients,
        sensors=sensors or SensorErrors(np.zeros((1, 3)), np.zeros((1, 3))),
        reference=log,
        law=law,
        x=x,
        recorder=make_recorder(steps + 1, step_s, step_s),
    )
    run.advance(steps)
    return run.recorder.rows[: run.position], run.diverged


class Output(NamedTuple):
    """What an INS gives out at one time, SI and radians."""

    lat: float
    lon: float
    height: float
    v_e: float
    v_n: float
    heading: float


_NEVER_S = 1e9


@dataclass
class OutsideDamping:
    """Damping laid on an INS's output as it comes, one step after the other.

    This is what a box beside the INS does; a run on a recording does the same with the whole track at hand.

    Attributes
    ----------
    law : Law
        As `navcore.law.law.prepare_law` makes it, for steps of ``step_s``.
    step_s : float
        Time between two outputs, s.
    hold_s : float
        A reading of the log older than this counts as missing, s.
    body_frame : bool
        The log's readings were turned by the *recorded* heading from the ship's axes.
    earth : Earth
        WGS-84 unless given.
    x : ndarray, shape (7,)
        e: dV_E, dV_N (m/s), dL, dlambda, phi_E, phi_N, phi_U (rad), damped minus recorded.
    """

    law: Law
    step_s: float
    hold_s: float
    body_frame: bool = False
    earth: Earth = WGS84
    x: np.ndarray = field(default_factory=lambda: np.zeros(7))
    _age_s: float = _NEVER_S
    _error: tuple[float, float] = (0.0, 0.0)

    def step(self, now: Output, after: Output, reading: tuple[float, float] | None) -> None:
        """Go on from one output to the next, ``step_s`` later.

        Parameters
        ----------
        now, after : Output
            As recorded at the begin and at the end of the step.
        reading : (float, float), optional
            The log's velocity at ``now``, E and N, m/s; None while it gives nothing new.
        """
        s = self.law.s
        if reading is None:
            self._age_s += self.step_s
        else:
            # The law tells epochs apart by their numbers: one after the other is 0, 1, 0, ...
            s["epoch"] = -1 if s["epoch"] == 1 else s["epoch"]
            self._age_s, self._error = 0.0, (reading[0] - now.v_e, reading[1] - now.v_n)
        second = s["epoch"] == (0 if reading is not None else 1)
        time_s = np.array([-_NEVER_S, -self._age_s] if second else [-self._age_s, _NEVER_S])
        heard = self._age_s <= self.hold_s
        log = ReferenceErrors(
            time_s, np.array([self._error] * 2), np.full(2, heard), self.body_frame, self.hold_s
        )
        along = coefficients(_between(now, after, self.step_s), self.earth, coupled=True)
        carry_on(self.law, self.x, along, log, 1, self.step_s)

    def damped(self, now: Output) -> Output:
        """Return an output as it would be with the damping in force."""
        dv_e, dv_n, d_lat, d_lon, _, _, phi_u = self.x.tolist()
        return Output(
            now.lat + d_lat,
            now.lon + d_lon,
            now.height,
            now.v_e + dv_e,
            now.v_n + dv_n,
            now.heading + phi_u,
        )


def _between(now: Output, after: Output, step_s: float) -> Truth:
    """Motion at the begin, the middle and the end of a step, the acceleration constant within it."""
    rows = np.zeros((3, COLUMNS))
    turn = math.remainder(after.heading - now.heading, math.tau)
    places = (LAT, LON, HEIGHT, VE, VN, HEADING)
    begin, end = np.array(now), np.array(after)
    end[-1] = now.heading + turn
    for row, share in zip(rows, (0.0, 0.5, 1.0), strict=True):
        row[list(places)] = begin + share * (end - begin)
    rows[:, AE], rows[:, AN] = (after.v_e - now.v_e) / step_s, (after.v_n - now.v_n) / step_s
    return Truth(0.5 * step_s, rows)
