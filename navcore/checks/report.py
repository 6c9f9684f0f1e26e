"""The report of a check: what a file holds and what is wrong with it, in words and as data."""

import math
from dataclasses import dataclass, field
from typing import Any

from navcore.foundation.errors import Fault
from navcore.foundation.text import Text


@dataclass(frozen=True)
class FileReport:
    """Outcome of a check.

    Attributes
    ----------
    file : str
        Path as given.
    kind : str
        What it was understood as; empty when it was not.
    details : dict
        What it holds, ready for JSON.
    text : tuple of str
        The same for reading.
    warnings : tuple of str
        What the user should know.
    faults : tuple of Fault
        Why it was not understood.
    """

    file: str
    kind: str
    details: dict[str, Any] = field(default_factory=dict)
    text: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    faults: tuple[Fault, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether the file was understood."""
        return not self.faults

    def lines(self) -> list[str]:
        """Text for a terminal: what it holds, then warnings and faults."""
        head = [f"{self.file}: {self.kind}"] if self.kind else []
        words = [Text("warning: {warning}", warning=warning) for warning in self.warnings]
        return [*head, *self.text, *words, *(str(fault) for fault in self.faults)]

    def as_dict(self) -> dict[str, Any]:
        """One JSON document (numbers that are unknown are null)."""
        return {
            "file": self.file,
            "ok": self.ok,
            "kind": self.kind,
            **self.details,
            "warnings": list(self.warnings),
            "faults": [
                {"where": f.where, "field": f.field, "value": _plain(f.value), "allowed": f.allowed}
                for f in self.faults
            ],
        }


def _plain(value: object) -> object:
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value if value is None or isinstance(value, str | int | float) else str(value)
