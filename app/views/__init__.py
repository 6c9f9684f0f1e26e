"""Views: one folder a tab or view, with its figure, its widgets, its scripts and styles.

A folder is registered by one line in `VIEWS`. Its module ``view`` names the class in ``VIEW`` (a
`schuler_bench.shell.view.View`); ``*.js`` and ``*.css`` in the folder are given to the browser.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from schuler_bench.shell.view import View

VIEWS: tuple[str, ...] = (
    "schuler_bench.views.scene",
    "schuler_bench.views.strip",
    "schuler_bench.views.start",
    "schuler_bench.views.verification",
    "schuler_bench.views.explain",
    "schuler_bench.views.method",
    "schuler_bench.views.sensors",
    "schuler_bench.views.log",
    "schuler_bench.views.run",
    "schuler_bench.views.motion",
    "schuler_bench.views.files",
    "schuler_bench.views.appearance",
    "schuler_bench.views.learn",
    "schuler_bench.views.frequency",
    "schuler_bench.views.poles",
    "schuler_bench.views.step",
    "schuler_bench.views.diagram",
    "schuler_bench.views.errors",
    "schuler_bench.views.spectrum",
    "schuler_bench.views.switching",
    "schuler_bench.views.metrics",
    "schuler_bench.views.requirements",
    "schuler_bench.views.design",
    "schuler_bench.views.tune",
    "schuler_bench.views.compare",
    "schuler_bench.views.sweep",
    "schuler_bench.views.study",
    "schuler_bench.views.ask",
    "schuler_bench.views.misprints",
    "schuler_bench.views.scenario_text",
)
"""Packages of the views, in the order of their tabs."""


def load(names: Sequence[str] = VIEWS) -> tuple[type[View], ...]:
    """Import registered views.

    Imports viser and all that the page needs: the server starts without it.

    Raises
    ------
    TypeError
        A folder's ``VIEW`` is no view.
    """
    from schuler_bench.shell.view import View

    kinds = tuple(import_module(f"{name}.view").VIEW for name in names)
    for name, kind in zip(names, kinds, strict=True):
        if not (isinstance(kind, type) and issubclass(kind, View)):
            raise TypeError(f"{name}.view.VIEW is no view: {kind!r}")
    return kinds


def scripts(names: Sequence[str] = VIEWS) -> list[Path]:
    """Scripts of registered views; imports none of them."""
    return [path for name in names for path in sorted(_folder(name).glob("*.js"))]


def _folder(name: str) -> Path:
    spec = find_spec(name)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"{name} is no package")
    return Path(spec.origin).parent
