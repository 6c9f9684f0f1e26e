"""Blocks ``[[requirement]]``: limits that belong to a scenario."""

from typing import TYPE_CHECKING, Literal

from navcore.foundation.parameters import Parameters, choice
from navcore.foundation.parameters import quantity as number
from navcore.foundation.text import Text
from navcore.quantities import LIMITED, QUANTITIES

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
            "them: per axis; settling_s and growth_per_s: of the setting, whatever from_h is."
        ),
    )
    at_most: float = number(
        ...,
        ge=-1e9,
        le=1e9,
        label=Text("limit"),
        help=Text("Largest value that meets it, in the unit of the name."),
    )
    from_h: float = number(
        0.0, unit="h", ge=0.0, le=8760.0, label=Text("from"), help=Text("Time from which the errors count.")
    )
