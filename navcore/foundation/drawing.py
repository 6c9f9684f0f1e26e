"""Figures are drawn by the functions of the page, which are loaded when the first one is asked for.

This is the only place where navcore asks for anything of the page, and nothing of navcore needs it to run.
"""

from importlib import import_module
from typing import Any

_PAGE = "app.notebook"


def drawn(what: str, subject: Any, *given: Any, **options: Any) -> Any:
    """Return a `plotly.graph_objects.Figure` of a run, a network or a budget, by a function of the page."""
    return getattr(import_module(_PAGE), what)(subject, *given, **options)
