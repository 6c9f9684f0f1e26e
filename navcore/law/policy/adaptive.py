"""Policy `adaptive`: the damping coefficient follows the velocity difference (Sun 2017, 8-18, Table 1)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, NamedTuple, TypeAlias

import numpy as np
from pydantic import Field, model_validator

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.errors import Fault
from navcore.foundation.parameters import bounded, choice, quantity
from navcore.foundation.records import COUNT, FLAG, REAL, record_type
from navcore.foundation.registry import any_of
from navcore.foundation.text import Text
from navcore.foundation.units import KNOT
from navcore.law.policy.base import LOW_MARGIN, Measure, PolicyParameters
from navcore.law.records import E, N
from navcore.networks.base import NetworkParameters, refuse
from navcore.networks.pole2 import Pole2Network
from navcore.networks.undamped import UndampedNetwork
from navcore.networks.unity2 import Unity2Network

LOWEST, HIGHEST = 0.04, 0.99
"""Ends of the damping coefficient in either law (Sun's Table 1)."""
QUADRATIC = (0.3076, -1.1452, 0.8101)
"""Sun 9 with its sign mended: coefficients of d^2, d, 1 with d in knots (theory.md section 4)."""
_LEAST_ROWS, _MOST_ROWS = 2, 500
_LEAST_SPACING_KN = 1e-3
if TYPE_CHECKING:
    _Retuned: TypeAlias = Unity2Network | Pole2Network
else:
    _Retuned = any_of({"unity2": Unity2Network, "pole2": Pole2Network}, "id")
_ADAPTABLE = Text("pole2 or unity2, in network or policy.network")


class TableRow(NamedTuple):
    """One row of the adaptive law's table: difference (kn) and damping coefficient."""

    difference_kn: Annotated[float, bounded(unit="kn", ge=0.0, le=1000.0)]
    xi: Annotated[float, bounded(ge=0.0, le=5.0)]


def _rows(*pairs: tuple[float, float]) -> tuple[TableRow, ...]:
    return tuple(TableRow(*pair) for pair in pairs)


SUN_TABLE = _rows(
    (0.0, 0.99), (0.1, 0.82), (0.2, 0.64), (0.3, 0.44), (0.4, 0.22), (0.5, 0.12), (0.6, 0.10), (0.7, 0.08),
    (1.8, 0.05), (3.0, 0.04),
)  # fmt: skip
"""Sun 2017, Table 1."""


def _filled(values: np.ndarray) -> np.ndarray:
    return np.pad(values, (0, _MOST_ROWS - len(values)))


@inlined
def _hermite(own, d):
    """Look up the table: cubic between its rows, constant beyond."""
    x, y, slope = own.argument, own.xi, own.slope
    last = own.rows - 1
    if d <= x[0]:
        return y[0]
    if d >= x[last]:
        return y[last]
    at = 0
    while x[at + 1] < d:
        at += 1
    h = x[at + 1] - x[at]
    t = (d - x[at]) / h
    y0, m0, y1, m1 = y[at], h * slope[at], y[at + 1], h * slope[at + 1]
    return y0 + t * (m0 + t * (3.0 * (y1 - y0) - 2.0 * m0 - m1 + t * (2.0 * (y0 - y1) + m0 + m1)))


@kernel
def law_coefficient(own, low, d):
    """Damping coefficient for a difference d (m/s): the law, clamped, and kept at least ``low``."""
    if own.quadratic:
        knots = d / KNOT
        xi = QUADRATIC[2] + knots * (own.linear + knots * QUADRATIC[0])
    else:
        xi = _hermite(own, d)
    return max(min(max(xi, LOWEST), HIGHEST), low)


@kernel
def _follow(own, memory, law):
    s, lowpass = law.s, memory.lowpass
    if not s.valid:
        return
    share = 1.0 if s.fresh == 1 else own.share
    lowpass[E] += share * (s.difference[E] - lowpass[E])
    lowpass[N] += share * (s.difference[N] - lowpass[N])
    s.measure = math.hypot(lowpass[E], lowpass[N])
    s.xi_target = law_coefficient(own, law.p.tuning.low, s.measure)


@inlined
def _decide(own, memory, law, sensed):
    """Set the damping coefficient to be reached; return True."""
    _follow(own, memory, law)
    return True


class Adaptive(PolicyParameters):
    """Always damped, with a damping coefficient that follows |low-passed V_r - V_c| (Sun 2017, 8-18).

    The east and the north difference are low-passed, and the norm is taken afterwards (theory.md 11).

    ``table`` holds pairs [difference in kn, xi]; between them the curve is monotone where they are (PCHIP),
    beyond them it stays. Every law is held within 0.04 and 0.99, and above what the network needs to be
    stable. The network that is re-tuned is the policy's own one, else the method's: `unity2` or `pole2`.
    """

    numbers: ClassVar[np.dtype] = record_type(
        quadratic=FLAG,
        linear=REAL,  # coefficient of the quadratic, per kn
        share=REAL,  # of a new sample in the low-pass
        rows=COUNT,  # of the table
        argument=(REAL, (_MOST_ROWS,)),  # m/s
        xi=(REAL, (_MOST_ROWS,)),
        slope=(REAL, (_MOST_ROWS,)),  # per m/s
    )
    memory: ClassVar[np.dtype] = record_type(lowpass=(REAL, (2,)))  # filtered difference, m/s
    decide: ClassVar[Any] = _decide
    needs_reference: ClassVar[bool] = True
    keeps_time: ClassVar[bool] = True
    tunes: ClassVar[bool] = True
    measure: ClassVar[Measure | None] = Measure(Text("|low-passed V_r - V_c|"), "kn", KNOT)
    id: Literal["adaptive"] = "adaptive"
    law: Literal["table", "quadratic", "as_printed"] = choice(
        "table",
        label=Text("law"),
        help=Text(
            "table: Sun's Table 1 or your own; quadratic: Sun 9 with its sign mended; as_printed: Sun 9 as "
            "printed. Both are clamped."
        ),
    )
    table: tuple[TableRow, ...] = Field(
        default=SUN_TABLE,
        description=Text("Pairs [difference in kn, damping ratio], in any order (Sun 2017, Table 1)."),
    )
    network: _Retuned | None = Field(
        default=None,
        description=Text(
            "Network that is re-tuned: unity2 or pole2, a name or a block. When not given, that of "
            "the method, and unity2 where the method has none."
        ),
    )
    lowpass_s: float = quantity(
        100.0,
        unit="s",
        gt=0.0,
        le=1e5,
        slider=(1.0, 1000.0),
        log=True,
        label=Text("low-pass"),
        help=Text(
            "Time constant of the low-pass on each component of the difference: above waves, below 806 s = "
            "1/ωₛ."
        ),
    )

    @model_validator(mode="after")
    def _increasing(self) -> Adaptive:
        if not _LEAST_ROWS <= len(self.table) <= _MOST_ROWS:
            raise refuse(
                "table",
                len(self.table),
                Text(
                    "must have {least_rows} to {most_rows} rows", least_rows=_LEAST_ROWS, most_rows=_MOST_ROWS
                ),
            )
        arguments = sorted(row.difference_kn for row in self.table)
        for first, second in zip(arguments, arguments[1:], strict=False):
            if second - first < _LEAST_SPACING_KN:
                near = Text(
                    "must have rows {least_spacing_kn:g} kn apart, not {first:g} and {second:g} kn",
                    least_spacing_kn=_LEAST_SPACING_KN,
                    first=first,
                    second=second,
                )
                raise refuse("table", [list(row) for row in self.table], near)
        return self

    def packed(self, law_step_s: float) -> dict[str, Any]:
        """Law, share of a new sample, and the table with its PCHIP slopes."""
        from scipy.interpolate import PchipInterpolator

        x, y = np.array(sorted(self.table)).T
        slopes = PchipInterpolator(x, y).derivative()(x)
        return {
            "quadratic": self.law != "table",
            "linear": -QUADRATIC[1] if self.law == "as_printed" else QUADRATIC[1],
            "share": -math.expm1(-law_step_s / self.lowpass_s),
            "rows": len(x),
            "argument": _filled(x * KNOT),
            "xi": _filled(y),
            "slope": _filled(slopes / KNOT),
        }

    def sets(self, network: NetworkParameters) -> tuple[str, ...]:
        """The damping ratio of the network that is re-tuned; all of the method's where that is another."""
        field = self.network_in_force(network).damping_field
        if self.network is None:
            return (f"network.{field}",)
        unused = (f"network.{name}" for name in type(network).model_fields if name != "id")
        return (f"policy.network.{field}", *unused)

    def network_in_force(self, network: NetworkParameters) -> NetworkParameters:
        """The policy's own network, else the method's, else `unity2`."""
        if self.network is not None:
            return self.network
        return Unity2Network() if isinstance(network, UndampedNetwork) else network

    def warnings(self, network: NetworkParameters) -> tuple[str, ...]:
        """The flaw of either quadratic, and a printed form held where it is stable."""
        texts = []
        if self.law == "quadratic":
            texts.append(
                Text(
                    "adaptive: Sun 9 with its sign mended is held at 0.04 between 0.95 and 2.77 kn, where it "
                    "is negative, and at 0.99 from 3.87 kn on"
                )
            )
        if self.law == "as_printed":
            texts.append(
                Text(
                    "adaptive: Sun 9 as printed is held at ζ = 0.99 from a difference of 0.15 kn on: there "
                    "it does not adapt"
                )
            )
        least = self.network_in_force(network).least_coefficient()
        if least > LOWEST:
            texts.append(
                Text(
                    "adaptive: below ζ = {least:.3g} the printed form is unstable: held above it", least=least
                )
            )
        return tuple(texts)

    def network_faults(self, network: NetworkParameters) -> Iterator[Fault]:
        """Two networks given, or one that cannot be re-tuned."""
        if self.network is not None:
            if not isinstance(network, UndampedNetwork) and network != self.network:
                allowed = Text(
                    'differs from the policy\'s own network "{id}": give only one of them', id=self.network.id
                )
                yield Fault("", "network.id", network.id, allowed)
        elif network.id not in ("none", "pole2", "unity2"):
            allowed = Text(
                'cannot re-tune network "{id}": must be {adaptable}', id=network.id, adaptable=_ADAPTABLE
            )
            yield Fault("", "policy.id", self.id, allowed)

    def stability_faults(self, network: NetworkParameters) -> Iterator[Fault]:
        """Refuse a printed form that is unstable wherever the law can go; it is held above that otherwise."""
        low = LOW_MARGIN * self.network_in_force(network).least_coefficient()
        if low > HIGHEST:
            reason = Text(
                "is unstable up to ζ = {low:.3g} with these n₁, n₂: must be stable below {highest}",
                low=low,
                highest=HIGHEST,
            )
            at = "network" if self.network is None else "policy.network"
            yield Fault("", f"{at}.variant", "as_printed", reason)
