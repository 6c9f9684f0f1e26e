"""Liu's complementary-filter network."""

from typing import ClassVar, Literal

from navcore.foundation.parameters import quantity
from navcore.foundation.text import Text
from navcore.networks.base import LinearNetwork, NetworkParameters, linear_network
from navcore.networks.pair import MainPair, Placement, dampings, placement_at_omega_s
from navcore.networks.roots import pair
from navcore.networks.tuning_codes import COMPLEMENTARY


class ComplementaryNetwork(NetworkParameters):
    """H = N/D of fourth order; the loop has three pairs at omega_s with damping 0.5, eta and zeta."""

    title: ClassVar[str] = Text("Complementary filter")
    source: ClassVar[str] = Text("Liu 5, 11 (powers of ωₛ mended, theory.md 3.2)")
    placeable: ClassVar[str] = "complementary"
    id: Literal["complementary"] = "complementary"
    zeta: float = quantity(
        0.5,
        gt=0.0,
        le=10.0,
        slider=(0.05, 2.0),
        label=Text("damping ratio ζ"),
        help=Text("Damping ratio of one closed-loop pair; 1 - H is proportional to it at η = 0.5 (Liu 5)."),
    )
    eta: float = quantity(
        0.5,
        gt=0.0,
        le=10.0,
        slider=(0.05, 2.0),
        label=Text("damping ratio η"),
        help=Text("Damping ratio of another closed-loop pair; Liu's optimum is 0.5."),
    )

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s) (theory.md 3.2) for a Schuler frequency in rad/s."""
        zeta, eta = self.zeta, self.eta
        outer = 1.0 + 2.0 * eta
        middle = 2.0 + 2.0 * zeta + 2.0 * eta + 4.0 * zeta * eta
        num = [1.0, outer + 4.0 * zeta * eta, middle, outer + 2.0 * zeta, 1.0]
        den = [1.0, outer + 2.0 * zeta, middle, outer + 4.0 * zeta, 1.0]
        closed_loop = [*pair(0.5, 1.0), *pair(eta, 1.0), *pair(zeta, 1.0)]
        return linear_network("complementary", omega_s, num, den, closed_loop_p=closed_loop)

    def with_pair(self, damping_ratio: float, frequency: float, omega_s: float) -> Placement:
        """Return the network with zeta = this damping ratio."""
        return placement_at_omega_s(self, {"zeta": damping_ratio}, damping_ratio, frequency, omega_s)

    def main_pair(self, omega_s: float) -> MainPair:
        """Return the pair of zeta: it always lies at omega_s."""
        return MainPair(self.zeta, omega_s, dampings(type(self), "zeta"), ((omega_s, omega_s),))

    def tuning(self, omega_s: float) -> list[float]:
        """Return code, eta."""
        return [COMPLEMENTARY, self.eta]
