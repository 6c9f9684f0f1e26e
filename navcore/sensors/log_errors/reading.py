"""How the log reads the velocity: scale, error by acceleration, delay, resolution."""

from collections.abc import Iterator

from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.foundation.units import PPM
from navcore.sensors.log_errors.base import LogPart, LogTerm


class LogReading(LogTerm):
    """Scale error, error by acceleration, delay and resolution.

    The covariance takes the resolution by `navcore.sensors.rounding`.
    """

    scale_ppm: float = quantity(
        0.0,
        unit="ppm",
        ge=-500000.0,
        le=500000.0,
        slider=(-20000.0, 20000.0),
        label=Text("scale error"),
        help=Text("Relative error of the measured velocity."),
    )
    acceleration_s: float = quantity(
        0.0,
        unit="s",
        ge=-100.0,
        le=100.0,
        slider=(-5.0, 5.0),
        label=Text("by acceleration"),
        help=Text("Error in proportion to the ship's acceleration, k a: the main cause of overshoot at sea."),
    )
    delay_s: float = quantity(
        0.0,
        unit="s",
        ge=0.0,
        le=3600.0,
        slider=(0.0, 60.0),
        label=Text("delay"),
        help=Text("The sample at t is the velocity at t - delay (before t = 0: that at t = 0)."),
    )
    lsb_mps: float = quantity(
        0.0,
        unit="m/s",
        ge=0.0,
        le=10.0,
        slider=(0.0, 0.2),
        label=Text("resolution"),
        help=Text("Readings are rounded to this."),
    )

    def parts(self) -> Iterator[LogPart]:
        """Yield all four."""
        yield LogPart(("scale_ppm",), "log_scale", Text("log bias"), scale=self.scale_ppm * PPM)
        yield LogPart(
            ("acceleration_s",),
            "log_acceleration",
            Text("log bias"),
            acceleration_s=self.acceleration_s,
        )
        yield LogPart(("delay_s",), "log_delay", Text("log delay and resolution"), delay_s=self.delay_s)
        yield LogPart(("lsb_mps",), "log_resolution", Text("log delay and resolution"), lsb=self.lsb_mps)
