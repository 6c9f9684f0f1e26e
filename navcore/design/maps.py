"""Effect of an interval on the errors of a damped system: transition matrices of the sampled loop itself.

One call of the damping law is written as a linear map, exactly as the simulation carries it out (held
difference, bilinear network, RK4 of the error model with held inputs); an interval of m calls is that map
composed with itself, by doubling. Kinds of intervals are handled together, as stacks of matrices.

States: the seven of the error model, the network of the east and of the north channel, and (when the log is
slower than the law) the held difference of both.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, Self, TypeVar

import numpy as np

from navcore.design.course import Course
from navcore.design.form import LawForm
from navcore.mechanization.trajectory import named, table_of


class _Piece(Protocol):
    def then(self, later: Self) -> Self: ...


Joined = TypeVar("Joined", bound=_Piece)

GYRO, ACCEL, LOG, MOTION = slice(0, 3), slice(3, 5), slice(5, 7), slice(7, 9)
"""Columns of the inputs: eps E, N, U; nabla E, N; error of the log E, N; minus the true velocity E, N, which
enters where the law takes the computed velocity by itself."""
INPUTS = 9
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
    """

    form: LawForm
    omega_s: float
    step_s: float
    hold: int
    body_frame: bool
    heading: bool
    decay: np.ndarray

    @property
    def order(self) -> int:
        """Network states of one channel."""
        return self.form.order

    @property
    def states(self) -> int:
        """States in all."""
        return ERRORS + 2 * self.order + (2 if self.hold > 1 else 0)

    @property
    def networks(self) -> slice:
        """Where the networks' states lie."""
        return slice(ERRORS, ERRORS + 2 * self.order)


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
    printed = 1.0 if loop.form.as_printed else 0.0
    # velocity added to the transport rate, E and N -> rates of the errors
    rate = np.zeros((g, ERRORS, 2))
    rate[:, 5, 0], rate[:, 4, 1] = named(half)["inv_n"], -named(half)["inv_m"]
    rate = integral @ rate
    fed = integral[:, :, 0:2] * law.F
    into = rate * (law.D - printed) + fed  # of the input u on the errors
    Phi[:, :ERRORS, 0:2] -= printed * rate
    B[:, :ERRORS, MOTION] = printed * rate
    enters = LOG if loop.form.uses_log else MOTION
    own = np.zeros((g, 2, ERRORS))
    own[:, 0, 0] = own[:, 1, 1] = -1.0
    if loop.body_frame and loop.form.uses_log:
        own[:, 0, 6], own[:, 1, 6] = named(half)["v_n"], -named(half)["v_e"]
    held = slice(ERRORS + 2 * n, ERRORS + 2 * n + 2)
    for channel in (0, 1):
        net = slice(ERRORS + n * channel, ERRORS + n * (channel + 1))
        Phi[:, net, net] = law.A
        Phi[:, :ERRORS, net] = rate[:, :, channel, None] * law.C + integral[:, :, channel, None] * law.E
        if fresh:
            Phi[:, net, :ERRORS] = law.B[:, None] * own[:, channel, None, :]
            B[:, net, enters.start + channel] = law.B
        else:
            Phi[:, net, held.start + channel] = law.B
    if fresh:
        Phi[:, :ERRORS, :ERRORS] += into @ own
        B[:, :ERRORS, enters] = into
        if loop.hold > 1:
            Phi[:, held, held] = 0.0
            Phi[:, held, :ERRORS] = own
            B[:, held, enters] = np.eye(2)
    else:
        Phi[:, :ERRORS, held] = into


def loop_model(
    form: LawForm,
    course: Course,
    omega_s: float,
    *,
    body_frame: bool,
    heading: bool,
    taus: tuple[float, float, float],
) -> LoopModel:
    """Collect what `call_map` needs; ``taus`` are the correlation times of gyros, accelerometers, log (s)."""
    hold = course.hold if form.uses_log else 1
    decay = np.ones(INPUTS)
    for columns, tau, calls in zip((GYRO, ACCEL, LOG), taus, (1, 1, hold), strict=True):
        decay[columns] = math.exp(-calls * course.step_s / tau)
    return LoopModel(form, omega_s, course.step_s, hold, body_frame, heading, decay)


def mean_coefficients(course: Course) -> np.ndarray:
    """Mean coefficients of a run without horizontal force and speed, shape (1, COLUMNS)."""
    row = named(course.half.mean(axis=0)[None, :])
    for name in ("f_e", "f_n", "v_e", "v_n", "v_u", "w_e", "up_lat"):
        row[name] = 0.0
    return table_of(row)
