"""Block ``initial_error`` of a scenario: where navigation starts from, and how well that is known."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated

from navcore.foundation.parameters import Parameters, bounded, quantity, vector_quantity
from navcore.foundation.text import Text
from navcore.foundation.units import ARCMIN, ARCSEC

_Tilt = Annotated[float, bounded(unit="arcmin", ge=-600.0, le=600.0)]
_Velocity = Annotated[float, bounded(unit="m/s", ge=-100.0, le=100.0)]
_Position = Annotated[float, bounded(unit="arcsec", ge=-36000.0, le=36000.0)]


class InitialError(Parameters):
    """Block ``initial_error``: computed minus true at t = 0."""

    attitude_arcmin: tuple[_Tilt, _Tilt, _Tilt] = vector_quantity(
        (0.0, 0.0, 0.0), unit="arcmin", elements=("φE", "φN", "φU"), slider=(-10.0, 10.0),
        label=Text("initial misalignment"), help=Text("Misalignment at t = 0."),
    )  # fmt: skip
    velocity_mps: tuple[_Velocity, _Velocity] = vector_quantity(
        (0.0, 0.0), unit="m/s", elements=("E", "N"), slider=(-2.0, 2.0),
        label=Text("initial velocity error"), help=Text("Velocity error at t = 0."),
    )  # fmt: skip
    position_arcsec: tuple[_Position, _Position] = vector_quantity(
        (0.0, 0.0), unit="arcsec", elements=("latitude", "longitude"), slider=(-60.0, 60.0),
        label=Text("initial position error"), help=Text("Position error at t = 0."),
    )  # fmt: skip

    level_std_arcmin: float | None = quantity(
        None, unit="arcmin", ge=0.0, le=600.0, slider=(0.0, 10.0), label=Text("initial tilt, "
"standard deviation"),
        help=Text("Standard deviation of φE and φN at t = 0 in the error budget and the tuning. Not given: "
        "the size of the numbers in attitude_arcmin."),
    )  # fmt: skip
    heading_std_arcmin: float | None = quantity(
        None, unit="arcmin", ge=0.0, le=600.0, slider=(0.0, 60.0),
        label=Text("initial heading error, standard deviation"),
        help=Text("The same for φU. Not given: the size of the third number in attitude_arcmin."),
    )  # fmt: skip
    velocity_std_mps: float | None = quantity(
        None, unit="m/s", ge=0.0, le=100.0, slider=(0.0, 2.0),
        label=Text("initial velocity error, standard deviation"),
        help=Text("The same for the velocity, on each axis. Not given: the size of the numbers "
"in velocity_mps."),
    )  # fmt: skip
    position_std_arcsec: float | None = quantity(
        None, unit="arcsec", ge=0.0, le=36000.0, slider=(0.0, 60.0),
        label=Text("initial position error, standard deviation"),
        help=Text("The same for latitude and longitude. Not given: the size of the numbers in "
"position_arcsec."),
    )  # fmt: skip

    def standard_deviations(self) -> list[float]:
        """Standard deviations of the seven error states in SI, in the order of `state`."""
        given = [
            *[self.velocity_std_mps] * 2,
            *[_times(self.position_std_arcsec, ARCSEC)] * 2,
            *[_times(self.level_std_arcmin, ARCMIN)] * 2,
            _times(self.heading_std_arcmin, ARCMIN),
        ]
        return [abs(x) if std is None else std for x, std in zip(self.state(), given, strict=True)]

    @classmethod
    def of_state(cls, state: Iterable[float]) -> InitialError:
        """Make the block from seven error states in SI, in the order of `state`; nothing is checked."""
        dv_e, dv_n, lat, lon, phi_e, phi_n, phi_u = (float(x) for x in state)
        return cls.model_construct(
            attitude_arcmin=(phi_e / ARCMIN, phi_n / ARCMIN, phi_u / ARCMIN),
            velocity_mps=(dv_e, dv_n),
            position_arcsec=(lat / ARCSEC, lon / ARCSEC),
        )

    def state(self) -> list[float]:
        """Seven error states in SI: dV_E, dV_N, dL, dlambda, phi_E, phi_N, phi_U."""
        angles = [value * ARCMIN for value in self.attitude_arcmin]
        return [*self.velocity_mps, *(value * ARCSEC for value in self.position_arcsec), *angles]


def _times(value: float | None, unit: float) -> float | None:
    return None if value is None else value * unit
