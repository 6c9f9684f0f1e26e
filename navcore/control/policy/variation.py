"""Policy `variation`: undamped while the reference velocity's error changes (Liu 2021, 12-16, fig. 8, 9)."""

from __future__ import annotations

from typing import ClassVar, Literal

import numpy as np
from pydantic import model_validator

from navcore.compiled import inlined, kernel
from navcore.control.history import slide
from navcore.control.layout import COUNT, DECISION, FRESH, MEASURE, POLICY_PARAMETERS, WANTED, WINDOW_SUM
from navcore.control.policy.base import Limit, Measure, PolicyParameters, calls
from navcore.network.base import refuse
from navcore.parameters import quantity


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

    code: ClassVar[int] = 4
    needs_reference: ClassVar[bool] = True
    keeps_time: ClassVar[bool] = True
    measure: ClassVar[Measure | None] = Measure("variation s", "m/s", 1.0)
    id: Literal["variation"] = "variation"
    n_s: float = _time(20.0, "mean n", "Time over which the difference is averaged (Liu 15).")
    t0_s: float = _time(80.0, "window t0", "Age of the mean compared with (Liu 15).")
    a: float = _speed(0.25, "small up to a", "Damped while s is at most this (Liu 16).")
    b: float = _speed(0.35, "medium at b", "Peak of the membership 'medium' (fig. 8), which alone it shapes.")
    c: float = _speed(0.45, "large from c", "Undamped while s is at least this (Liu 16).")
    count: int = quantity(
        20,
        ge=1,
        le=100_000,
        slider=(1, 200),
        label="count",
        help="Calls in a row, one a law step, for which the wish must differ from the state (Liu, fig. 9).",
    )

    @model_validator(mode="after")
    def _ordered(self) -> Variation:
        if not self.a < self.b:
            raise refuse("b", self.b, f"must be > a = {self.a:g} (m/s)")
        if not self.b < self.c:
            raise refuse("c", self.c, f"must be > b = {self.b:g} (m/s)")
        return self

    def packed(self, law_step_s: float) -> list[float]:
        """Windows n and t0 in calls, a and c in m/s, count."""
        return [calls(self.n_s, law_step_s), calls(self.t0_s, law_step_s), self.a, self.c, self.count]

    def ring_rows(self, law_step_s: float) -> int:
        """Both windows and the row that leaves the older one."""
        return calls(self.n_s, law_step_s) + calls(self.t0_s, law_step_s) + 1

    def limits(self) -> tuple[Limit, ...]:
        """a, b and c."""
        return tuple(Limit(name, getattr(self, name), "m/s") for name in ("a", "b", "c"))


def membership(s: np.ndarray | float, policy: Variation) -> np.ndarray:
    """Degrees of membership small, medium, large of a variation (Liu 2021, fig. 8).

    Parameters
    ----------
    s : array_like
        Variation, m/s.
    policy : Variation
        Its a, b, c.

    Returns
    -------
    ndarray, shape of ``s`` + (3,)
        1 up to a falling to 0 at b; triangle a, b, c; rising from b to 1 at c. They add up to 1.

    Examples
    --------
    >>> membership([0.2, 0.3, 0.35, 0.5], Variation()).round(3).tolist()
    [[1.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    """
    s = np.asarray(s, dtype=float)
    small = np.clip((policy.b - s) / (policy.b - policy.a), 0.0, 1.0)
    large = np.clip((s - policy.b) / (policy.c - policy.b), 0.0, 1.0)
    return np.stack([small, 1.0 - small - large, large], axis=-1)


@kernel
def _variation(p, s, ring):
    """Both windows of both channels; 0 while a valid difference is not as old as they reach."""
    n, t0 = int(p[POLICY_PARAMETERS]), int(p[POLICY_PARAMETERS + 1])
    now_e, now_n = slide(s, ring, WINDOW_SUM, 0, 0, n), slide(s, ring, WINDOW_SUM + 1, 1, 0, n)
    old_e, old_n = slide(s, ring, WINDOW_SUM + 2, 0, t0, n), slide(s, ring, WINDOW_SUM + 3, 1, t0, n)
    if s[FRESH] < n + t0:
        return 0.0
    return max(abs(now_e - old_e), abs(now_n - old_n)) / n


@inlined
def decide_variation(p, s, ring, accel, heading):
    """Return the state after Liu's fig. 9: the wish f against the state i, counted."""
    s[MEASURE] = _variation(p, s, ring)
    if s[MEASURE] <= p[POLICY_PARAMETERS + 2]:
        s[WANTED] = 1.0
    elif s[MEASURE] >= p[POLICY_PARAMETERS + 3]:
        s[WANTED] = 0.0
    else:
        s[WANTED] = s[DECISION]
    if s[WANTED] == s[DECISION]:
        s[COUNT] = 0.0
    else:
        s[COUNT] += 1.0
        if s[COUNT] >= p[POLICY_PARAMETERS + 4]:
            s[DECISION] = s[WANTED]
            s[COUNT] = 0.0
    return s[DECISION] != 0.0
