"""Which tab each view stands in: the one place where titles of views are turned into tabs and modes.

A tab of the right column may hold several views, its modes, of which one is shown. A tab of the left column
shows all of its views below each other, as folds. A view of the menu (`schuler_bench.shell.view.MENU`) has a
tab only while it is in front. Everything that opens a view names it by its title: addresses, lessons, the
palette, a scenario's block ``view``, whoever presents. static/tabs.js finds its tab and mode from this.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

from schuler_bench.shell.view import MENU

if TYPE_CHECKING:
    from schuler_bench.shell.view import View


@dataclass(frozen=True)
class Standing:
    """Where a view is found on the page.

    Attributes
    ----------
    title : str
        Of the view.
    tab : str
        Title of its tab; "" for a view of the menu.
    mode : str
        Its name among the modes, or the folds, of its tab.
    fold : bool
        It is a fold of its tab, with others in sight; else a mode, or alone in it.
    """

    title: str
    tab: str
    mode: str
    fold: bool


def standings(kinds: Sequence[type[View]]) -> list[Standing]:
    """Where each registered view with a title stands, in the order of the registry."""
    titled = [kind for kind in kinds if kind.title]
    return [
        Standing(
            kind.title,
            "" if kind.tab == MENU else tab_of(kind),
            kind.mode or kind.title,
            kind.place == "edit" and tab_of(kind) != kind.title and kind.tab != MENU,
        )
        for kind in titled
    ]


def tab_of(kind: type[View]) -> str:
    """Title of the tab in which a view stands."""
    return kind.title if kind.tab in ("", MENU) else kind.tab


def tabs(kinds: Sequence[type[View]]) -> dict[str, list[Standing]]:
    """Tabs of the page, in the order of the registry, each with its views; without those of the menu."""
    found: dict[str, list[Standing]] = {}
    for one in standings(kinds):
        if one.tab:
            found.setdefault(one.tab, []).append(one)
    return found


def told(kinds: Sequence[type[View]]) -> list[dict[str, object]]:
    """What the page's scripts are told of it (static/tabs.js)."""
    return [asdict(one) for one in standings(kinds)]
