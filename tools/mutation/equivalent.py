"""Changes that nothing can notice, as `equivalent.toml` lists them with their reasons."""

import tomllib
from functools import cache
from pathlib import Path

from tools.mutation.mutants import Mutant

_HERE = Path(__file__).resolve()


@cache
def listed() -> tuple[dict[str, str], ...]:
    """Read the list."""
    return tuple(tomllib.loads(_HERE.with_suffix(".toml").read_text("utf-8"))["change"])


def is_equivalent(mutant: Mutant, entries: tuple[dict[str, str], ...] | None = None) -> bool:
    """Whether a change is among the entries, those of the list unless told."""
    return any(
        entry["file"] == mutant.file and entry["what"] == mutant.what and entry["where"] in _line(mutant)
        for entry in (listed() if entries is None else entries)
    )


def _line(mutant: Mutant) -> str:
    return (_HERE.parents[2] / mutant.file).read_text("utf-8").splitlines()[mutant.line - 1]
