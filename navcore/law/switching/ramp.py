"""Switching `ramp`: the damping coefficient rises after re-engagement (Liu 2021, 3.4, fig. 10)."""

import math
from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np

from navcore.foundation.compiled import inlined
from navcore.foundation.errors import Fault
from navcore.foundation.parameters import choice, quantity
from navcore.foundation.records import FLAG, REAL, record_type
from navcore.foundation.text import Text
from navcore.foundation.times import EitherUnit
from navcore.law.policy.base import PolicyParameters
from navcore.law.records import CLEAR, REST
from navcore.law.switching.base import SwitchingParameters
from navcore.networks.base import NetworkParameters


@inlined
def _switch(own, memory, law, wanted):
    """Raise the coefficient after re-engagement; undamped at once."""
    s = law.s
    if not wanted:
        s.damped, s.xi = False, 0.0
        return
    if not s.damped:
        s.action = CLEAR
        if not s.engaged:
            s.switch_time = -math.inf
    left = own.duration - (s.clock - s.switch_time)
    # Rounded: a clock that adds up tenths of a second must not end the ramp a step late.
    left = 0.0 if abs(left) < 1e-6 else left
    s.damped, s.xi = True, s.xi_target * math.exp(-max(left, 0.0))
    s.to_xi = s.xi
    if left >= 0.0 and own.as_printed:
        # What a recursion on differences has seen until now came with e^-49 ... e^-1.
        s.action = REST


class Ramp(EitherUnit, SwitchingParameters):
    """Cleared on re-engagement, the coefficient raised as xi e^-(49-m), m = 0..49 s (Liu 2021, fig. 10).

    While undamped the last correction stays. The start of the run is no switch: it begins with the full
    coefficient.
    """

    numbers: ClassVar[np.dtype] = record_type(
        duration=REAL,  # s to the full coefficient
        as_printed=FLAG,
    )
    switch: ClassVar[Any] = _switch
    keeps_time: ClassVar[bool] = True
    tunes: ClassVar[bool] = True
    freezes: ClassVar[bool] = True
    id: Literal["ramp"] = "ramp"
    duration_s: float = quantity(
        50.0,
        unit="s",
        ge=1.0,
        le=3600.0,
        slider=(1.0, 600.0),
        log=True,
        label=Text("ramp"),
        help=Text(
            "The coefficient is ζ e^-(duration - 1 - m) m seconds after re-engagement (Liu 2021, fig. 10)."
        ),
    )
    form: Literal["state", "as_printed"] = choice(
        "state",
        label=Text("ramp form"),
        help=Text(
            "state: the filter's states are cleared and the present difference arrives as a step; "
            "as_printed: Liu 19's recursion, which sees differences of its input only, so that what stands "
            "during the ramp is never seen."
        ),
    )

    def packed(self, law_step_s: float, omega_s: float) -> dict[str, Any]:
        """Time to the full coefficient; form."""
        return {"duration": self.duration_s - 1.0, "as_printed": self.form == "as_printed"}

    def network_faults(
        self, network: NetworkParameters, realisation: str, policy: PolicyParameters
    ) -> Iterator[Fault]:
        """Refuse also a printed form whose loop is unstable at the small coefficients of the ramp."""
        faults = list(super().network_faults(network, realisation, policy))
        if not faults and network.least_coefficient() > 0.0:
            allowed = Text(
                "passes damping ratios below {least_coefficient:.3g}, at which the loop of",
                least_coefficient=network.least_coefficient(),
            )
            faults.append(
                self._refused(Text('{allowed} "{id}" as printed is unstable', allowed=allowed, id=network.id))
            )
        yield from faults
