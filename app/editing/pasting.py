"""A method, or the disturbances of the log, as a text that is copied and pasted."""

from dataclasses import dataclass
from typing import Any

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.scenario.bounds import MAX_METHODS
from navcore.scenario.file import blocks_to_toml, parse_toml
from navcore.scenario.model import Scenario
from schuler_bench.editing.edits import free_name

WHERE = Text("pasted text")
"""Name that faults give the pasted text."""
DISTURBANCES = ("event", "outage", "current")
_ALLOWED = Text(
    "must be [[method]], [[reference.event]], [[reference.outage]] or [[reference.current]]; open a whole "
    "scenario as a file"
)


@dataclass(frozen=True)
class Pasted:
    """Result of a pasted text.

    Attributes
    ----------
    scenario : Scenario
        With what was pasted.
    selected : int
        Method to edit now.
    words : str
        What was done.
    """

    scenario: Scenario
    selected: int
    words: str


def method_toml(scenario: Scenario, index: int) -> str:
    """One method, complete, as a block ``[[method]]``."""
    return blocks_to_toml({"method": [scenario.canonical()["method"][index]]}).lstrip()


def disturbances_toml(scenario: Scenario) -> str:
    """All events, outages and passing currents of the log, as blocks such as ``[[reference.event]]``."""
    reference = scenario.canonical()["reference"]
    return blocks_to_toml({"reference": {name: reference.get(name, []) for name in DISTURBANCES}}).lstrip()


def paste(scenario: Scenario, selected: int, text: str) -> Pasted:
    """Put a text of `method_toml` or `disturbances_toml` into a scenario.

    Parameters
    ----------
    scenario : Scenario
        Stays as it is.
    selected : int
        Methods are added behind this one; one whose name is taken gets a number.
    text : str
        TOML. Lists of events or of outages take the place of the scenario's own.

    Returns
    -------
    Pasted

    Raises
    ------
    InputError
        The text is no TOML, holds something else, or a value in it is wrong: one fault for each field, with
        its value and the allowed range.
    """
    given = parse_toml(text, WHERE)
    methods, reference = given.get("method", []), given.get("reference", {})
    if not isinstance(methods, list) or not isinstance(reference, dict):
        raise InputError(Fault(WHERE, "", None, _ALLOWED))
    others = [key for key in given if key not in ("method", "reference")]
    others += [f"reference.{key}" for key in reference if key not in DISTURBANCES]
    if others or not given:
        raise InputError(Fault(WHERE, others[0] if others else "", None, _ALLOWED))
    data = scenario.canonical()
    most = MAX_METHODS - len(data["method"])
    if len(methods) > most:
        allowed = Text(
            "must be at most {most} blocks [[method]]: a scenario has at most {max_methods} methods",
            most=most,
            max_methods=MAX_METHODS,
        )
        raise InputError(Fault(WHERE, "method", len(methods), allowed))
    known = [method["name"] for method in data["method"]]
    added = [_with_free_name(method, known) for method in methods]
    data["method"][selected + 1 : selected + 1] = added
    data["reference"].update(reference)
    pasted = Scenario.parse(data, WHERE)
    at = selected + len(added)
    said = [Text("method {name}", name=method.name) for method in pasted.method[selected + 1 : at + 1]]
    if "event" in reference:
        said.append(Text("log events: {event}", event=len(pasted.reference.event)))
    if "outage" in reference:
        said.append(Text("log outages: {outage}", outage=len(pasted.reference.outage)))
    if reference.get("current"):
        said.append(Text("currents: {current}", current=len(pasted.reference.current)))
    return Pasted(pasted, at, ", ".join(said))


def _with_free_name(method: Any, known: list[str]) -> Any:
    """Give a method a name that none of the known ones has, and note it; what is no block stays as it is."""
    if not isinstance(method, dict):
        return method
    network = method.get("network")
    network_id = network.get("id") if isinstance(network, dict) else network
    name = free_name(str(method.get("name") or network_id or method.get("damping") or "free"), known)
    known.append(name)
    return method | {"name": name}
