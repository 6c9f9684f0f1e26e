"""Files of the worst logs: for each method and error a log, and a scenario that plays it."""

from __future__ import annotations

import re
from collections.abc import Iterator

from navcore.design.ship import Ship
from navcore.design.worst.played import log_file, playing, silent
from navcore.design.worst.result import FILE_KEYS, Worst
from navcore.engine.environment import start_utc
from navcore.quantities import COMPONENTS, ERRORS
from navcore.scenario.file import to_toml
from navcore.scenario.model import Scenario

_ODD = re.compile(r"[^a-z0-9]+")


def _stems(scenario: Scenario) -> list[str]:
    """Begin of the names of each method's files."""
    plain = [_ODD.sub("-", method.name.lower()).strip("-") or "method" for method in scenario.method]
    return [f"{place + 1}-{name}" for place, name in enumerate(plain)]


def names_of(scenario: Scenario) -> list[str]:
    """Names of all files that `files_of` can give."""
    return [
        f"{stem}-{key}.{kind}" for stem in _stems(scenario) for key in FILE_KEYS for kind in ("csv", "toml")
    ]


def files_of(scenario: Scenario, answer: Worst) -> Iterator[tuple[str, str]]:
    """Name and text of each file; none of a method that does not read the log, or that diverges.

    Parameters
    ----------
    scenario : Scenario
        That was asked about.
    answer : Worst
        Of it.
    """
    quiet = silent(scenario)
    truth, begin = Ship(quiet).course.truth, start_utc(quiet) or 0.0
    for stem, method, found in zip(_stems(scenario), quiet.method, answer.methods, strict=False):
        if not found.playable or found.diverged:
            continue
        for key, error, log in zip(FILE_KEYS, ERRORS[: len(COMPONENTS)], found.logs, strict=True):
            name = f"{stem}-{key}.csv"
            yield name, log_file(quiet, truth, log, begin)
            yield f"{stem}-{key}.toml", to_toml(playing(quiet, truth, method, name, error.label))
