"""Zhao 2015: two signs of the system matrix, three coefficients of its solution, a unit."""

import math

import numpy as np

from navcore.analysis.response import free_states, matrix_exponential
from navcore.foundation.earth import EARTH_RATE, SEMI_MAJOR_AXIS, SPHERE_GRAVITY
from navcore.foundation.text import Text
from navcore.foundation.units import ARCMIN, ARCSEC, DEG, DEG_PER_HOUR, MINUTE
from navcore.mechanization.error_model import system_matrix
from navcore.mechanization.recorder import DV_E
from schuler_bench.misprints.base import (
    OMEGA_S,
    TIME,
    Axis,
    Comparison,
    Curve,
    Misprint,
    Number,
    growth_time,
    run_scenario,
)

_LAT = 45.7796 * DEG
# Zhao 5.1.1: dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U
_INITIAL = np.array([0.1, 0.1, 2.0 * ARCSEC, 2.0 * ARCSEC, 0.6 * ARCMIN, 0.6 * ARCMIN, 7.0 * ARCMIN])
_DRIFT = 0.01 * DEG_PER_HOUR
_BIAS = 1e-4 * SPHERE_GRAVITY


def _matrix() -> np.ndarray:
    return system_matrix(_LAT, SEMI_MAJOR_AXIS, SPHERE_GRAVITY, EARTH_RATE)


def printed_matrix() -> np.ndarray:
    """System matrix of Zhao 1 as printed, with our longitude row, shape (7, 7)."""
    matrix = _matrix()
    matrix[2, 1], matrix[5, 0] = -matrix[2, 1], -matrix[5, 0]
    return matrix


def _states(
    matrix: np.ndarray, start: np.ndarray, forcing: np.ndarray, step_s: float, count: int
) -> np.ndarray:
    """States of x' = F x + W with a constant W, shape (count, 7)."""
    augmented = np.zeros((8, 8))
    augmented[:7, :7], augmented[:7, 7] = matrix, forcing
    return free_states(matrix_exponential(augmented * step_s), np.append(start, 1.0), count)[:, :7]


def _signs() -> Comparison:
    step, count, nothing = 20.0, 541, np.zeros(7)
    printed = _states(printed_matrix(), _INITIAL, nothing, step, count)[:, 0]
    corrected = _states(_matrix(), _INITIAL, nothing, step, count)[:, 0]
    growth = growth_time(np.linalg.eigvals(printed_matrix()))
    assert growth is not None
    return Comparison(
        x_axis=TIME,
        y_axis=Axis(Text("east velocity error"), "m/s"),
        x=step * np.arange(count),
        curves=(
            Curve(Text("Zhao 1 as printed"), "printed", printed),
            Curve(Text("signs mended"), "corrected", corrected),
        ),
        numbers=(
            Number(Text("e-folding time"), "s", growth, growth_time(np.linalg.eigvals(_matrix()))),
            Number(
                Text("east velocity error after 3 h at most"),
                "m/s",
                float(np.max(np.abs(printed))),
                float(np.max(np.abs(corrected))),
            ),
        ),
        words=Text(
            "As printed one channel grows e-fold every {growth:.1f} min; with the signs "
            "mended every eigenvalue lies on the imaginary axis: the errors only "
            "oscillate.",
            growth=growth / MINUTE,
        ),
    )


def _tilt(t: np.ndarray, printed: bool) -> np.ndarray:
    """phi_E(t) of Zhao 6 for the initial errors of Zhao 5.1.1, rad."""
    ws, we = OMEGA_S, EARTH_RATE
    m1 = -_INITIAL[1] / (SEMI_MAJOR_AXIS * ws)
    m2 = tilt = _INITIAL[4]
    m4 = -tilt if printed else -((we / ws) ** 2) * tilt
    return m1 * np.sin(ws * t) + m2 * np.cos(ws * t) + m4 * np.cos(we * t)


def _tilt_coefficient() -> Comparison:
    step, count = 120.0, 721
    t = step * np.arange(count)
    start = np.zeros(7)
    start[1], start[4] = _INITIAL[1], _INITIAL[4]
    model = _states(_matrix(), start, np.zeros(7), step, count)[:, 4]
    printed, corrected, tilt = _tilt(t, True), _tilt(t, False), float(_INITIAL[4])
    return Comparison(
        x_axis=TIME,
        y_axis=Axis(Text("tilt φE"), "rad"),
        x=t,
        curves=(
            Curve(Text("Zhao 6 as printed"), "printed", printed),
            Curve(Text("Zhao 6, M4 mended"), "corrected", corrected),
            Curve(Text("error model (with Foucault)"), "corrected", model),
        ),
        numbers=(
            Number(Text("tilt at t = 0"), "rad", float(printed[0]), float(corrected[0])),
            Number(Text("amplitude of the 24 h line"), "rad", tilt, (EARTH_RATE / OMEGA_S) ** 2 * tilt),
        ),
        words=Text(
            "As printed the solution starts at {printed:.0f} arcsec although the initial "
            "tilt is {corrected:.0f}, and carries a 24 h line of {tilt:.0f} arcsec that "
            "is not there.",
            printed=printed[0] / ARCSEC,
            corrected=corrected[0] / ARCSEC,
            tilt=tilt / ARCSEC,
        ),
    )


def _latitude(t: np.ndarray, printed: bool) -> np.ndarray:
    """dL(t) of Zhao 7 for the gyro drifts and accelerometer biases of Zhao 5.1.2 alone, rad."""
    ws, we, sin, cos = OMEGA_S, EARTH_RATE, math.sin(_LAT), math.cos(_LAT)
    schuler = (we * sin * _DRIFT - we * cos * _DRIFT) / ws**2
    l1, l2 = -_DRIFT / ws, schuler - _BIAS / SPHERE_GRAVITY
    l3 = _DRIFT / we
    l4 = (sin if printed else -sin) * _DRIFT / we + cos * _DRIFT / we
    # L5 printed has eps_E; all three drifts are equal here (Zhao 5.1.2), so only the sign in L4 shows.
    l5 = (sin - cos) * _DRIFT / we + _BIAS / SPHERE_GRAVITY
    return l1 * np.sin(ws * t) + l2 * np.cos(ws * t) + l3 * np.sin(we * t) + l4 * np.cos(we * t) + l5


def _latitude_coefficients() -> Comparison:
    step, count = 120.0, 721
    t = step * np.arange(count)
    forcing = np.array([_BIAS, _BIAS, 0.0, 0.0, _DRIFT, _DRIFT, _DRIFT])
    model = _states(_matrix(), np.zeros(7), forcing, step, count)[:, 2]
    printed, corrected = _latitude(t, True), _latitude(t, False)
    metres = SEMI_MAJOR_AXIS
    return Comparison(
        x_axis=TIME,
        y_axis=Axis(Text("latitude error"), "rad"),
        x=t,
        curves=(
            Curve(Text("Zhao 7 as printed"), "printed", printed),
            Curve(Text("Zhao 7, L4 and L5 mended"), "corrected", corrected),
            Curve(Text("error model (with Foucault)"), "corrected", model),
        ),
        numbers=(
            Number(Text("latitude error at t = 0"), "rad", float(printed[0]), float(corrected[0])),
            Number(
                Text("largest departure from the error model"),
                "rad",
                float(np.max(np.abs(printed - model))),
                float(np.max(np.abs(corrected - model))),
            ),
        ),
        words=Text(
            "As printed the latitude is wrong by {printed:.1f} km before anything has "
            "happened (t = 0); mended it starts {corrected:.1f} m from zero.",
            printed=printed[0] * metres / 1e3,
            corrected=abs(corrected[0]) * metres,
        ),
    )


def _walk(vrw_ugpshz: float) -> tuple[np.ndarray, np.ndarray]:
    t, (east,) = run_scenario(
        {
            "run": {"duration_h": 24.0, "output_step_s": 120.0, "earth": "sphere"},
            "site": {"lat_deg": 45.7796},
            "imu": {"accel_vrw_ugpshz": vrw_ugpshz},
        },
        DV_E,
    )
    return t, east


def _unit() -> Comparison:
    t, printed = _walk(500.0)
    _, corrected = _walk(50.0)
    rms = [float(np.sqrt(np.mean(y * y))) for y in (printed, corrected)]
    return Comparison(
        x_axis=TIME,
        y_axis=Axis(Text("east velocity error"), "m/s"),
        x=t,
        curves=(
            Curve(Text("5×10⁻⁴ g read per √Hz"), "printed", printed),
            Curve(Text("5×10⁻⁴ g per 100 Hz sample: 50 µg/√Hz"), "corrected", corrected),
        ),
        numbers=(Number(Text("RMS of the east velocity error"), "m/s", rms[0], rms[1]),),
        words=Text(
            "Read per √Hz the random walk alone gives {rms:.2f} m/s RMS in 24 h; read "
            "per sample of 100 Hz it gives {rms_2:.3f} m/s.",
            rms=rms[0],
            rms_2=rms[1],
        ),
    )


ZHAO = (
    Misprint(
        id="zhao-1",
        paper="Zhao 2015",
        where="eq. 1",
        printed="F(3,2) = -1/R, F(5,1) = -1/R",
        right="both +1/R",
        consequence=Text("one channel diverges"),
        compute=_signs,
    ),
    Misprint(
        id="zhao-6",
        paper="Zhao 2015",
        where="eq. 6",
        printed="M4 contains -ΦE₀",
        right="-(Ω/ωₛ)² ΦE₀",
        consequence=Text("the tilt does not start at its initial value and swings with 24 h"),
        compute=_tilt_coefficient,
    ),
    Misprint(
        id="zhao-7",
        paper="Zhao 2015",
        where="eq. 7",
        printed="L4: + sin(φ) εN/Ω; L5: sin(φ) εE/Ω",
        right="L4: - sin(φ) εN/Ω; L5: sin(φ) εN/Ω",
        consequence=Text("a latitude error of kilometres at t = 0"),
        compute=_latitude_coefficients,
    ),
    Misprint(
        id="zhao-5.1.2",
        paper="Zhao 2015",
        where="section 5.1.2",
        printed=Text("angle random walk in °/h, velocity random walk 5×10⁻⁴ g"),
        right=Text("both per 100 Hz sample: 0.005 °/h = 8.3×10⁻⁶ °/√h, 5×10⁻⁴ g = 50 µg/√Hz"),
        consequence=Text("read per root of time, 600 and ten times the random walks"),
        compute=_unit,
    ),
)
"""Misprints of Zhao 2015 in the order of the paper."""
