"""Internal damping: the network is fed with the system's own velocity."""

from collections.abc import Iterator
from typing import ClassVar

from navcore.damping.base import Configured, NetworkDamping
from navcore.foundation.errors import Fault
from navcore.foundation.text import Text
from navcore.law.records import LawKind


class Internal(NetworkDamping):
    """Damping without a reference: the ship's own manoeuvres enter (theory.md 3)."""

    id: ClassVar[str] = "internal"
    help: ClassVar[str] = Text("own velocity")
    law: ClassVar[LawKind] = "internal"

    def faults(self, method: Configured, law_step_s: float) -> Iterator[Fault]:
        """Refuse velocity feedback too: without a reference there is nothing to pull the velocity onto."""
        running = self.network(method)
        if running.requires_reference:
            allowed = Text(
                'must be "network" with damping = "{damping}": velocity feedback needs a reference',
                damping=self.id,
            )
            yield Fault("", "network.realisation", running.external_form, allowed)
        yield from super().faults(method, law_step_s)

    def notices(self, method: Configured) -> Iterator[str]:
        """Yield also that a realisation by velocity feedback is not used."""
        if method.network.external_form != "network":
            yield Text("internal damping uses the network form; the feedback realisation needs a reference")
        yield from super().notices(method)
