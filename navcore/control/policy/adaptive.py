"""Policy `adaptive`: the damping coefficient follows the velocity difference (Sun 2017, 8-18, Table 1)."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar, Literal, NamedTuple

import numpy as np
from pydantic import BeforeValidator, Field, model_validator

from navcore.compiled import inlined, kernel
from navcore.control.layout import (
    DIFFERENCE,
    FRESH,
    LOWPASS,
    MEASURE,
    POLICY_PARAMETERS,
    TABLE,
    TABLE_COLUMNS,
    TABLE_ROWS,
    TUNING_LOW,
    VALID,
    XI_TARGET,
)
from navcore.control.policy.base import Measure, PolicyParameters
from navcore.network.base import NetworkParameters, refuse
from navcore.network.pole2 import Pole2Network
from navcore.network.undamped import UndampedNetwork
from navcore.network.unity2 import Unity2Network
from navcore.parameters import bounded, choice, quantity
from navcore.units import KNOT

LOWEST, HIGHEST = 0.04, 0.99
"""Ends of the damping coefficient in either law (Sun's Table 1)."""
QUADRATIC = (0.3076, -1.1452, 0.8101)
"""Sun 9 with its sign mended: coefficients of d^2, d, 1 with d in knots (physics.md section 4)."""
_LEAST_ROWS, _MOST_ROWS = 2, 500
_LEAST_SPACING_KN = 1e-3


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


def _by_id(value: Any) -> Any:
    if isinstance(value, str) and value not in ("unity2", "pole2"):
        raise refuse("", value, "must be unity2 or pole2, or a block with one of them as id")
    return {"id": value} if isinstance(value, str) else value


class Adaptive(PolicyParameters):
    """Always damped, with a damping coefficient that follows the low-passed |V_r - V_c| (Sun 2017, 8-18).

    ``table`` holds pairs [difference in kn, xi]; between them the curve is monotone where they are (PCHIP),
    beyond them it stays. Either law is held within 0.04 and 0.99, and above what the network needs to be
    stable. The network that is re-tuned is the policy's own one, else the method's: `unity2` or `pole2`.
    """

    code: ClassVar[int] = 5
    needs_reference: ClassVar[bool] = True
    keeps_time: ClassVar[bool] = True
    tunes: ClassVar[bool] = True
    measure: ClassVar[Measure | None] = Measure("low-passed |V_r - V_c|", "kn", KNOT)
    id: Literal["adaptive"] = "adaptive"
    law: Literal["table", "quadratic"] = choice(
        "table",
        label="law",
        help="table: Sun's Table 1 or your own; quadratic: Sun 9 with its sign mended, clamped.",
    )
    table: tuple[TableRow, ...] = Field(
        default=SUN_TABLE,
        description="Pairs [difference in kn, damping coefficient], in any order (Sun 2017, Table 1).",
    )
    network: Annotated[
        Annotated[Unity2Network | Pole2Network, Field(discriminator="id")] | None, BeforeValidator(_by_id)
    ] = Field(
        default=None,
        description="Network that is re-tuned: unity2 or pole2, a name or a block. When not given, that of "
        "the method, and unity2 where the method has none.",
    )
    lowpass_s: float = quantity(
        100.0,
        unit="s",
        gt=0.0,
        le=1e5,
        slider=(1.0, 1000.0),
        log=True,
        label="low-pass",
        help="Time constant of the low-pass on the difference: above waves, below 806 s = 1/omega_s.",
    )

    @model_validator(mode="after")
    def _increasing(self) -> Adaptive:
        if not _LEAST_ROWS <= len(self.table) <= _MOST_ROWS:
            raise refuse("table", len(self.table), f"must have {_LEAST_ROWS} to {_MOST_ROWS} rows")
        arguments = sorted(row.difference_kn for row in self.table)
        for first, second in zip(arguments, arguments[1:], strict=False):
            if second - first < _LEAST_SPACING_KN:
                near = f"must have rows {_LEAST_SPACING_KN:g} kn apart, not {first:g} and {second:g} kn"
                raise refuse("table", [list(row) for row in self.table], near)
        return self

    def packed(self, law_step_s: float) -> list[float]:
        """Law (1: quadratic); share of a new sample in the low-pass."""
        return [float(self.law == "quadratic"), -math.expm1(-law_step_s / self.lowpass_s)]

    def table_rows(self) -> list[tuple[float, float, float]]:
        """Arguments (m/s), damping coefficients and PCHIP slopes (per m/s)."""
        from scipy.interpolate import PchipInterpolator

        x, y = np.array(sorted(self.table)).T
        slopes = PchipInterpolator(x, y).derivative()(x)
        return list(zip((x * KNOT).tolist(), y.tolist(), (slopes / KNOT).tolist(), strict=True))

    def network_in_force(self, network: NetworkParameters) -> NetworkParameters:
        """The policy's own network, else the method's, else `unity2`."""
        if self.network is not None:
            return self.network
        return Unity2Network() if isinstance(network, UndampedNetwork) else network

    def warnings(self) -> tuple[str, ...]:
        """The quadratic's flaw."""
        if self.law == "table":
            return ()
        return (
            "adaptive: the quadratic is negative between 0.95 and 2.77 kn (held at 0.04 there), and beyond "
            "it rises again: use the table",
        )


@inlined
def _hermite(p, d):
    """Look up the table: cubic between its rows, constant beyond."""
    rows = int(p[TABLE_ROWS])
    last = TABLE + TABLE_COLUMNS * (rows - 1)
    if d <= p[TABLE]:
        return p[TABLE + 1]
    if d >= p[last]:
        return p[last + 1]
    at = TABLE
    while p[at + TABLE_COLUMNS] < d:
        at += TABLE_COLUMNS
    h = p[at + TABLE_COLUMNS] - p[at]
    t = (d - p[at]) / h
    y0, m0, y1, m1 = p[at + 1], h * p[at + 2], p[at + TABLE_COLUMNS + 1], h * p[at + TABLE_COLUMNS + 2]
    return y0 + t * (m0 + t * (3.0 * (y1 - y0) - 2.0 * m0 - m1 + t * (2.0 * (y0 - y1) + m0 + m1)))


@kernel
def law_coefficient(p, d):
    """Damping coefficient for a difference d (m/s): the law, clamped, and kept where the loop is stable."""
    if p[POLICY_PARAMETERS] != 0.0:
        knots = d / KNOT
        xi = QUADRATIC[2] + knots * (QUADRATIC[1] + knots * QUADRATIC[0])
    else:
        xi = _hermite(p, d)
    return max(min(max(xi, LOWEST), HIGHEST), p[TUNING_LOW])


@kernel
def _follow(p, s):
    if s[VALID] == 0.0:
        return
    share = 1.0 if s[FRESH] == 1.0 else p[POLICY_PARAMETERS + 1]
    s[LOWPASS] += share * (s[DIFFERENCE] - s[LOWPASS])
    s[LOWPASS + 1] += share * (s[DIFFERENCE + 1] - s[LOWPASS + 1])
    s[MEASURE] = math.hypot(s[LOWPASS], s[LOWPASS + 1])
    s[XI_TARGET] = law_coefficient(p, s[MEASURE])


@inlined
def decide_adaptive(p, s, ring, accel, heading):
    """Set the damping coefficient to be reached; return True."""
    _follow(p, s)
    return True
