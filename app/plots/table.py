"""Tables of the page and of its reports: cells as data, their look in table.css."""

from collections.abc import Iterable
from pathlib import Path

from navcore.foundation.text import Text

CSS = (Path(__file__).parent / "table.css").read_text(encoding="utf-8")
"""For the page, and for every file with tables, to add once."""


def cell(content: str = "", look: str = "", *, tag: str = "td", **attributes: object) -> str:
    """HTML of a cell, or of another element around a content.

    Parameters
    ----------
    content : str
        HTML.
    look : str
        Classes of table.css, such as ``sb-n`` for a number.
    tag : str
        ``th`` for a heading.
    **attributes
        Of the element, ``data_value`` for ``data-value``; None and "" are left out.
    """
    given = {
        name: value if isinstance(value, str) else str(value)
        for name, value in ({"class": look} | attributes).items()
        if value not in (None, "")
    }
    words = "".join(f' {name.replace("_", "-")}="{{{name}:html}}"' for name in given)
    return Text(f"<{tag}{words}>{{content}}</{tag}>", content=content, **given)


def row(cells: Iterable[str], look: str = "", **attributes: object) -> str:
    """HTML of a row; attributes as for `cell`."""
    return cell(Text.joined("", cells), look, tag="tr", **attributes)


def parts(count: int, most: int) -> list[range]:
    """Columns of the tables in which ``count`` of them stand, at most ``most`` abreast."""
    each = -(-count // -(-count // most))
    return [range(first, min(first + each, count)) for first in range(0, count, each)]


def table(head: Iterable[str], body: Iterable[str], look: str = "") -> str:
    """HTML of a table of rows, which scrolls where it is too wide; ``look``: more classes."""
    rows = Text(
        "<thead>{head}</thead><tbody>{body}</tbody>", head=Text.joined("", head), body=Text.joined("", body)
    )
    return cell(cell(rows, f"sb-t {look}".rstrip(), tag="table"), "sb-scroll", tag="div")
