"""Methods that the rest of a scenario refuses: each is refused alone, and the others stand."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from navcore.foundation.errors import Fault
from navcore.foundation.text import Text
from navcore.scenario.method import Method


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


def refused_methods(
    methods: Sequence[Method], faults_of: Callable[[Method], Iterator[Fault]]
) -> tuple[Refused, ...]:
    """Methods that have faults of their own in a scenario.

    Parameters
    ----------
    methods : sequence of Method
        Of the scenario.
    faults_of : callable
        Yields the faults of the scenario with one method alone.

    Returns
    -------
    tuple of Refused
        Empty where a fault concerns the scenario as a whole.
    """
    if [*faults_of(Method(name="free"))]:
        return ()
    found = []
    for place, method in enumerate(methods):
        faults = tuple(_at(place, faults_of(method)))
        if faults:
            found.append(Refused(method.label(), place, faults))
    return tuple(found)


def _at(place: int, faults: Iterator[Fault]) -> Iterator[Fault]:
    """Name a method of a scenario of one by its number among all."""
    for fault in faults:
        head, dot, rest = fault.field.removeprefix("method.").partition(".")
        own = fault.field.startswith("method.") and head == "0"
        yield replace(fault, field=f"method.{place}{dot}{rest}") if own else fault
