"""Policy `variation`: undamped while the reference velocity's error changes (Liu 2021, 12-16, fig. 8, 9).

Liu's memberships (fig. 8) are *small* (1 up to a, falling to 0 at b), *medium* (the triangle a, b, c) and
*large* (rising from b to 1 at c). His outputs are not those of the largest membership, which would damp up to
(a + b)/2 and stop from (b + c)/2 on. He lists them below (16): f1 (damp) for s <= a, f2 (keep) for a < s < c
and f3 (undamp) for s >= c. So f1 and f3 come out only where *small* or *large* is 1, and b, at which neither
is, cannot change a decision. The field ``b`` stays because the membership is specified with it; the switching
view draws it between a and c.
"""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from navcore.foundation.compiled import inlined, kernel
from navcore.foundation.parameters import quantity
from navcore.foundation.records import COUNT, REAL, record_type
from navcore.foundation.text import Text
from navcore.law.history import difference_e, difference_n, slide
from navcore.law.policy.base import Limit, Measure, PolicyParameters, calls
from navcore.law.records import E, N
from navcore.networks.base import refuse


@inlined
def _variation(own, memory, law):
    """Change of the mean, the larger channel's; 0 while no valid difference is as old as it reaches."""
    n, t0 = own.window, own.age
    memory.now[E] = slide(law, memory.now[E], difference_e, 0, n)
    memory.now[N] = slide(law, memory.now[N], difference_n, 0, n)
    memory.before[E] = slide(law, memory.before[E], difference_e, t0, n)
    memory.before[N] = slide(law, memory.before[N], difference_n, t0, n)
    if law.s.fresh < n + t0:
        return 0.0
    return max(abs(memory.now[E] - memory.before[E]), abs(memory.now[N] - memory.before[N])) / n


@kernel
def _decision(own, memory, law):
    s = law.s
    s.measure = _variation(own, memory, law)
    if s.measure <= own.a:
        s.wanted = 1
    elif s.measure >= own.c:
        s.wanted = 0
    else:
        s.wanted = memory.decision
    if s.wanted == memory.decision:
        memory.count = 0
    else:
        memory.count += 1
        if memory.count >= own.count:
            memory.decision = s.wanted
            memory.count = 0
    return memory.decision != 0


@inlined
def _decide(own, memory, law, sensed):
    """Return the state after Liu's fig. 9: the wish f against the state i, counted."""
    return _decision(own, memory, law)


def _speed(default: float, label: str, help: str):
    return quantity(
        default, unit="m/s", gt=0.0, le=100.0, slider=(0.01, 2.0), log=True, label=label, help=help
    )


def _time(default: float, label: str, help: str):
    return quantity(
        default, unit="s", gt=0.0, le=3600.0, slider=(1.0, 600.0), log=True, label=label, help=help
    )


class Variation(PolicyParameters):
    """Damped while the difference V_r - V_c stays what it was, undamped while it varies (Liu 2021, 3.3).

    s = |mean of the difference over n - the same mean t0 earlier|, the larger of east and north. s <= a: the
    wish is damped, s >= c: undamped, between: as it is. The change is made when the wish differed for
    ``count`` calls in a row.
    """

    numbers: ClassVar[np.dtype] = record_type(
        window=COUNT,  # calls
        age=COUNT,  # of the mean compared with, calls
        a=REAL,  # m/s
        c=REAL,  # m/s
        count=COUNT,  # calls
    )
    memory: ClassVar[np.dtype] = record_type(
        now=(REAL, (2,)),  # sum of the difference over the window, m/s
        before=(REAL, (2,)),  # the same earlier
        decision=COUNT,  # 0 or 1
        count=COUNT,  # calls in a row for which the wish differed from it
    )
    decide: ClassVar[Any] = _decide
    needs_reference: ClassVar[bool] = True
    keeps_time: ClassVar[bool] = True
    measure: ClassVar[Measure | None] = Measure(Text("variation s"), "m/s", 1.0)
    id: Literal["variation"] = "variation"
    n_s: float = _time(20.0, Text("mean n"), Text("Time over which the difference is averaged (Liu 15)."))
    t0_s: float = _time(80.0, Text("window t0"), Text("Age of the mean compared with (Liu 15)."))
    a: float = _speed(0.25, Text("small up to a"), Text("Damped while s is at most this (Liu 16)."))
    b: float = _speed(
        0.35,
        Text("medium at b"),
        Text(
            "Peak of Liu's membership 'medium' (fig. 8): a line in the switching view. It "
            "changes no decision,"
            " because the state is kept everywhere between a and c (Liu 16)."
        ),
    )
    c: float = _speed(0.45, Text("large from c"), Text("Undamped while s is at least this (Liu 16)."))
    count: int = quantity(
        20,
        ge=1,
        le=100_000,
        slider=(1, 200),
        label=Text("count"),
        help=Text(
            "Calls in a row, one a law step, for which the wish must differ from the state (Liu, fig. 9)."
        ),
    )

    @model_validator(mode="after")
    def _ordered(self) -> Variation:
        if not self.a < self.b:
            raise refuse("b", self.b, Text("must be > a = {a:g} (m/s)", a=self.a))
        if not self.b < self.c:
            raise refuse("c", self.c, Text("must be > b = {b:g} (m/s)", b=self.b))
        return self

    def packed(self, law_step_s: float) -> dict[str, Any]:
        """Windows n and t0, a, c and count."""
        window, age = calls(self.n_s, law_step_s), calls(self.t0_s, law_step_s)
        return {"window": window, "age": age, "a": self.a, "c": self.c, "count": self.count}

    def remembered(self) -> dict[str, Any]:
        """Damped at the start."""
        return {"decision": 1}

    def ring_rows(self, law_step_s: float) -> int:
        """Both windows and the row that leaves the older one."""
        return calls(self.n_s, law_step_s) + calls(self.t0_s, law_step_s) + 1

    def limits(self) -> tuple[Limit, ...]:
        """a, b and c; the corners of the memberships (Liu 2021, fig. 8)."""
        return tuple(Limit(name, getattr(self, name), "m/s") for name in ("a", "b", "c"))
