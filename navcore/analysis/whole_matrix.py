"""System matrix of the whole system: both level channels, heading and latitude, with the states of the law.

The model is the one of theory.md 2 without longitude, at rest or at a constant velocity. Time is measured in
1/omega_s and velocity in g/omega_s, so that all elements of the matrix lie near 1.
"""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from navcore.foundation.earth import EARTH_RATE, SPHERE, Earth
from navcore.networks.azimuth_loop import AzimuthChannel, AzimuthGains
from navcore.networks.base import LinearNetwork
from navcore.networks.state_space import state_space, state_spaces

DV_E, DV_N, LATITUDE, PHI_E, PHI_N, PHI_U = range(6)
STATES = 6


class Course(NamedTuple):
    """A constant velocity.

    Attributes
    ----------
    v_e, v_n : float
        m/s.
    turned : bool
        The law reads a log in the ship's axes, turned by the computed heading: phi_U enters its difference.
    """

    v_e: float
    v_n: float
    turned: bool


AT_REST = Course(0.0, 0.0, False)


@dataclass(frozen=True, eq=False)
class LawForm:
    """The damping law of one channel as it acts on the velocity error dV, in normalised time.

    c = C z + D dV is the correction of the platform's velocity and a = E z - k1 dV the feedback into the
    velocity, with z' = A z + B dV.
    """

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    D: float
    E: np.ndarray
    k1: float


@lru_cache(maxsize=512)
def law_form(network: LinearNetwork) -> LawForm:
    """State-space form of the damping law of a network as it acts (`navcore.damping.base.Damping.acting`)."""
    poles = network.poles / network.omega_s
    if network.feedback_p is not None:
        system, second = state_spaces([network.num_p, network.feedback_p], poles)
        return LawForm(system.A, system.B, system.C, system.D - 1.0, -second.C, second.D)
    if network.realisation != "network":
        k1, k2, k3 = feedback_gains(network)
        return LawForm(np.zeros((1, 1)), np.array([k3]), np.ones(1), k2, np.zeros(1), k1)
    system = state_space(network.num_p, poles)
    return LawForm(system.A, system.B, system.C, system.D - 1.0, np.zeros(len(system.B)), 0.0)


def feedback_gains(network: LinearNetwork) -> tuple[float, float, float]:
    """K1/omega_s, K2, K3/omega_s of H = ((1 + K2) p + K3)/(p + K1), p = s/omega_s (theory.md 3.1)."""
    num, den = np.zeros(2), np.zeros(2)
    num[2 - len(network.num_p) :] = network.num_p
    den[2 - len(network.den_p) :] = network.den_p
    if len(network.den_p) == 1:  # a common root at zero was removed
        return 0.0, float(num[1]) - 1.0, 0.0
    return float(den[1]), float(num[0]) - 1.0, float(num[1])


def free_matrix(
    lat: float, omega_s: float, earth: Earth = SPHERE, height: float = 0.0, course: Course = AT_REST
) -> np.ndarray:
    """System matrix of the undamped model in normalised units, shape (6, 6) (theory.md 2).

    States dV_E, dV_N over g/omega_s, dL, phi_E, phi_N, phi_U.

    Parameters
    ----------
    lat : float
        rad.
    omega_s : float
        Unit of the eigenvalues, rad/s.
    earth : Earth
        WGS-84 or the sphere.
    height : float
        m.
    course : Course
        Velocity; the latitude stays.
    """
    east, north = _stiffness(lat, omega_s, earth, height)
    wz, wy = EARTH_RATE / omega_s * math.sin(lat), EARTH_RATE / omega_s * math.cos(lat)
    f = np.zeros((STATES, STATES))
    f[DV_E, DV_N], f[DV_E, PHI_N] = 2.0 * wz, -1.0
    f[DV_N, DV_E], f[DV_N, PHI_E] = -2.0 * wz, 1.0
    f[LATITUDE, DV_N] = north
    f[PHI_E, DV_N], f[PHI_E, PHI_N], f[PHI_E, PHI_U] = -north, wz, -wy
    f[PHI_N, DV_E], f[PHI_N, LATITUDE], f[PHI_N, PHI_E] = east, -wz, -wz
    f[PHI_U, DV_E], f[PHI_U, LATITUDE], f[PHI_U, PHI_E] = east * math.tan(lat), wy, wy
    v_e, v_n = _normalised(course, lat, omega_s, earth, height)
    # transport rate, which turns with the Earth's, and its change with the latitude
    turn_e, turn_n, turn_u = -north * v_n, east * v_e, east * v_e * math.tan(lat)
    by_lat, weight = turn_n / math.cos(lat) ** 2, (2.0 * wy + turn_n) * v_e - turn_e * v_n
    f[DV_E, DV_N] += turn_u
    f[DV_N, DV_E] -= turn_u
    d_up = f[PHI_U] * [1.0, 0.0, 2.0, 0.0, 0.0, 0.0]
    d_up[LATITUDE] += by_lat
    f[DV_E] += v_n * d_up
    f[DV_N] -= v_e * d_up
    f[DV_E, PHI_N] += weight
    f[DV_N, PHI_E] -= weight
    f[DV_E, PHI_U], f[DV_N, PHI_U] = (2.0 * wz + turn_u) * v_e, (2.0 * wz + turn_u) * v_n
    f[PHI_E:, PHI_E:] -= _cross(turn_e, turn_n, turn_u)
    f[PHI_U, LATITUDE] += by_lat
    return f


def _cross(e: float, n: float, u: float) -> np.ndarray:
    """Matrix of the cross product with a vector from the left, shape (3, 3)."""
    return np.array([[0.0, -u, n], [u, 0.0, -e], [-n, e, 0.0]])


def _normalised(
    course: Course, lat: float, omega_s: float, earth: Earth, height: float
) -> tuple[float, float]:
    """Velocity over g/omega_s."""
    unit = earth.gravity(lat, height) / omega_s
    return course.v_e / unit, course.v_n / unit


def inputs_of_law(lat: float, omega_s: float, earth: Earth = SPHERE, height: float = 0.0) -> np.ndarray:
    """How c_E, c_N, a_E, a_N act on the six states, shape (6, 4)."""
    east, north = _stiffness(lat, omega_s, earth, height)
    b = np.zeros((STATES, 4))
    b[PHI_N, 0], b[PHI_E, 1] = east, -north
    b[DV_E, 2] = b[DV_N, 3] = 1.0
    return b


def _stiffness(lat: float, omega_s: float, earth: Earth, height: float) -> tuple[float, float]:
    """g/((N + h) omega_s^2) and g/((M + h) omega_s^2): 1 on the sphere whose omega_s is the unit."""
    m, n = earth.radii(lat)
    scale = earth.gravity(lat, height) / omega_s**2
    return scale / (n + height), scale / (m + height)


def system_matrix(
    network: LinearNetwork,
    lat: float,
    earth: Earth = SPHERE,
    height: float = 0.0,
    azimuth: AzimuthChannel | None = None,
    course: Course = AT_REST,
) -> np.ndarray:
    """System matrix with the law's states of the east, the north and the azimuth channel.

    Shape (6 + 2 n + m, 6 + 2 n + m) for n states of H(s) and m of Y(s); of Y(s) with a log that is turned by
    the computed heading, L_r - L is one more.
    """
    law = law_form(network)
    n = len(law.B)
    act = inputs_of_law(lat, network.omega_s, earth, height)
    compass = isinstance(azimuth, AzimuthGains)
    m = 0 if azimuth is None else 1 if compass else azimuth.order + course.turned
    seen = seen_differences(lat, network.omega_s, earth, course, height)
    f = np.zeros((STATES + 2 * n + m, STATES + 2 * n + m))
    f[:STATES, :STATES] = free_matrix(lat, network.omega_s, earth, height, course)
    for channel in (DV_E,) if compass else (DV_E, DV_N):
        z = slice(STATES + channel * n, STATES + (channel + 1) * n)
        f[:STATES, :STATES] += np.outer(act[:, channel] * law.D - act[:, 2 + channel] * law.k1, seen[channel])
        f[:STATES, z] = np.outer(act[:, channel], law.C) + np.outer(act[:, 2 + channel], law.E)
        f[z, :STATES], f[z, z] = np.outer(law.B, seen[channel]), law.A
    if isinstance(azimuth, AzimuthGains):
        f = np.delete(np.delete(f, north := range(STATES + n, STATES + 2 * n), 0), north, 1)
        rate = network.omega_s
        f[DV_N, :STATES] -= azimuth.k1 / rate * seen[DV_N]
        f[PHI_E, :STATES] += act[PHI_E, 1] * azimuth.k2 * seen[DV_N]
        f[PHI_U, -1], f[-1, -1] = 1.0, -azimuth.k4 / rate
        pull = azimuth.k3 * earth.gravity(lat, height) / (rate**3 * EARTH_RATE * math.cos(lat))
        f[-1, :STATES] = pull * seen[DV_N]
    elif azimuth is not None:
        y, rate = law_form(azimuth), azimuth.omega_s / network.omega_s
        up, z = np.zeros(len(f)), slice(STATES + 2 * n, STATES + 2 * n + azimuth.order)
        up[:STATES] = up_rate(lat, network.omega_s, earth, height, course)
        if course.turned:  # omega_Ur has the errors of the log, and of the latitude that the log gives
            up[PHI_U] += seen[DV_E, PHI_U] * up[DV_E]
            up[-1] = -up[LATITUDE]
            f[-1, PHI_U] = act[PHI_E, 1] * seen[DV_N, PHI_U]
        f[PHI_U] += y.D * up
        f[PHI_U, z] += y.C
        f[z] = rate * np.outer(y.B, up)
        f[z, z] += rate * y.A
    return f


def seen_differences(
    lat: float, omega_s: float, earth: Earth = SPHERE, course: Course = AT_REST, height: float = 0.0
) -> np.ndarray:
    """Errors of V_c - V_r, E and N, by the six states, shape (2, 6); a log that is turned has one too."""
    seen = np.eye(STATES)[[DV_E, DV_N]]
    if course.turned:
        v_e, v_n = _normalised(course, lat, omega_s, earth, height)
        seen[:, PHI_U] = -v_n, v_e
    return seen


def up_rate(
    lat: float, omega_s: float, earth: Earth = SPHERE, height: float = 0.0, course: Course = AT_REST
) -> np.ndarray:
    """Error of the computed rate about the vertical by the six states, shape (6,); omega_Ur has none."""
    row = np.zeros(STATES)
    east, _ = _stiffness(lat, omega_s, earth, height)
    row[DV_E] = east * math.tan(lat)
    v_e, _ = _normalised(course, lat, omega_s, earth, height)
    row[LATITUDE] = EARTH_RATE / omega_s * math.cos(lat) + east * v_e / math.cos(lat) ** 2
    return row
