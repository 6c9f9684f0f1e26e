"""Pages of the API reference: one for navcore's public names, one a room, each module from its docstrings."""

from __future__ import annotations

import ast
from pathlib import Path

import navcore


def rooms(root: Path) -> dict[str, str]:
    """Folders of navcore, and what the first line of each one's docstring says."""
    found = {}
    for path in sorted((root / "navcore").glob("*/__init__.py")):
        about = ast.get_docstring(ast.parse(path.read_text("utf-8"))) or ""
        found[path.parent.name] = about.split("\n")[0].rstrip(".")
    return found


def pages(root: Path) -> dict[str, str]:
    """ReStructuredText of each page of the reference by its file's name."""
    made = {"index.rst": _index(rooms(root)), "navcore.rst": _public()}
    for room in rooms(root):
        made[f"{room}.rst"] = _room(root, room)
    return made


def _headed(title: str, line: str = "=") -> str:
    return f"{title}\n{line * len(title)}\n\n"


def _index(named: dict[str, str]) -> str:
    entries = "".join(f"   {room}\n" for room in named)
    table = "".join(f"   * - :doc:`{room}`\n     - {about}\n" for room, about in named.items())
    return (
        _headed("API reference")
        + "Import a name from the module under which it stands here; the names that a notebook needs first\n"
        "are in ``navcore`` itself. All quantities are in SI units and radians.\n\n"
        f".. list-table::\n\n{table}\n"
        f".. toctree::\n   :maxdepth: 1\n   :hidden:\n\n   navcore\n{entries}"
    )


def _public() -> str:
    listed = "".join(
        f"- :py:obj:`{name} <{getattr(navcore, name).__module__}.{name}>`\n"
        for name in navcore.__all__
        if hasattr(getattr(navcore, name), "__module__")
    )
    about = ".. automodule:: navcore\n   :no-members:\n\n"
    return _headed("navcore") + about + _headed("Public names", "-") + listed


def _room(root: Path, room: str) -> str:
    text = _headed(f"navcore.{room}") + f".. automodule:: navcore.{room}\n\n"
    for path in sorted((root / "navcore" / room).rglob("*.py")):
        parts = path.relative_to(root).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        if parts[-1] != "__main__" and name != f"navcore.{room}":
            text += _headed(name, "-") + f".. automodule:: {name}\n\n"
    return text
