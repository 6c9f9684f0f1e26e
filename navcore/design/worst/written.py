"""Files of the worst logs: for each method and error a log, and a scenario that plays it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from navcore.design.ship import Ship
from navcore.design.worst.played import log_file, playing, silent
from navcore.design.worst.result import FILE_KEYS, Worst
from navcore.engine.environment import start_utc
from navcore.quantities import ERRORS
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


def files_of(answer: Worst, places: Iterable[tuple[int, int]] | None = None) -> Iterator[tuple[str, str]]:
    """Name and text of each file, first a log and then the scenario that plays it.

    Parameters
    ----------
    answer : Worst
        Of the question.
    places : iterable of (int, int), optional
        Which method and which error; by default all that can be played.
    """
    quiet = silent(answer.scenario)
    truth, begin, stems = Ship(quiet).course.truth, start_utc(quiet) or 0.0, _stems(quiet)
    for place, k in answer.playable if places is None else places:
        method, log = quiet.method[place], answer.methods[place].logs[k]
        name = f"{stems[place]}-{FILE_KEYS[k]}"
        yield f"{name}.csv", log_file(quiet, truth, log, begin)
        yield f"{name}.toml", to_toml(playing(quiet, truth, method, f"{name}.csv", ERRORS[k].label))
