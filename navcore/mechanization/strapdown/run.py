"""A strapdown run under way: start values, constants, and chunks of increments that advance it."""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from navcore.foundation.compiled import plain
from navcore.foundation.earth import Earth
from navcore.foundation.records import new_record
from navcore.foundation.text import Text
from navcore.law.law import Law
from navcore.mechanization.recorder import QUANTITIES, Recorder, axes_along, make_recorder
from navcore.mechanization.strapdown import records as at
from navcore.mechanization.strapdown.attitude import quaternion_of
from navcore.mechanization.strapdown.kernel import Pace, advance_kernel
from navcore.mechanization.strapdown.log import VelocityReference
from navcore.mechanization.strapdown.step import THIRD_ORDER, TWO_SAMPLE
from navcore.motion.truth import HEADING, HEIGHT, LAT, LON, PITCH, ROLL, VE, VN, VU
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.true_state import horizontal_state, to_ship

Vertical = Literal["locked", "altimeter"]

ALTIMETER_TAU_S = 100.0
"""Time constant of the third-order vertical loop: all three poles at -1/tau."""


def no_reference() -> VelocityReference:
    """No epochs at all: for free runs and internal damping."""
    return VelocityReference(np.zeros(0), np.zeros((0, 2)), np.zeros(0, bool), False, 0.0)


def velocity_reference(errors: ReferenceErrors, truth) -> VelocityReference:
    """Reference velocity from its errors and the truth (`navcore.motion.truth.Truth` on any grid)."""
    if len(errors.time_s) == 0:
        return no_reference()
    velocity, heading = horizontal_state(truth, errors.time_s)
    # A new array: one that may not be written to would make numba compile the kernel a second time.
    measured = velocity + errors.error
    if errors.body_frame:
        measured = to_ship(measured, np.broadcast_to(heading, len(measured)))
    return VelocityReference(errors.time_s, measured, errors.valid, errors.body_frame, float(errors.hold_s))


@dataclass(frozen=True)
class Start:
    """Navigation state at t = 0.

    Attributes
    ----------
    lat, lon, height : float
        rad, rad, m.
    velocity : ndarray, shape (3,)
        E, N, U, m/s.
    quaternion : ndarray, shape (4,)
        Body to navigation frame.
    """

    lat: float
    lon: float
    height: float
    velocity: np.ndarray
    quaternion: np.ndarray


def start_from(true_row: np.ndarray, errors: np.ndarray | None = None) -> Start:
    """Start at a row of truth, shape (15,), with errors dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U (SI)."""
    x = np.zeros(7) if errors is None else np.asarray(errors, dtype=float)
    true = np.array(plain(quaternion_of)(true_row[PITCH], true_row[ROLL], true_row[HEADING]))
    return Start(
        float(true_row[LAT] + x[2]),
        float(true_row[LON] + x[3]),
        float(true_row[HEIGHT]),
        np.array([true_row[VE] + x[0], true_row[VN] + x[1], true_row[VU]]),
        turned_by(-x[4:7], true),
    )


def turned_by(rotation: np.ndarray, quaternion: np.ndarray) -> np.ndarray:
    """Quaternion of exp([rotation x]) C: a rotation vector (rad, navigation axes) applied from the left."""
    angle = float(np.linalg.norm(rotation))
    w, v = np.cos(0.5 * angle), 0.5 * np.sinc(0.5 * angle / np.pi) * np.asarray(rotation)
    s, u = quaternion[0], quaternion[1:]
    return np.concatenate([[w * s - v @ u], w * u + s * v + np.cross(v, u)])


@dataclass(frozen=True)
class Settings:
    """How a strapdown run is made.

    Attributes
    ----------
    rate_hz : float
        IMU rate.
    samples : int
        Samples of the run; a multiple of ``record_every``.
    law_every, record_every : int
        Samples between two calls of the law, and between two recorded states.
    output_step_s : float
        Interval of the output rows, s.
    vertical : {"locked", "altimeter"}
        Vertical channel held (a ship) or damped by the altimeter (third order).
    compensation : bool
        Coning and sculling with the previous increment, and the third-order term.
    """

    rate_hz: float
    samples: int
    law_every: int
    record_every: int
    output_step_s: float
    vertical: Vertical = "locked"
    compensation: bool = True

    @property
    def record_step_s(self) -> float:
        """Time between two recorded states, s."""
        return self.record_every / self.rate_hz


def constants(start: Start, settings: Settings, earth: Earth) -> np.void:
    """Make the record of what the kernel reads and never changes."""
    con = new_record(
        at.CONSTANTS, dt=1.0 / settings.rate_hz, e2=earth.e2, g_equator=earth.g_equator,
        k_gravity=earth.somigliana_k, lat0=start.lat, lon0=start.lon, height0=start.height,
    )  # fmt: skip
    if settings.compensation:
        con["two_sample"], con["third_order"] = TWO_SAMPLE, THIRD_ORDER
    if settings.vertical == "altimeter":
        a = 1.0 / ALTIMETER_TAU_S
        stiffness = 2.0 * earth.gravity(start.lat, start.height) / earth.radii(start.lat)[1]
        con["altimeter"] = True
        con["altimeter_k1"], con["altimeter_k2"] = 3.0 * a, 3.0 * a * a + stiffness
        con["altimeter_k3"] = a**3
    return con


@dataclass
class StrapdownRun:
    """One method under way; give it the increments chunk by chunk.

    Attributes
    ----------
    settings : Settings
    con, x : record
        `records.CONSTANTS` and `records.STATE`.
    law : Law
    reference : VelocityReference
    truth : ndarray, shape (records + 1, 15) or (1, 15)
        True states at the recorded times.
    recorder : Recorder
    navigation : ndarray, shape (rows, 11)
        Navigation solution at the output rows, columns `records.NAVIGATION`.
    position : int
        Samples done.
    code : int
        `records.UNDER_WAY`, COMPLETE, DIVERGED (errors out of range) or POLE (too near a pole).
    """

    settings: Settings
    con: np.void
    x: np.void
    law: Law
    reference: VelocityReference
    truth: np.ndarray
    recorder: Recorder
    navigation: np.ndarray
    position: int = 0
    code: int = at.UNDER_WAY

    @cached_property
    def _heights(self) -> np.ndarray:
        """True heights for the altimeter, m: copied out of the truth once, not with every chunk."""
        return np.ascontiguousarray(self.truth[:, HEIGHT])

    @property
    def diverged(self) -> bool:
        """Whether the run left the range in which it means anything."""
        return self.code in (at.DIVERGED, at.POLE)

    @property
    def reason(self) -> str:
        """Why the run ended early; empty otherwise."""
        if self.code == at.DIVERGED:
            return Text("the errors left the range of navigation (tilt 1 rad, velocity 1e4 m/s)")
        return Text("the computed latitude passed 89.9°") if self.code == at.POLE else ""

    def advance(self, increments: np.ndarray) -> bool:
        """Integrate a chunk; return True when the run is complete or has diverged.

        Parameters
        ----------
        increments : ndarray, shape (n, 6)
            Angle (rad) and velocity increments (m/s) in body axes, the sample after the last one first; those
            beyond the end of the run are not taken.
        """
        set_ = self.settings
        self.position, self.code = advance_kernel(
            np.ascontiguousarray(increments, dtype=float), self.position,
            Pace(set_.samples, set_.law_every, set_.record_every, set_.record_step_s),
            self.con, self.x, self.truth, self._heights, self.reference, self.law, self.navigation,
            self.recorder,
        )  # fmt: skip
        return self.code != at.UNDER_WAY


def start_run(
    start: Start,
    settings: Settings,
    earth: Earth,
    law: Law,
    truth: np.ndarray,
    reference: VelocityReference | None = None,
    before: np.ndarray | None = None,
) -> StrapdownRun:
    """Prepare a run.

    Parameters
    ----------
    start : Start
        State at t = 0.
    settings : Settings
        Rates, length, vertical channel, compensation.
    earth : Earth
        WGS-84 or the sphere.
    law : Law
        From `navcore.law.law.prepare_law` with ``law_step_s = law_every / rate_hz``.
    truth : ndarray, shape (records + 1, 15) or (1, 15)
        True states at the recorded times.
    reference : VelocityReference, optional
        None without one.
    before : ndarray, shape (6,), optional
        Increment of the interval that ends at t = 0, for coning and sculling of the first sample.

    Raises
    ------
    ValueError
        The length is no whole number of recorded intervals, or the truth does not fit.
    """
    if settings.samples % settings.record_every:
        raise ValueError("samples must be a multiple of record_every")
    records = settings.samples // settings.record_every
    if truth.shape[0] not in (1, records + 1):
        raise ValueError(f"{records + 1} recorded states, but {truth.shape[0]} rows of truth")
    reference = no_reference() if reference is None else reference
    velocity = np.array(start.velocity, dtype=float)
    if settings.vertical == "locked":
        velocity[2] = 0.0
    x = new_record(
        at.STATE, height=start.height, v=velocity, q=start.quaternion,
        last={"v_e": velocity[0], "v_n": velocity[1]},
    )  # fmt: skip
    if before is not None:
        x["before"] = before
    recorder = make_recorder(records, settings.record_step_s, settings.output_step_s, axes_along(truth))
    assert recorder.stats.shape[0] == QUANTITIES
    return StrapdownRun(
        settings=settings,
        con=constants(start, settings, earth),
        x=x,
        law=law,
        reference=reference,
        truth=np.ascontiguousarray(truth, dtype=float),
        recorder=recorder,
        navigation=np.zeros((len(recorder.row_steps), len(at.NAVIGATION))),
    )
