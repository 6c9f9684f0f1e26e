"""Our own two-pole network: exact damping ratio and H(0) = 1 together."""

from __future__ import annotations

import math
from typing import Any, ClassVar, Literal

from pydantic import model_validator

from navcore.foundation.parameters import bounds_of, given, quantity
from navcore.foundation.text import Text
from navcore.networks.base import (
    LinearNetwork,
    NetworkParameters,
    linear_network,
    refuse,
)
from navcore.networks.pair import MainPair, Placement, dampings, placement, same_frequency
from navcore.networks.roots import pair, quadratic_roots
from navcore.networks.tuning_codes import UNITY2

FORBIDDEN = (0.99, 1.01)
"""At r = 1 no second pair gives H(0) = 1; between these values it would be too slow or too fast to run."""


class Unity2Network(NetworkParameters):
    """Two poles and two zeros with N(0) = D(0); closed-loop pair with damping zeta at r omega_s.

    The second pair is chosen by its damping zeta2 or by its alpha, not both. It is faster than omega_s for
    r > 1, and H'(0) > 0: the 24 h mode grows. For r < 1 it is slower, H'(0) < 0, and the 24 h mode decays
    (theory.md 10).
    """

    title: ClassVar[str] = Text("Unity gain, exact damping")
    source: ClassVar[str] = "theory.md 3.4"
    alternatives: ClassVar[tuple[tuple[str, ...], ...]] = (("zeta2",), ("alpha",))
    placeable: ClassVar[str] = "unity2"
    id: Literal["unity2"] = "unity2"
    zeta: float = quantity(
        0.5,
        gt=0.0,
        le=5.0,
        slider=(0.02, 1.5),
        label=Text("damping ratio ζ"),
        help=Text("Damping ratio of the main closed-loop pair (theory.md 3.4)."),
    )
    r: float = quantity(
        1.2,
        ge=0.1,
        le=10.0,
        slider=(0.5, 3.0),
        label="r",
        help=Text(
            "Frequency of the main pair over ωₛ (theory.md 3.4); not within 0.99 to 1.01. Below 1 the "
            "24 h mode decays (theory.md 10)."
        ),
    )
    zeta2: float | None = quantity(
        None,
        gt=0.0,
        le=5.0,
        slider=(0.1, 2.0),
        label=Text("damping ratio ζ₂"),
        help=Text("Damping ratio of the second pair; max(0.7, ζ) when not given (theory.md 3.4)."),
    )
    alpha: float | None = quantity(
        None,
        unit="rad/s",
        gt=0.0,
        le=10.0,
        slider=(1e-4, 0.1),
        log=True,
        label="α",
        help=Text("Sum of the second pair's poles, instead of ζ₂ (theory.md 3.4)."),
    )

    @model_validator(mode="before")
    @classmethod
    def _one_way_only(cls, data: Any) -> Any:
        if len(given(data, ("zeta2", "alpha"))) == 2:
            raise refuse(
                "alpha", data["alpha"], Text("must not be given together with zeta2: each sets the other")
            )
        return data

    @model_validator(mode="after")
    def _not_at_omega_s(self) -> Unity2Network:
        low, high = FORBIDDEN
        if low < self.r < high:
            raise refuse(
                "r",
                self.r,
                Text(
                    "must be <= {low:g} or >= {high:g}: at 1 no second pair gives H(0) = 1",
                    low=low,
                    high=high,
                ),
            )
        return self

    def transfer(self, omega_s: float) -> LinearNetwork:
        """Return H(s) (theory.md 3.4) for a Schuler frequency in rad/s."""
        zeta, r = self.zeta, self.r
        excess = (r - 1.0) * (r + 1.0)
        if self.alpha is None:
            zeta2 = max(0.7, zeta) if self.zeta2 is None else self.zeta2
            half = 2.0 * zeta * zeta2 * r
            root = math.hypot(half, excess)
            q = (half + root) / excess if r > 1.0 else -excess / (half + root)
            alpha, beta, second = 2.0 * zeta2 * q, q * q, pair(zeta2, q)
        else:
            alpha = self.alpha / omega_s
            beta = (2.0 * zeta * r * alpha + excess) / excess
            if beta <= 0.0:
                limit = -excess / (2.0 * zeta * r) * omega_s
                raise refuse(
                    "alpha",
                    self.alpha,
                    Text("must be < {limit:.4g} (rad/s) with this ζ and r < 1", limit=limit),
                )
            zeta2 = alpha / (2.0 * math.sqrt(beta))
            second = quadratic_roots(alpha, beta)
        c3 = 2.0 * zeta * r + alpha
        c1 = r * r * alpha + 2.0 * zeta * r * beta
        c0 = r * r * beta
        # D(0) = c2 - 1 equals c0 by the choice of beta; written so, N(0) = D(0) holds exactly
        warnings = ()
        if zeta2 < zeta * (1.0 - 1e-12):
            warnings = (
                Text(
                    "the second pair is worse damped ({zeta2:.3g}) than the {zeta:g} asked",
                    zeta2=zeta2,
                    zeta=zeta,
                ),
            )
        return linear_network(
            "unity2",
            omega_s,
            [1.0, c1, c0],
            [1.0, c3, c0],
            closed_loop_p=[*pair(zeta, r), *second],
            warnings=warnings,
        )

    @classmethod
    def design_fields(cls) -> tuple[str, ...]:
        """Return zeta, r and the damping of the second pair."""
        return ("zeta", "r", "zeta2")

    def with_pair(self, damping_ratio: float, frequency: float, omega_s: float) -> Placement:
        """Return the network with this damping ratio, and r within its range."""
        least, largest = bounds_of(type(self).model_fields["r"])
        r = min(max(frequency / omega_s, least), largest)
        low, high = FORBIDDEN
        if low < r < high:
            r = low if r < 1.0 else high
        note = ""
        if not same_frequency(r * omega_s, frequency):
            allowed = Text(
                "{least:g} to {low:g} or {high:g} to {largest:g} ωₛ",
                least=least,
                low=low,
                high=high,
                largest=largest,
            )
            note = Text("the pair can only lie at {allowed}: {r:g} ωₛ is taken", allowed=allowed, r=r)
        data = self.model_dump(exclude_none=True) | {"zeta": damping_ratio, "r": r}
        return placement(type(self), data, damping_ratio, r * omega_s, note)

    def main_pair(self, omega_s: float) -> MainPair:
        """Return the pair of zeta and r."""
        (least, largest), (low, high) = bounds_of(type(self).model_fields["r"]), FORBIDDEN
        ranges = ((least * omega_s, low * omega_s), (high * omega_s, largest * omega_s))
        return MainPair(self.zeta, self.r * omega_s, dampings(type(self), "zeta"), ranges)

    def following(self, network: LinearNetwork) -> dict[str, Any]:
        """Return alpha and zeta2 of the second pair p^2 + alpha p + beta (theory.md 3.4)."""
        # D(p) = p^2 + (2 zeta r + alpha) p + r^2 beta
        alpha = float(network.den_p[1]) - 2.0 * self.zeta * self.r
        beta = float(network.den_p[2]) / self.r**2
        return {"alpha": alpha * network.omega_s, "zeta2": alpha / (2.0 * math.sqrt(beta))}

    def tuning(self, omega_s: float) -> list[float]:
        """Return code, r, zeta2 and alpha / omega_s; 0 where not given.

        For r < 1 an alpha stands for the damping of the second pair that it gives: held itself, it would have
        no second pair at a larger zeta.
        """
        if self.alpha is None:
            return [UNITY2, self.r, self.zeta2 or 0.0, 0.0]
        if self.r > 1.0:
            return [UNITY2, self.r, 0.0, self.alpha / omega_s]
        return [UNITY2, self.r, self.following(self.transfer(omega_s))["zeta2"], 0.0]
