"""How the log reads the velocity: scale, errors by motion, delay, smoothing, resolution."""

from collections.abc import Iterator

from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.foundation.units import PPM
from navcore.sensors.log_errors.base import LogPart, LogTerm


class LogReading(LogTerm):
    """Scale error, errors by acceleration and in turns, delay, smoothing and resolution.

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
    turn_s: float = quantity(
        0.0,
        unit="s",
        ge=-100.0,
        le=100.0,
        slider=(-5.0, 5.0),
        label=Text("in turns"),
        help=Text(
            "Error in proportion to the yaw rate times the speed through the water, across the course: to "
            "starboard in a turn to starboard."
        ),
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
    smoothing_s: float = quantity(
        0.0,
        unit="s",
        ge=0.0,
        le=3600.0,
        slider=(0.0, 60.0),
        label=Text("smoothing"),
        help=Text(
            "Time constant of the first-order filter with which the log smooths its readings: they lag "
            "behind the velocity, and their noise becomes a drift of this correlation time."
        ),
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
        """Yield all six."""
        yield LogPart(("scale_ppm",), "log_scale", Text("log bias"), scale=self.scale_ppm * PPM)
        yield LogPart(
            ("acceleration_s",),
            "log_acceleration",
            Text("log bias"),
            acceleration_s=self.acceleration_s,
        )
        yield LogPart(("turn_s",), "log_turn", Text("log bias"), turn_s=self.turn_s)
        yield LogPart(("delay_s",), "log_delay", Text("log delay and resolution"), delay_s=self.delay_s)
        yield LogPart(
            ("smoothing_s",),
            "log_smoothing",
            Text("log delay and resolution"),
            smoothing_s=self.smoothing_s,
        )
        yield LogPart(("lsb_mps",), "log_resolution", Text("log delay and resolution"), lsb=self.lsb_mps)
