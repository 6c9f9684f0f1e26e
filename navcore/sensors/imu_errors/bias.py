"""Constant bias of each inertial sensor, which budget and tuning know by its standard deviation only."""

from collections.abc import Iterator
from typing import Annotated

import numpy as np

from navcore.foundation.parameters import bounded, quantity, vector_quantity
from navcore.foundation.text import Text
from navcore.foundation.units import DEG_PER_HOUR, MICRO_G
from navcore.sensors.imu_errors.base import ImuTerm, Part

_GyroBias = Annotated[float, bounded(unit="deg/h", ge=-1e5, le=1e5)]
_AccelBias = Annotated[float, bounded(unit="ug", ge=-1e6, le=1e6)]


class BiasDeviation(ImuTerm):
    """Standard deviations of the biases, which `Bias` takes from here; last among the fields of the page."""

    gyro_bias_std_dph: float | None = quantity(
        None,
        unit="deg/h",
        ge=0.0,
        le=1e5,
        slider=(0.0, 0.1),
        label=Text("gyro bias, standard deviation"),
        help=Text(
            "Standard deviation of each gyro's bias in the error budget and the tuning, which know the bias "
            "by its size only. Not given: the size of each gyro_bias_dph counts as its standard deviation."
        ),
    )
    accel_bias_std_ug: float | None = quantity(
        None,
        unit="ug",
        ge=0.0,
        le=1e6,
        slider=(0.0, 200.0),
        label=Text("accelerometer bias, standard deviation"),
        help=Text("The same for the accelerometers. Not given: the size of each accel_bias_ug."),
    )

    def parts(self) -> Iterator[Part]:
        """Yield nothing of its own."""
        yield from ()


class Bias(ImuTerm):
    """Constant errors of gyros and accelerometers."""

    gyro_bias_dph: tuple[_GyroBias, _GyroBias, _GyroBias] = vector_quantity(
        (0.0, 0.0, 0.0),
        unit="deg/h",
        slider=(-0.1, 0.1),
        label=Text("gyro bias"),
        help=Text("Constant error of each gyro."),
    )
    accel_bias_ug: tuple[_AccelBias, _AccelBias, _AccelBias] = vector_quantity(
        (0.0, 0.0, 0.0),
        unit="ug",
        slider=(-200.0, 200.0),
        label=Text("accelerometer bias"),
        help=Text("Constant error of each accelerometer; 1 µg = 9.80665e-6 m/s²."),
    )

    def parts(self) -> Iterator[Part]:
        """Yield both biases."""
        gyro, accel = np.asarray(self.gyro_bias_dph), np.asarray(self.accel_bias_ug)
        gyro_std, accel_std = (
            getattr(self, "gyro_bias_std_dph", None),
            getattr(self, "accel_bias_std_ug", None),
        )
        gyro_std = np.abs(gyro) if gyro_std is None else np.full(3, gyro_std)
        accel_std = np.abs(accel) if accel_std is None else np.full(3, accel_std)
        yield Part(
            ("gyro_bias_dph",),
            "gyro_bias",
            Text("gyro bias"),
            constant=gyro * DEG_PER_HOUR,
            deviation=gyro_std * DEG_PER_HOUR,
        )
        yield Part(
            ("accel_bias_ug",),
            "accel_bias",
            Text("accelerometer bias"),
            constant=accel * MICRO_G,
            deviation=accel_std * MICRO_G,
        )
