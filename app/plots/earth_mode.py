"""The 24 h mode of the whole system in words."""

from __future__ import annotations

from navcore.analysis.whole_system import duration
from navcore.foundation.text import Text


def earth_mode_text(growth: float) -> str:
    """How the 24 h mode behaves, e.g. "grows, e-folding 3.1 days"; ``growth`` in 1/s."""
    if growth == 0.0:
        return "neither grows nor decays"
    return (
        Text("grows, e-folding {growth}", growth=duration(1.0 / growth))
        if growth > 0.0
        else Text("decays, e-folding {growth}", growth=duration(1.0 / growth))
    )
