"""Write docs/stable.md: the public names of navcore and how each is called, which stay as they are.

``python -m tools.stable`` writes the page; a test compares it, so that nothing in it changes unseen.
"""

import inspect
from collections.abc import Iterator
from pathlib import Path

import navcore

PAGE = Path(__file__).resolve().parents[1] / "docs" / "stable.md"
_HEAD = """# Stable from 0.1

These names of `navcore` keep their meaning and can be called as here from version 0.1 on. A name, parameter
or default is taken away only after a release that warns of it; new parameters have defaults. All else may
change.
`help(navcore.simulate)` explains a name; [extending.md](extending.md) says what a class of your own needs.

```text
"""


def text() -> str:
    """Make the page."""
    return _HEAD + "\n".join(_lines()) + "\n```\n"


def _lines() -> Iterator[str]:
    for name in sorted(navcore.__all__):
        thing = getattr(navcore, name)
        if not callable(thing):
            yield name
        elif not isinstance(thing, type):
            yield name + _signature(thing)
        else:
            yield name
            yield from (f"    .{member}" for member in _members(thing))


def _members(kind: type) -> Iterator[str]:
    """Public methods that a class defines itself."""
    for name, value in sorted(vars(kind).items()):
        function = getattr(value, "__func__", value)
        if inspect.isfunction(function) and not name.startswith(("_", "model_")):
            yield name + _signature(function)


def _signature(function: object) -> str:
    """Parameters with their defaults; types are in the help."""
    found = inspect.signature(function)  # pyright: ignore[reportArgumentType]
    plain = [one.replace(annotation=inspect.Parameter.empty) for one in found.parameters.values()]
    kept = [one for one in plain if one.name not in ("self", "cls")]
    return str(found.replace(parameters=kept, return_annotation=inspect.Signature.empty))


if __name__ == "__main__":
    PAGE.write_text(text(), "utf-8")
