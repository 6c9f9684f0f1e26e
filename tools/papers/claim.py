"""The parts of the report as data: a claim, a table, an exhibit (one figure or table of a paper), a paper."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from tools.papers.estimate import Estimate, number
from tools.papers.runs import Runs
from tools.papers.search import Search, Span

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Verdict = Literal["agrees", "agrees if", "differs", "undecided"]
"""Agrees: our number, or its whole confidence interval, lies in the range. Differs: none of it does.
Undecided: the interval reaches across an end of the range. Agrees if: it does not agree in the claim's own
setting, but it does in one of its readings."""
Kind = Literal["predicted", "fitted", "direction only", "own"]
"""Predicted: a number from the paper's settings alone. Fitted: a number that a setting of ours was fitted to.
Direction only: the paper states a relation, or its setting is too incomplete for more than one.
Own: the claim is ours."""
KINDS: tuple[Kind, ...] = ("predicted", "fitted", "direction only", "own")


def about(value: float, tolerance: float) -> Span:
    """From ``value`` less to ``value`` plus a relative tolerance."""
    reach = abs(value) * tolerance
    return value - reach, value + reach


def at_least(value: float) -> Span:
    """``value`` or more."""
    return value, math.inf


def at_most(value: float) -> Span:
    """``value`` or less, of either sign."""
    return -math.inf, value


def order_of(value: float, factor: float = 3.0) -> Span:
    """Same order of magnitude: between ``value / factor`` and ``value * factor``, > 0."""
    return value / factor, value * factor


@dataclass(frozen=True)
class Reading:
    """Another way to read a claim's number, or to fill in what is not printed; part of the claim's row.

    Where the claim itself does not agree and a reading does, the verdict is "agrees, if" with its name.

    Attributes
    ----------
    name : str
        The reading as it follows "if": "read as a variance".
    printed : str
        The paper's number in this reading.
    agreed : tuple of float
        Range of our number within which the two agree.
    ours : callable
        Our number in this reading, as `Claim.ours`.
    strapdown : bool
        Whether it is computed in the full strapdown where the claim is.
    """

    name: str
    printed: str
    agreed: Span
    ours: Callable[[Runs], float | np.ndarray | Estimate]
    strapdown: bool = True


@dataclass(frozen=True)
class Claim:
    """One statement of a paper and how it is checked.

    Attributes
    ----------
    says : str
        What the paper says, in words.
    quote : str
        The paper's own words, or its row of a table, letter by letter; " ... " stands where something is left
        out. A claim of kind "own" has none, and every other claim has one.
    printed : str
        Its number or relation as the paper gives it.
    agreed : tuple of float
        Range of our number within which the two agree; printed in the report.
    ours : callable
        Our number from the runs, in ``unit``; an array holds one number for each seed, and the verdict then
        goes by the 95 % confidence interval of their mean. Another statistic of the seeds is an `Estimate`.
    unit : str
        Unit of both numbers.
    kind : {"predicted", "fitted", "direction only", "own"}
        What the number is worth as evidence.
    strapdown : bool
        Whether the number is computed in the full strapdown as well; both must agree.
    why : str
        Why it differs. Empty when it agrees, be it in a reading: the report fails when this and the numbers
        contradict. May stand when the verdict is "undecided".
    note : str
        What should be known even when it agrees.
    facts : mapping of str to callable
        Numbers that ``why`` and ``note`` name in braces.
    digits : int
        Significant digits of our number; 0: it is a count, and printed whole.
    readings : tuple of Reading
        The other readings of the same statement. The claim itself has the one that fits the whole exhibit,
        and the exhibit's setting says why.
    """

    says: str
    printed: str
    agreed: Span
    ours: Callable[[Runs], float | np.ndarray | Estimate]
    unit: str = ""
    kind: Kind = "direction only"
    strapdown: bool = False
    why: str = ""
    note: str = ""
    facts: Mapping[str, Callable[[Runs], float]] = field(default_factory=dict)
    digits: int = 3
    readings: tuple[Reading, ...] = ()
    quote: str = ""

    def verdict(self, *found: Estimate) -> Verdict:
        """Agreement of all estimates with the range, without the readings."""
        positions = [one.position(*self.agreed) for one in found]
        if min(positions) < 0:
            return "differs"
        return "agrees" if min(positions) > 0 else "undecided"

    @property
    def allowed(self) -> str:
        """The range that counts as agreement, as text."""
        low, high = (number(value, self.digits) for value in self.agreed)
        if math.isinf(self.agreed[0]):
            return f"<= {high}"
        return f">= {low}" if math.isinf(self.agreed[1]) else f"{low} to {high}"


@dataclass(frozen=True)
class Table:
    """A table side by side with a paper's: head and rows of text."""

    caption: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Exhibit:
    """One figure or table of a paper.

    Attributes
    ----------
    name : str
        Anchor, and name of the picture's file.
    title : str
        "Figure 4: ...".
    presets : tuple of str
        Presets that show it; the runs behind the claims start from these.
    setting : str
        What is run, and what the paper leaves open and how it was filled in.
    claims : tuple of Claim
        The paper's statements.
    tables : tuple of callable
        Tables to print below.
    search : Search, optional
        Over the settings that the paper does not print; every exhibit with a claim that does not agree as it
        is has one.
    draw : callable, optional
        Draws the picture on a matplotlib figure.
    height : float
        Height of the picture, inches.
    """

    name: str
    title: str
    presets: tuple[str, ...]
    setting: str
    claims: tuple[Claim, ...] = ()
    tables: tuple[Callable[[Runs], Table], ...] = ()
    search: Search | None = None
    draw: Callable[[Runs, Figure], None] | None = field(default=None, repr=False)
    height: float = 3.2


@dataclass(frozen=True)
class Paper:
    """A paper: short name, full reference, its exhibits."""

    name: str
    reference: str
    exhibits: tuple[Exhibit, ...]


def quoted_parts(quote: str) -> tuple[str, ...]:
    """Parts of a quotation between what it leaves out."""
    return tuple(part for part in quote.split(" ... ") if part)
