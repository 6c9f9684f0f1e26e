"""Base of the policies: parameters, a compiled decision, and what it needs to decide."""

from collections.abc import Iterator
from typing import Any, ClassVar, NamedTuple

import numpy as np

from navcore.foundation.errors import Fault
from navcore.foundation.parameters import Parameters
from navcore.foundation.records import record_type
from navcore.law.history import USE_NOTHING
from navcore.networks.base import NetworkParameters

LOW_MARGIN = 1.05
"""The law stays this much above the damping coefficient at which a loop becomes unstable."""


class Measure(NamedTuple):
    """Measure of a policy, for the switching view.

    Attributes
    ----------
    label : str
        Name on the axis.
    unit : str
        Unit in which it is shown.
    si : float
        SI value of that unit: shown = ``s.measure`` / si.
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
    numbers, memory : dtype
        Records of what the compiled decision reads and of what it keeps between calls.
    decide : compiled function
        ``decide(own, memory, law, sensed)``: True when the policy wants the loop damped. ``own`` and
        ``memory`` are its records, ``law`` and ``sensed`` a `Law` and a `Sensed` of `navcore.law.records`.
    follow : compiled function or None
        ``follow(own, memory, law, u_e, u_n)``, called after the decision: changes the running network.
    plain : bool
        The decision needs nothing but the present difference and sets nothing but ``s.measure``.
    always : bool
        The loop is always wanted damped.
    needs_reference : bool
        The policy looks at V_r - V_c, so the scenario must have a reference velocity.
    remembers : int
        What of the motion the history keeps (`navcore.law.history`).
    keeps_time : bool
        The policy needs the clock and the history.
    tunes : bool
        The policy sets the damping coefficient of a network that can be re-tuned.
    changes_input : bool
        The policy changes between V_r - V_c and the ship's own velocity as the input of the networks.
    measure : Measure or None
        What ``s.measure`` holds.
    """

    numbers: ClassVar[np.dtype] = record_type()
    memory: ClassVar[np.dtype] = record_type()
    decide: ClassVar[Any]
    follow: ClassVar[Any] = None
    plain: ClassVar[bool] = False
    always: ClassVar[bool] = False
    needs_reference: ClassVar[bool] = False
    remembers: ClassVar[int] = USE_NOTHING
    keeps_time: ClassVar[bool] = False
    tunes: ClassVar[bool] = False
    changes_input: ClassVar[bool] = False
    measure: ClassVar[Measure | None] = None
    id: Any  # a Literal in each subclass

    def packed(self, law_step_s: float) -> dict[str, Any]:
        """Values of `numbers`, for a law that is called every ``law_step_s`` seconds."""
        return {}

    def remembered(self) -> dict[str, Any]:
        """Values of `memory` at the start that are not zero."""
        return {}

    def ring_rows(self, law_step_s: float) -> int:
        """Law calls of history that the decision needs."""
        return 0

    def limits(self) -> tuple[Limit, ...]:
        """Thresholds to draw over the measure."""
        return ()

    def warnings(self, network: NetworkParameters) -> tuple[str, ...]:
        """Return the notices about these parameters with a network, as configured."""
        return ()

    def network_faults(self, network: NetworkParameters) -> Iterator[Fault]:
        """Say what does not go together with a network as configured; fields relative to the method."""
        return iter(())

    def stability_faults(self, network: NetworkParameters) -> Iterator[Fault]:
        """Say where the decision would leave every stable loop; asked when there are no other faults."""
        return iter(())

    def sets(self, network: NetworkParameters) -> tuple[str, ...]:
        """Fields of a method whose values the policy replaces while it runs.

        Parameters
        ----------
        network : NetworkParameters
            As configured.

        Returns
        -------
        tuple of str
            Relative to the method, such as ``"network.zeta"``.
        """
        return ()

    def network_in_force(self, network: NetworkParameters) -> NetworkParameters:
        """Network that runs when the method is configured with ``network``."""
        return network


def calls(seconds: float, law_step_s: float) -> int:
    """Law calls in a time, at least one."""
    return max(1, int(seconds / law_step_s + 0.5))
