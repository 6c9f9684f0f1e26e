"""No damping: H = 1."""

from typing import ClassVar, Literal

from navcore.foundation.text import Text
from navcore.networks.base import LinearNetwork, NetworkParameters, linear_network


class UndampedNetwork(NetworkParameters):
    """H = 1: the free Schuler loop."""

    title: ClassVar[str] = Text("Undamped")
    source: ClassVar[str] = "theory.md 3"
    no_handle: ClassVar[str] = Text("H = 1 has no parameter")
    id: Literal["none"] = "none"

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H = 1."""
        return linear_network("none", omega_s, [1.0], [1.0], closed_loop_p=[-1j, 1j])
