"""Aligned text tables for people."""

import math
from collections.abc import Sequence


def columns(rows: Sequence[Sequence[str]], gap: str = "  ") -> list[str]:
    """Lay rows of equal length out in columns: the first left, the others right-aligned.

    Examples
    --------
    >>> columns([["method", "m/s"], ["free", "1.25"]])
    ['method   m/s', 'free    1.25']
    """
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]
    lines = []
    for first, *others in rows:
        cells = [first.ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(others, widths[1:], strict=True)]
        lines.append(gap.join(cells).rstrip())
    return lines


def number(value: float | None, digits: int = 4) -> str:
    """Write a number with so many significant digits; a dash where there is none.

    Examples
    --------
    >>> number(0.72691), number(12345.6), number(None), number(1.2e-7)
    ('0.7269', '12346', '-', '1.2e-07')
    """
    if value is None or not math.isfinite(value):
        return "-"
    if abs(value) >= 10.0**digits:
        return f"{value:.0f}" if abs(value) < 1e9 else f"{value:.{digits - 1}e}"
    return f"{value:.{digits}g}"
