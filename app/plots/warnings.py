"""Warnings about each method of a run, in plain words."""

from __future__ import annotations

from typing import Literal

from navcore.engine.run import Run

Severity = Literal["error", "warning"]


def warnings_for(run: Run) -> dict[int, list[str]]:
    """Warnings of each method that has any: place in the scenario -> texts, an early end first."""
    texts = ((method.reason, *method.warnings) for method in run.methods)
    lists = (list(dict.fromkeys(text for text in own if text)) for own in texts)
    return {index: own for index, own in enumerate(lists) if own}


def severity(run: Run, index: int) -> Severity | None:
    """How serious a method's warnings are: an unstable or diverged one is an error; None without warnings."""
    method = run.methods[index]
    if not method.loop.stable or method.status == "diverged":
        return "error"
    return "warning" if method.warnings or method.reason else None
