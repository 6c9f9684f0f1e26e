"""Where a scenario comes from: its source, as long as it is what the source describes."""

from functools import lru_cache
from typing import Any

from navcore.foundation.text import Text
from navcore.scenario.file import load, presets
from navcore.scenario.model import Scenario

_NAMING = ("title", "source", "view")
"""Blocks that change nothing of what is computed."""


def source_of(scenario: Scenario) -> str:
    """Source of a scenario in words; where it began as a preset and was changed, in how many fields.

    The title says which preset it began as: a copy keeps it.

    Examples
    --------
    >>> from navcore import load
    >>> source_of(load("liu-step"))
    'Liu 2021, fig. 7'
    >>> source_of(load("liu-step", ["run.duration_h=3", "site.lat_deg=10"]))
    'changed in 2 fields from liu-step (Liu 2021, fig. 7)'
    """
    name = _preset_of(scenario.title, scenario.source) if scenario.source else ""
    count = _differing(_canonical(name), scenario.canonical()) if name else 0
    if count == 0:
        return scenario.source
    return Text.plural(
        "changed in {count} field from {name} ({source})",
        "changed in {count} fields from {name} ({source})",
        count=count,
        name=name,
        source=scenario.source,
    )


@lru_cache(maxsize=64)
def _preset_of(title: str, source: str) -> str:
    """Name of the preset with this title and source; "" for none. Only a file with the title is parsed."""
    texts = ((name, path.read_text(encoding="utf-8")) for name, path in presets().items())
    found = (name for name, text in texts if title and title in text)
    return next((name for name in found if (one := load(name)).title == title and one.source == source), "")


@lru_cache(maxsize=64)
def _canonical(name: str) -> dict[str, Any]:
    return load(name).canonical()


def _differing(before: Any, after: Any) -> int:
    """Count the values in which two documents differ; a block that one of them lacks counts by its values."""
    if before == after:
        return 0
    if isinstance(before, dict) or isinstance(after, dict):
        old, new = (value if isinstance(value, dict) else {} for value in (before, after))
        return sum(_differing(old.get(key), new.get(key)) for key in {*old, *new} - {*_NAMING})
    lists = [value for value in (before, after) if isinstance(value, list) and value]
    blocks = any(isinstance(value[0], dict) for value in lists)
    if blocks:
        old, new = (value if isinstance(value, list) else [] for value in (before, after))
        longest = max(len(old), len(new))
        padded = ([*value, *[None] * (longest - len(value))] for value in (old, new))
        return sum(_differing(one, other) for one, other in zip(*padded, strict=True))
    return 1
