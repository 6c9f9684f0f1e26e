"""Effect of an interval on the errors of a damped system: transition matrices of the sampled loop itself.

One call of the damping law is written as a linear map, exactly as the simulation carries it out (held
difference, bilinear network, RK4 of the error model with held inputs); an interval of m calls is that map
composed with itself, by doubling. Kinds of intervals are handled together, as stacks of matrices.

States: the seven of the error model, the network of the east and of the north channel, the azimuth channel's,
and (when the log is slower than the law) the held difference of both level channels.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, Self, TypeVar

import numpy as np

from navcore.design.azimuth import AzimuthForm, put_azimuth
from navcore.design.course import Course
from navcore.design.form import LawForm
from navcore.mechanization.trajectory import named, table_of


class _Piece(Protocol):
    def then(self, later: Self) -> Self: ...


Joined = TypeVar("Joined", bound=_Piece)

GYRO, ACCEL, LOG, MOTION, UP = slice(0, 3), slice(3, 5), slice(5, 7), slice(7, 9), 9
"""Columns of the inputs: eps E, N, U; nabla E, N; error of the log E, N; minus the true velocity E, N; minus
the true rate omega_U about the vertical. The last three enter where the law takes the computed ones."""
INPUTS = 10
ERRORS = 7


@dataclass(frozen=True, eq=False)
class Map:
    """x -> Phi x + B w for a constant input w, and Phi x + G w for one that decays each call; stacked.

    Attributes
    ----------
    Phi : ndarray, shape (g, n, n)
    B, G : ndarray, shape (g, n, INPUTS)
    decay : ndarray, shape (INPUTS,)
        What is left of w after the map.
    """

    Phi: np.ndarray
    B: np.ndarray
    G: np.ndarray
    decay: np.ndarray

    def then(self, later: Map) -> Map:
        """Return this map followed by another."""
        return Map(
            later.Phi @ self.Phi,
            later.Phi @ self.B + later.B,
            later.Phi @ self.G + later.G * self.decay,
            self.decay * later.decay,
        )


def repeated(one: Joined, count: int) -> Joined:
    """Join ``count`` equal pieces by doubling."""
    result: Joined | None = None
    while True:
        if count & 1:
            result = one if result is None else result.then(one)
        count >>= 1
        if count == 0:
            assert result is not None
            return result
        one = one.then(one)


def calls_joined(fresh: Joined, held: Callable[[], Joined], calls: int, hold: int) -> Joined:
    """Join ``calls`` calls of the law: the first of every ``hold`` is fresh, the others hold its sample."""
    if hold == 1:
        return repeated(fresh, calls)
    later = held()
    samples, rest = divmod(calls, hold)
    lengths = {hold: samples, rest: 1} if rest else {hold: samples}
    pieces = [
        repeated(fresh if length == 1 else fresh.then(repeated(later, length - 1)), count)
        for length, count in lengths.items()
        if count
    ]
    return pieces[0] if len(pieces) == 1 else pieces[0].then(pieces[1])


@dataclass(frozen=True, eq=False)
class DiscreteForm:
    """A `LawForm` at the step of the law, bilinear and prewarped at omega_s (theory.md 3.5)."""

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: float
    E: np.ndarray
    F: float


def discrete_form(form: LawForm, omega_s: float, step_s: float) -> DiscreteForm:
    """Discretise a law; A is the whole transition matrix, E and F give m/s^2."""
    n, a = form.order, math.tan(0.5 * omega_s * step_s)
    inverse = np.linalg.inv(np.eye(n) - a * form.A)
    return DiscreteForm(
        A=np.eye(n) + 2.0 * a * form.A @ inverse,
        B=2.0 * a * inverse @ form.B,
        C=form.C @ inverse,
        D=form.D + a * float(form.C @ inverse @ form.B),
        E=omega_s * form.E @ inverse,
        F=omega_s * (form.F + a * float(form.E @ inverse @ form.B)),
    )


def system_matrices(half: np.ndarray) -> np.ndarray:
    """System matrices of the seven error states for rows of coefficients; shape (g, 7, 7)."""
    c = named(half)
    f = np.zeros((len(half), ERRORS, ERRORS))
    coriolis = c["w_u"] + c["earth_u"]
    up = c["tan_lat"] * c["inv_n"]
    d_up = 2.0 * c["earth_n"] + c["up_lat"]
    f[:, 0, 0] = up * c["v_n"] - c["inv_n"] * c["v_u"]
    f[:, 0, 1], f[:, 0, 5], f[:, 0, 6] = coriolis, -c["f_u"], c["f_n"]
    f[:, 0, 2] = d_up * c["v_n"] + 2.0 * c["earth_u"] * c["v_u"]
    f[:, 1, 0], f[:, 1, 1] = -coriolis - up * c["v_e"], -c["inv_m"] * c["v_u"]
    f[:, 1, 2], f[:, 1, 4], f[:, 1, 6] = -d_up * c["v_e"], c["f_u"], -c["f_e"]
    f[:, 2, 1] = c["inv_m"]
    f[:, 3, 0] = c["inv_n"] * c["sec_lat"]
    f[:, 3, 2] = c["v_e"] * c["tan_lat"] * c["inv_n"] * c["sec_lat"]
    f[:, 4, 1], f[:, 4, 5], f[:, 4, 6] = -c["inv_m"], c["w_u"], -c["w_n"]
    f[:, 5, 0], f[:, 5, 2], f[:, 5, 4], f[:, 5, 6] = c["inv_n"], -c["earth_u"], -c["w_u"], c["w_e"]
    f[:, 6, 0], f[:, 6, 2] = up, c["up_lat"] + c["earth_n"]
    f[:, 6, 4], f[:, 6, 5] = c["w_n"], -c["w_e"]
    return f


def error_step(half: np.ndarray, step_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Transition and input integral of the undamped model over one step, as RK4 has them; (g, 7, 7) each."""
    f = system_matrices(half) * step_s
    eye = np.eye(ERRORS)
    integral = step_s * (eye + f @ (eye / 2.0 + f @ (eye / 6.0 + f / 24.0)))
    return eye + system_matrices(half) @ integral, integral


@dataclass(frozen=True, eq=False)
class LoopModel:
    """Parts of a method that all intervals share.

    Attributes
    ----------
    form : LawForm
    omega_s, step_s : float
        rad/s, s.
    hold : int
        Calls for which a difference is held; 1 where the law takes no log.
    body_frame : bool
        The log is turned by the computed heading.
    heading : bool
        False for the `channel` fidelity: its up gyro drives nothing.
    decay : ndarray, shape (INPUTS,)
        What one call leaves of a drift; of the log's, one sample.
    azimuth : AzimuthForm or None
        What acts in the azimuth channel.
    """

    form: LawForm
    omega_s: float
    step_s: float
    hold: int
    body_frame: bool
    heading: bool
    decay: np.ndarray
    azimuth: AzimuthForm | None = None

    @property
    def order(self) -> int:
        """Network states of one channel."""
        return self.form.order

    @property
    def states(self) -> int:
        """States in all."""
        return self.networks.stop + (2 if self.hold > 1 else 0)

    @property
    def networks(self) -> slice:
        """Where the states of all channels lie: what is cleared when the log comes back."""
        own = 0 if self.azimuth is None else self.azimuth.states
        return slice(ERRORS, ERRORS + 2 * self.order + own)


def interval_map(loop: LoopModel, half: np.ndarray, calls: int, damped: bool) -> Map:
    """Map of an interval of ``calls`` calls for each row of coefficients."""
    fresh = call_map(loop, half, damped, fresh=True)
    return calls_joined(fresh, lambda: call_map(loop, half, damped, fresh=False), calls, loop.hold)


def call_map(loop: LoopModel, half: np.ndarray, damped: bool, fresh: bool) -> Map:
    """Map of one call of the law and the step that follows it.

    Parameters
    ----------
    loop : LoopModel
        The method.
    half : ndarray, shape (g, COLUMNS)
        Coefficients.
    damped : bool
        False: the log is out of service, the correction is zero and the networks stay as they are.
    fresh : bool
        A new sample of the log is taken; else the last difference is held.
    """
    transition, integral = error_step(half, loop.step_s)
    g, size = len(half), loop.states
    law = discrete_form(loop.form, loop.omega_s, loop.step_s)
    Phi, B = np.zeros((g, size, size)), np.zeros((g, size, INPUTS))
    Phi[:, :ERRORS, :ERRORS] = transition
    Phi[:, range(ERRORS, size), range(ERRORS, size)] = 1.0
    B[:, :ERRORS, GYRO] = -integral[:, :, 4:7]
    B[:, :ERRORS, ACCEL] = integral[:, :, 0:2]
    if not loop.heading:
        B[:, :, 2] = 0.0
    decay = loop.decay.copy()
    if not fresh:
        decay[LOG] = 1.0
    if damped and loop.form.acts:
        _put_law(loop, law, half, integral, fresh, Phi, B)
    return Map(Phi, B, B.copy(), decay)


def _put_law(
    loop: LoopModel,
    law: DiscreteForm,
    half: np.ndarray,
    integral: np.ndarray,
    fresh: bool,
    Phi: np.ndarray,
    B: np.ndarray,
) -> None:
    g, n = len(half), loop.order
    compass = None if loop.azimuth is None else loop.azimuth.compass
    # velocity added to the transport rate, E and N -> rates of the errors
    rate = np.zeros((g, ERRORS, 2))
    rate[:, 5, 0], rate[:, 4, 1] = named(half)["inv_n"], -named(half)["inv_m"]
    rate = integral @ rate
    printed = rate * (1.0 if loop.form.as_printed else 0.0)
    into = rate * law.D + integral[:, :, 0:2] * law.F  # of the input u on the errors
    if compass is not None:
        printed[:, :, 1] = 0.0
        into[:, :, 1] = integral[:, :, 1] * compass.k1 - rate[:, :, 1] * compass.k2
    into -= printed
    Phi[:, :ERRORS, 0:2] -= printed
    B[:, :ERRORS, MOTION] = printed
    d, entered = _difference(loop, half, fresh)
    Phi[:, :ERRORS] += into @ d.swapaxes(0, 1)
    B[:, :ERRORS] += into @ entered.swapaxes(0, 1)
    for channel in (0, 1) if compass is None else (0,):
        net = slice(ERRORS + n * channel, ERRORS + n * (channel + 1))
        Phi[:, net, net] = law.A
        Phi[:, :ERRORS, net] = rate[:, :, channel, None] * law.C + integral[:, :, channel, None] * law.E
        Phi[:, net] += law.B[:, None] * d[channel, :, None]
        B[:, net] += law.B[:, None] * entered[channel, :, None]
    if loop.azimuth is not None:
        first = ERRORS + 2 * n
        put_azimuth(loop.azimuth, half, integral[:, :, 6], (d, entered), first, fresh, UP, Phi, B)
    if fresh and loop.hold > 1:
        held = slice(loop.networks.stop, loop.states)
        Phi[:, held] = d.swapaxes(0, 1)
        B[:, held] = entered.swapaxes(0, 1)


def _difference(loop: LoopModel, half: np.ndarray, fresh: bool) -> tuple[np.ndarray, np.ndarray]:
    """The law's input u of both level channels by states, shape (2, g, n), and by inputs, (2, g, INPUTS)."""
    g, uses_log = len(half), loop.form.uses_log
    d, entered = np.zeros((2, g, loop.states)), np.zeros((2, g, INPUTS))
    if not fresh:
        held = loop.networks.stop
        d[0, :, held] = d[1, :, held + 1] = 1.0
        return d, entered
    d[0, :, 0] = d[1, :, 1] = -1.0
    if loop.body_frame and uses_log:
        d[0, :, 6], d[1, :, 6] = named(half)["v_n"], -named(half)["v_e"]
    enters = LOG if uses_log else MOTION
    entered[0, :, enters.start] = entered[1, :, enters.start + 1] = 1.0
    return d, entered


def loop_model(
    form: LawForm,
    course: Course,
    omega_s: float,
    *,
    body_frame: bool,
    heading: bool,
    taus: tuple[float, float, float],
    azimuth: AzimuthForm | None = None,
) -> LoopModel:
    """Collect what `call_map` needs; ``taus`` are the correlation times of gyros, accelerometers, log (s)."""
    hold = course.hold if form.uses_log else 1
    decay = np.ones(INPUTS)
    for columns, tau, calls in zip((GYRO, ACCEL, LOG), taus, (1, 1, hold), strict=True):
        decay[columns] = math.exp(-calls * course.step_s / tau)
    return LoopModel(form, omega_s, course.step_s, hold, body_frame, heading, decay, azimuth)


def mean_coefficients(course: Course) -> np.ndarray:
    """Mean coefficients of a run without horizontal force and speed, shape (1, COLUMNS)."""
    row = named(course.half.mean(axis=0)[None, :])
    for name in ("f_e", "f_n", "v_e", "v_n", "v_u", "w_e", "up_lat"):
        row[name] = 0.0
    return table_of(row)
