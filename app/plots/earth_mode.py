"""The 24 h mode of the whole system in words."""

from __future__ import annotations

from navcore.analysis.whole_system import duration


def earth_mode_text(growth: float) -> str:
    """How the 24 h mode behaves, e.g. "grows, e-folding 3.1 days"; ``growth`` in 1/s."""
    if growth == 0.0:
        return "neither grows nor decays"
    return f"{'grows' if growth > 0.0 else 'decays'}, e-folding {duration(1.0 / growth)}"
