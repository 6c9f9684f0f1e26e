"""The eight errors that every run records, and the four kinds of errors."""

from dataclasses import dataclass
from functools import cache
from typing import Literal

from navcore.foundation.text import Text
from navcore.foundation.units import UNITS


@dataclass(frozen=True)
class Kind:
    """Kind of errors: they share units, a scale and a line of the budget.

    Attributes
    ----------
    name, title : str
        One word, and the same as a heading.
    label : str
        Name of the error.
    figure : str
        Key of its root mean square in a budget, SI.
    unit : str
        Unit in which it is shown, a key of `navcore.foundation.units.UNITS`.
    dimension : {"angle", "speed", "length"}
        What the unit measures.
    """

    name: str
    title: str
    label: str
    figure: str
    unit: str
    dimension: Literal["angle", "speed", "length"]

    @property
    def size(self) -> float:
        """SI value of the unit."""
        return UNITS[self.unit]


TILT = Kind("tilt", Text("Tilt"), Text("tilt"), "tilt_rad", "arcsec", "angle")
VELOCITY = Kind("velocity", Text("Velocity"), Text("velocity error"), "velocity_mps", "m/s", "speed")
HEADING = Kind("heading", Text("Heading"), Text("heading error"), "heading_rad", "arcmin", "angle")
POSITION = Kind("position", Text("Position"), Text("position error"), "position_m", "m", "length")
KINDS = (TILT, VELOCITY, HEADING, POSITION)
"""In the order of a budget."""


LENGTHS = (*(kind.name for kind in KINDS), "seclat", "roll", "pitch")
"""What a run keeps of its errors at every step.

Tilt and velocity error as vectors, heading and position error, the heading error times cos L, and the errors
of roll and pitch.
"""


@dataclass(frozen=True)
class RecordedError:
    """One error of the navigation.

    Attributes
    ----------
    name : str
        Column of the time series and key in ``metrics.json``, with its SI unit.
    key : str
        Short name, of a plot or in a lesson.
    symbol : str
        On the axis of a plot.
    label : str
        In a table.
    title : str
        Over a plot.
    kind : Kind
        Kind of the error.
    """

    name: str
    key: str
    symbol: str
    label: str
    title: str
    kind: Kind


ERRORS = (
    RecordedError("phi_e_rad", "phi_e", "φE", Text("tilt φE"), Text("Tilt about east φE"), TILT),
    RecordedError("phi_n_rad", "phi_n", "φN", Text("tilt φN"), Text("Tilt about north φN"), TILT),
    RecordedError("phi_u_rad", "phi_u", "φU", Text("heading φU"), Text("Heading error φU"), HEADING),
    RecordedError("dve_mps", "dve", "δVE", Text("velocity δVE"), Text("Velocity error east δVE"), VELOCITY),
    RecordedError("dvn_mps", "dvn", "δVN", Text("velocity δVN"), Text("Velocity error north δVN"), VELOCITY),
    RecordedError("dlat_m", "dlat", "δLat", "latitude", Text("Latitude error"), POSITION),
    RecordedError("dlon_m", "dlon", "δLon", "longitude", Text("Longitude error"), POSITION),
    RecordedError(
        "position_m", "position", Text("position"), Text("position"), Text("Position error"), POSITION
    ),
)
"""In the order of the recorder's columns; the last is the distance that the two before it make."""


@dataclass(frozen=True)
class ErrorVector:
    """Length of an error that has a component along each horizontal axis.

    Attributes
    ----------
    key, symbol, title : str
        As of a `RecordedError`.
    kind : Kind
        Kind of the components; its name is that of the length in `LENGTHS`.
    """

    key: str
    symbol: str
    title: str
    kind: Kind


VECTORS = (
    ErrorVector("tilt", "|φ|", Text("Tilt |φ|"), TILT),
    ErrorVector("velocity", "|δV|", Text("Velocity error |δV|"), VELOCITY),
)
"""Lengths that limits on the tilt and the velocity error are about; the position error is recorded itself."""
NAMES = tuple(error.name for error in ERRORS)
COMPONENTS = NAMES[:-1]
"""Errors that are states of the error model."""

STATISTICS = {"rms": Text("rms"), "max_abs": Text("max"), "final": Text("final")}
"""Statistics of an error that tables show, and their short names."""


def budgeted(steady: bool) -> tuple[Kind, ...]:
    """Kinds that a budget has: the steady state of one channel has neither heading nor position."""
    return KINDS[:2] if steady else KINDS


@cache
def components(kind: Kind) -> tuple[str, ...]:
    """Return the names of a kind's components, of the distance both.

    Examples
    --------
    >>> components(POSITION)
    ('dlat_m', 'dlon_m')
    """
    return tuple(error.name for error in ERRORS if error.kind is kind and error.name in COMPONENTS)
