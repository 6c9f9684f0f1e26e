"""One level channel as its law runs: called every T, the log's difference held for T_log (theory.md 15).

The map of the state over one period of the log is linear. Its eigenvalues say whether the loop grows, and the
discrete Lyapunov equation gives the variance at the begin of a period, from which the mean over the period
follows. Units are those of `navcore.design.level`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from navcore.analysis.held_log import growth_of_map
from navcore.analysis.response import matrix_exponential
from navcore.analysis.transfers import RADIUS
from navcore.design.figures import Entry, Figures
from navcore.design.form import LawForm
from navcore.design.level import DV, PHI, Level
from navcore.design.maps import discrete_form, repeated
from navcore.scenario.fields import ScenarioFields
from navcore.scenario.stochastic import RANDOM_SOURCES, StochasticModel

_GROWS = 1e-7
"""Growth over omega_s above which a loop counts as unstable; rounding moves an eigenvalue by less."""
_SQUARINGS = 60


class Timing(NamedTuple):
    """How a scenario samples its law.

    Attributes
    ----------
    step_s : float
        Time between two calls of the law, s.
    hold : int
        Calls for which the log's difference is held.
    """

    step_s: float
    hold: int


def timing_of(scenario: ScenarioFields) -> Timing:
    """Step of the law and period of the simulated log, in whole steps; a recorded log is read each call."""
    log, step_s = scenario.reference, scenario.law_step_s
    return Timing(step_s, 1 if log.kind != "log" else max(1, round(1.0 / (log.rate_hz * step_s))))


@dataclass(frozen=True, eq=False)
class SampledLevel:
    """Map of the channel's state.

    States dV, phi sqrt(gR), network, held difference, gyro drift, accelerometer drift, log drift.

    Attributes
    ----------
    fresh : ndarray, shape (n, n)
        Takes a new difference V_r - V_c.
    step : ndarray, shape (n, n)
        One call of the law with the difference that is held, and the step that follows.
    added : dict of ndarray, shape (n,)
        Column of each random source whose noise of unit variance each step adds.
    read : float
        Standard deviation that each epoch of the log adds to the difference, m/s.
    timing : Timing
    omega_s : float
        rad/s.
    """

    fresh: np.ndarray
    step: np.ndarray
    added: dict[str, np.ndarray]
    read: float
    timing: Timing
    omega_s: float

    @property
    def held(self) -> int:
        """Where the held difference lies."""
        return len(self.step) - 4

    def growth_per_s(self) -> float:
        """Largest ln|eigenvalue| of the loop over a period of the log, 1/s; 0 where rounding makes it."""
        loop = slice(0, self.held + 1)
        step, fresh = self.step[loop, loop], self.fresh[loop, loop]
        period = np.linalg.matrix_power(step, self.timing.hold) @ fresh
        return growth_of_map(period, self.timing.hold * self.timing.step_s, self.omega_s)

    @property
    def grows(self) -> bool:
        """Whether the loop is unstable as it is sampled."""
        return self.growth_per_s() > _GROWS * self.omega_s


def sampled_level(form: LawForm, model: StochasticModel, omega_s: float, timing: Timing) -> SampledLevel:
    """Make the sampled channel of a method, with the sensors' errors held over a step as in a run.

    Parameters
    ----------
    form : LawForm
        The method's law.
    model : StochasticModel
        The sensors.
    omega_s : float
        Schuler frequency, rad/s.
    timing : Timing
        Of `timing_of`.
    """
    n, h = form.order, timing.step_s
    held, gyro, accel, log = (n + 2 + k for k in range(4))
    size, net = n + 6, slice(2, n + 2)
    law = discrete_form(form, omega_s, h)
    # columns: dV, phi, and what an input of dV' and of phi' that is held over the step makes of them
    joint = np.zeros((4, 4))
    joint[DV, PHI], joint[PHI, DV], joint[DV, 2], joint[PHI, 3] = 1.0, -1.0, 1.0, 1.0
    moved = matrix_exponential(joint * (omega_s * h))[:2]
    into_dv, into_phi = moved[:, 2], moved[:, 3]
    own, reference, printed = -float(form.acts), float(form.uses_log), 1.0 if form.as_printed else 0.0
    step, fresh = np.eye(size), np.eye(size)
    step[:2, :2] = moved[:, :2]
    step[:2, DV] += printed * into_phi
    step[:2, net] = np.outer(into_dv, law.E / omega_s) - np.outer(into_phi, law.C)
    step[:2, held] = into_dv * law.F / omega_s - into_phi * (law.D - printed)
    step[net, net], step[net, held] = law.A, law.B
    step[:2, gyro], step[:2, accel] = -RADIUS * into_phi, into_dv / omega_s
    fresh[held, held], fresh[held, DV], fresh[held, log] = 0.0, own, reference
    figures, added = model.loop_figures, {}
    for source, white, at in (("gyro", figures.gyro_white, gyro), ("accel", figures.accel_white, accel)):
        added[f"{source}_white"] = np.zeros(size)
        added[f"{source}_white"][:2] = step[:2, at] * white / math.sqrt(h)
    drifts = ((gyro, model.gyro_drift), (accel, model.accel_drift), (log, model.log_drift))
    for source, (at, drift) in zip(("gyro", "accel", "log"), drifts, strict=True):
        step[at, at] = left = math.exp(-h / drift.tau_s)
        column = added[f"{source}_drift"] = np.zeros(size)
        column[at] = drift.sigma * math.sqrt(1.0 - left * left)
    read = reference * figures.log_noise / math.sqrt(max(1.0, figures.log_rate_hz * h))
    return SampledLevel(fresh, step, added, read, timing, omega_s)


@dataclass(frozen=True, eq=False)
class _Summed:
    """Steps S of a run of m: S^m, sum over j < m of (S^j)' c c' S^j, and the sum of those sums over j < m."""

    S: np.ndarray
    G: np.ndarray
    H: np.ndarray
    count: int

    def then(self, later: _Summed) -> _Summed:
        """Return this run followed by another of the same step."""
        S = self.S
        return _Summed(
            later.S @ S,
            self.G + S.T @ later.G @ S,
            self.H + later.count * self.G + S.T @ later.H @ S,
            self.count + later.count,
        )


def sampled_parts(sampled: SampledLevel, channel: Level) -> dict[str, Entry]:
    """Standard deviations that each random source leaves, mean square over a period of the log.

    By the adjoint equation X = M' X M + G with M the map over a period: one solution for an output serves all
    sources.

    Parameters
    ----------
    sampled : SampledLevel
        Of a loop all of whose modes decay.
    channel : Level
        The same channel in continuous time, for its units.
    """
    hold, size = sampled.timing.hold, len(sampled.step)
    columns = np.stack([sampled.added.get(source, np.zeros(size)) for source in RANDOM_SOURCES], axis=1)
    C = np.zeros((2, size, size))  # of both outputs, dV and phi, side by side
    C[(0, 1), (DV, PHI), (DV, PHI)] = 1.0
    period = repeated(_Summed(sampled.step, C, np.zeros_like(C), 1), hold)
    # X is of the state after an epoch is read; what a period adds before the next one is seen through it
    X = _discrete_lyapunov(sampled.fresh @ period.S, period.G)
    later = sampled.fresh.T @ X @ sampled.fresh
    through = repeated(_Summed(sampled.step, later, np.zeros_like(C), 1), hold).G
    variances = np.sum(columns * ((period.H + through) @ columns), axis=1)
    read = X[:, sampled.held, sampled.held] * sampled.read**2
    variances[:, RANDOM_SOURCES.index("log_white")] += read
    velocity, tilt = np.sqrt(np.maximum(variances, 0.0) / hold).tolist()
    return {
        source: Entry(Figures(tilt[k] * channel.tilt_unit, velocity[k]))
        for k, source in enumerate(RANDOM_SOURCES)
    }


def _discrete_lyapunov(M: np.ndarray, G: np.ndarray) -> np.ndarray:
    """Solve X = M' X M + G by squaring; G has no negative eigenvalue, shape (k, n, n)."""
    X = G
    for _ in range(_SQUARINGS):
        added = M.T @ X @ M
        X = X + added
        # the largest elements of such matrices stand on their diagonals
        if (_diagonals(added) <= 1e-15 * _diagonals(X)).all():
            break
        M = M @ M
    return X


def _diagonals(X: np.ndarray) -> np.ndarray:
    """Largest diagonal element of each matrix."""
    return X.diagonal(axis1=1, axis2=2).max(axis=1)
