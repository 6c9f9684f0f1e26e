"""Base of the switching methods."""

from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np

from navcore.foundation.errors import Fault
from navcore.foundation.parameters import Parameters
from navcore.foundation.records import record_type
from navcore.foundation.text import Text
from navcore.law.policy.base import PolicyParameters
from navcore.networks.base import NetworkParameters

_RETUNABLE = Text("complementary, pole2 or unity2")


class SwitchingParameters(Parameters):
    """Base of the ``switching`` block of a method; subclasses narrow ``id`` to a Literal.

    Attributes
    ----------
    numbers, memory, history : dtype
        Records of what the compiled method reads, of what it keeps between calls, and of what it puts itself
        into each row of the history.
    switch : compiled function
        ``switch(own, memory, law, wanted)`` sets ``s.damped`` and ``s.xi``, and asks for what is to be done
        to the network: ``s.to_xi``, ``s.action``. The law does it, in one place: re-tuning is long, and is
        compiled in as often as it is called.
    restore : compiled function or None
        ``restore(own, memory, law)`` puts the network's states back when the action `RESTORE` was asked for.
    feed : compiled function or None
        ``feed(own, memory, law)`` gives the network's input (E, N, m/s) in place of the difference, while
        undamped too: the correction then goes on.
    plain : bool
        The method needs no clock and no history and never re-tunes a network.
    keeps_time : bool
        The method needs the clock and the history.
    tunes : bool
        The method moves the damping coefficient of a network that can be re-tuned.
    freezes : bool
        While undamped the last correction stays.
    follows_input : bool
        The method keeps nothing that belongs to the network's input, so that a policy may change that.
    needs_log : str
        Why the method works against a log only; empty where it needs none.
    """

    numbers: ClassVar[np.dtype] = record_type()
    memory: ClassVar[np.dtype] = record_type()
    history: ClassVar[np.dtype] = record_type()
    switch: ClassVar[Any]
    restore: ClassVar[Any] = None
    feed: ClassVar[Any] = None
    plain: ClassVar[bool] = False
    keeps_time: ClassVar[bool] = False
    tunes: ClassVar[bool] = False
    freezes: ClassVar[bool] = False
    follows_input: ClassVar[bool] = False
    needs_log: ClassVar[str] = ""
    id: Any  # a Literal in each subclass

    def packed(self, law_step_s: float, omega_s: float) -> dict[str, Any]:
        """Values of `numbers` for a law called every ``law_step_s`` seconds, Schuler frequency in rad/s."""
        return {}

    def ring_rows(self, law_step_s: float) -> int:
        """Law calls of history that the method needs."""
        return 0

    def warnings(self, network: NetworkParameters) -> tuple[str, ...]:
        """Return the notices about the method with the network in force."""
        return ()

    def network_faults(
        self, network: NetworkParameters, realisation: str, policy: PolicyParameters
    ) -> Iterator[Fault]:
        """Say what does not go together; fields relative to the method.

        Parameters
        ----------
        network : NetworkParameters
            In force.
        realisation : str
            In force: "network", "feedback" or "as_printed".
        policy : PolicyParameters
            As configured.
        """
        if self.tunes and policy.follow is not None:
            yield self._begins_anew(policy)
        elif self.tunes and network.tuning(1.0) is None:
            allowed = Text(
                'moves the damping ratio, which network "{id}" has not or cannot change', id=network.id
            )
            yield self._refused(
                Text(
                    "{allowed} while it runs: needs network {retunable}",
                    allowed=allowed,
                    retunable=_RETUNABLE,
                )
            )

    def _begins_anew(self, policy: PolicyParameters) -> Fault:
        return self._refused(
            Text('must be hard or keep with policy "{id}", which sets the gains', id=policy.id)
        )

    def _refused(self, allowed: str) -> Fault:
        return Fault("", "switching.id", self.id, allowed)
