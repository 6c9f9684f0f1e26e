"""Methods that the rest of a scenario refuses: each is refused alone, and the others stand."""

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from navcore.foundation.errors import Fault
from navcore.foundation.text import Text
from navcore.scenario.method import Method

if TYPE_CHECKING:
    from navcore.scenario.model import Scenario


class Refused(NamedTuple):
    """A method that is left out of a scenario.

    Attributes
    ----------
    name : str
        Of the method.
    place : int
        Its number among the methods as they were given.
    faults : tuple of Fault
        What the rest of the scenario does not give it.
    """

    name: str
    place: int
    faults: tuple[Fault, ...]

    @property
    def reason(self) -> str:
        """The faults in one line."""
        return Text.joined("; ", map(str, self.faults))

    @property
    def line(self) -> str:
        """The method and why it is refused."""
        return Text("{name} is refused and left out: {reason}", name=self.name, reason=self.reason)

    def as_dict(self) -> dict[str, str]:
        """Return the document of interface.md."""
        return {"name": self.name, "reason": str(self.reason)}


def refused_methods(scenario: "Scenario") -> tuple[Refused, ...]:
    """Methods that have faults of their own in a scenario.

    Parameters
    ----------
    scenario : Scenario
        Whose fields are right each by itself.

    Returns
    -------
    tuple of Refused
        Empty where a fault concerns the scenario as a whole.
    """
    free = scenario.model_copy(update={"method": (Method(name="free"),)})
    if [*free.faults()]:
        return ()
    found = []
    for place, method in enumerate(scenario.method):
        faults = tuple(_at(place, scenario.model_copy(update={"method": (method,)}).faults()))
        if faults:
            found.append(Refused(method.label(), place, faults))
    return tuple(found)


def _at(place: int, faults: Iterator[Fault]) -> Iterator[Fault]:
    """Name a method of a scenario of one by its number among all."""
    for fault in faults:
        head, dot, rest = fault.field.removeprefix("method.").partition(".")
        own = fault.field.startswith("method.") and head == "0"
        yield replace(fault, field=f"method.{place}{dot}{rest}") if own else fault
