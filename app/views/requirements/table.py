"""The table of verdicts: what each requirement asks, what each method measures, and whether it is met."""

from __future__ import annotations

import math
from collections.abc import Sequence
from html import escape

from app.plots import style
from app.plots.pinned import Pinned, pinned_methods, together
from app.plots.units import number, rounded
from app.session.requirements import Requirements, Verdict, sign_of, verdicts
from navcore.engine.run import Run
from navcore.foundation.parameters import extra_of

PASSED, FAILED = style.PASSED, style.DANGER
_DIGITS = 4


def requirements_html(
    run: Run,
    requirements: Requirements,
    pins: Sequence[Pinned] = (),
    methods: Sequence[int] | None = None,
) -> str:
    """Return a row a requirement and a column a method: measured value, and whether it meets the limit.

    Parameters
    ----------
    run : Run
        Result.
    requirements : Requirements
        Limits.
    pins : sequence of Pinned
        Runs that are judged beside it.
    methods : sequence of int, optional
        Places of the columns to show, the run's methods first; all when None.
    """
    judged = together(run, pins)
    shown = range(len(judged.methods)) if methods is None else methods
    found = verdicts(judged, requirements)
    lines = [f"solid {style.method_color(i)}" for i in range(len(run.methods))]
    lines += [f"dashed {pinned.color}" for pinned in pinned_methods(pins)]
    head = "".join(
        f'<th style="{_HEAD};border-bottom:3px {lines[i]}">{escape(judged.methods[i].method.name)}</th>'
        for i in shown
    )
    asked = any(verdict.limit is not None for verdict in found)
    body = "".join(_row(verdict, shown, asked=asked) for verdict in found)
    foot = "".join(f'<td style="{_CELL}">{_overall(found, i)}</td>' for i in shown)
    return (
        f'<div style="overflow-x:auto"><table style="{_TABLE}"><thead><tr>'
        f'<th style="{_LEFT}">requirement</th><th style="{_CELL}">limit</th>{head}</tr></thead>'
        f'<tbody>{body}<tr style="{_LINE}"><td style="{_LEFT};font-weight:600">all together</td><td></td>'
        f"{foot}</tr></tbody></table></div>"
    )


def _row(verdict: Verdict, shown: Sequence[int], *, asked: bool) -> str:
    info = Requirements.model_fields[verdict.name]
    extra = extra_of(info)
    unit = f' <span style="color:{style.MUTED}">({escape(extra["unit"])})</span>' if extra["unit"] else ""
    limit = (
        "no limit" if verdict.limit is None else f"{sign_of(verdict.name)} {number(verdict.limit, _DIGITS)}"
    )
    cells = "".join(
        f'<td data-measure="{verdict.name}" data-value="{_number(value)}" data-passed="{_word(verdict, ok)}" '
        f'style="{_CELL}">{_measured(value)}{_mark(verdict, ok) if asked else ""}</td>'
        for value, ok in ((verdict.measured[i], verdict.passed[i]) for i in shown)
    )
    return (
        f'<tr style="{_LINE}" title="{escape(info.description or "")}"><td style="{_LEFT}">'
        f'{escape(extra["label"])}{unit}</td><td style="{_CELL}">{limit}</td>{cells}</tr>'
    )


def _number(value: float) -> str:
    """Value as the page's scripts read it."""
    return f"{value:.9g}" if math.isfinite(value) else "Infinity"


def _measured(value: float) -> str:
    return "never" if math.isinf(value) else rounded(value)


def _word(verdict: Verdict, passed: bool) -> str:
    return "" if verdict.limit is None else "met" if passed else "missed"


def _mark(verdict: Verdict, passed: bool) -> str:
    """Word beside the value, of one width, so that the values stand below each other."""
    word = "" if verdict.limit is None else _badge("✓ met", PASSED) if passed else _badge("✗ missed", FAILED)
    place = "display:inline-block;width:5.6em;padding-left:8px;text-align:left"
    return f'<span class="sb-word" style="{place}">{word}</span>'


def _overall(found: tuple[Verdict, ...], index: int) -> str:
    asked = [verdict for verdict in found if verdict.limit is not None]
    if not asked:
        return f'<span style="color:{style.MUTED}">nothing asked</span>'
    missed = sum(not verdict.passed[index] for verdict in asked)
    if missed:
        return _badge(f"✗ misses {missed} of {len(asked)}", FAILED)
    return _badge(f"✓ meets {'it' if len(asked) == 1 else f'all {len(asked)}'}", PASSED)


def _badge(text: str, color: str) -> str:
    return f'<span style="color:{color};font-weight:600;white-space:nowrap">{text}</span>'


_TABLE = (
    f"border-collapse:collapse;font-size:{style.FONT_SIZE}px;color:{style.INK};width:100%;"
    "font-variant-numeric:tabular-nums;line-height:1.6"
)
_HEAD = "text-align:center;padding:2px 8px;font-weight:600"
_CELL = "text-align:right;padding:1px 8px;white-space:nowrap;font-weight:400"
_LEFT = "text-align:left;padding:1px 8px 1px 2px;white-space:nowrap;font-weight:400"
_LINE = f"border-top:1px solid {style.GRID}"
