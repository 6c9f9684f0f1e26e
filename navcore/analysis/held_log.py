"""Stability of the damping law as it runs: sampled, with the log's difference held between two log epochs.

Between two epochs of the log the law holds the difference V_r - V_c of the last one (interface.md), and
between two calls of the law the correction is held. A loop that is stable in continuous time diverges when
either lasts too long: a log each 100 s, or `compass` with sigma = 1 at a law step of 1 s (theory.md 10). The
map over one period of the log is linear, so its eigenvalues decide.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from navcore.analysis.loop import closed_loop_poles
from navcore.analysis.response import matrix_exponential
from navcore.analysis.whole_matrix import (
    AT_REST,
    DV_E,
    DV_N,
    LATITUDE,
    PHI_E,
    PHI_N,
    PHI_U,
    STATES,
    Course,
    feedback_gains,
    free_matrix,
    inputs_of_law,
    seen_differences,
    up_rate,
)
from navcore.analysis.whole_system import duration
from navcore.foundation.earth import EARTH_RATE, SPHERE, Earth
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.networks.azimuth_loop import AzimuthChannel, AzimuthGains
from navcore.networks.base import LinearNetwork
from navcore.networks.discrete import discretise

_FAST = 0.3
"""A growing mode faster than this times omega_s is not the 24 h mode: it comes from the hold."""
_STANDS = 1e-7
_FASTER = 2.0
"""Growth along a motion counts from so many times the rate at which the latitude changes."""
_SEARCH = 20
_CHANNELS = np.zeros((STATES, STATES))
"""Ones where a level channel acts on itself."""
for _velocity, _tilt in ((DV_E, PHI_N), (DV_N, PHI_E)):
    _CHANNELS[_velocity, _tilt] = _CHANNELS[_tilt, _velocity] = 1.0
_ALONE = [LATITUDE, PHI_U]


@dataclass(frozen=True)
class HeldLog:
    """Effect on the loop of holding the log's difference.

    Attributes
    ----------
    log_period_s, law_step_s : float
        s; the log's period is rounded to whole steps of the law.
    stable : bool
        No mode that comes from the hold grows.
    growth : float
        Fastest growth of such a mode, 1/s; negative: all decay; nan where there is none.
    growth_per_s : float
        Fastest growth of all modes, the slow ones too, 1/s; 0 where rounding could make it; nan where the
        network cannot run at this step.
    stable_up_to_s : float or None
        Longest log period (or law step, when the log is as fast as the law) that is stable, s; None when
        stable as it is, or unstable in continuous time too; 0 when no shorter one helps.
    warnings : tuple of str
        Says what is held too long; empty when the loop is unstable in continuous time too.
    """

    log_period_s: float
    law_step_s: float
    stable: bool
    growth: float
    growth_per_s: float
    stable_up_to_s: float | None
    warnings: tuple[str, ...]


@lru_cache(maxsize=256)
def held_log(
    network: LinearNetwork,
    log_period_s: float,
    law_step_s: float,
    lat: float,
    earth: Earth = SPHERE,
    coupled: bool = True,
    azimuth: AzimuthChannel | None = None,
) -> HeldLog:
    """Check the sampled law of a method of a ship at rest.

    Parameters
    ----------
    network : LinearNetwork
        H(s) as it acts.
    log_period_s : float
        Time between two epochs of what the law reads, s: of the log, or of its own calls where it reads the
        computed velocity (internal damping). A log faster than the law is read once a call.
    law_step_s : float
        Time between two calls of the law, s.
    lat : float
        rad.
    earth : Earth
        WGS-84 or the sphere.
    coupled : bool
        False: `growth_per_s` is that of the level channels by themselves, without heading and latitude.
    azimuth : LinearNetwork or AzimuthGains, optional
        Y(s) or the gyrocompass of the azimuth channel; it counts in `growth_per_s`.
    """
    calls = max(1, round(log_period_s / law_step_s))
    growth = _growth(network, law_step_s, calls, lat, earth)
    try:
        period = period_map(network, law_step_s, calls, lat, earth, coupled, azimuth)
        overall = growth_of_map(period, calls * law_step_s, network.omega_s)
    except InputError:
        overall = math.nan
    stable = not growth > _STANDS * network.omega_s
    up_to, warnings = None, ()
    if not stable and np.max(closed_loop_poles(network).real) <= _STANDS:
        up_to = _stable_up_to(network, law_step_s, calls, lat, earth)
        warnings = (_warning(growth, calls * law_step_s, law_step_s, calls, up_to),)
    return HeldLog(calls * law_step_s, law_step_s, stable, growth, overall, up_to, warnings)


class Stretch(NamedTuple):
    """Part of a motion.

    Attributes
    ----------
    lat : float
        Mean latitude, rad.
    v_e, v_n : float
        Mean velocity, m/s.
    duration_s : float
        s.
    """

    lat: float
    v_e: float
    v_n: float
    duration_s: float


@lru_cache(maxsize=256)
def growth_along(
    network: LinearNetwork,
    log_period_s: float,
    law_step_s: float,
    stretches: tuple[Stretch, ...],
    earth: Earth = SPHERE,
    azimuth: AzimuthChannel | None = None,
    turned: bool = False,
) -> float:
    """Growth of the whole system as its law is sampled along a motion, 1/s; nan where it cannot run.

    It is that of the map over the whole motion, as if the motion were repeated for ever. What grows no faster
    than twice the rate at which the latitude changes is a passing distortion of the meridians, and not judged
    (theory.md 10).

    Parameters
    ----------
    network, log_period_s, law_step_s, earth, azimuth
        As of `held_log`.
    stretches : tuple of Stretch
        The motion; within each of them velocity and latitude count as constant.
    turned : bool
        The law reads a log in the ship's axes, which the computed heading turns.
    """
    calls = max(1, round(log_period_s / law_step_s))
    period_s, omega_s = calls * law_step_s, network.omega_s
    whole, grown, total_s = None, 0.0, sum(one.duration_s for one in stretches)
    try:
        maps = [
            period_map(
                network, law_step_s, calls, one.lat, earth, True, azimuth, Course(one.v_e, one.v_n, turned)
            )
            for one in stretches
        ]
    except InputError:
        return math.nan
    if len(maps) == 1:
        growth = growth_of_map(maps[0], period_s, omega_s)
    else:
        for one, period in zip(stretches, maps, strict=True):
            count = max(1, round(one.duration_s / period_s))
            rate = max(0.0, growth_of_map(period, period_s, omega_s))  # taken out, or the power overflows
            power = np.linalg.matrix_power(period * math.exp(-rate * period_s), count)
            grown += rate * count * period_s
            whole = power if whole is None else power @ whole
        assert whole is not None
        growth = growth_of_map(whole, total_s, omega_s) + grown / total_s
    changes = sum(
        abs(one.v_n) / earth.radii(one.lat)[0] * max(1.0, abs(math.tan(one.lat))) * one.duration_s
        for one in stretches
    )
    return growth if growth <= 0.0 or growth > _FASTER * changes / total_s else 0.0


def period_map(
    network: LinearNetwork,
    law_step_s: float,
    calls: int,
    lat: float,
    earth: Earth = SPHERE,
    coupled: bool = True,
    azimuth: AzimuthChannel | None = None,
    course: Course = AT_REST,
) -> np.ndarray:
    """Map of the state over one period of the log, i.e. ``calls`` calls of the law.

    The state holds the six errors (normalised as in `whole_system.free_matrix`), the law's states of both
    channels and, when the log is slower than the law, the two held differences V_r - V_c. Uncoupled, it is
    that of the level channels, without heading and latitude. With an azimuth network its states follow, and
    the held difference omega_Ur - omega_U; where the computed heading turns the log, also the error that this
    gives its north velocity, held, and that of the latitude L_r that follows from it.

    Raises
    ------
    InputError
        The network cannot run at this step.
    """
    dA, B, C, D, E, k1 = _sampled_law(network, law_step_s)
    n, omega_s = len(B), network.omega_s
    plant, forced = _held_plant(lat, omega_s, law_step_s, earth, coupled, course)
    seen = seen_differences(lat, omega_s, earth, course)
    held = STATES + 2 * n
    m = 0 if azimuth is None else 1 if isinstance(azimuth, AzimuthGains) else azimuth.order + 3
    step = np.zeros((held + 2 + m, held + 2 + m))
    step[:STATES, :STATES] = plant
    for channel in range(2):
        z = slice(STATES + channel * n, STATES + (channel + 1) * n)
        step[:STATES, z] = np.outer(forced[:, channel], C) + np.outer(forced[:, 2 + channel], E)
        step[:STATES, held + channel] = forced[:, channel] * D + forced[:, 2 + channel] * k1
        step[z, z] = np.eye(n) + dA
        step[z, held + channel] = B
        step[held + channel, held + channel] = 1.0
    # a fresh epoch: the difference becomes that of now before the law is called
    fresh = np.eye(held + 2 + m)
    fresh[held : held + 2] = 0.0
    fresh[held : held + 2, :STATES] = -seen
    if isinstance(azimuth, AzimuthGains):
        pull = earth.gravity(lat, 0.0) / (EARTH_RATE * math.cos(lat))
        _turn_north(step, forced, azimuth, omega_s, law_step_s, pull)
    elif azimuth is not None:
        y, u = discretise(azimuth, law_step_s), held + 2 + azimuth.order
        z, turned, lat_r = slice(held + 2, u), u + 1, u + 2
        step[:STATES, z] = np.outer(forced[:, 4], -y.C)
        step[:STATES, u] = forced[:, 4] * (1.0 - y.D)
        step[z, z], step[z, u], step[u, u] = np.eye(y.order) + y.dA, y.B, 1.0
        step[turned, turned] = step[lat_r, lat_r] = 1.0
        step[lat_r, turned] = omega_s * law_step_s
        up = up_rate(lat, omega_s, earth, course=course)
        fresh[[u, turned]] = 0.0
        fresh[turned, PHI_U] = inputs_of_law(lat, omega_s, earth)[PHI_E, 1] * seen[DV_N, PHI_U]
        fresh[u, :STATES], fresh[u, lat_r] = -up, up[LATITUDE]
        fresh[u, PHI_U] -= seen[DV_E, PHI_U] * up[DV_E]
    period = np.linalg.matrix_power(step, calls) @ fresh
    return period if coupled else np.delete(np.delete(period, _ALONE, 0), _ALONE, 1)


def _turn_north(
    step: np.ndarray, forced: np.ndarray, gains: AzimuthGains, omega_s: float, step_s: float, pull: float
) -> None:
    """Put a gyrocompass in the place of the north network: w is the last state, d_N the one before.

    ``pull`` is g/(Omega cos L), m/s.
    """
    w, held, left = len(step) - 1, len(step) - 2, math.exp(-gains.k4 * step_s)
    gain = gains.k3 * pull * (1.0 - left) / (gains.k4 * omega_s**2)
    step[w, w], step[w, held] = left, -gain
    step[:STATES, STATES + (held - 1 - STATES) // 2 : held - 1] = 0.0
    step[:STATES, held] = (
        forced[:, 3] * (gains.k1 / omega_s) - forced[:, 1] * gains.k2 - forced[:, 4] * 0.5 * gain
    )
    step[:STATES, w] = forced[:, 4] * 0.5 * (1.0 + left)


def growth_of_map(period: np.ndarray, period_s: float, omega_s: float) -> float:
    """Growth of the fastest growing mode of a map over a period, 1/s; 0 where rounding could make it.

    Parameters
    ----------
    period : ndarray, shape (n, n)
    period_s : float
        s.
    omega_s : float
        Schuler frequency, rad/s.
    """
    growth = math.log(max(float(np.max(np.abs(np.linalg.eigvals(_connected(period))))), 1e-300)) / period_s
    return growth if abs(growth) > _STANDS * omega_s else 0.0


def _connected(period: np.ndarray) -> np.ndarray:
    """Leave out states that the errors do not drive, or that do not act on them: integrators that idle."""
    linked = np.abs(period) > 0.0
    reached, acting = (_reachable(matrix) for matrix in (linked, linked.T))
    kept = np.flatnonzero(reached & acting)
    return period[np.ix_(kept, kept)]


def _reachable(linked: np.ndarray) -> np.ndarray:
    """Mark the states that the first ones, the errors of the level channels, reach; shape (n,)."""
    found = np.zeros(len(linked), dtype=bool)
    found[:2] = True
    for _ in range(len(linked)):
        found = found | (linked[:, found].any(axis=1))
    return found


def _sampled_law(
    network: LinearNetwork, step_s: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float, np.ndarray, float]:
    """dA, B, C, D, E, k1 of z += dA z + B d, c = C z + D d, a = omega_s (E z + k1 d), for d = V_r - V_c."""
    if network.feedback_p is None and network.realisation != "network":
        k1, k2, k3 = feedback_gains(network)
        tau = network.omega_s * step_s
        return np.zeros((1, 1)), np.array([-k3 * tau]), np.ones(1), -k2 - 0.5 * k3 * tau, np.zeros(1), k1
    discrete = discretise(network, step_s)
    E = np.zeros(discrete.order) if discrete.E is None else discrete.E / network.omega_s
    return discrete.dA, discrete.B, -discrete.C, 1.0 - discrete.D, E, discrete.F / network.omega_s


def _held_plant(
    lat: float, omega_s: float, step_s: float, earth: Earth, coupled: bool, course: Course
) -> tuple[np.ndarray, np.ndarray]:
    """Transition of the six states over a step, and that of the five inputs held over it."""
    both = np.zeros((STATES + 5, STATES + 5))
    both[:STATES, :STATES] = free_matrix(lat, omega_s, earth, course=course) * (1.0 if coupled else _CHANNELS)
    both[:STATES, STATES:-1] = inputs_of_law(lat, omega_s, earth)
    both[PHI_U, -1] = 1.0
    moved = matrix_exponential(both * (omega_s * step_s))
    return moved[:STATES, :STATES], moved[:STATES, STATES:]


def _growth(network: LinearNetwork, step_s: float, calls: int, lat: float, earth: Earth) -> float:
    """Growth of the fastest growing mode that is not a slow one, 1/s."""
    try:
        factors = np.linalg.eigvals(period_map(network, step_s, calls, lat, earth))
    except InputError:  # the run itself says why this network cannot run at this step
        return math.nan
    rates = np.log(factors[np.abs(factors) > 1e-300].astype(complex)) / (calls * step_s)
    fast = rates[np.abs(rates) > _FAST * network.omega_s]
    return float(np.max(fast.real)) if len(fast) else math.nan


def _stable_up_to(network: LinearNetwork, step_s: float, calls: int, lat: float, earth: Earth) -> float:
    """Longest stable log period, or law step when the log is as fast as the law, s; 0: none."""
    limit = _STANDS * network.omega_s

    def grows(n: int, step: float) -> bool:
        return _growth(network, step, n, lat, earth) > limit

    if calls > 1 and not grows(1, step_s):
        low, high = 1, calls
        while high - low > 1:
            middle = (low + high) // 2
            low, high = (low, middle) if grows(middle, step_s) else (middle, high)
        return low * step_s
    low, high = 0.0, step_s
    for _ in range(_SEARCH):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if grows(1, middle) else (middle, high)
    return low if low > 1e-3 * step_s else 0.0


def _warning(growth: float, period_s: float, step_s: float, calls: int, up_to: float) -> str:
    slower_log = calls > 1 and up_to >= step_s
    what = (
        Text("the log's difference is held for {period_s:g} s", period_s=period_s)
        if slower_log
        else Text("the law runs every {step_s:g} s and holds its correction", step_s=step_s)
    )
    every = duration(1.0 / growth)
    text = Text(
        "unstable as sampled: {what}, too long for this loop; the errors grow by e every {every}",
        what=what,
        every=every,
    )
    if up_to > 0.0:
        return Text.joined("; ", (text, Text("stable up to about {up_to:.3g} s", up_to=up_to)))
    return text
