"""Quantisation: increments in whole counts."""

from collections.abc import Iterator
from typing import Annotated

import numpy as np

from navcore.foundation.parameters import bounded, vector_quantity
from navcore.foundation.text import Text
from navcore.sensors.imu_errors.base import ImuTerm, Part

_GyroLsb = Annotated[float, bounded(unit="rad", ge=0.0, le=0.01)]
_AccelLsb = Annotated[float, bounded(unit="m/s", ge=0.0, le=1.0)]


class Counts(ImuTerm):
    """Counts of gyros and accelerometers; what is left of one goes into the next increment."""

    gyro_lsb: tuple[_GyroLsb, _GyroLsb, _GyroLsb] = vector_quantity(
        (0.0, 0.0, 0.0),
        unit="rad",
        label=Text("gyro count"),
        help=Text("Angle of one count of each gyro; 0 for no quantisation."),
    )
    accel_lsb: tuple[_AccelLsb, _AccelLsb, _AccelLsb] = vector_quantity(
        (0.0, 0.0, 0.0),
        unit="m/s",
        label=Text("accelerometer count"),
        help=Text("Velocity of one count of each accelerometer; 0 for no quantisation."),
    )

    def parts(self) -> Iterator[Part]:
        """Yield the counts of both."""
        yield Part(("gyro_lsb",), "gyro_counts", Text("IMU quantisation"), lsb=np.array(self.gyro_lsb, float))
        yield Part(
            ("accel_lsb",), "accel_counts", Text("IMU quantisation"), lsb=np.array(self.accel_lsb, float)
        )
