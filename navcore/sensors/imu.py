"""The inertial measurement unit: its errors as a scenario gives them, and their effect along a motion."""

from __future__ import annotations

import math
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from navcore.foundation.earth import Earth
from navcore.foundation.parameters import FileName, Parameters, bounded, choice, quantity, vector_quantity
from navcore.foundation.units import ARCSEC, DEG_PER_HOUR, DEG_PER_SQRT_HOUR, MICRO_G, PPM
from navcore.motion.base import Truth
from navcore.sensors.base import SensorErrors
from navcore.sensors.imu_kernels import (
    add_quantisation,
    attitude_changes,
    body_errors,
    mean_attitude,
    scaled_signals,
    turn_errors,
)
from navcore.sensors.noise import gauss_markov, unit_noise

_ZERO3 = (0.0, 0.0, 0.0)
_ZERO6 = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
_PAIRS = ("xy", "xz", "yx", "yz", "zx", "zy")

_GyroBias = Annotated[float, bounded(unit="deg/h", ge=-1e5, le=1e5)]
_AccelBias = Annotated[float, bounded(unit="ug", ge=-1e6, le=1e6)]
_Scale = Annotated[float, bounded(unit="ppm", ge=-1e5, le=1e5)]
_Misalignment = Annotated[float, bounded(unit="arcsec", ge=-36000.0, le=36000.0)]
_GyroLsb = Annotated[float, bounded(unit="rad", ge=0.0, le=0.01)]
_AccelLsb = Annotated[float, bounded(unit="m/s", ge=0.0, le=1.0)]
_MISALIGNMENT_HELP = (
    "Rows of the error matrix without its diagonal: xy is what the x sensor feels of the y axis."
)


@dataclass(frozen=True)
class SensorModel:
    """Error model of three gyros or accelerometers in SI: rad/s or m/s^2, and their integrals.

    Attributes
    ----------
    stream : str
        Name of the sensor's random numbers.
    bias : ndarray, shape (3,)
        Constant error.
    white : float
        Random walk of the integral, (rad/s)/sqrt(Hz) or (m/s^2)/sqrt(Hz).
    instability, tau_s : float
        Standard deviation and correlation time (s) of the first-order Gauss-Markov part.
    coupling : ndarray, shape (3, 3)
        Scale factor errors (diagonal) and misalignments: the error is ``coupling @ true``.
    lsb : ndarray, shape (3,)
        One count of an increment, rad or m/s; 0 for none.
    """

    stream: Literal["gyro", "accel"]
    bias: np.ndarray
    white: float
    instability: float
    tau_s: float
    coupling: np.ndarray
    lsb: np.ndarray

    @property
    def measures_motion(self) -> bool:
        """True when the error depends on the true signal."""
        return bool(self.coupling.any() or self.lsb.any())

    @property
    def constant(self) -> bool:
        """True when the error at rest does not change with time."""
        return self.white == 0.0 and self.instability == 0.0 and not self.lsb.any()

    @property
    def perfect(self) -> bool:
        """True when there is no error at all."""
        return self.constant and not self.coupling.any() and not self.bias.any()


def _coupling(scale_ppm: tuple[float, ...], misalignment_arcsec: tuple[float, ...]) -> np.ndarray:
    matrix = np.zeros((3, 3))
    np.fill_diagonal(matrix, np.asarray(scale_ppm) * PPM)
    matrix[~np.eye(3, dtype=bool)] = np.asarray(misalignment_arcsec) * ARCSEC
    return matrix


class Imu(Parameters):
    """Block ``imu``: errors of gyros and accelerometers in body axes, measured minus true.

    Scalars apply to all three axes. A Gauss-Markov value is held for a step of the run, which is right for
    correlation times well above the step.
    A recorded IMU (``file``, strapdown only) brings its own errors: those given here are then not used.
    """

    gyro_bias_dph: tuple[_GyroBias, _GyroBias, _GyroBias] = vector_quantity(
        _ZERO3, unit="deg/h", slider=(-0.1, 0.1), label="gyro bias", help="Constant error of each gyro."
    )
    gyro_arw_dpsh: float = quantity(
        0.0,
        unit="deg/sqrt(h)",
        ge=0.0,
        le=100.0,
        slider=(0.0, 0.05),
        label="angular random walk",
        help="White noise of the gyros: standard deviation of the integrated angle after one hour.",
    )
    accel_bias_ug: tuple[_AccelBias, _AccelBias, _AccelBias] = vector_quantity(
        _ZERO3,
        unit="ug",
        slider=(-200.0, 200.0),
        label="accelerometer bias",
        help="Constant error of each accelerometer; 1 µg = 9.80665e-6 m/s².",
    )
    accel_vrw_ugpshz: float = quantity(
        0.0,
        unit="ug/sqrt(Hz)",
        ge=0.0,
        le=1e6,
        slider=(0.0, 100.0),
        label="velocity random walk",
        help="White noise of the accelerometers: the mean over T s has the standard deviation VRW/√(T).",
    )
    gyro_instability_dph: float = quantity(
        0.0,
        unit="deg/h",
        ge=0.0,
        le=1e4,
        slider=(0.0, 0.05),
        label="gyro instability",
        help="Standard deviation of a first-order Gauss-Markov drift, stationary from the start.",
    )
    gyro_tau_s: float = quantity(
        3600.0,
        unit="s",
        ge=1.0,
        le=1e7,
        slider=(10.0, 86400.0),
        log=True,
        label="gyro correlation time",
        help="Correlation time of the gyros' Gauss-Markov drift.",
    )
    accel_instability_ug: float = quantity(
        0.0,
        unit="ug",
        ge=0.0,
        le=1e5,
        slider=(0.0, 100.0),
        label="accelerometer instability",
        help="Standard deviation of a first-order Gauss-Markov drift, stationary from the start.",
    )
    accel_tau_s: float = quantity(
        3600.0,
        unit="s",
        ge=1.0,
        le=1e7,
        slider=(10.0, 86400.0),
        log=True,
        label="accelerometer correlation time",
        help="Correlation time of the accelerometers' Gauss-Markov drift.",
    )
    gyro_scale_ppm: tuple[_Scale, _Scale, _Scale] = vector_quantity(
        _ZERO3,
        unit="ppm",
        slider=(-100.0, 100.0),
        label="gyro scale factor",
        help="Scale factor error of each gyro.",
    )
    accel_scale_ppm: tuple[_Scale, _Scale, _Scale] = vector_quantity(
        _ZERO3,
        unit="ppm",
        slider=(-200.0, 200.0),
        label="accelerometer scale factor",
        help="Scale factor error of each accelerometer.",
    )
    gyro_misalignment_arcsec: tuple[
        _Misalignment, _Misalignment, _Misalignment, _Misalignment, _Misalignment, _Misalignment
    ] = vector_quantity(
        _ZERO6,
        unit="arcsec",
        elements=_PAIRS,
        slider=(-60.0, 60.0),
        label="gyro misalignment",
        help=_MISALIGNMENT_HELP,
    )
    accel_misalignment_arcsec: tuple[
        _Misalignment, _Misalignment, _Misalignment, _Misalignment, _Misalignment, _Misalignment
    ] = vector_quantity(
        _ZERO6,
        unit="arcsec",
        elements=_PAIRS,
        slider=(-60.0, 60.0),
        label="accelerometer misalignment",
        help=_MISALIGNMENT_HELP,
    )
    gyro_lsb: tuple[_GyroLsb, _GyroLsb, _GyroLsb] = vector_quantity(
        _ZERO3, unit="rad", label="gyro count", help="Angle of one count of each gyro; 0 for no quantisation."
    )
    accel_lsb: tuple[_AccelLsb, _AccelLsb, _AccelLsb] = vector_quantity(
        _ZERO3,
        unit="m/s",
        label="accelerometer count",
        help="Velocity of one count of each accelerometer; 0 for no quantisation.",
    )
    gyro_bias_std_dph: float | None = quantity(
        None,
        unit="deg/h",
        ge=0.0,
        le=1e5,
        slider=(0.0, 0.1),
        label="gyro bias, standard deviation",
        help="Standard deviation of each gyro's bias in the error budget and the tuning, which know the bias "
        "by its size only. Not given: the size of each gyro_bias_dph counts as its standard deviation.",
    )
    accel_bias_std_ug: float | None = quantity(
        None,
        unit="ug",
        ge=0.0,
        le=1e6,
        slider=(0.0, 200.0),
        label="accelerometer bias, standard deviation",
        help="The same for the accelerometers. Not given: the size of each accel_bias_ug.",
    )
    file: FileName | None = Field(
        default=None,
        description="Recorded IMU in place of the simulated one (strapdown): PSINS text, or CSV with t_s and "
        "gx_rad_s, gy_rad_s, gz_rad_s, fx_mps2, fy_mps2, fz_mps2 (means), or dax_rad ... dvz_mps "
        "(increments). Alignment and navigation take its samples one after the other.",
        json_schema_extra={"label": "IMU file"},
    )
    axes: Literal["rfu", "frd"] = choice(
        "rfu",
        help="Axes of a recorded CSV: right, forward, up, or forward, right, down. PSINS files are rfu.",
    )
    begin_s: float = quantity(
        0.0, unit="s", ge=0.0, le=1e7, label="skip", help="Time of the recorded IMU that is left out before."
    )

    def gyro(self) -> SensorModel:
        """Error model of the gyros in SI."""
        return SensorModel(
            "gyro",
            np.asarray(self.gyro_bias_dph) * DEG_PER_HOUR,
            self.gyro_arw_dpsh * DEG_PER_SQRT_HOUR,
            self.gyro_instability_dph * DEG_PER_HOUR,
            self.gyro_tau_s,
            _coupling(self.gyro_scale_ppm, self.gyro_misalignment_arcsec),
            np.array(self.gyro_lsb, dtype=float),
        )

    def accel(self) -> SensorModel:
        """Error model of the accelerometers in SI."""
        return SensorModel(
            "accel",
            np.asarray(self.accel_bias_ug) * MICRO_G,
            self.accel_vrw_ugpshz * MICRO_G,
            self.accel_instability_ug * MICRO_G,
            self.accel_tau_s,
            _coupling(self.accel_scale_ppm, self.accel_misalignment_arcsec),
            np.array(self.accel_lsb, dtype=float),
        )


def imu_errors(
    imu: Imu, truth_half: Truth, count: int, step_s: float, earth: Earth, seed: int, level_body: bool = False
) -> SensorErrors:
    """Gyro and accelerometer errors in the navigation frame, mean over each step.

    In body axes: bias, white noise, Gauss-Markov drift, scale factor and misalignment times the true signal,
    and quantisation of the increments with carry (a count's rest goes into the next increment). They are
    turned by Simpson's mean of the attitude over the step, the part that follows the true signal by Simpson's
    mean of the turned product.

    Parameters
    ----------
    imu : Imu
        The errors.
    truth_half : Truth
        True motion at half steps, 2 count + 1 rows, or one row at rest.
    count : int
        Number of steps.
    step_s : float
        Step of the mechanization, s.
    earth : Earth
        WGS-84 or the sphere.
    seed : int
        Seed of the scenario.
    level_body : bool
        True for the `channel` fidelity: a level body pointing north, no Earth rate, no coupling.

    Returns
    -------
    SensorErrors
        Arrays of shape (count, 3), or (1, 3) when constant in time.

    Raises
    ------
    ValueError
        The truth has neither 2 count + 1 rows nor one.
    """
    rows = truth_half.values.shape[0]
    if rows not in (1, 2 * count + 1):
        raise ValueError(f"{count} steps need 1 or {2 * count + 1} rows of truth at half steps, not {rows}")
    models = imu.gyro(), imu.accel()
    values = truth_half.values
    signal = coupled = np.zeros((2, 1, 3))
    if any(model.measures_motion for model in models):
        signal, coupled = np.empty((2, 2, 1 if rows == 1 else count, 3))
        coupling = np.stack([model.coupling for model in models])
        constants = (earth.e2, earth.g_equator, earth.somigliana_k)
        scaled_signals(values, level_body, *constants, coupling, signal, coupled)
    level = level_body or all(model.perfect for model in models)
    # Gyros, accelerometers and attitude at the same time: of a new seed this is a fifth of the whole run.
    with ThreadPoolExecutor(2) as pool:
        turning = pool.submit(_level if level else _mean_attitude, values, count)
        made = [
            pool.submit(_navigation_errors, model, turning, signal[i], coupled[i], count, step_s, seed)
            for i, model in enumerate(models)
        ]
        return SensorErrors(made[0].result(), made[1].result())


def _level(values: np.ndarray, count: int) -> np.ndarray:
    """C_b^n of a level body pointing north, row by row: (1, 9)."""
    return np.eye(3).reshape(1, 9)


def _mean_attitude(values: np.ndarray, count: int) -> np.ndarray:
    """C_b^n, mean over each step, row by row: (count, 9), or (1, 9) when the attitude never changes."""
    if not attitude_changes(values):
        values, count = np.repeat(values[:1], 3, axis=0), 1
    out = np.empty((count, 9))
    mean_attitude(values, out)
    return out


def _navigation_errors(
    model: SensorModel,
    turned_by: Future[np.ndarray],
    signal: np.ndarray,
    coupled: np.ndarray,
    count: int,
    step_s: float,
    seed: int,
) -> np.ndarray:
    """Errors of three gyros or accelerometers in the navigation frame, shape (count, 3) or (1, 3)."""
    if model.perfect:
        return np.zeros((1, 3))
    white = drift = np.empty((0, 3), dtype=np.float32)
    if model.white > 0.0:
        white = unit_noise(seed, f"{model.stream}.white", count, 3)
    if model.instability > 0.0:
        unit = unit_noise(seed, f"{model.stream}.instability", count, 3)
        drift = gauss_markov(unit, math.exp(-step_s / model.tau_s))
    turning = turned_by.result()
    moving = turning.shape[0] > 1 or (coupled.shape[0] > 1 and bool(model.coupling.any()))
    error = np.empty((count if moving or not model.constant else 1, 3))
    body_errors(model.bias, model.white / math.sqrt(step_s), white, model.instability, drift, error)
    if model.lsb.any():
        add_quantisation(signal, model.coupling, model.lsb, step_s, error)
    turn_errors(turning, coupled, error)
    return error
