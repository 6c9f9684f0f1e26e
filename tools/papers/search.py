"""A search over the settings that a paper does not print, for one that meets all claims of an exhibit."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from tools.papers.estimate import number
from tools.papers.runs import Runs

Span = tuple[float, float]
Found = Mapping[str, Sequence[float]]
"""Our number for each claim of a search, by the name of the setting; NaN: the setting has none (diverged)."""


@dataclass(frozen=True)
class Search:
    """Settings that are tried, and what each gives.

    Attributes
    ----------
    varied : str
        What is varied, within which ranges, and with how many seeds.
    claims : tuple of int
        Numbers of the claims whose numbers are looked at, from 1; the others do not depend on the settings.
    tried : callable
        Our numbers of these claims with each setting, means over the seeds.
    """

    varied: str
    claims: tuple[int, ...]
    tried: Callable[[Runs], Found]


@dataclass(frozen=True)
class Outcome:
    """Which settings meet which claims.

    Attributes
    ----------
    names : tuple of str
        Settings.
    claims : tuple of int
        Numbers of the claims.
    values, met : ndarray, shape (settings, claims)
        Our numbers, and whether they lie in the ranges.
    """

    names: tuple[str, ...]
    claims: tuple[int, ...]
    values: np.ndarray
    met: np.ndarray

    @property
    def possible(self) -> tuple[str, ...]:
        """Settings that meet all claims."""
        return tuple(name for name, row in zip(self.names, self.met, strict=True) if row.all())

    def meeting(self, columns: Sequence[int]) -> list[int]:
        """Settings that meet the claims of some columns."""
        return [int(i) for i in np.flatnonzero(self.met[:, list(columns)].all(axis=1))]


def outcome(search: Search, agreed: Sequence[Span], runs: Runs) -> Outcome:
    """Carry a search out against the ranges of its claims."""
    found = search.tried(runs)
    values = np.array([found[name] for name in found], dtype=float)
    low, high = np.array(agreed).T
    return Outcome(tuple(found), search.claims, values, (values >= low) & (values <= high))


def verdict(found: Outcome) -> str:
    """Say in words what the search found: the setting, or which claims exclude each other."""
    count = len(found.names)
    if found.possible:
        return f"Possible with {_some(found, range(len(found.claims)))}: {_all(found.claims)} met."
    sentences = []
    columns = range(len(found.claims))
    never = [k for k in columns if not found.met[:, k].any()]
    for k in never:
        least, most = np.nanmin(found.values[:, k]), np.nanmax(found.values[:, k])
        ours = f"ours from {number(float(least))} to {number(float(most))}"
        sentences.append(f"No setting of {count} tried meets claim {found.claims[k]} ({ours}).")
    rest = [k for k in columns if k not in never]
    if rest:
        sentences += _rest(found, rest)
    return " ".join(sentences)


def _rest(found: Outcome, rest: list[int]) -> list[str]:
    """Sentences on the claims that some setting meets."""
    if found.meeting(rest):
        alone = "It stands" if len(found.claims) - len(rest) == 1 else "They stand"
        return [f"{alone} alone: {_all([found.claims[k] for k in rest])} met by {_some(found, rest)}."]
    sentences = []
    for size in range(2, len(rest) + 1):
        against = [group for group in combinations(rest, size) if not found.meeting(group)]
        if against:
            told = ", nor ".join(_joined([found.claims[k] for k in group]) for group in against[:4])
            sentences.append(f"No setting of {len(found.names)} tried meets claims {told} together.")
            break
    alone = [k for k in rest if found.meeting([other for other in rest if other != k])]
    for k in alone:
        by = _some(found, [other for other in rest if other != k])
        sentences.append(f"Claim {found.claims[k]} stands alone against the others, which are met by {by}.")
    if not alone:
        best = int(np.argmax(found.met.sum(axis=1)))
        met = [claim for claim, ok in zip(found.claims, found.met[best], strict=True) if ok]
        sentences.append(f"At most {_all(met)} met by one setting: {found.names[best]}.")
    return sentences


def _some(found: Outcome, columns: Sequence[int]) -> str:
    """The first setting that meets the claims of some columns, and how many there are."""
    those = found.meeting(columns)
    several = f" ({len(those)} of {len(found.names)} settings tried)"
    return f"{found.names[those[0]]}{several}"


def _all(claims: Sequence[int]) -> str:
    return f"claim {claims[0]} is" if len(claims) == 1 else f"claims {_joined(claims)} are"


def _joined(claims: Sequence[int]) -> str:
    """Text "2, 5 and 7"."""
    *first, last = (str(claim) for claim in claims)
    return f"{', '.join(first)} and {last}" if first else last
