"""Under the metrics: which error source and which period dominate each method's result, in words."""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING

from app.plots import style
from app.plots.units import duration
from navcore.design.dominance import HEADING, POSITION, TILT
from navcore.foundation.text import Text

if TYPE_CHECKING:
    from app.jobs.why import Explainer
    from navcore.design.dominance import Cause, Why
    from navcore.engine.run import Run

_WAITS = "What dominates this result is computed once the controls rest."


def why_html(explainer: Explainer, run: Run, selected: int = 0, *, folded: bool = False) -> str:
    """A line for each method; a mark while it is of an earlier run.

    Parameters
    ----------
    explainer : Explainer
        Of the session.
    run : Run
        That is shown.
    selected : int
        Method that ``folded`` tells about.
    folded : bool
        One line in the place of all, which opens: there is little room.
    """
    result, fits = explainer.result, explainer.asked is run
    if fits and result is not None:
        name, causes = result.methods[min(selected, len(result.methods) - 1)]
        return _box(_lines(result), "", f"{name}: {_told(causes, result)}", folded=folded)
    if explainer.words:
        return _box("", "What dominates this result could not be found.", "", folded=folded)
    state = _WAITS
    if explainer.fraction is not None:
        state = Text(
            "Computing what dominates this result: {fraction:.0f} %.", fraction=100.0 * explainer.fraction
        )
    if result is None or len(result.methods) != len(run.methods):
        return _box("", state, "", folded=folded)
    old = f'<div class="sb-old">{_lines(result)}</div>'
    return _box(old, Text("{state} Below: of an earlier run.", state=state), "", folded=folded)


def _box(lines: str, state: str, short: str, *, folded: bool) -> str:
    status = f'<span role="status" class="sb-muted">{escape(state)}</span>' if state else ""
    which = f'id="sb-why" data-fits="{int(not state)}"'
    if not folded:
        return f"<div {which}><b>Why</b> {status}{lines}</div>"
    return f"<details {which}><summary><b>Why</b> {status}{escape(short)}</summary>{lines}</details>"


def _words(causes: tuple[Cause, ...], result: Why, *quantities: str) -> str:
    return "; ".join(cause_text(cause, result) for cause in causes if cause.quantity in quantities)


def _told(causes: tuple[Cause, ...], result: Why) -> str:
    """Position and tilt in words; the heading stands in the tooltip."""
    return _words(causes, result, POSITION, TILT) or "neither position error nor tilt"


def _lines(result: Why) -> str:
    rows = "".join(
        f'<div title="{escape(_words(causes, result, HEADING))}"><span class="sb-swatch" style="background:'
        f'{style.method_color(index)}"></span><b>{escape(name)}</b>: {escape(_told(causes, result))}.</div>'
        for index, (name, causes) in enumerate(result.methods)
    )
    return rows + "".join(f'<div class="sb-muted">{escape(text)}</div>' for text in result.remarks)


def cause_text(cause: Cause, result: Why) -> str:
    """One cause in words.

    Such as "position error mostly (83 %) from log bias, as a constant".
    """
    period = _period(cause, result)
    if not cause.source:
        return f"{cause.quantity} {period}"
    if cause.share > 0.995:
        return Text(
            "{quantity} all from {source}, {period}",
            quantity=cause.quantity,
            source=cause.source,
            period=period,
        )
    percent = f"{100.0 * cause.share:.0f}"
    if cause.share >= 0.5:
        return Text(
            "{quantity} mostly ({percent} %) from {source}, {period}",
            quantity=cause.quantity,
            percent=percent,
            source=cause.source,
            period=period,
        )
    return Text(
        "{quantity} most of all ({percent} %) from {source}, {period}",
        quantity=cause.quantity,
        percent=percent,
        source=cause.source,
        period=period,
    )


def _period(cause: Cause, result: Why) -> str:
    largest = cause.swing.largest
    if largest == "schuler":
        beat = ""
        if cause.swing.beats and math.isfinite(result.foucault_s):
            beat = Text(", beating (Foucault {foucault_s})", foucault_s=duration(result.foucault_s))
        return Text(
            "at the Schuler period ({schuler_s}){beat}", schuler_s=duration(result.schuler_s), beat=beat
        )
    return {
        "constant": "as a constant",
        "drift": "as a slow drift",
        "earth": "at the 24 h period",
        "other": "without a natural period",
    }[largest]
