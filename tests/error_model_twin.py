"""The error model once more, slow and obvious: vectors, cross products, matrices, plain Python.

The compiled kernel is tested against this sample by sample. It shares no computation with it: the ellipsoid
is written out again, coefficients come straight from the truth, the rate from vector formulas, and the law
from `tests.law_twin`.
"""

import math

import numpy as np

from navcore.foundation.earth import EARTH_RATE, Earth
from navcore.motion.truth import AE, AN, AU, HEADING, HEIGHT, LAT, VE, VN, VU
from tests.law_twin import TwinLaw

Vector = np.ndarray
SEMI_MAJOR_AXIS = 6378137.0


def cross(a: Vector, b: Vector) -> Vector:
    """Cross product of two vectors; `numpy.cross` takes ten times as long for so few numbers."""
    (a0, a1, a2), (b0, b1, b2) = a.tolist(), b.tolist()
    return np.array([a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0])


def radii(earth: Earth, lat: float) -> tuple[float, float]:
    """Radii of curvature in the meridian and the prime vertical, m."""
    w = math.sqrt(1.0 - earth.e2 * math.sin(lat) ** 2)
    return SEMI_MAJOR_AXIS * (1.0 - earth.e2) / w**3, SEMI_MAJOR_AXIS / w


def gravity(earth: Earth, lat: float, height: float) -> float:
    """Somigliana's normal gravity and its second-order series in the height (NGA.STND.0036, 4.3), m/s^2."""
    s2 = math.sin(lat) ** 2
    at_surface = earth.g_equator * (1.0 + earth.somigliana_k * s2) / math.sqrt(1.0 - earth.e2 * s2)
    f, m = (1.0 / 298.257223563, 0.00344978650684) if earth.e2 > 0.0 else (0.0, 0.0)
    first = -2.0 * at_surface / SEMI_MAJOR_AXIS * (1.0 + f + m - 2.0 * f * s2)
    return at_surface + first * height + 3.0 * at_surface / SEMI_MAJOR_AXIS**2 * height**2


def model_rate(
    truth: Vector, x: Vector, eps: Vector, nabla: Vector, c: Vector, a: Vector, earth: Earth
) -> Vector:
    """Time derivative of the seven error states at one row of the truth table.

    Parameters
    ----------
    truth : ndarray, shape (15,)
        Row of `Truth.values`.
    x : ndarray, shape (7,)
        dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U.
    eps, nabla : ndarray, shape (3,)
        Sensor errors in the navigation frame.
    c, a : ndarray, shape (2,)
        The law's velocity correction and acceleration feedback, E and N.
    earth : Earth
        Earth model.
    """
    lat, height = truth[LAT], truth[HEIGHT]
    meridian, prime = radii(earth, lat)
    m, n = meridian + height, prime + height
    v = truth[[VE, VN, VU]]
    dv, d_lat, phi = np.array([x[0], x[1], 0.0]), x[2], x[4:7]
    omega_ie = EARTH_RATE * np.array([0.0, math.cos(lat), math.sin(lat)])
    omega_en = np.array([-v[1] / m, v[0] / n, v[0] * math.tan(lat) / n])
    gravity_vector = np.array([0.0, 0.0, -gravity(earth, lat, height)])
    force = truth[[AE, AN, AU]] + cross(2.0 * omega_ie + omega_en, v) - gravity_vector
    d_omega_ie = EARTH_RATE * np.array([0.0, -math.sin(lat), math.cos(lat)]) * d_lat
    d_omega_up = dv[0] * math.tan(lat) / n + v[0] / (n * math.cos(lat) ** 2) * d_lat
    d_omega_en = np.array([-dv[1] / m, dv[0] / n, d_omega_up])
    # The platform's horizontal transport rate is formed with V* = V_c + c (theory.md section 3).
    d_omega_platform = np.array([-(dv[1] + c[1]) / m, (dv[0] + c[0]) / n, d_omega_up])
    dv_rate = (
        cross(force, phi)
        + nabla
        - cross(2.0 * omega_ie + omega_en, dv)
        - cross(2.0 * d_omega_ie + d_omega_en, v)
        + np.array([a[0], a[1], 0.0])
    )
    phi_rate = -cross(omega_ie + omega_en, phi) + d_omega_ie + d_omega_platform - eps
    lat_rate = dv[1] / m
    lon_rate = dv[0] / (n * math.cos(lat)) + v[0] * math.tan(lat) / (n * math.cos(lat)) * d_lat
    return np.array([dv_rate[0], dv_rate[1], lat_rate, lon_rate, *phi_rate])


def run_twin(
    truth_half: np.ndarray,
    eps: np.ndarray,
    nabla: np.ndarray,
    dv_r: np.ndarray,
    valid: np.ndarray,
    x0: Vector,
    law: TwinLaw | None,
    earth: Earth,
    step_s: float,
) -> np.ndarray:
    """Integrate the model by RK4; the log gives one epoch each step.

    Parameters
    ----------
    truth_half : ndarray, shape (2 n + 1, 15)
        Truth on the half-step grid.
    eps, nabla : ndarray, shape (n, 3)
        Sensor errors, mean over each step.
    dv_r : ndarray, shape (n + 1, 2)
        Errors of the reference velocity at each step.
    valid : ndarray of bool, shape (n + 1,)
        Validity of the log.
    x0 : ndarray, shape (7,)
        Initial errors.
    law : TwinLaw or None
        None runs free.
    earth : Earth
        Earth model.
    step_s : float
        Step, s.

    Returns
    -------
    ndarray, shape (n + 1, 7)
    """
    n = len(eps)
    out = np.empty((n + 1, 7))
    out[0] = x0
    none = np.zeros(2)
    for k in range(n):
        x, t0, t1, t2 = out[k], truth_half[2 * k], truth_half[2 * k + 1], truth_half[2 * k + 2]
        v_c = t0[[VE, VN]] + x[:2]
        c = a = none
        if law is not None:
            c, a = law.step(dv_r[k] - x[:2], bool(valid[k]), v_c, float(t0[HEADING] + x[6]))
        arguments = (eps[k], nabla[k], c, a, earth)
        k1 = model_rate(t0, x, *arguments)
        k2 = model_rate(t1, x + 0.5 * step_s * k1, *arguments)
        k3 = model_rate(t1, x + 0.5 * step_s * k2, *arguments)
        k4 = model_rate(t2, x + step_s * k3, *arguments)
        out[k + 1] = x + step_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
    return out
