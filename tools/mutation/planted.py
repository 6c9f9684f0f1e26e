"""Changes of `planted.toml`, which survived once and which the draw cannot make: one text for another."""

import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tools.mutation.mutants import Mutant

_HERE = Path(__file__).resolve()


@dataclass(frozen=True)
class Planted(Mutant):
    """One text of a file in the place of another, which stands there once."""

    room: str = ""
    old: str = ""
    new: str = ""

    @property
    def name(self) -> str:
        """Name that stays as long as the file does."""
        return f"{self.file}#{self.what}"

    def applied(self, source: str) -> str:
        """Text of the file with the change.

        Raises
        ------
        ValueError
            The text stands there not once.
        """
        if source.count(self.old) != 1:
            raise ValueError(f"{self.file}: {self.old!r} stands there {source.count(self.old)} times")
        return source.replace(self.old, self.new)


@cache
def planted() -> tuple[Planted, ...]:
    """Read the list."""
    found = []
    for entry in tomllib.loads(_HERE.with_suffix(".toml").read_text("utf-8"))["change"]:
        source = (_HERE.parents[2] / entry["file"]).read_text("utf-8")
        line = source.partition(entry["old"])[0].count("\n") + 1
        found.append(Planted(place=-1, line=line, **entry))
    return tuple(found)
