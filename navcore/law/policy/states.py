"""Policy `states`: changes among the five working states of a ship's system (Sun 2017, section 1)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np

from navcore.foundation.compiled import inlined
from navcore.foundation.errors import Fault
from navcore.foundation.parameters import quantity
from navcore.foundation.records import COUNT, REAL, record_type
from navcore.foundation.text import Text
from navcore.law.history import USE_ACCELERATION, auxiliary, slide
from navcore.law.policy.base import Measure, PolicyParameters, calls
from navcore.law.policy.mean_acceleration import acceleration_limit, averaging_time
from navcore.law.records import E, N
from navcore.networks.base import NetworkParameters

UNDAMPED, INTERNAL, INTERNAL_WHOLE, EXTERNAL, EXTERNAL_WHOLE = range(5)
"""The five states, as the measure counts them."""


@inlined
def _decide(own, memory, law, sensed):
    """Choose input and channels of the damping; return whether there is any."""
    s = law.s
    memory.total = slide(law, memory.total, auxiliary, 0, own.window)
    calm = max(memory.total, 0.0) / min(own.window, s.ring_fill) <= own.limit
    memory.calm = memory.calm + 1 if calm else 0
    apart = math.hypot(s.difference[E], s.difference[N])
    memory.good = memory.good + 1 if s.valid and apart <= own.difference else 0
    s.internal = memory.good == 0 or (s.internal and memory.good < own.returns)
    s.level_only = law.p.azimuth_order == 0 or memory.calm < own.settled
    s.measure = 0.0
    if calm:
        s.measure = (INTERNAL if s.internal else EXTERNAL) + (0.0 if s.level_only else 1.0)
    return calm


class States(PolicyParameters):
    """Changes among undamped, internal and external, horizontal and whole damping (Sun 2017, section 1).

    Undamped while the ship manoeuvres; else external damping while the log is good, and internal damping
    while it is not; whole damping once the ship has not manoeuvred for some time, where the method has an
    azimuth network. The networks start anew at each change. Sun names the five states, and prints a rule for
    two of them only: external damping while the ship sails at constant velocity, undamped while it
    manoeuvres. The other rules, and the numbers, are ours.
    """

    numbers: ClassVar[np.dtype] = record_type(
        window=COUNT,  # calls
        limit=REAL,  # m/s^2
        difference=REAL,  # m/s
        returns=COUNT,  # calls
        settled=COUNT,  # calls
    )
    memory: ClassVar[np.dtype] = record_type(
        total=REAL,  # over the window, m/s^2
        calm=COUNT,  # calls since the last manoeuvre
        good=COUNT,  # calls since the log was last not good
    )
    decide: ClassVar[Any] = _decide
    needs_reference: ClassVar[bool] = True
    changes_input: ClassVar[bool] = True
    remembers: ClassVar[int] = USE_ACCELERATION
    keeps_time: ClassVar[bool] = True
    measure: ClassVar[Measure | None] = Measure(
        Text("state: 0 undamped, 1 internal, 2 internal whole, 3 external, 4 external whole"), "1", 1.0
    )
    id: Literal["states"] = "states"
    limit_mps2: float = acceleration_limit()
    mean_s: float = averaging_time()
    difference_mps: float = quantity(
        1.0,
        unit="m/s",
        gt=0.0,
        le=1000.0,
        slider=(0.01, 10.0),
        log=True,
        label=Text("external up to"),
        help=Text("Internal damping while |V_r - V_c| exceeds this, and while the log is missing."),
    )
    return_s: float = quantity(
        60.0,
        unit="s",
        gt=0.0,
        le=36000.0,
        slider=(1.0, 3600.0),
        log=True,
        label=Text("external again after"),
        help=Text("Time for which the log must be good before external damping comes back."),
    )
    settled_s: float = quantity(
        1800.0,
        unit="s",
        gt=0.0,
        le=1e6,
        slider=(60.0, 86400.0),
        log=True,
        label=Text("whole after"),
        help=Text("Time without a manoeuvre after which the azimuth is damped too."),
    )

    def packed(self, law_step_s: float) -> dict[str, Any]:
        """Window, limits and times in calls."""
        return {
            "window": calls(self.mean_s, law_step_s),
            "limit": self.limit_mps2,
            "difference": self.difference_mps,
            "returns": calls(self.return_s, law_step_s),
            "settled": calls(self.settled_s, law_step_s),
        }

    def ring_rows(self, law_step_s: float) -> int:
        """The window and the row that leaves it."""
        return calls(self.mean_s, law_step_s) + 1

    def network_faults(self, network: NetworkParameters) -> Iterator[Fault]:
        """Refuse velocity feedback, which internal damping has none of."""
        if network.external_form != "network":
            allowed = Text(
                'must be "network" with policy "{id}": internal damping has no velocity feedback', id=self.id
            )
            yield Fault("", "network.realisation", network.external_form, allowed)
