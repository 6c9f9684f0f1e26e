"""The style sheet of a page: that of the shell, those of its views, and that of the plots over time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from app.plots import style, table
from app.shell.view import View, styles_of

_STATIC = Path(__file__).parent / "static"


def page_styles(kinds: Sequence[type[View]], state_id: str, command_id: str) -> str:
    """CSS of a page with these views.

    Parameters
    ----------
    kinds : sequence of type
        The registered views.
    state_id, command_id : str
        Ids of the controls through which the page reports and asks.
    """
    css = "".join(
        (_STATIC / f"{name}.css").read_text(encoding="utf-8") for name in ("page", "commands", "touch")
    )
    css = css.replace("PAGE_STATE", state_id).replace("PAGE_COMMAND", command_id)
    return css + table.CSS + styles_of(kinds) + style.UPLOT_CSS
