"""Parts of a block diagram: boxes, lines of signal, sums, words and the switch."""

from dataclasses import dataclass, field

METHOD, LOG, SENSORS = "Method", "Log", "Sensors"
"""Tabs that a block opens."""
WIDTH = 780
"""px."""
HIGH, LOW = 268.0, 226.0
"""Height of one channel, with and without the blocks that decide, px."""


@dataclass(frozen=True)
class State:
    """State of the law at a moment.

    Attributes
    ----------
    damped : bool
        The switch is closed.
    coefficient : float or None
        Damping coefficient in force, where a policy sets it.
    """

    damped: bool = True
    coefficient: float | None = None


@dataclass(frozen=True)
class Block:
    """A box with lines of text; what is left of ``opens`` empty cannot be pressed.

    Attributes
    ----------
    x, y, width, height : float
        Upper left corner and size, px.
    lines : tuple of str
        The first one is written larger; ``V_c`` has an index.
    opens : str
        Tab with its controls.
    own : bool
        It belongs to the method, and has its colour.
    """

    x: float
    y: float
    width: float
    height: float
    lines: tuple[str, ...]
    opens: str = ""
    own: bool = False


@dataclass(frozen=True)
class Line:
    """A line of signal through points, with an arrow at its end.

    Attributes
    ----------
    points : tuple of (float, float)
    own : bool
        It is part of the damping, and dead while the switch is open.
    dashed : bool
        It carries a decision, no signal.
    arrow : bool
    """

    points: tuple[tuple[float, float], ...]
    own: bool = False
    dashed: bool = False
    arrow: bool = True


@dataclass(frozen=True)
class Sum:
    """A circle in which signals are added.

    Attributes
    ----------
    x, y : float
        Its middle.
    minus : tuple of str
        Sides at which what enters is subtracted: "left", "top", "bottom".
    """

    x: float
    y: float
    minus: tuple[str, ...] = ()


@dataclass(frozen=True)
class Word:
    """A word beside a line; ``muted`` is written paler."""

    x: float
    y: float
    text: str
    anchor: str = "middle"
    muted: bool = False


@dataclass(frozen=True)
class Switch:
    """The switch of the damping, at its left end."""

    x: float
    y: float


Part = Block | Line | Sum | Word | Switch


@dataclass
class Diagram:
    """All parts of a method's picture.

    Attributes
    ----------
    title, told : str
        Its name, and what it is in a line.
    parts : list
        In the order in which they are drawn.
    height : float
        px; the width is `WIDTH`.
    """

    title: str
    told: str
    parts: list[Part] = field(default_factory=list)
    height: float = HIGH

    @property
    def decides(self) -> bool:
        """Whether a policy, or an outage of the log, opens the switch."""
        return any(isinstance(part, Line) and part.dashed for part in self.parts)
