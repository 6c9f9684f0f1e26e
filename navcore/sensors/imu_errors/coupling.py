"""Errors in proportion to the true signal: scale factors and misalignments."""

from collections.abc import Iterator
from typing import Annotated, TypeAlias

import numpy as np

from navcore.foundation.parameters import bounded, vector_quantity
from navcore.foundation.text import Text
from navcore.foundation.units import ARCSEC, PPM
from navcore.sensors.imu_errors.base import ImuTerm, Part

_Scale = Annotated[float, bounded(unit="ppm", ge=-1e5, le=1e5)]
_Angle = Annotated[float, bounded(unit="arcsec", ge=-36000.0, le=36000.0)]
_SixAngles: TypeAlias = tuple[_Angle, _Angle, _Angle, _Angle, _Angle, _Angle]
_PAIRS = ("xy", "xz", "yx", "yz", "zx", "zy")
_MISALIGNMENT_HELP = Text(
    "Rows of the error matrix without its diagonal: xy is what the x sensor feels of the y axis."
)


class Coupling(ImuTerm):
    """Scale factors and misalignments of gyros and accelerometers."""

    gyro_scale_ppm: tuple[_Scale, _Scale, _Scale] = vector_quantity(
        (0.0, 0.0, 0.0),
        unit="ppm",
        slider=(-100.0, 100.0),
        label=Text("gyro scale factor"),
        help=Text("Scale factor error of each gyro."),
    )
    accel_scale_ppm: tuple[_Scale, _Scale, _Scale] = vector_quantity(
        (0.0, 0.0, 0.0),
        unit="ppm",
        slider=(-200.0, 200.0),
        label=Text("accelerometer scale factor"),
        help=Text("Scale factor error of each accelerometer."),
    )
    gyro_misalignment_arcsec: _SixAngles = vector_quantity(
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        unit="arcsec",
        elements=_PAIRS,
        slider=(-60.0, 60.0),
        label=Text("gyro misalignment"),
        help=_MISALIGNMENT_HELP,
    )
    accel_misalignment_arcsec: _SixAngles = vector_quantity(
        (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        unit="arcsec",
        elements=_PAIRS,
        slider=(-60.0, 60.0),
        label=Text("accelerometer misalignment"),
        help=_MISALIGNMENT_HELP,
    )

    def parts(self) -> Iterator[Part]:
        """Yield scale factors and misalignments of both."""
        labels = {
            "gyro": Text("gyro scale factor and misalignment"),
            "accel": Text("accelerometer scale factor and misalignment"),
        }
        for sensor, label in labels.items():
            scale, misalignment = f"{sensor}_scale_ppm", f"{sensor}_misalignment_arcsec"
            turned = np.zeros((3, 3))
            turned[~np.eye(3, dtype=bool)] = np.asarray(getattr(self, misalignment)) * ARCSEC
            yield Part((scale,), f"{sensor}_scale", label, coupling=np.diag(getattr(self, scale)) * PPM)
            yield Part((misalignment,), f"{sensor}_misalignment", label, coupling=turned)
