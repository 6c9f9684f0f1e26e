"""How a number is known to be right: the ledger that `tools.ledger` makes from the tests."""

import json
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from navcore.foundation.assets import asset_path
from navcore.foundation.text import Text

Way = Literal["oracle", "twin", "golden", "none"]
WAYS: tuple[Way, ...] = ("oracle", "twin", "golden", "none")
"""The best first."""
WORDS: dict[Way, str] = {
    "oracle": Text("outside oracle"),
    "twin": Text("own twin"),
    "golden": Text("golden value"),
    "none": Text("no test of its value"),
}
MARKS: dict[Way, str] = {"oracle": "●", "twin": "◐", "golden": "○", "none": "·"}
"""Beside a number on the page."""
METHODS = ("free", "internal", "external", "averaging", "kalman", "whole", "gyrocompass")
"""Kinds of damping, and what holds the heading beside external damping."""
FIDELITIES = ("loop", "channel", "error_model", "strapdown", "covariance", "seeds")
"""Where a number is computed: of the loop, of a run, by covariance, or over seeds."""


@dataclass(frozen=True)
class Entry:
    """What one test shows.

    Attributes
    ----------
    by : {"oracle", "twin", "golden"}
        An outside oracle (published figure, closed form, another library), a slow program of our own in the
        tests, or what came out before.
    quantities, kinds, fidelities : tuple of str
        Of which quantities, kinds of damping and fidelities.
    source : str
        The oracle in words.
    """

    by: Way
    quantities: tuple[str, ...]
    kinds: tuple[str, ...]
    fidelities: tuple[str, ...]
    source: str


def best(entries: Iterable[Entry], key: str, kind: str = "", fidelity: str = "") -> Way:
    """Best way in which a quantity is known; of all kinds and fidelities where none is given."""
    ways: set[Way] = {
        one.by
        for one in entries
        if key in one.quantities
        and (not kind or kind in one.kinds)
        and (not fidelity or fidelity in one.fidelities)
    }
    for way in WAYS:
        if way in ways:
            return way
    return "none"


@lru_cache(maxsize=1)
def ledger() -> tuple[Entry, ...]:
    """Entries of the ledger."""
    entries = json.loads(asset_path("ledger.json").read_text("utf-8"))["entries"]
    return tuple(
        Entry(
            one["by"],
            tuple(one["quantities"]),
            tuple(one["kinds"]),
            tuple(one["fidelities"]),
            one["source"],
        )
        for one in entries
    )


def known(key: str, kind: str = "", fidelity: str = "") -> Way:
    """Best way in which a quantity is known by the ledger.

    Examples
    --------
    >>> known("position_cep50_m", "free", "seeds"), known("no_such")
    ('oracle', 'none')
    """
    return best(ledger(), key, kind, fidelity)


def sources(key: str) -> tuple[str, ...]:
    """Oracles by which a quantity is known, in words."""
    found = (one.source for one in ledger() if key in one.quantities and one.by == "oracle")
    return tuple(dict.fromkeys(found))
