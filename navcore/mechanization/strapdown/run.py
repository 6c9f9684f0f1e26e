"""A strapdown run under way: start values, constants, and chunks of increments that advance it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal

import numpy as np

from navcore.compiled import plain
from navcore.control.law import Law
from navcore.earth import Earth
from navcore.mechanization.recorder import QUANTITIES, Recorder, make_recorder
from navcore.mechanization.strapdown import layout as at
from navcore.mechanization.strapdown.attitude import quaternion_of
from navcore.mechanization.strapdown.kernel import advance_kernel
from navcore.mechanization.strapdown.step import THIRD_ORDER, TWO_SAMPLE
from navcore.motion.base import HEADING, HEIGHT, LAT, LON, PITCH, ROLL, VE, VN, VU
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.true_state import horizontal_state, to_ship

Vertical = Literal["locked", "altimeter"]

ALTIMETER_TAU_S = 100.0
"""Time constant of the third-order vertical loop: all three poles at -1/tau."""


@dataclass(frozen=True)
class VelocityReference:
    """The reference velocity itself, as a strapdown run compares it with its own.

    Attributes
    ----------
    time_s : ndarray, shape (m,)
        Epochs, s.
    velocity : ndarray, shape (m, 2)
        East, north; with ``body_frame`` starboard, forward (turned by the computed heading), m/s.
    valid : ndarray of bool, shape (m,)
    body_frame : bool
    hold_s : float
        A sample older than this counts as missing, s.
    """

    time_s: np.ndarray
    velocity: np.ndarray
    valid: np.ndarray
    body_frame: bool
    hold_s: float


def no_reference() -> VelocityReference:
    """No epochs at all: for free runs and internal damping."""
    return VelocityReference(np.zeros(0), np.zeros((0, 2)), np.zeros(0, bool), False, 0.0)


def velocity_reference(errors: ReferenceErrors, truth) -> VelocityReference:
    """Reference velocity from its errors and the truth (`navcore.motion.base.Truth` on any grid)."""
    if len(errors.time_s) == 0:
        return no_reference()
    velocity, heading = horizontal_state(truth, errors.time_s)
    # A new array: one that may not be written to would make numba compile the kernel a second time.
    measured = velocity + errors.error
    if errors.body_frame:
        measured = to_ship(measured, np.broadcast_to(heading, len(measured)))
    return VelocityReference(errors.time_s, measured, errors.valid, errors.body_frame, errors.hold_s)


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


def constants(start: Start, settings: Settings, earth: Earth, reference: VelocityReference) -> np.ndarray:
    """Lay out what the kernel reads and never changes."""
    con = np.zeros(at.CONSTANTS)
    con[at.STEP], con[at.E2] = 1.0 / settings.rate_hz, earth.e2
    con[at.G_EQUATOR], con[at.K_GRAVITY] = earth.g_equator, earth.somigliana_k
    if settings.compensation:
        con[at.K12], con[at.K6] = TWO_SAMPLE, THIRD_ORDER
    con[at.LAT0], con[at.LON0], con[at.HEIGHT0] = start.lat, start.lon, start.height
    con[at.BODY_LOG], con[at.HOLD] = float(reference.body_frame), reference.hold_s
    if settings.vertical == "altimeter":
        a = 1.0 / ALTIMETER_TAU_S
        stiffness = 2.0 * earth.gravity(start.lat, start.height) / earth.radii(start.lat)[1]
        con[at.ALTIMETER] = 1.0
        con[at.ALT_K1], con[at.ALT_K2], con[at.ALT_K3] = 3.0 * a, 3.0 * a * a + stiffness, a**3
    return con


@dataclass
class StrapdownRun:
    """One method under way; give it the increments chunk by chunk.

    Attributes
    ----------
    settings : Settings
    con, x : ndarray
        Constants and state, laid out in `layout`.
    law : Law
    reference : VelocityReference
    truth : ndarray, shape (records + 1, 15) or (1, 15)
        True states at the recorded times.
    recorder : Recorder
    navigation : ndarray, shape (rows, 11)
        Navigation solution at the output rows, columns `layout.NAVIGATION`.
    position : int
        Samples done.
    code : int
        `layout.UNDER_WAY`, COMPLETE, DIVERGED (errors out of range) or POLE (too near a pole).
    """

    settings: Settings
    con: np.ndarray
    x: np.ndarray
    law: Law
    reference: VelocityReference
    truth: np.ndarray
    recorder: Recorder
    navigation: np.ndarray
    position: int = 0
    code: int = at.UNDER_WAY
    _errors: np.ndarray = field(default_factory=lambda: np.zeros(7))

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
            return "the errors left the range of navigation (tilt 1 rad, velocity 1e4 m/s)"
        return "the computed latitude passed 89.9 deg" if self.code == at.POLE else ""

    def advance(self, increments: np.ndarray) -> bool:
        """Integrate a chunk; return True when the run is complete or has diverged.

        Parameters
        ----------
        increments : ndarray, shape (n, 6)
            Angle (rad) and velocity increments (m/s) in body axes, the sample after the last one first.
        """
        room = self.settings.samples - self.position
        r, log, set_ = self.recorder, self.reference, self.settings
        self.position, self.code = advance_kernel(
            np.ascontiguousarray(increments[:room], dtype=float), self.position, set_.samples, set_.law_every,
            set_.record_every, self.con, self.x, self.truth, set_.record_step_s,
            self._heights, log.time_s, log.velocity, log.valid,
            self.law.p, self.law.s, self.law.ring, self._errors, self.navigation,
            r.row_steps, r.rows, r.stats, r.bin_width, r.bin_low, r.bin_high, r.bin_order,
            r.buffer, r.cursor,
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
        From `navcore.control.law.prepare_law` with ``law_step_s = law_every / rate_hz``.
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
    x = np.zeros(at.STATE)
    x[at.HEIGHT], x[at.V_E : at.V_U + 1] = start.height, start.velocity
    x[at.Q0 : at.Q0 + 4] = start.quaternion
    if settings.vertical == "locked":
        x[at.V_U] = 0.0
    if before is not None:
        x[at.THETA : at.THETA + 6] = before
    x[at.LAST_V_E], x[at.LAST_V_N] = start.velocity[:2]
    recorder = make_recorder(records, settings.record_step_s, settings.output_step_s)
    assert recorder.stats.shape[0] == QUANTITIES
    return StrapdownRun(
        settings=settings,
        con=constants(start, settings, earth, reference),
        x=x,
        law=law,
        reference=reference,
        truth=np.ascontiguousarray(truth, dtype=float),
        recorder=recorder,
        navigation=np.zeros((len(recorder.row_steps), len(at.NAVIGATION))),
    )
