"""Views that may fill a window alone, for a frame in another page: their names in an address."""

from __future__ import annotations

import json
from collections.abc import Sequence
from html import escape

from app.shell.view import View


def view_names(kinds: Sequence[type[View]]) -> dict[str, str]:
    """Names for ``?view=`` -> titles of the tabs of results; "" for what stands beside the tabs.

    A scenario's block ``view`` uses the same names for the tabs.
    """
    results = [kind for kind in kinds if kind.place in ("upper", "lower")]
    beside = [name for kind in kinds for name in kind.alone]
    return {kind.focus or kind.title.lower(): kind.title for kind in results} | dict.fromkeys(beside, "")


def views_element(kinds: Sequence[type[View]]) -> str:
    """HTML that tells the page's script these names."""
    return f'<div id="sb-views" hidden data-names="{escape(json.dumps(view_names(kinds)))}"></div>'
