"""Blocks ``[[requirement]]``: limits that belong to a scenario."""

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field, model_validator

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.numbers import NotANumber
from navcore.foundation.parameters import Parameters, choice
from navcore.foundation.parameters import quantity as number
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.foundation.with_unit import read_with_unit
from navcore.quantities import LIMITED, QUANTITIES, limit_unit, limit_unit_name, value_unit, value_unit_name

MOST = 20
if TYPE_CHECKING:
    Limited = str
else:
    Limited = Literal[LIMITED]
OF_THE_SETTING = tuple(key for key in LIMITED if QUANTITIES[key].kind is None)
"""Quantities of a setting: no time acts on them."""
OVER_SEEDS = tuple(key for key in LIMITED if QUANTITIES[key].over)
"""Quantities that many seeds have together."""
AT_AN_HOUR = tuple(key for key in LIMITED if QUANTITIES[key].statistic in ("at", "held", "final"))
"""Quantities that ``at_h`` acts on."""
OF_READINGS = ("settled", "point", "spread")
"""Statistics of a gyrocompass's readings, which begin at the start."""
_SENSE_OF_ARC = ("sec L", "secL", "sec(L)")
"""Behind the unit of a limit on a heading error times cos L, as standards write it."""
_LARGEST = 1e9


class Requirement(Parameters):
    """One ``[[requirement]]``: a limit that a design keeps on every step from ``from_h`` to the end."""

    quantity: Limited = choice(
        LIMITED[0],
        help=Text(
            "What is limited. Largest tilt and velocity error: length of the vector; root mean squares of "
            "them: per axis. Of the setting, whatever from_h is: settling_s, growth_per_s, "
            "tilt_overshoot (%), damping_ratio, h0_deviation, h_slope_s, log_tilt and worst_tilt "
            "(arcsec), worst_velocity (m/s), heading_settling_s. Over the seeds: position_cep50_m, "
            "position_r95_m, position_2drms_m, position_trms_m, position_rate_cep_nmph, "
            "settle_repeat_seclat_arcmin."
        ),
    )
    at_most: Annotated[float, Field(strict=True, ge=-_LARGEST, le=_LARGEST)] | str | None = Field(
        default=None,
        description=Text(
            'Largest value that meets it: a number in the unit of the name, or a text with a unit ("1 nmi"). '
            "Of all quantities but damping_ratio; of reset_interval_h the position error that must not be "
            "exceeded, in m."
        ),
        json_schema_extra={"unit": "", "label": Text("limit")},
    )
    at_least: float | None = number(
        None,
        ge=0.0,
        le=1.0,
        label=Text("least"),
        help=Text("Smallest value that meets it, of damping_ratio, in place of at_most."),
    )
    share: float | None = number(
        None,
        ge=0.0,
        le=1.0,
        label=Text("share"),
        help=Text(
            "Share of the seeds that must meet it. Without one the run itself is judged; of a quantity over "
            "the seeds, its value."
        ),
    )
    at_h: float | None = number(
        None,
        unit="h",
        ge=0.0,
        le=8760.0,
        label=Text("at"),
        help=Text(
            "Hour at which the position error is judged, of position_cep50_m, position_r95_m, "
            "position_2drms_m and position_final_m; of reset_interval_h the time that it must reach. The end "
            "of the run where it is not given."
        ),
    )
    from_h: float = number(
        0.0, unit="h", ge=0.0, le=8760.0, label=Text("from"), help=Text("Time from which the errors count.")
    )
    clause: str | None = Field(
        default=None,
        max_length=200,
        description=Text("Number of the clause of the specification; each only once in a scenario."),
        json_schema_extra={"label": Text("clause")},
    )
    text: str | None = Field(
        default=None,
        max_length=1000,
        description=Text("Words of the clause, for the verification matrix."),
        json_schema_extra={"label": Text("text")},
    )

    @model_validator(mode="before")
    @classmethod
    def _of_its_quantity(cls, data: Any) -> Any:
        """Refuse the field of the other sense, a unit of another dimension, and an hour without meaning."""
        row = QUANTITIES.get(data.get("quantity", LIMITED[0])) if isinstance(data, dict) else None
        if row is None or row.key not in LIMITED:
            return data
        named, other = ("at_least", "at_most") if row.sense == ">=" else ("at_most", "at_least")
        if data.get(other) is not None:
            allowed = Text("is not for {quantity}: give {named}", quantity=row.key, named=named)
            raise InputError(Fault("", other, data[other], allowed))
        if isinstance(data.get(named), str):
            _read_limit(row.key, named, data[named])
        if data.get("at_h") is not None and row.key not in AT_AN_HOUR:
            allowed = Text(
                "is not for {quantity}: only for {others}", quantity=row.key, others=", ".join(AT_AN_HOUR)
            )
            raise InputError(Fault("", "at_h", data["at_h"], allowed))
        return data

    @property
    def sense(self) -> str:
        """Sense of the limit, "<=" or ">="."""
        return QUANTITIES[self.quantity].sense

    @property
    def limit(self) -> float:
        """The limit, in the unit of a limit that is given as a number."""
        named = "at_least" if self.sense == ">=" else "at_most"
        value = getattr(self, named)
        assert value is not None  # `faults` has refused it
        return _read_limit(self.quantity, named, value) if isinstance(value, str) else value

    @property
    def limit_si(self) -> float:
        """The limit, SI."""
        return self.limit * limit_unit(self.quantity)

    @property
    def unit(self) -> str:
        """Unit of a value of its quantity in files; empty for a plain number."""
        return value_unit_name(self.quantity)

    @property
    def begins_s(self) -> float:
        """Time from which a run is watched, s: 0 for a quantity of the setting, infinite for the end."""
        statistic = QUANTITIES[self.quantity].statistic
        if statistic in ("at", "final"):
            return math.inf if self.at_h is None else self.at_h * HOUR
        return 0.0 if statistic in ("", "held", *OF_READINGS) else self.from_h * HOUR

    @property
    def bound_m(self) -> float:
        """Position error that is watched, m; infinite where the limit is of something else."""
        return self.limit_si if QUANTITIES[self.quantity].statistic == "held" else math.inf

    @property
    def words(self) -> str:
        """The limit as a specification has it: quantity, limit, share and times."""
        asked = getattr(self, "at_least" if self.sense == ">=" else "at_most")
        parts = [f"{self.quantity} {self.sense} {asked if isinstance(asked, str) else f'{asked:.6g}'}"]
        parts += (
            [] if self.share is None else [Text("for {share:g} % of the seeds", share=100.0 * self.share)]
        )
        parts += [] if self.at_h is None else [Text("at {hours:g} h", hours=self.at_h)]
        parts += [Text("from {hours:g} h", hours=self.from_h)] if self.from_h else []
        return Text.joined(" ", parts)

    def met(self, value: float) -> bool:
        """Whether a value in the unit of the quantity's name meets it; one that is not a number does not."""
        if QUANTITIES[self.quantity].statistic == "held":
            return value >= self._needed
        return value >= self.limit if self.sense == ">=" else value <= self.limit

    def times(self, value: float | None) -> float:
        """Value over the limit, or the other way round for a least one; infinite without a value."""
        if value is None:
            return float("inf")
        over, under = (self.limit, value) if self.sense == ">=" else (value, self.limit)
        if QUANTITIES[self.quantity].statistic == "held":
            over, under = (self._needed, value) if math.isfinite(self._needed) else (1.0, 1.0)
        if under > 0.0:
            return over / under
        return 0.0 if self.met(value) else float("inf")

    @property
    def _needed(self) -> float:
        """Value that a time within a bound must reach, in the unit of its name; infinite for the end."""
        return math.inf if self.at_h is None else self.at_h * HOUR / value_unit(self.quantity)

    def faults(self, field: str, end_h: float) -> Iterator[Fault]:
        """Yield what is wrong with the limit in a run of ``end_h`` hours; ``field`` names the block."""
        named = "at_least" if self.sense == ">=" else "at_most"
        given, row = getattr(self, named), QUANTITIES[self.quantity]
        if given is None:
            yield Fault("", f"{field}.{named}", None, Text("is required"))
        elif self.limit < 0.0 and not row.signed:
            allowed = Text("must be >= 0: {quantity} has no sign", quantity=self.quantity)
            yield Fault("", f"{field}.{named}", given, allowed)
        if self.at_h is not None and self.at_h > end_h:
            allowed = Text("must be >= 0 and <= {end_h:g} (h), the end of the run", end_h=end_h)
            yield Fault("", f"{field}.at_h", self.at_h, allowed)


def clause_faults(requirements: Sequence[Requirement]) -> Iterator[Fault]:
    """Yield a fault for each clause that stands in an earlier requirement, too."""
    first: dict[str, int] = {}
    for i, one in enumerate(requirements):
        clause = (one.clause or "").strip()
        if clause and first.setdefault(clause, i) != i:
            allowed = Text("must differ from that of requirement.{other}", other=first[clause])
            yield Fault("", f"requirement.{i}.clause", one.clause, allowed)


def _read_limit(quantity: str, named: str, text: str) -> float:
    """Read a limit with a unit, in the unit of one without.

    Raises
    ------
    InputError
        No number, or a unit of another dimension; the fault names the field.
    """
    plain, row = text.strip(), QUANTITIES[quantity]
    if row.axes == "seclat":
        for words in _SENSE_OF_ARC:
            plain = plain.removesuffix(words).rstrip()
    try:
        value = read_with_unit(plain, limit_unit_name(quantity))
    except NotANumber as error:
        raise InputError(Fault("", named, text, error.allowed)) from None
    if abs(value) > _LARGEST:
        allowed = Text("must be >= {low:g} and <= {high:g}", low=-_LARGEST, high=_LARGEST)
        raise InputError(Fault("", named, text, allowed))
    return value
