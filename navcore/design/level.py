"""One level channel at rest with a method's loop: what each source does to it in the steady state.

Everything is in normalised units, or double precision is lost (theory.md 15): time tau = omega_s t, velocity
in m/s, tilt times sqrt(g R) in m/s, so that the free loop is dV' = phi, phi' = -dV.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from navcore.analysis.transfers import RADIUS
from navcore.design.figures import Entry, Figures
from navcore.design.form import LawForm
from navcore.foundation.units import HOUR
from navcore.scenario.stochastic import RANDOM_SOURCES, StochasticModel

DV, PHI = 0, 1
_MARGINAL = 1e-9
"""Real part over omega_s above which a mode has no decay to speak of."""
_UNSEEN = 1e-12
"""Share of a mode in a source or an output below which it takes no part in it."""


@dataclass(frozen=True, eq=False)
class Level:
    """The channel of a method with the drifts of its sensors: x' = A x + sum of B_s w_s, in tau.

    States dV, phi sqrt(gR), network, gyro drift, accelerometer drift, log drift.

    Attributes
    ----------
    A : ndarray, shape (n, n)
    drives : dict of ndarray, shape (n,)
        Input column of each random source, scaled so that its white noise has unit density in tau.
    constants : dict of ndarray, shape (n,)
        Input column of 1 rad/s, 1 m/s^2, 1 m/s of ``gyro``, ``accel`` and ``log``.
    omega_s : float
        rad/s.
    """

    A: np.ndarray
    drives: dict[str, np.ndarray]
    constants: dict[str, np.ndarray]
    omega_s: float

    @property
    def tilt_unit(self) -> float:
        """Tilt (rad) of one normalised unit."""
        return 1.0 / (self.omega_s * RADIUS)

    @cached_property
    def growth_per_s(self) -> float:
        """Largest real part of the eigenvalues, 1/s: positive when the loop is unstable."""
        return float(np.max(np.real(np.linalg.eigvals(self.A)))) * self.omega_s


def level(form: LawForm, model: StochasticModel, omega_s: float) -> Level:
    """Make the channel of a method.

    Parameters
    ----------
    form : LawForm
        The method's law.
    model : StochasticModel
        The sensors.
    omega_s : float
        Schuler frequency, rad/s.
    """
    n = form.order
    size = n + 5
    net, gyro, accel, log = slice(2, n + 2), n + 2, n + 3, n + 4
    A, own, reference = np.zeros((size, size)), -float(form.acts), float(form.uses_log)
    A[DV, PHI], A[PHI, DV] = 1.0, -1.0
    # u = own dV + reference d with d the log's error; c = C xi + D u, less dV + u where as_printed
    A[PHI, net], A[DV, net], A[net, net] = -form.C, form.E, form.A
    printed = 1.0 if form.as_printed else 0.0
    law = np.zeros(size)
    law[PHI], law[DV], law[net] = -(form.D - printed), form.F, form.B
    A[:, DV] += own * law
    A[PHI, DV] += printed
    A[PHI, gyro], A[DV, accel], A[:, log] = -1.0, 1.0, reference * law
    constants = {
        "gyro": -RADIUS * _unit(size, PHI),
        "accel": _unit(size, DV) / omega_s,
        "log": reference * law,
    }
    drives = {
        "gyro_white": constants["gyro"] * model.figures.gyro_white * math.sqrt(omega_s),
        "accel_white": constants["accel"] * model.figures.accel_white * math.sqrt(omega_s),
        "log_white": constants["log"] * math.sqrt(model.loop_figures.log_density * omega_s),
    }
    sizes = {
        "gyro_drift": (gyro, model.gyro_drift, RADIUS),
        "accel_drift": (accel, model.accel_drift, 1.0 / omega_s),
        "log_drift": (log, model.log_drift, 1.0),
    }
    for source, (i, drift, unit) in sizes.items():
        A[i, i] = -1.0 / (drift.tau_s * omega_s)
        drives[source] = _unit(size, i) * unit * math.sqrt(drift.drive / omega_s)
    return Level(A, drives, constants, omega_s)


def _unit(size: int, i: int) -> np.ndarray:
    column = np.zeros(size)
    column[i] = 1.0
    return column


def steady_parts(channel: Level) -> dict[str, Entry]:
    """Standard deviations that each random source leaves in the steady state (theory.md 15).

    The adjoint equation A^T X + X A + c c^T = 0 gives the variance of one output for every source at once,
    b^T X b.

    Parameters
    ----------
    channel : Level
        Of `level`.
    """
    from scipy.linalg import get_lapack_funcs, matrix_balance, schur

    A = channel.A
    if not decays(channel):
        return {source: _growing(channel, channel.drives[source]) for source in RANDOM_SOURCES}
    balanced, (scale, order) = matrix_balance(A, separate=True)
    columns = np.stack([channel.drives[source] for source in RANDOM_SOURCES], axis=1)
    columns = (columns / scale[:, None])[order]
    # Bartels and Stewart's method: both outputs, and all that is drawn from them, in one Schur basis.
    T, U = schur(balanced.T, output="real")[:2]
    (trsyl,) = get_lapack_funcs(("trsyl",), (T,))
    columns = U.T @ columns
    deviations = {}
    for output in (DV, PHI):
        row = U[order.tolist().index(output)] * scale[output]
        X, size, _ = trsyl(T, T, -np.outer(row, row), tranb="T")
        variance = size * np.sum(columns * (X @ columns), axis=0)
        deviations[output] = np.sqrt(np.maximum(variance, 0.0))
    return {
        source: Entry(Figures(float(deviations[PHI][k]) * channel.tilt_unit, float(deviations[DV][k])))
        for k, source in enumerate(RANDOM_SOURCES)
    }


def decays(channel: Level) -> bool:
    """Whether every mode of a channel decays in continuous time."""
    return channel.growth_per_s < -_MARGINAL * channel.omega_s


def _growing(channel: Level, column: np.ndarray) -> Entry:
    """Steady deviation where the source meets only modes that decay, else how it grows."""
    values, right = np.linalg.eig(channel.A)
    try:
        shares = np.linalg.solve(right, column.astype(complex))
    except np.linalg.LinAlgError:
        return Entry(Figures())
    deviations: list[float | None] = []
    for output in (PHI, DV):
        residues = right[output] * shares
        size = float(np.max(np.abs(residues), initial=0.0))
        seen = np.abs(residues) > _UNSEEN * max(size, 1e-300)
        marginal = seen & (np.real(values) >= -_MARGINAL)
        unit = channel.tilt_unit if output == PHI else 1.0
        if not np.any(marginal):
            deviations += [unit * _decaying(values[seen], residues[seen]), None]
        elif np.any(np.real(values[seen]) > _MARGINAL):
            deviations += [None, None]
        else:  # white noise into a mode without decay: variance |residue|^2 a unit of tau
            rate = float(np.sum(np.abs(residues[marginal]) ** 2))
            deviations += [None, unit * math.sqrt(rate * channel.omega_s * HOUR)]
    growth = Figures(deviations[1], deviations[3])
    return Entry(Figures(deviations[0], deviations[2]), growth=None if growth == Figures() else growth)


def _decaying(values: np.ndarray, residues: np.ndarray) -> float:
    """Standard deviation of sum of residue exp(value tau) under white noise of unit density."""
    if len(values) == 0:
        return 0.0
    pairs = -np.outer(residues, residues.conj()) / (values[:, None] + values.conj()[None, :])
    return math.sqrt(max(float(np.sum(pairs).real), 0.0))


def line_part(channel: Level, amplitude: float, omega: float) -> Entry:
    """Standard deviation that a sine of the log's error leaves: amplitude |T(j omega)| / sqrt(2).

    Parameters
    ----------
    channel : Level
        Of `level`.
    amplitude : float
        m/s.
    omega : float
        Its frequency, rad/s.
    """
    system = 1j * omega / channel.omega_s * np.eye(len(channel.A)) - channel.A
    try:
        x = np.linalg.solve(system, channel.constants["log"].astype(complex))
    except np.linalg.LinAlgError:
        return Entry(Figures())
    root = amplitude / math.sqrt(2.0)
    return Entry(Figures(root * abs(x[PHI]) * channel.tilt_unit, root * abs(x[DV])))


def constant_part(channel: Level, source: str, size: float) -> Entry:
    """Compute what a constant error leaves in the steady state of a stable loop.

    Parameters
    ----------
    channel : Level
        Of `level`.
    source : {"gyro", "accel", "log"}
        Where it enters.
    size : float
        Its standard deviation, SI.
    """
    if size == 0.0 or not channel.constants[source].any():  # it does not enter, whatever the loop does
        return Entry(Figures(0.0, 0.0))
    if not decays(channel):
        return Entry(Figures())
    x = np.linalg.solve(channel.A, -channel.constants[source]) * size
    return Entry(Figures(abs(float(x[PHI])) * channel.tilt_unit, abs(float(x[DV]))))
