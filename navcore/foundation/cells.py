"""Cells of a CSV file as programs for tables take them: no text is carried out as a formula."""

import math
from typing import Any

_BEGIN_A_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n", "＝", "＋", "－", "＠")
"""First characters, with the full-width forms that some programs take for them."""


def safe_cell(cell: Any) -> Any:
    """Return a cell as it may be written.

    Parameters
    ----------
    cell : object
        A text, a number, or what else `csv.writer` takes.

    Returns
    -------
    object
        A text that a program for tables would carry out as a formula gets an apostrophe before it. A number
        keeps all its digits; one that is not finite is an empty cell.

    Examples
    --------
    >>> safe_cell("=1+1"), safe_cell("bridge"), safe_cell(-0.5), safe_cell(math.nan)
    ("'=1+1", 'bridge', '-0.5', '')
    """
    if isinstance(cell, float):
        return repr(cell) if math.isfinite(cell) else ""
    if isinstance(cell, str) and cell.lstrip(" ").startswith(_BEGIN_A_FORMULA):
        return f"'{cell}"
    return cell
