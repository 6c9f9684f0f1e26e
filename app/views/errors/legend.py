"""The legend of the error curves: a bar and a name for every curve, dimmed or hidden by a click."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from html import escape
from itertools import accumulate

from app.plots import style
from app.plots.envelope import Envelope
from app.plots.legend import entry
from app.plots.pinned import Pinned, pinned_methods
from app.plots.uplot import LABEL_SIZE, Y_SIZE, Dash
from app.session.display import Display
from app.views.errors.figure import STRAPDOWN, Overlay, legend_name
from navcore.engine.run import Run


def legend_html(
    run: Run,
    overlay: Overlay | None = None,
    pins: Sequence[Pinned] = (),
    envelope: Envelope | None = None,
    display: Display | None = None,
) -> str:
    """One legend for a stack of plots: a bar and the name of every method; a click dims or hides it."""
    state_of = (display or Display()).state_of
    items = [
        entry(
            method.method.name,
            legend_name(method),
            f"height:3px;background:{style.method_color(i)}",
            state_of(method.method.name),
        )
        for i, method in enumerate(run.methods)
    ]
    if overlay is not None:
        old = " of an earlier scenario" if overlay.old else ""
        items.append(_legend_item(f"{STRAPDOWN}{old}", f"border-top:3px dashed {style.MUTED}"))
    items += [
        entry(pin.label, pin.label, css_dash(pin.dash, pin.color), state_of(pin.label))
        for pin in pinned_methods(pins)
    ]
    if envelope is not None:
        bar = f"height:10px;background:{style.MUTED}{'22' if envelope.old else '55'}"
        items.append(_legend_item(envelope.label, bar, " ".join(envelope.details)))
    return (
        '<div class="sb-legend" role="group" aria-label="legend" '
        f'style="padding-left:{Y_SIZE + LABEL_SIZE}px">'
        f"{''.join(items)}</div>"
    )


def legend_names(
    run: Run,
    overlay: Overlay | None = None,
    pins: Sequence[Pinned] = (),
    envelope: Envelope | None = None,
) -> list[str]:
    """Texts of `legend_html`, from which its height follows."""
    names = [method.method.name for method in run.methods]
    if overlay is not None:
        names.append("full strapdown of an earlier scenario")
    names += [pin.label for pin in pinned_methods(pins)]
    # with the longest words: the plots keep their height while the band is an old one
    return names if envelope is None else [*names, replace(envelope, old=True).label]


def css_dash(dash: Dash, color: str) -> str:
    """Style of a short bar that shows a dash pattern."""
    ends = [0, *accumulate(dash)]
    shades = (color if place % 2 == 0 else "transparent" for place in range(len(dash)))
    stops = (f"{shade} {start}px {end}px" for shade, start, end in zip(shades, ends, ends[1:], strict=False))
    return f"height:2px;background:repeating-linear-gradient(90deg,{','.join(stops)})"


def _legend_item(name: str, bar: str, title: str = "") -> str:
    more = f' title="{escape(title)}"' if title else ""
    return f'<span class="sb-entry"{more}><span class="sb-line" style="{bar}"></span>{escape(name)}</span>'
