"""Table of every numbered item of the papers: what it is, and where it is here."""

import re
import tomllib
from pathlib import Path
from typing import Any

from navcore.foundation.markdown import markdown_table
from navcore.foundation.notation import in_symbols

FILE = Path(__file__).with_name("items.toml")
HEAD = """\
<a id="items"></a>

## Every item of the papers: where it is here

Each numbered equation, figure and table has a row, and so has each statement of the text that is an item of
its own. *None* begins what is not here, with the reason. A tab in
italics belongs to the page; its tab *Misprints* is the misprint laboratory.
"""
_LINK = re.compile(r"\b([trp]):([\w-]+)")


def items() -> list[dict[str, Any]]:
    """Papers with their numbers of equations, figures and tables, and their rows, as in the file."""
    return list(tomllib.loads(FILE.read_text("utf-8")).values())


def items_text() -> str:
    """Section of the report."""
    rows = [item_row(paper["name"], *row) for paper in items() for row in paper["rows"]]
    return f"{HEAD}\n{markdown_table(('paper', 'item', 'what it is', 'where it is here'), rows)}\n"


def item_row(paper: str, item: str, what: str, where: str) -> tuple[str, ...]:
    """Cells of an item."""
    return (paper, item, in_symbols(what), where_text(in_symbols(where)))


def where_text(where: str) -> str:
    """Text of a place with its links written out.

    Examples
    --------
    >>> where_text("`compass` (t:3-1), r:misprints, p:zha-fast")
    '`compass` ([theory 3.1](theory.md#s-3-1)), [report](#misprints), preset `zha-fast`'
    """
    return _LINK.sub(_link, where).replace("None:", "**None:**")


def _link(found: re.Match[str]) -> str:
    kind, name = found.groups()
    if kind == "t":
        return f"[theory {name.replace('-', '.')}](theory.md#s-{name})"
    return f"[report](#{name})" if kind == "r" else f"preset `{name}`"
