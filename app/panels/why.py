"""Under the metrics: which error source and which period dominate each method's result, in words."""

from __future__ import annotations

import math
from html import escape
from typing import TYPE_CHECKING

from app.figures import style
from app.figures.units import duration

if TYPE_CHECKING:
    from app.why import Explainer
    from navcore.dominance import Cause, Why
    from navcore.run import Run

_WAITS = "What dominates this result is looked for as soon as it stands still."


def why_html(explainer: Explainer, run: Run) -> str:
    """A line for each method; a mark while it is of an earlier run."""
    result, fits = explainer.result, explainer.fits(run)
    if fits and result is not None:
        return _box(_lines(result, run), "")
    if explainer.failed:
        return _box("", "What dominates this result could not be found.")
    if explainer.fraction is not None:
        told = f"Running the error sources apart: {100.0 * explainer.fraction:.0f} %"
    else:
        told = _WAITS
    old = _lines(result, run) if result is not None and len(result.methods) == len(run.methods) else ""
    return _box(
        f'<div class="sb-old">{old}</div>' if old else "",
        f"{told} Below: of an earlier run." if old else told,
    )


def _box(lines: str, state: str) -> str:
    told = f'<div role="status" style="color:{style.MUTED}">{escape(state)}</div>' if state else ""
    return (
        f'<div id="sb-why" data-fits="{int(not state)}" style="margin:2px 10px 8px;font-size:12.5px;'
        f'line-height:1.4;color:{style.INK}"><b>Why</b> {told}{lines}</div>'
    )


def _lines(result: Why, run: Run) -> str:
    rows = []
    for index, (name, causes) in enumerate(result.methods):
        words = "; ".join(cause_text(cause, result) for cause in causes) or "no error at all"
        rows.append(
            f'<div><span style="display:inline-block;width:14px;height:4px;border-radius:2px;'
            f'margin-right:6px;vertical-align:middle;background:{style.method_color(index)}"></span>'
            f"<b>{escape(name)}</b>: {escape(words)}.</div>"
        )
    remarks = "".join(f'<div style="color:{style.MUTED}">{escape(text)}</div>' for text in result.remarks)
    return "".join(rows) + remarks


def cause_text(cause: Cause, result: Why) -> str:
    """One cause in words.

    Such as "position error mostly (83 %) from log bias, as a constant".
    """
    source = ""
    if cause.source:
        how = "all" if cause.share > 0.995 else "mostly" if cause.share >= 0.5 else "most of all"
        part = "" if cause.share > 0.995 else f" ({100.0 * cause.share:.0f} %)"
        source = f" {how}{part} from {cause.source},"
    return f"{cause.quantity}{source} {_period(cause, result)}"


def _period(cause: Cause, result: Why) -> str:
    largest = cause.swing.largest
    if largest == "schuler":
        beat = ""
        if cause.swing.beats and math.isfinite(result.foucault_s):
            beat = f", coming and going with the Foucault period ({duration(result.foucault_s)})"
        return f"at the Schuler period ({duration(result.schuler_s)}){beat}"
    return {
        "constant": "as a constant",
        "drift": "as a slow drift",
        "earth": "at the 24 h period",
        "other": "without a natural period (transient, noise or manoeuvres)",
    }[largest]
