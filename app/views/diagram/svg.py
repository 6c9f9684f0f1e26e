"""A diagram as SVG: for the page, where a block opens its controls, and for the documentation."""

import re
from functools import singledispatch

from navcore.foundation.text import Text
from schuler_bench.plots import style
from schuler_bench.views.diagram.parts import (
    WIDTH,
    Block,
    Diagram,
    Line,
    Part,
    State,
    Sum,
    Switch,
    Word,
)

_INDEX = re.compile(r"_(U\d|[A-Za-z]+\d?)|\^([bn])\b")
_SIGNS = {"left": (-16.0, -6.0), "top": (7.0, -12.0), "bottom": (7.0, 20.0)}
_STYLE = (
    ".sb-d text{font-size:12px;fill:#243B53}.sb-d .m{fill:#52667A;font-size:12px}"
    ".sb-d .b{fill:#fff;stroke:#52667A;stroke-width:1.3}.sb-d .l{fill:none;stroke:#52667A;stroke-width:1.3}"
    ".sb-d .o{stroke-width:2}.sb-d [data-command]{cursor:pointer}"
    ".sb-d [data-command]:hover .b,.sb-d [data-command]:focus .b{fill:#EAF2FA}"
)


class _Pen:
    """Colours of a picture, and whether its blocks open their controls."""

    def __init__(self, color: str, state: State, commands: bool) -> None:
        self.color, self.closed, self.commands = color, state.damped, commands

    def of(self, own: bool) -> str:
        """Colour of a line; grey where the open switch leaves it dead."""
        return style.MUTED if not own else self.color if self.closed else style.REFERENCE


def diagram_svg(found: Diagram, color: str, state: State, commands: bool = True) -> str:
    """Draw a diagram.

    Parameters
    ----------
    found : Diagram
        Of `schuler_bench.views.diagram.blocks.diagram`.
    color : str
        Of the method, ``#RRGGBB``.
    state : State
        What the law does at the moment that is shown.
    commands : bool
        Blocks open their controls.
    """
    pen = _Pen(color, state, commands)
    parts = [_drawn(part, pen) for part in found.parts]
    ends = Text.joined("", (_end(hue) for hue in (style.MUTED, color, style.REFERENCE)))
    return Text(
        '<svg class="sb-d" viewBox="0 0 {width} {height:g}" role="{role}" xmlns="http://www.w3.org/2000/svg" '
        'font-family="{font}" aria-label="{told:html}"><style>{css}</style><defs>{ends}</defs>{parts}</svg>',
        width=WIDTH,
        height=found.height,
        role="group" if commands else "img",  # an image holds no buttons
        font=style.SVG_FONT,
        told=found.told,
        css=_STYLE,
        ends=ends,
        parts=Text.joined("", parts),
    )


def _end(color: str) -> str:
    """The arrow of one colour."""
    return Text(
        '<marker id="{name}" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" '
        'markerUnits="userSpaceOnUse" orient="auto"><path d="M0 0.8L8 4L0 7.2z" fill="{color}"/></marker>',
        name=_name(color),
        color=color,
    )


def _name(color: str) -> str:
    return f"sb-end-{color[1:]}"


@singledispatch
def _drawn(part: Part, pen: _Pen) -> str:
    """SVG of a part."""
    raise TypeError(f"{part!r} cannot be drawn by {pen!r}")


@_drawn.register
def _(part: Block, pen: _Pen) -> str:
    middle = part.x + 0.5 * part.width
    first = part.y + 0.5 * part.height - 7.5 * (len(part.lines) - 1) + 4.5
    lines = Text.joined(
        "",
        (
            Text(
                '<text x="{x:g}" y="{y:g}" text-anchor="middle"{weight}>{line}</text>',
                x=middle,
                y=first + 15.0 * k,
                weight=' font-weight="600"' if k == 0 else "",
                line=_rich(line),
            )
            for k, line in enumerate(part.lines)
        ),
    )
    box = Text(
        '<rect class="b{own}" x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" rx="4"{stroke}/>',
        own=" o" if part.own else "",
        x=part.x,
        y=part.y,
        width=part.width,
        height=part.height,
        stroke=f' style="stroke:{pen.of(True)}"' if part.own else "",
    )
    if not (part.opens and pen.commands):
        return Text("<g>{box}{lines}</g>", box=box, lines=lines)
    return Text(
        '<g data-command="tab {opens}" role="button" tabindex="0" aria-label="{name:html}">{box}{lines}</g>',
        opens=part.opens,
        name=Text.joined(" ", part.lines),
        box=box,
        lines=lines,
    )


@_drawn.register
def _(part: Line, pen: _Pen) -> str:
    path = "M" + "L".join(f"{x:g} {y:g}" for x, y in part.points)
    color = pen.of(part.own)
    return Text(
        '<path class="l{own}" d="{path}" style="stroke:{color}"{dash}{end}/>',
        own=" o" if part.own else "",
        path=path,
        color=color,
        dash=' stroke-dasharray="3 3"' if part.dashed else "",
        end=f' marker-end="url(#{_name(color)})"' if part.arrow else "",
    )


@_drawn.register
def _(part: Sum, pen: _Pen) -> str:
    del pen
    signs = Text.joined(
        "",
        (
            Text(
                '<text x="{x:g}" y="{y:g}" text-anchor="middle">−</text>',
                x=part.x + _SIGNS[side][0],
                y=part.y + _SIGNS[side][1],
            )
            for side in part.minus
        ),
    )
    return Text(
        '<circle class="b" cx="{x:g}" cy="{y:g}" r="9"/>'
        '<path class="l" d="M{left:g} {y:g}h10M{x:g} {up:g}v10"/>{signs}',
        x=part.x,
        y=part.y,
        left=part.x - 5.0,
        up=part.y - 5.0,
        signs=signs,
    )


@_drawn.register
def _(part: Word, pen: _Pen) -> str:
    del pen
    return Text(
        '<text x="{x:g}" y="{y:g}" text-anchor="{anchor}"{muted}>{text}</text>',
        x=part.x,
        y=part.y,
        anchor=part.anchor,
        muted=' class="m"' if part.muted else "",
        text=_rich(part.text),
    )


@_drawn.register
def _(part: Switch, pen: _Pen) -> str:
    color = pen.of(True)
    word = Text("damped") if pen.closed else Text("undamped")
    return Text(
        '<circle cx="{x:g}" cy="{y:g}" r="3" fill="{color}"/>'
        '<circle cx="{end:g}" cy="{y:g}" r="3" fill="{color}"/>'
        '<path class="l o" d="M{x:g} {y:g}L{end:g} {tip:g}" style="stroke:{color}"/>'
        '<text class="m" x="{middle:g}" y="{under:g}" text-anchor="start">{word}</text>',
        x=part.x,
        y=part.y,
        end=part.x + 36.0,
        tip=part.y if pen.closed else part.y - 18.0,
        middle=part.x + 24.0,
        under=part.y + 20.0,
        color=color,
        word=word,
    )


def _shifted(letters: str, low: bool) -> str:
    """An index, or a raised letter."""
    return Text(
        '<tspan dy="{to:g}" font-size="75%">{letters}</tspan><tspan dy="{back:g}">&#8203;</tspan>',
        letters=letters,
        to=3.5 if low else -4.5,
        back=-3.5 if low else 4.5,
    )


def _rich(text: str) -> str:
    """Text of a label with its indices lowered, and with raised names of axes."""
    if not _INDEX.search(text):
        return Text("{text:html}", text=text)
    marks: list[str] = []
    end = 0
    for found in _INDEX.finditer(text):
        low, high = found.groups()
        marks += [
            Text("<tspan>{part:html}</tspan>", part=text[end : found.start()]),
            _shifted(low or high, bool(low)),
        ]
        end = found.end()
    marks.append(Text("<tspan>{part:html}</tspan>", part=text[end:]))
    return Text.joined("", marks)
