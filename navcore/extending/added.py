"""What was registered in this process, and the faults of what could not be."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, NamedTuple

from navcore.foundation.errors import Fault

COLLECTED: ContextVar[list[Fault] | None] = ContextVar("collected", default=None)
"""Where faults go while a file or package is loaded; None: they are raised."""


class Added(NamedTuple):
    """One thing that was registered.

    Attributes
    ----------
    what : str
        What it is, such as "network".
    name : str
        How a scenario names it: its id, or its fields.
    thing
        The class, or the module of a format.
    """

    what: str
    name: str
    thing: Any


ADDED: list[Added] = []
"""All that was registered, in order; what was registered anew is here once."""


@contextmanager
def collected() -> Iterator[list[Fault]]:
    """Collect the faults of what is registered in the body, which then goes on."""
    faults: list[Fault] = []
    token = COLLECTED.set(faults)
    try:
        yield faults
    finally:
        COLLECTED.reset(token)
