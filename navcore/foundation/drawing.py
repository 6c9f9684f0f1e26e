"""Figures and tables for a notebook: made by the page and the commands, loaded when one is asked for.

This is the only place where navcore asks for anything of the page, and nothing of navcore needs it to run.
"""

from importlib import import_module
from typing import Any

_PAGE = "schuler_bench.notebook"
_PROGRAMS = "navcore.engine.handed_over"


def drawn(what: str, subject: Any, *given: Any, **options: Any) -> Any:
    """Return a `plotly.graph_objects.Figure` of a run, a network or a budget, or its tables as HTML."""
    return getattr(import_module(_PAGE), what)(subject, *given, **options)


def handed_over(what: str, subject: Any, *given: Any) -> Any:
    """Return a run as another program takes it, or write it into a file for one."""
    return getattr(import_module(_PROGRAMS), what)(subject, *given)
