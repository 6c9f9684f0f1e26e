"""Faults of the user's input: each names the place, the field, the value and the allowed range."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from navcore.foundation.text import Text

_LONGEST_VALUE = 200
_LONGEST_ALLOWED = 3000


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong with an input: a field, its value and what would be right.

    Attributes
    ----------
    where : str
        File, preset or part of the page the value came from; may be empty.
    field : str
        Dotted path of the field, e.g. ``method.0.network.xi``; may be empty when the whole input is meant.
    value : object
        The offending value; None when a value is missing.
    allowed : str
        What would have been right, e.g. ``must be > 0 and <= 5``.
    """

    where: str
    field: str
    value: object
    allowed: str

    def __str__(self) -> str:
        """One line: place, field, value, allowed range."""
        place = Text.joined(": ", (_one_line(_cut(part)) for part in (self.where, self.field) if part))
        if self.value is not None:
            value = _one_line(_shorten(self.value))
            place = Text("{place} = {value}", place=place, value=value) if place else f"= {value}"
        allowed = _cut(self.allowed, _LONGEST_ALLOWED)
        return Text("{place}: {allowed}", place=place, allowed=allowed) if place else allowed


def _shorten(value: object) -> str:
    try:
        text = repr(value) if isinstance(value, str) else str(value)
    except ValueError:
        text = Text("an integer of thousands of digits")  # Python refuses to write it
    return _cut(text)


def _one_line(text: str) -> str:
    line = " ".join(text.split())
    return text if line == text else line


def _cut(text: str, longest: int = _LONGEST_VALUE) -> str:
    half = (longest - 3) // 2  # of a path, the end tells most
    return text if len(text) <= longest else f"{text[:half]}...{text[-half:]}"


class InputError(ValueError):
    """The input is wrong. Its text has one line for each fault that was found.

    Parameters
    ----------
    faults : Fault or iterable of Fault
        What is wrong; at least one.

    Attributes
    ----------
    faults : tuple of Fault
        The same, in order.

    Examples
    --------
    >>> print(InputError(Fault("my.toml", "site.lat_deg", 95.0, "must be >= -90 and <= 90")))
    my.toml: site.lat_deg = 95.0: must be >= -90 and <= 90
    """

    def __init__(self, faults: Fault | Iterable[Fault]) -> None:
        self.faults: tuple[Fault, ...] = (faults,) if isinstance(faults, Fault) else tuple(faults)
        super().__init__("\n".join(str(fault) for fault in self.faults))

    def __reduce__(self) -> tuple[type[InputError], tuple[tuple[Fault, ...]]]:
        """Keep the faults when it goes from one process to another."""
        return type(self), (self.faults,)

    def located(self, where: str, prefix: str = "") -> InputError:
        """Return the same error with the place filled in where it is still unknown.

        Parameters
        ----------
        where : str
            File or preset name.
        prefix : str
            Put before each field name, e.g. ``reference.``.
        """
        return InputError(
            Fault(
                f.where or where, f"{prefix}{f.field}" if f.field else prefix.rstrip("."), f.value, f.allowed
            )
            for f in self.faults
        )


class UnstableError(InputError):
    """Every setting that was tried is unstable: the input is read, and there is no answer to it."""


class StoppedError(InputError):
    """The work was stopped before it had an answer: the input is read, and nothing is found."""
