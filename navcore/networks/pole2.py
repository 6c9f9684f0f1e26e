"""Sun's two-pole network, designed by the closed-loop damping ratio."""

from __future__ import annotations

import math
from typing import ClassVar, Literal

from pydantic import model_validator

from navcore.foundation.parameters import choice, quantity
from navcore.foundation.text import Text
from navcore.networks.base import LinearNetwork, NetworkParameters, linear_network, refuse
from navcore.networks.pair import MainPair, Placement, dampings, placement_at_omega_s
from navcore.networks.roots import pair
from navcore.networks.tuning_codes import POLE2


class Pole2Network(NetworkParameters):
    """H = 1 + A/(s+w1) + B/(s+w2) from xi, n1, n2.

    ``exact`` puts the closed-loop poles at the asked places (pair with damping xi at omega_s, n1 xi omega_s,
    n2 xi omega_s), but H(0) is not 1. ``as_printed`` (Sun 18) forces H(0) = 1, which moves the pair.
    """

    title: ClassVar[str] = Text("Two poles (Sun)")
    source: ClassVar[str] = "Sun 12-18"
    placeable: ClassVar[str] = "pole2 (exact)"
    no_handle: ClassVar[str] = Text("the printed variant moves its pair away from where it is asked for")
    id: Literal["pole2"] = "pole2"
    xi: float = quantity(
        0.5,
        ge=1e-6,
        le=5.0,
        slider=(0.02, 1.5),
        label=Text("damping ratio ζ"),
        help=Text("Damping ratio asked of the closed-loop pair (Sun 14); Sun writes ξ, and his σ is -ζ ωₛ."),
    )
    n1: float = quantity(
        14.0,
        gt=0.0,
        le=100.0,
        slider=(12.0, 30.0),
        label="n₁",
        help=Text("First real closed-loop pole at n₁ ζ ωₛ (Sun 14)."),
    )
    n2: float = quantity(
        5.0,
        gt=0.0,
        le=100.0,
        slider=(1.0, 6.0),
        label="n₂",
        help=Text("Second real closed-loop pole at n₂ ζ ωₛ (Sun 14)."),
    )
    variant: Literal["exact", "as_printed"] = choice(
        "exact",
        label=Text("variant"),
        help=Text(
            "exact: poles where asked, H(0) below 1; as_printed: H(0) = 1, the pair less damped than asked "
            "and unstable for small ζ (theory.md 3.3)."
        ),
    )

    @model_validator(mode="after")
    def _real_poles(self) -> Pole2Network:
        discriminant = (self.n1 - self.n2) ** 2 + 4.0 - 4.0 * (self.n1 + self.n2)
        if discriminant < 0.0:
            allowed = Text(
                "with n₂ = {n2:g} the network's poles w₁, w₂ are complex: must satisfy "
                "(n₁-n₂)² + 4 - 4(n₁+n₂) >= 0, here {discriminant:g}",
                n2=self.n2,
                discriminant=discriminant,
            )
            raise refuse("n1", self.n1, allowed)
        if discriminant == 0.0 and self.variant == "as_printed":
            allowed = Text(
                "with n₂ = {n2:g} gives w₁ = w₂: A, B of the printed form do not exist", n2=self.n2
            )
            raise refuse("n1", self.n1, allowed)
        return self

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s) (theory.md 3.3) for a Schuler frequency in rad/s."""
        xi, total, product = self.xi, self.n1 + self.n2, self.n1 * self.n2
        a, b = (total + 2.0) * xi, (product + 2.0 * total) * xi**2
        c, d = (2.0 * product * xi**2 + total) * xi, product * xi**2
        root = math.sqrt(max(0.0, (self.n1 - self.n2) ** 2 + 4.0 - 4.0 * total)) * xi
        w1 = 2.0 * b / (a + root)
        w2 = b / w1
        if self.variant == "exact":
            closed_loop = [*pair(xi, 1.0), complex(-self.n1 * xi), complex(-self.n2 * xi)]
            num = [1.0, c, d]
        else:
            closed_loop = None
            residue = ((c - a) * w1 - (d - b)) / (w1 - w2)
            num = [1.0, a + residue * (1.0 - w2 / w1), b]
        return linear_network(
            "pole2", omega_s, num, [1.0, a, b], poles_p=[-w1, -w2], closed_loop_p=closed_loop
        )

    def with_pair(self, damping_ratio: float, frequency: float, omega_s: float) -> Placement | None:
        """Return the exact network with this damping ratio; None as printed, where the pair moves."""
        if self.variant != "exact":
            return None
        return placement_at_omega_s(self, {"xi": damping_ratio}, damping_ratio, frequency, omega_s)

    def main_pair(self, omega_s: float) -> MainPair | None:
        """Return the pair of xi, which always lies at omega_s; None as printed, where it moves."""
        if self.variant != "exact":
            return None
        return MainPair(self.xi, omega_s, dampings(type(self), "xi"), ((omega_s, omega_s),))

    def tuning(self, omega_s: float) -> list[float]:
        """Return code, n1, n2, and 1 when as printed."""
        return [POLE2, self.n1, self.n2, float(self.variant == "as_printed")]

    def least_coefficient(self) -> float:
        """Return the xi above which the printed form is stable; 0 for the exact one.

        Routh's condition on p^4 + a p^3 + (b+1) p^2 + e p + b with a = xi alpha, b = xi^2 beta and
        e = xi (g + h xi^2) is quadratic in y = xi^2, and opens upwards: it holds above its larger root.
        """
        if self.variant == "exact":
            return 0.0
        total, product = self.n1 + self.n2, self.n1 * self.n2
        alpha, beta = total + 2.0, product + 2.0 * total
        w1 = 2.0 * beta / (alpha + math.sqrt((self.n1 - self.n2) ** 2 + 4.0 - 4.0 * total))
        g, h = total + 2.0 * total / w1, 2.0 * product
        quadratic = h * (alpha * beta - h)
        linear = alpha * beta * g + alpha * h - 2.0 * g * h - alpha * alpha * beta
        constant = g * (alpha - g)
        discriminant = linear * linear - 4.0 * quadratic * constant
        if discriminant < 0.0:
            return 0.0
        return math.sqrt(max(0.0, 0.5 * (math.sqrt(discriminant) - linear) / quadratic))
