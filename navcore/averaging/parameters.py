"""Settings of half-period averaging, and the small base motions that may disturb its alignment record."""

from typing import Annotated, Literal

from pydantic import Field

from navcore.foundation.parameters import Parameters, bounded, choice, quantity, vector_quantity
from navcore.foundation.text import Text
from navcore.foundation.times import EitherUnit

Variant = Literal["schuler", "cascade"]
_Turn = Annotated[float, bounded(unit="deg", ge=-5.0, le=5.0)]


class Averaging(Parameters):
    """Block ``averaging`` of a method with ``damping = "averaging"``: which solutions are averaged."""

    variant: Variant = choice(
        "schuler",
        label=Text("averaging"),
        help=Text(
            "schuler: one copy half a Schuler period ahead (Zhao 17); cascade: copies half a period of each "
            "of the two lines into which the Foucault term splits it."
        ),
    )
    earth: bool = Field(
        default=True,
        strict=True,
        description=Text(
            "A further copy (cascade: as many again) runs half a sidereal day ahead, against the "
            "24 h line. Its forecast carries the gyro noise of the alignment record."
        ),
        json_schema_extra={"label": Text("24 h line too")},
    )

    order: int = quantity(
        0,
        ge=0,
        le=3,
        label=Text("order of the fit"),
        help=Text(
            "Of the polynomial that is fitted to the alignment record by least squares and extrapolated "
            "(Zhao 18 to 21). 0: its mean. A line already carries the noise of 600 s to degrees per hour "
            "after 12 h."
        ),
    )
    segments: Literal["turned", "shifted"] = choice(
        "turned",
        label=Text("parts of the record"),
        help=Text(
            "How the parts between small motions of the base are brought together. turned: into one "
            "attitude, by the gyros. shifted: onto the fit of the last part (Zhao 26 as printed), so that it "
            "alone counts."
        ),
    )


class AlignmentMotion(EitherUnit):
    """Small motion of the base while the record is taken from which the future is forecast (Zhao, fig. 3)."""

    t_s: float = quantity(
        -400.0,
        unit="s",
        ge=-86400.0,
        lt=0.0,
        slider=(-600.0, -10.0),
        label=Text("begins"),
        help=Text("Start; navigation starts at 0, so the alignment lies at negative times."),
    )
    duration_s: float = quantity(
        5.0,
        unit="s",
        ge=1.0,
        le=600.0,
        slider=(1.0, 60.0),
        label=Text("lasts"),
        help=Text("Length of the motion."),
    )
    turn_deg: tuple[_Turn, _Turn, _Turn] = vector_quantity(
        (0.0, 0.0, 0.0),
        unit="deg",
        slider=(-1.0, 1.0),
        label=Text("turns by"),
        help=Text("About body x, y, z; it stays there. A base that turns back makes a second motion."),
    )
