"""Views: one folder a tab or view, with its figure, its widgets, its scripts and styles.

A folder is registered by one line in `VIEWS`. Its module ``view`` names the class in ``VIEW`` (a
`app.shell.view.View`); ``*.js`` and ``*.css`` in the folder are given to the browser.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.shell.view import View

VIEWS: tuple[str, ...] = (
    "app.views.scene",
    "app.views.start",
    "app.views.verification",
    "app.views.explain",
    "app.views.method",
    "app.views.sensors",
    "app.views.log",
    "app.views.run",
    "app.views.files",
    "app.views.appearance",
    "app.views.learn",
    "app.views.frequency",
    "app.views.poles",
    "app.views.step",
    "app.views.misprints",
    "app.views.errors",
    "app.views.switching",
    "app.views.metrics",
    "app.views.compare",
    "app.views.spectrum",
    "app.views.requirements",
    "app.views.design",
    "app.views.tune",
    "app.views.scenario_text",
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
    from app.shell.view import View

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
