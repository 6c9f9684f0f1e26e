"""No damping: every error swings for ever."""

from typing import ClassVar

from navcore.damping.base import Damping
from navcore.foundation.text import Text


class Free(Damping):
    """The navigation runs undamped (theory.md 2)."""

    id: ClassVar[str] = "free"
    help: ClassVar[str] = Text("none")
