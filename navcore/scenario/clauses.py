"""Sets of clauses: a standard's limits, each with the scenario that its test prescribes.

A set is a TOML file. Its blocks ``[[test]]`` have a ``name``, a ``text``, a mapping ``scenario`` that is laid
over the scenario under test, and blocks ``[[test.requirement]]``.
"""

import copy
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from navcore.foundation.assets import asset_path
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.scenario.file import read_toml
from navcore.scenario.model import Scenario

_OF_A_TEST = {"name", "text", "scenario", "requirement"}
_LEFT_ALONE = ("method", "requirement", "schema")


@dataclass(frozen=True)
class Test:
    """What some clauses prescribe.

    Attributes
    ----------
    name, text : str
        Short, and in words.
    scenario : mapping
        Blocks that are laid over the scenario under test.
    requirement : list
        Blocks of the limits.
    """

    name: str
    text: str
    scenario: Mapping[str, Any]
    requirement: list[Any]

    def of(self, scenario: Scenario) -> Scenario:
        """Return the scenario of this test: methods and sensors of the one under test, all else prescribed.

        Raises
        ------
        InputError
            The two do not go together; the faults name the test.
        """
        data = _laid_over(scenario.canonical(), self.scenario)
        data["requirement"] = copy.deepcopy(self.requirement)
        data["title"] = self.name
        return Scenario.parse(data, self.name)


@dataclass(frozen=True)
class ClauseSet:
    """A standard.

    Attributes
    ----------
    title, source : str
        What it is, and where it is from.
    tests : tuple of Test
        In order.
    """

    title: str
    source: str
    tests: tuple[Test, ...]


def clause_sets() -> dict[str, Path]:
    """Return the sets that come with the program: name -> path of the TOML file, sorted by name."""
    return {path.stem: path for path in sorted(asset_path("clauses").glob("*.toml"))}


def load_clauses(source: str) -> ClauseSet:
    """Read a set of clauses: a listed one by its name, or a TOML file.

    Raises
    ------
    InputError
        There is none of this name, or it is wrong; one fault a field.
    """
    known = clause_sets()
    path = known.get(source, Path(source))
    if not os.path.lexists(path):
        allowed = Text("is neither a listed set of clauses nor a file; sets: {names}", names=", ".join(known))
        raise InputError(Fault(source, "", None, allowed))
    data = read_toml(path, source)
    tests = data.get("test")
    if not isinstance(tests, list) or not tests or not all(isinstance(one, dict) for one in tests):
        raise InputError(Fault(source, "test", None, Text("must be a list of blocks, [[test]]")))
    faults = [fault for k, one in enumerate(tests) for fault in _faults(one, f"test.{k}", source)]
    if faults:
        raise InputError(faults)
    made = (
        Test(str(one.get("name", "")), str(one.get("text", "")), one.get("scenario", {}), one["requirement"])
        for one in tests
    )
    return ClauseSet(str(data.get("title", source)), str(data.get("source", "")), tuple(made))


def _faults(test: dict[str, Any], at: str, where: str) -> list[Fault]:
    known = ", ".join(sorted(_OF_A_TEST))
    faults = [
        Fault(where, f"{at}.{name}", None, Text("is not a field here; known: {known}", known=known))
        for name in sorted({*test} - _OF_A_TEST)
    ]
    blocks = test.get("scenario", {})
    if not isinstance(blocks, dict):
        return [*faults, Fault(where, f"{at}.scenario", blocks, Text("must be a table of fields"))]
    alone = Text("is that of the scenario under test")
    faults += [Fault(where, f"{at}.scenario.{name}", None, alone) for name in _LEFT_ALONE if name in blocks]
    limits = test.get("requirement")
    if not isinstance(limits, list) or not limits:
        wanted = Text("must be a list of blocks, [[{block}]]", block="test.requirement")
        faults.append(Fault(where, f"{at}.requirement", None, wanted))
    return faults


def _laid_over(data: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """Lay blocks over others, field by field; a block of another kind begins anew."""
    out = copy.deepcopy(dict(data))
    for name, value in over.items():
        own = out.get(name)
        if (
            isinstance(value, dict)
            and isinstance(own, dict)
            and value.get("kind", own.get("kind")) == own.get("kind")
        ):
            out[name] = _laid_over(own, value)
        else:
            out[name] = copy.deepcopy(value)
    return out
