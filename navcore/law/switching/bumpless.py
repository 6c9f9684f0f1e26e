"""Switching `bumpless` (ours): only the *change* of the log is removed, the damping achieved is kept.

On the way out the network's state and the mean difference of before the event are put aside and the
correction is frozen; on the way back the state returns with the steady state for what the mean difference
has changed by (theory.md section 4).
"""

from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np

from navcore.analysis.loop import H0_TOLERANCE
from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.parameters import quantity
from navcore.foundation.records import COUNT, REAL, record_type
from navcore.foundation.text import Text
from navcore.law.history import input_e, input_n, mean_of, row_of_age
from navcore.law.policy.base import PolicyParameters, calls
from navcore.law.records import EXTERNAL, MAX_STATES, RESTORE, E, N
from navcore.law.switching.base import SwitchingParameters
from navcore.networks.base import NetworkParameters

_ANY_OMEGA_S = 1.24e-3


@kernel
def _put_aside(own, memory, law):
    """Take state and mean of before the event; what is put aside already stays if that was undamped."""
    row = row_of_age(law, own.age)
    if law.s.ring_fill < own.age + own.window or not row.damped:
        return
    for channel in range(2):
        for i in range(law.p.order):
            memory.x[channel, i] = row.x[channel, i]
    memory.mean[E] = mean_of(law, input_e, own.age, own.window)
    memory.mean[N] = mean_of(law, input_n, own.age, own.window)


@kernel
def _restore(own, memory, law):
    """Put the state back, moved by the steady state for the change of the mean."""
    s = law.s
    change_e = mean_of(law, input_e, 0, own.window) - memory.mean[E]
    change_n = mean_of(law, input_n, 0, own.window) - memory.mean[N]
    s.offset[E] = s.offset[N] = 0.0
    for i in range(law.p.order):
        s.x[E, i] = memory.x[E, i] + s.network.steady[i] * change_e
        s.x[N, i] = memory.x[N, i] + s.network.steady[i] * change_n


@inlined
def _switch(own, memory, law, wanted):
    """Leave with the state of before the event put aside; come back without a step."""
    s = law.s
    if not wanted:
        if s.damped:
            _put_aside(own, memory, law)
        s.damped, s.xi = False, 0.0
        return
    if not s.damped:
        known = s.fresh if law.p.damping == EXTERNAL else s.ring_fill
        if known < own.window:
            return
        s.action = RESTORE
    s.damped = True
    s.xi = s.to_xi = s.xi_target


class Bumpless(SwitchingParameters):
    """Restore the network's state of before the event, shifted by the change of the log (theory.md 4).

    While undamped the last correction stays. Damping begins, at the start of the run too, when n_s of valid
    differences are there.
    """

    numbers: ClassVar[np.dtype] = record_type(
        window=COUNT,  # of the mean, calls
        age=COUNT,  # of what is put aside, calls
    )
    memory: ClassVar[np.dtype] = record_type(
        x=(REAL, (2, MAX_STATES)),  # network states of before the event
        mean=(REAL, (2,)),  # mean difference of before the event, m/s
    )
    switch: ClassVar[Any] = _switch
    restore: ClassVar[Any] = _restore
    keeps_time: ClassVar[bool] = True
    freezes: ClassVar[bool] = True
    id: Literal["bumpless"] = "bumpless"
    n_s: float = quantity(
        20.0,
        unit="s",
        gt=0.0,
        le=3600.0,
        slider=(1.0, 300.0),
        log=True,
        label=Text("bumpless mean"),
        help=Text("Time over which the difference is averaged, before the event and on re-engagement."),
    )
    memory_s: float = quantity(
        110.0,
        unit="s",
        gt=0.0,
        le=3600.0,
        slider=(1.0, 1200.0),
        log=True,
        label=Text("memory"),
        help=Text(
            "How far before the switch state and mean are taken: window, mean and count of the policy."
        ),
    )

    def packed(self, law_step_s: float, omega_s: float) -> dict[str, Any]:
        """Mean and memory."""
        return {"window": calls(self.n_s, law_step_s), "age": calls(self.memory_s, law_step_s)}

    def ring_rows(self, law_step_s: float) -> int:
        """The memory and the mean before it."""
        return calls(self.n_s, law_step_s) + calls(self.memory_s, law_step_s) + 1

    def warnings(self, network: NetworkParameters) -> tuple[str, ...]:
        """A network that passes on part of a standing difference."""
        try:
            h0 = network.transfer(_ANY_OMEGA_S).h0
        except InputError:
            return ()
        if abs(h0 - 1.0) > H0_TOLERANCE:
            return (Text("bumpless: H(0) differs from 1, so a change of the log acts for good"),)
        return ()

    def network_faults(
        self, network: NetworkParameters, realisation: str, policy: PolicyParameters
    ) -> Iterator[Fault]:
        """Refuse gains that a policy sets, and a realisation that never comes to rest."""
        if policy.follow is not None:
            yield self._begins_anew(policy)
        elif realisation != "network":
            yield self._refused(
                Text(
                    "needs a network that comes to rest with a standing difference: "
                    'network.realisation must be "network" with {id}',
                    id=network.id,
                )
            )
