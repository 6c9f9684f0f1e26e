"""Blocks ``[[requirement]]``: limits that belong to a scenario."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Literal

from pydantic import model_validator

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import Parameters, choice
from navcore.foundation.parameters import quantity as number
from navcore.foundation.text import Text
from navcore.quantities import LIMITED, QUANTITIES, limit_unit

MOST = 20
if TYPE_CHECKING:
    Limited = str
else:
    Limited = Literal[LIMITED]
OF_THE_SETTING = tuple(key for key in LIMITED if QUANTITIES[key].kind is None)
"""Quantities of a setting: no time acts on them."""


class Requirement(Parameters):
    """One ``[[requirement]]``: a limit that a design keeps on every step from ``from_h`` to the end."""

    quantity: Limited = choice(
        LIMITED[0],
        help=Text(
            "What is limited. Largest tilt and velocity error: length of the vector; root mean squares of "
            "them: per axis. Of the setting, whatever from_h is: settling_s, growth_per_s, "
            "tilt_overshoot (%), damping_ratio, h0_deviation, h_slope_s, log_tilt and worst_tilt "
            "(arcsec), worst_velocity (m/s)."
        ),
    )
    at_most: float | None = number(
        None,
        ge=-1e9,
        le=1e9,
        label=Text("limit"),
        help=Text(
            "Largest value that meets it, in the unit of the name; of all quantities but damping_ratio."
        ),
    )
    at_least: float | None = number(
        None,
        ge=0.0,
        le=1.0,
        label=Text("least"),
        help=Text("Smallest value that meets it, of damping_ratio, in place of at_most."),
    )
    from_h: float = number(
        0.0, unit="h", ge=0.0, le=8760.0, label=Text("from"), help=Text("Time from which the errors count.")
    )

    @model_validator(mode="before")
    @classmethod
    def _of_its_quantity(cls, data: Any) -> Any:
        """Refuse the field of the other sense, and a text, by the quantity: its name says the unit."""
        row = QUANTITIES.get(data.get("quantity", LIMITED[0])) if isinstance(data, dict) else None
        if row is None:
            return data
        named, other = ("at_least", "at_most") if row.sense == ">=" else ("at_most", "at_least")
        if data.get(other) is not None:
            allowed = Text("is not for {quantity}: give {named}", quantity=row.key, named=named)
            raise InputError(Fault("", other, data[other], allowed))
        if isinstance(data.get(named), str):
            words = Text("must be a number without a unit")
            if unit := row.key.rpartition("_")[2] if limit_unit(row.key) != row.size else row.shown:
                words = Text("must be a number in {unit}, without the unit", unit=unit)
            raise InputError(Fault("", named, data[named], words))
        return data

    @property
    def sense(self) -> str:
        """Sense of the limit, "<=" or ">="."""
        return QUANTITIES[self.quantity].sense

    @property
    def limit(self) -> float:
        """The limit, in the unit of the quantity's name."""
        value = self.at_least if self.sense == ">=" else self.at_most
        assert value is not None  # `faults` has refused it
        return value

    @property
    def limit_si(self) -> float:
        """The limit, SI."""
        return self.limit * limit_unit(self.quantity)

    def met(self, value: float) -> bool:
        """Whether a value in the unit of the quantity's name meets it; one that is not a number does not."""
        return value >= self.limit if self.sense == ">=" else value <= self.limit

    def times(self, value: float | None) -> float:
        """Value over the limit, or the other way round for a least one; infinite without a value."""
        if value is None:
            return float("inf")
        over, under = (self.limit, value) if self.sense == ">=" else (value, self.limit)
        if under > 0.0:
            return over / under
        return 0.0 if self.met(value) else float("inf")

    def faults(self, field: str) -> Iterator[Fault]:
        """Yield what is wrong with the limit; ``field`` names the block."""
        named = "at_least" if self.sense == ">=" else "at_most"
        value, row = getattr(self, named), QUANTITIES[self.quantity]
        if value is None:
            yield Fault("", f"{field}.{named}", None, Text("is required"))
        elif value < 0.0 and not row.signed:
            allowed = Text("must be >= 0: {quantity} has no sign", quantity=self.quantity)
            yield Fault("", f"{field}.{named}", value, allowed)
