"""What every policy has: parameters, a code for the compiled dispatch, and what it needs to decide."""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

from navcore.control.history import USE_NOTHING
from navcore.network.base import NetworkParameters
from navcore.parameters import Parameters


class Measure(NamedTuple):
    """What a policy measures, for the switching view.

    Attributes
    ----------
    label : str
        Name on the axis.
    unit : str
        Unit in which it is shown.
    si : float
        SI value of that unit: shown = ``s[MEASURE]`` / si.
    """

    label: str
    unit: str
    si: float


class Limit(NamedTuple):
    """One threshold of a policy, to be drawn as a line over its measure.

    Attributes
    ----------
    name : str
        Field that sets it.
    value : float
        In the unit in which the measure is shown.
    unit : str
        That unit.
    """

    name: str
    value: float
    unit: str


class PolicyParameters(Parameters):
    """Base of the ``policy`` block of a method; subclasses narrow ``id`` to a Literal.

    Attributes
    ----------
    code : int
        Number by which the compiled dispatch knows the policy.
    needs_reference : bool
        The policy looks at V_r - V_c, so the scenario must have a reference velocity.
    remembers : int
        What of the motion the history keeps (`navcore.control.history`).
    keeps_time : bool
        The policy needs the clock and the history.
    tunes : bool
        The policy sets the damping coefficient of a network that can be re-tuned.
    measure : Measure or None
        What ``s[MEASURE]`` holds.
    """

    code: ClassVar[int]
    needs_reference: ClassVar[bool] = False
    remembers: ClassVar[int] = USE_NOTHING
    keeps_time: ClassVar[bool] = False
    tunes: ClassVar[bool] = False
    measure: ClassVar[Measure | None] = None
    id: Any  # a Literal in each subclass

    def packed(self, law_step_s: float) -> list[float]:
        """Values for ``p[POLICY_PARAMETERS:]``, at most 16."""
        return []

    def table_rows(self) -> list[tuple[float, float, float]]:
        """Rows (argument in m/s, damping coefficient, slope) of a table the decision looks up."""
        return []

    def ring_rows(self, law_step_s: float) -> int:
        """Law calls of history that the decision needs."""
        return 0

    def limits(self) -> tuple[Limit, ...]:
        """Thresholds to draw over the measure."""
        return ()

    def warnings(self) -> tuple[str, ...]:
        """What the user should know about these parameters."""
        return ()

    def network_in_force(self, network: NetworkParameters) -> NetworkParameters:
        """Network that runs when the method is configured with ``network``."""
        return network


def calls(seconds: float, law_step_s: float) -> int:
    """Law calls in a time, at least one."""
    return max(1, int(seconds / law_step_s + 0.5))
