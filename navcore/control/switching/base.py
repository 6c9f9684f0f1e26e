"""What every switching method has."""

from __future__ import annotations

from typing import Any, ClassVar

from navcore.parameters import Parameters


class SwitchingParameters(Parameters):
    """Base of the ``switching`` block of a method; subclasses narrow ``id`` to a Literal.

    Attributes
    ----------
    code : int
        Number by which the compiled dispatch knows the method.
    keeps_time : bool
        The method needs the clock and the history.
    tunes : bool
        The method moves the damping coefficient of a network that can be re-tuned.
    freezes : bool
        While undamped the last correction stays.
    """

    code: ClassVar[int]
    keeps_time: ClassVar[bool] = False
    tunes: ClassVar[bool] = False
    freezes: ClassVar[bool] = False
    id: Any  # a Literal in each subclass

    def packed(self, law_step_s: float) -> list[float]:
        """Values for ``p[SWITCHING_PARAMETERS:]``, at most 8."""
        return []

    def ring_rows(self, law_step_s: float) -> int:
        """Law calls of history that the method needs."""
        return 0
