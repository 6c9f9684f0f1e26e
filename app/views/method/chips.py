"""The methods as chips: colour, name and eye of each; a menu at the one that the controls edit."""

from collections.abc import Mapping, Sequence
from functools import lru_cache

from navcore.foundation.text import Text
from schuler_bench.plots import style
from schuler_bench.plots.table import cell
from schuler_bench.shell.palette import COPY_METHOD, PASTE

ADD, COPY, REMOVE = "method-add", "method-copy", "method-remove"
SELECT, EYE, RENAME = "method-select", "method-eye", "method-rename"
"""Commands: the last three with a number of a method, or a name."""
_MENU = {
    COPY: Text("copy"),
    REMOVE: Text("remove"),
    COPY_METHOD: Text("copy as TOML"),
    PASTE: Text("paste TOML"),
}
_ADD = {
    "title": Text("Add a method: all run on the same truth, sensors and log"),
    "aria_label": Text("Add a method"),
    "data_command": ADD,
}
_OPEN, _CLOSED = (
    "M1 8q7-10 14 0q-7 10-14 0M8 6a2 2 0 1 0 0 4a2 2 0 1 0 0-4",
    "M1 7q7 8 14 0M3 10l-1 2M8 11v2M13 10l1 2",
)
"""Paths of the eye: its curves are shown, and hidden."""


def chips_html(names: Mapping[str, int], chosen: int, hidden: Sequence[bool], *, arranging: bool) -> str:
    """Return the row of chips.

    Parameters
    ----------
    names : mapping of str to int
        Of the methods, with the places of their colours.
    chosen : int
        Method that the controls edit.
    hidden : sequence of bool
        Whether the curves of each are hidden.
    arranging : bool
        Methods can be added, and the chosen one has a menu.
    """
    chips = [
        _chip(at, name, style.method_color(place), at == chosen, hidden[at], arranging)
        for at, (name, place) in enumerate(names.items())
    ]
    if arranging:
        chips.append(cell("+", "sb-chip sb-plus", tag="button", **_ADD))
    return Text(
        '<div class="sb-chips" role="group" aria-label="methods">{chips}</div>', chips=Text.joined("", chips)
    )


@lru_cache(maxsize=256)
def _chip(place: int, name: str, color: str, chosen: bool, hidden: bool, arranging: bool) -> str:
    eye = Text("Show {name}", name=name) if hidden else Text("Hide {name}", name=name)
    return Text(
        '<div class="sb-chip" data-chosen="{chosen}" data-hidden="{hidden}"><button aria-pressed="{chosen}" '
        'title="The controls below belong to this method." data-command="{select} {place}">'
        '<i style="background:{color}"></i><span>{name:html}</span></button>'
        '<button class="sb-eye" title="{eye:html}" aria-label="{eye:html}" '
        'data-command="{ask} {place}"><svg viewBox="0 0 16 16" aria-hidden="true"><path d="{path}"/></svg>'
        "</button>{menu}</div>",
        hidden=str(hidden).lower(),
        chosen=str(chosen).lower(),
        select=SELECT,
        ask=EYE,
        place=place,
        color=color,
        name=name,
        eye=eye,
        path=_CLOSED if hidden else _OPEN,
        menu=_menu(name) if chosen and arranging else "",
    )


def _menu(name: str) -> str:
    buttons = (cell(words, "sb-do", tag="button", data_command=ask) for ask, words in _MENU.items())
    title = Text("Copy, remove or rename {name}", name=name)
    return Text(
        '<details class="sb-menu"><summary title="{title:html}" aria-label="{title:html}">⋯</summary><div>'
        '<label><span>name</span><input class="sb-rename" value="{name:html}" '
        'title="Empty: a name is made from the network."></label>{buttons}</div></details>',
        title=title,
        name=name,
        buttons=Text.joined("", buttons),
    )
