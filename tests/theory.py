"""docs/theory.md as the tests read it: anchors, equations and tables."""

import re
from pathlib import Path

THEORY = Path(__file__).resolve().parent.parent / "docs" / "theory.md"
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?")


def text() -> str:
    """The page with a plain minus sign for the typographic one."""
    return THEORY.read_text("utf-8").replace("\u2212", "-")


def anchors(page: str) -> list[str]:
    """Explicit anchors of a Markdown page, in order."""
    return re.findall(r'<a id="([^"]+)"></a>', page)


def sections(page: str) -> list[str]:
    """Numbers of the numbered headings, such as 3 and 3.1, in order."""
    return re.findall(r"^#{2,3} (\d+(?:\.\d+)?) ", page, re.MULTILINE)


def numbers(text: str) -> list[float]:
    """All numbers of a table cell."""
    return [float(found) for found in _NUMBER.findall(text)]


def table(anchor: str, which: int = 0) -> dict[str, list[str]]:
    """Rows of a table below an anchor: the first cell, and the others.

    Parameters
    ----------
    anchor : str
        Explicit anchor somewhere above the table.
    which : int
        How many tables to skip.
    """
    below = text().split(f'<a id="{anchor}"></a>', 1)[1]
    found = re.findall(r"(?:^\|.*\n)+", below, re.MULTILINE)[which]
    rows = [[cell.strip() for cell in line.strip("|\n").split("|")] for line in found.splitlines()[2:]]
    return {row[0]: row[1:] for row in rows}
