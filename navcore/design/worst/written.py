"""Files of the worst logs: for each method and error a log, and a scenario that plays it."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from navcore.design.ship import Ship
from navcore.design.worst.logs import LogError
from navcore.design.worst.played import log_file, playing, silent
from navcore.engine.environment import start_utc
from navcore.quantities import ERRORS
from navcore.scenario.file import to_toml
from navcore.scenario.model import Scenario

FILE_KEYS = ("tilt_e", "tilt_n", "heading", "velocity_e", "velocity_n", "lat", "lon")
"""Names of the errors in names of files, in the order of `navcore.quantities.COMPONENTS`."""

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


def files_of(
    scenario: Scenario, logs: Sequence[Sequence[LogError]], places: Iterable[tuple[int, int]]
) -> Iterator[tuple[str, str]]:
    """Name and text of each file, first a log and then the scenario that plays it.

    Parameters
    ----------
    scenario : Scenario
        Of the question.
    logs : sequence of sequence of LogError
        Worst log of each method, for each error.
    places : iterable of (int, int)
        Which method and which error.
    """
    quiet = silent(scenario)
    truth, begin, stems = Ship(quiet).course.truth, start_utc(quiet) or 0.0, _stems(quiet)
    for place, k in places:
        method, log = quiet.method[place], logs[place][k]
        name = f"{stems[place]}-{FILE_KEYS[k]}"
        yield f"{name}.csv", log_file(quiet, truth, log, begin)
        yield f"{name}.toml", to_toml(playing(quiet, truth, method, f"{name}.csv", ERRORS[k].label))
