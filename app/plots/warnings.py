"""What the user should know about each method and about the run, in plain words."""

from __future__ import annotations

from typing import Literal

from navcore.engine.run import Run

Severity = Literal["error", "warning"]


def warnings_for(run: Run) -> dict[int, list[str]]:
    """Warnings of each method that has any: place in the scenario -> texts, an early end first."""
    found: dict[int, list[str]] = {}
    for index, method in enumerate(run.methods):
        texts = list(dict.fromkeys(text for text in (method.reason, *method.warnings) if text))
        if texts:
            found[index] = texts
    return found


def notices_for(run: Run) -> list[str]:
    """Notices about the scenario as a whole, recorded data for example."""
    return list(dict.fromkeys(run.warnings))


def severity(run: Run, index: int) -> Severity | None:
    """How serious a method's warnings are: an unstable or diverged one is an error; None without warnings."""
    method = run.methods[index]
    if not method.loop.stable or method.status == "diverged":
        return "error"
    return "warning" if method.warnings or method.reason else None
