"""The reference velocity (log): the block ``reference`` of a scenario."""

import math
from collections.abc import Iterable
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import Field, create_model, model_validator

from navcore.foundation.parameters import FileName, Parameters, bounded, quantity, vector_quantity
from navcore.foundation.repeated import Repeated
from navcore.foundation.text import Text
from navcore.io.column_map import map_field
from navcore.sensors.base import NO_DRIFT, modelled_drift
from navcore.sensors.data_sheets import names_of, with_part
from navcore.sensors.log_errors import TERMS
from navcore.sensors.log_errors.base import LogPart
from navcore.sensors.rounding import standing_rounding

if TYPE_CHECKING:
    from navcore.sensors.log_errors.events import LogEvents
    from navcore.sensors.log_errors.own import LogBias, LogDrift, LogNoise
    from navcore.sensors.log_errors.reading import LogReading
    from navcore.sensors.log_errors.water import Water


_Metres = Annotated[float, bounded(unit="m", ge=-500.0, le=500.0)]
RECORDED_ONLY = ("clock_s", "factor", "lever_arm_m")
"""Corrections of a recorded log; a simulated one has none of them."""


class Outage(Repeated):
    """Time in which the log gives nothing."""

    duration_s: float = quantity(
        600.0,
        unit="s",
        gt=0.0,
        le=1e7,
        slider=(1.0, 36000.0),
        log=True,
        label=Text("lasts"),
        help=Text("Length of the outage."),
    )


class _Kind(Parameters):
    kind: Literal["none", "log", "file"] = Field(
        default="none",
        description=Text("none: no reference; log: simulated; file: recorded."),
        json_schema_extra={"label": "reference"},
    )
    frame: Literal["enu", "body"] = Field(
        default="enu",
        description=Text(
            "enu: the log gives east and north. body: it gives starboard and forward (and so bias, "
            "drift, noise and resolution count) and is turned by the computed heading: a heading "
            "error enters."
        ),
        json_schema_extra={"label": "frame"},
    )
    rate_hz: float = quantity(
        1.0,
        unit="Hz",
        ge=0.001,
        le=1000.0,
        slider=(0.1, 10.0),
        log=True,
        label=Text("rate"),
        help=Text("Samples a second."),
    )


if TYPE_CHECKING:

    class _Errors(LogBias, LogNoise, LogDrift, LogReading, Water, LogEvents, _Kind):
        pass
else:
    # pydantic takes the fields of the last base first
    _Errors = create_model("_Errors", __base__=(*TERMS[::-1], _Kind))


if TYPE_CHECKING:
    PartName = str
else:
    PartName = Literal[names_of("reference")]
    """Name of a log in the list."""


class Reference(_Errors):
    """Block ``reference``: the velocity that external damping compares with.

    The simulated log (``kind = "log"``) reads, in its own axes,
    ``(1 + scale) (V - V_water) + k a + k_t w x (V - V_water) + bias + drift + noise``, rounded to
    ``lsb_mps``, with V, the ship's acceleration a, its yaw rate w and the velocity of the water ``V_water``
    (current and tide) taken ``delay_s`` earlier. What depends on V, and the noise, is smoothed with the
    time constant ``smoothing_s``. Events are added to that. The recorded one (``kind = "file"``) uses only
    ``file``, ``speed``, ``frame``, ``event``, ``outage``, ``min_speed_mps`` and the corrections of
    `RECORDED_ONLY`.
    """

    part: PartName | None = Field(
        default=None,
        description=Text(
            "A log from the list (schuler parts): its published figures fill the fields that are not given "
            "beside it."
        ),
        json_schema_extra={"label": Text("part")},
    )
    outage: tuple[Outage, ...] = Field(
        default=(), max_length=200, description=Text("Times without log, [[reference.outage]].")
    )
    min_speed_mps: float = quantity(
        0.0,
        unit="m/s",
        ge=0.0,
        le=50.0,
        slider=(0.0, 3.0),
        label=Text("valid from"),
        help=Text(
            "The log gives nothing while the ship is slower than this through the water (a recorded log: "
            "while its reading is below this)."
        ),
    )
    zero_below_mps: float = quantity(
        0.0,
        unit="m/s",
        ge=0.0,
        le=5.0,
        slider=(0.0, 0.5),
        label=Text("moored below"),
        help=Text(
            "While the ship is slower than this over the ground, the reference is the velocity zero instead "
            "of the log, whose errors and outages then do not count: a moored ship knows it. 0 for never."
        ),
    )
    file: FileName | tuple[FileName, ...] | None = Field(
        default=None,
        description=Text(
            "Recorded log: NMEA 0183 (VBW, VHW, VTG, RMC), CSV, Parquet or MAT; several files are "
            "joined by UTC. Speeds along the ship's axes are preferred to course and speed over ground."
        ),
        json_schema_extra={"label": Text("log files")},
    )
    map: FileName | None = map_field()
    speed: Literal["water", "ground"] = Field(
        default="water",
        description=Text(
            "Which speed of a recorded VBW sentence is used; the other one when the log lacks this."
        ),
        json_schema_extra={"label": "speed"},
    )

    clock_s: float = quantity(
        0.0,
        unit="s",
        ge=-86400.0,
        le=86400.0,
        slider=(-120.0, 120.0),
        label=Text("clock correction"),
        help=Text("Added to the times of a recorded log, whose logger has a clock of its own."),
    )
    factor: float = quantity(
        1.0,
        ge=-100.0,
        le=100.0,
        slider=(0.5, 1.5),
        label=Text("speed factor"),
        help=Text("The speeds of a recorded log are multiplied by it."),
    )
    lever_arm_m: tuple[_Metres, _Metres, _Metres] = vector_quantity(
        (0.0, 0.0, 0.0),
        unit="m",
        elements=(Text("starboard"), Text("forward"), Text("up")),
        slider=(-100.0, 100.0),
        label=Text("lever arm"),
        help=Text(
            "Where a recorded log (or the antenna that gives its velocity) stands, seen from the place that "
            "the track is of: the velocity that turning and rolling give it there is taken off."
        ),
    )

    @model_validator(mode="before")
    @classmethod
    def _of_part(cls, data: Any) -> Any:
        """Take the figures of the part."""
        return with_part(data, "reference")

    def all_parts(self) -> tuple[LogPart, ...]:
        """Contributions of all terms, whether they do anything or not."""
        return _parts_of(self)  # pyright: ignore[reportArgumentType]

    @property
    def interrupted(self) -> bool:
        """Whether the log can fail within a run."""
        return bool(self.outage) or self.min_speed_mps > 0.0

    @property
    def white(self) -> float:
        """Noise of a sample with that of rounding, m/s."""
        values = (value for part in self.all_parts() for value in (part.white, part.lsb / math.sqrt(12.0)))
        return math.hypot(*values)

    @property
    def rounding(self) -> float:
        """Root mean square of the error of rounding that stands while the speed does, m/s."""
        return standing_rounding(sum(part.lsb for part in self.all_parts()), self.dither)

    @property
    def dither(self) -> float:
        """Noise of a sample before it is rounded, m/s."""
        return math.hypot(*(part.white for part in self.all_parts()))

    @property
    def markov(self) -> tuple[float, float]:
        """Standard deviation (m/s) and correlation time (s) of the drift that the stochastic model holds."""
        drift = modelled_drift(self.all_parts())
        return NO_DRIFT if drift is None else drift.markov

    @property
    def deviation(self) -> np.ndarray:
        """Standard deviations of the constant errors in the log's axes, m/s, shape (2,)."""
        return np.sqrt(sum((part.deviation**2 for part in self.all_parts()), np.zeros(2)))


@lru_cache(maxsize=64)
def _parts_of(reference: Reference) -> tuple[LogPart, ...]:
    filtered = reference.smoothing_s, 1.0 / reference.rate_hz
    return tuple(part.smoothed(*filtered) for term in TERMS for part in term.parts(reference))


def in_service(outages: Iterable[Outage], time_s: np.ndarray) -> np.ndarray:
    """Whether the log works at each time, ndarray of bool, shape (m,)."""
    valid = np.ones(time_s.size, dtype=bool)
    for outage in outages:
        valid &= ~outage.holds(time_s)
    return valid
