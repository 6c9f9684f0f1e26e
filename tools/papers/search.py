"""A search over the settings that a paper does not print, for one that meets all claims of an exhibit.

A search declares its axes: what is varied, and the values of each. The settings are all their combinations,
and the text of the report is made from the same axes, so that it cannot name what is not varied. A setting is
judged as a claim is: by the confidence interval over the stated seeds.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations, product
from typing import Any

import numpy as np

from tools.papers.estimate import Estimate, estimate, number
from tools.papers.runs import Runs

Span = tuple[float, float]
Setting = Mapping[str, Any]
"""The value of each axis of a search, by the axis's name."""
Numbers = Sequence[float | np.ndarray | Estimate]
"""Our number for each claim of a search in one setting: as `Claim.ours` gives it."""


_MOST_SPELLED = 10
"""Values of an axis that the report lists one by one."""


@dataclass(frozen=True)
class Axis:
    """One thing that a search varies.

    Attributes
    ----------
    name : str
        What is varied: "standing error of the log".
    values : mapping of str to any
        What stands for each value in the text, and the value: ``{"0.5 m/s": 0.5}``.
    """

    name: str
    values: Mapping[str, Any] = field(hash=False)

    @property
    def text(self) -> str:
        """Name and values: "sigma: 0.03 1/s / 0.13 1/s"; of many values, how many, and the ends."""
        texts = list(self.values)
        if len(texts) > _MOST_SPELLED:
            return f"{self.name}: {len(texts)} values from {texts[0]} to {texts[-1]}"
        return f"{self.name}: {' / '.join(texts)}"


@dataclass(frozen=True)
class Search:
    """Settings that are tried, and what each gives.

    Attributes
    ----------
    axes : tuple of Axis
        What is varied. Each combination of their values is one setting.
    claims : tuple of int
        Numbers of the claims whose numbers are looked at, from 1; the others do not depend on the settings.
    at : callable
        Our numbers of these claims in one setting; None: there is no such setting.
    seeds : int
        Random seeds of a setting; 0: nothing is random.
    remark : str
        What else is to be said of the settings.
    """

    axes: tuple[Axis, ...]
    claims: tuple[int, ...]
    at: Callable[[Runs, Setting], Numbers | None]
    seeds: int = 0
    remark: str = ""

    @property
    def varied(self) -> str:
        """What is varied, as text."""
        seeds = f"; {self.seeds} seeds a setting" if self.seeds else ""
        remark = f" {self.remark}" if self.remark else ""
        return f"{'; '.join(axis.text for axis in self.axes)}{seeds}.{remark}"

    def settings(self) -> dict[str, Setting]:
        """All settings by their names."""
        found = {}
        for texts in product(*(axis.values for axis in self.axes)):
            pairs = list(zip(self.axes, texts, strict=True))
            name = ", ".join(f"{axis.name} {text}".strip() for axis, text in pairs)
            found[name] = {axis.name: axis.values[text] for axis, text in pairs}
        return found


@dataclass(frozen=True)
class Outcome:
    """Which settings meet which claims.

    Attributes
    ----------
    names : tuple of str
        Settings.
    claims : tuple of int
        Numbers of the claims.
    values : ndarray, shape (settings, claims)
        Our numbers; NaN: the setting has none (diverged).
    position : ndarray of int, shape (settings, claims)
        1: the whole interval lies in the range, -1: none of it does, 0: a part.
    idle : mapping of int to tuple of str
        For each claim, the axes on which its number does not depend.
    """

    names: tuple[str, ...]
    claims: tuple[int, ...]
    values: np.ndarray
    position: np.ndarray
    idle: Mapping[int, tuple[str, ...]] = field(default_factory=dict)

    @property
    def met(self) -> np.ndarray:
        """Whether a setting meets a claim, shape (settings, claims)."""
        return self.position > 0

    @property
    def possible(self) -> tuple[str, ...]:
        """Settings that meet all claims."""
        return tuple(name for name, row in zip(self.names, self.met, strict=True) if row.all())

    def meeting(self, columns: Sequence[int]) -> list[int]:
        """Settings that meet the claims of some columns."""
        return [int(i) for i in np.flatnonzero(self.met[:, list(columns)].all(axis=1))]


class IdleAxis(Exception):
    """A search names what moves none of its numbers."""


def outcome(search: Search, agreed: Sequence[Span], runs: Runs) -> Outcome:
    """Carry a search out against the ranges of its claims.

    Raises
    ------
    IdleAxis
        An axis moves no number: it is named, but not varied.
    ValueError
        A number has other seeds than the search states.
    """
    made = {name: search.at(runs, setting) for name, setting in search.settings().items()}
    found = {
        name: [estimate(value) for value in numbers] for name, numbers in made.items() if numbers is not None
    }
    for name, numbers in found.items():
        seeds = {one.seeds for one in numbers} - {1}
        if seeds - {search.seeds}:
            raise ValueError(f"{name}: {sorted(seeds)} seeds, must be {search.seeds}")
    values = np.array([[one.value for one in numbers] for numbers in found.values()])
    position = np.array(
        [
            [one.position(*span) for one, span in zip(numbers, agreed, strict=True)]
            for numbers in found.values()
        ]
    )
    return Outcome(tuple(found), search.claims, values, position, _idle(search, found))


def _idle(search: Search, found: Mapping[str, Sequence[Estimate]]) -> dict[int, tuple[str, ...]]:
    """For each claim the axes on which its number does not depend; raises when one moves no number."""
    texts = dict(zip(search.settings(), product(*(axis.values for axis in search.axes)), strict=True))
    idle: dict[int, tuple[str, ...]] = {claim: () for claim in search.claims}
    for k, axis in enumerate(search.axes):
        moved = set()
        for column, claim in enumerate(search.claims):
            groups: dict[tuple[str, ...], set[str]] = {}
            for name, numbers in found.items():
                others = texts[name][:k] + texts[name][k + 1 :]
                groups.setdefault(others, set()).add(f"{numbers[column].value:.9g}")
            if any(len(group - {"nan"}) > 1 for group in groups.values()):
                moved.add(claim)
            else:
                idle[claim] += (axis.name,)
        if not moved:
            raise IdleAxis(f"{axis.text}: no number depends on it")
    return idle


def verdict(found: Outcome) -> str:
    """Say in words what the search found: the setting, or which claims exclude each other."""
    return " ".join([_possible(found), *_idle_texts(found)])


def _idle_texts(found: Outcome) -> list[str]:
    """Which claims do not depend on which axes."""
    alike: dict[tuple[str, ...], list[int]] = {}
    for claim, axes in found.idle.items():
        if axes:
            alike.setdefault(axes, []).append(claim)
    return [
        f"{'Claim' if len(claims) == 1 else 'Claims'} {_joined(claims)} "
        f"{'does' if len(claims) == 1 else 'do'} not depend on {_joined(axes)}."
        for axes, claims in alike.items()
    ]


def _possible(found: Outcome) -> str:
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


def _joined(claims: Sequence[int | str]) -> str:
    """Text "2, 5 and 7"."""
    *first, last = (str(claim) for claim in claims)
    return f"{', '.join(first)} and {last}" if first else last
