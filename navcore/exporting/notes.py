"""What the fields of the law's records are: the comments beside them, with their units."""

import inspect
import re
from functools import lru_cache
from importlib import import_module

from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS

_NAME = re.compile(r'\b(\w+)"?\s*[:=]\s*\(?[A-Z_]')
"""Name of a field before its type."""
_SECTION = re.compile(r"^(?:    )?(\w+)(?:: ClassVar\[np.dtype\])? = (?:record_type\(|\{)")
_OWN = {"policies": POLICIES, "switchings": SWITCHINGS}
_WHERE = {
    "p": ("PARAMETERS", "numbers"),
    "s": ("STATE", "memory"),
    "ring": ("HISTORY", "history"),
}
"""Where the fields right below a root are declared, by its name."""


def notes_of(path: tuple[str, ...]) -> str:
    """Return the comment of a field of the law's records; empty where there is none.

    Parameters
    ----------
    path : tuple of str
        Names from the record on: ``("p", "policies", "threshold", "limit")``.
    """
    module = "navcore.law.records" if path[0] in _WHERE else "navcore.exporting.records"
    names = [name for name in path if not name.isdigit()]
    direct = len(names) == 2
    for part, registry in _OWN.items():
        if part in names:
            module, direct = registry[names[names.index(part) + 1]].__module__, True
    found = [one for one in _comments(module) if one[1] == names[-1]]
    here = [one for one in found if (one[0] in _WHERE.get(path[0], ())) == direct]
    return (here or found or [("", "", "")])[0][2]


@lru_cache(maxsize=64)
def _comments(module: str) -> tuple[tuple[str, str, str], ...]:
    """Section, name and comment of the fields that a module declares."""
    found, section = [], ""
    for line in inspect.getsource(import_module(module)).splitlines():
        if match := _SECTION.match(line):
            section = match[1]
        declared, _, note = line.partition("#")
        if (names := _NAME.findall(declared)) and note.strip():
            found.append((section, names[-1], note.strip()))
    return tuple(found)
