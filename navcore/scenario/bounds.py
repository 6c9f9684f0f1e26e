"""Bounds on a scenario's text before it is read, so that hostile text is refused at once.

A scenario of every field and twelve methods has some 20 kB. The TOML reader of the standard library takes
quadratic time for a key of very many parts, recurses into nested arrays and refuses integers of thousands of
digits by an error of its own; each of these is reported as a fault,
here or by `navcore.scenario.file.parse_toml`.
"""

import re
from typing import Any

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text

LARGEST_BYTES = 1 << 20
MOST_VALUES = 100_000
"""Of a whole scenario: a profile may have 10,000 points of several values."""
MOST_BLOCKS = 15_000
MOST_FIELDS = 200
"""Of one block."""
MAX_METHODS = 12
MOST_METHODS = 1000
"""Mentions of a method's block, in comments too, beyond which the text is not read."""
DEEPEST = 12
"""Blocks within blocks; the deepest of a scenario is 5."""
MOST_PARTS = 12
"""Of a dotted key."""
MOST_DOTS_OF_PROSE = 300
MOST_DIGITS = 300
LARGEST_INTEGER = 1 << 63
LONGEST_KEY = 80
_DIGITS = re.compile(rf"[0-9A-Fa-f_]{{{MOST_DIGITS}}}")
_ENDS_A_KEY = re.compile(r"[=,{}\[\]\n]")


def require_readable(text: str, where: str) -> None:
    """Refuse text that a TOML reader would take too long for.

    Raises
    ------
    InputError
        Too long, a number of too many digits, or a key of too many parts (names the line).
    """
    if len(text) > LARGEST_BYTES:
        raise InputError(
            Fault(
                where,
                "",
                None,
                Text("is larger than {largest_bytes} bytes: no scenario", largest_bytes=LARGEST_BYTES),
            )
        )
    blocks = text.count("\n[")
    if blocks > MOST_BLOCKS:
        raise InputError(
            Fault(
                where,
                "",
                None,
                Text(
                    "has {blocks} blocks; at most {most_blocks} are read",
                    blocks=blocks,
                    most_blocks=MOST_BLOCKS,
                ),
            )
        )
    methods = text.count("[[method]]")
    if methods > MOST_METHODS:
        raise InputError(
            Fault(
                where,
                "method",
                methods,
                Text("must be 1 to {max_methods} blocks [[method]]", max_methods=MAX_METHODS),
            )
        )
    digits = _DIGITS.search(text)
    if digits is not None:
        line = text.count("\n", 0, digits.start()) + 1
        allowed = Text(
            "line {line} has a number of more than {most_digits} digits", line=line, most_digits=MOST_DIGITS
        )
        raise InputError(Fault(where, "", None, allowed))
    position = 0
    for part in _ENDS_A_KEY.split(text):
        prose = '"' in part or "'" in part or "#" in part
        if part.count(".") > (MOST_DOTS_OF_PROSE if prose else MOST_PARTS):
            line = text.count("\n", 0, position) + 1
            allowed = Text(
                "line {line} has a key of more than {most_parts} parts", line=line, most_parts=MOST_PARTS
            )
            raise InputError(Fault(where, "", None, allowed))
        position += len(part) + 1


def require_bounded(data: dict[str, Any], where: str) -> None:
    """Refuse a mapping that is too deep or too large to be a scenario.

    Raises
    ------
    InputError
        Names the field.
    """
    count = 0
    waiting: list[tuple[str, Any, int]] = [("", data, 0)]
    while waiting:
        name, value, depth = waiting.pop()
        count += 1
        if count > MOST_VALUES:
            raise InputError(
                Fault(
                    where,
                    "",
                    None,
                    Text("holds more than {most_values} values: no scenario", most_values=MOST_VALUES),
                )
            )
        if depth > DEEPEST:
            raise InputError(
                Fault(where, name, None, Text("is nested more than {deepest} deep", deepest=DEEPEST))
            )
        if isinstance(value, dict):
            if len(value) > MOST_FIELDS:
                raise InputError(
                    Fault(
                        where, name, None, Text("has {value} fields: no block has so many", value=len(value))
                    )
                )
            for key, item in value.items():
                if len(key) > LONGEST_KEY:
                    allowed = Text(
                        "is no field: names have at most {longest_key} characters", longest_key=LONGEST_KEY
                    )
                    raise InputError(Fault(where, key, None, allowed))
                waiting.append((f"{name}.{key}" if name else key, item, depth + 1))
        elif isinstance(value, list):
            waiting += [(name, item, depth + 1) for item in value]
        elif isinstance(value, int) and abs(value) >= LARGEST_INTEGER:
            raise InputError(Fault(where, name, None, Text("is an integer of more than 64 bits")))
