"""Numbers with a decimal comma, which TOML cannot read: recognised, so that the fault names the comma."""

import re

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text

_COMMA = r"(?<![\d.])[+-]?\d+,\d+(?![\d.])"
_NUMBER = re.compile(_COMMA)
_GIVEN = re.compile(rf"([\w-]+)\s*=\s*(?:({_COMMA})|\[[^#\]]*?((?<![\d.])[+-]?\d+,0\d*[1-9]))")
"""A field and its value; in a list only what is no two numbers of TOML, which have no leading zero."""
_LINE = re.compile(r"at line (\d+)")


def comma_refused(value: object, line: int = 0) -> str:
    """Say what is wrong with a number that has a decimal comma; empty for everything else.

    Examples
    --------
    >>> comma_refused("1,5"), comma_refused("1.5")
    ('must be a number with a decimal point, 1.5, not with a decimal comma', '')
    """
    if not isinstance(value, str) or not _NUMBER.fullmatch(value.strip()):
        return ""
    point = value.strip().replace(",", ".")
    if line:
        return Text(
            "must be a number with a decimal point, {point}, not with a decimal comma (line {line})",
            point=point,
            line=line,
        )
    return Text("must be a number with a decimal point, {point}, not with a decimal comma", point=point)


def refuse_comma(text: str, reason: str, where: str) -> None:
    """Refuse TOML text that could not be read, where its faulty line has a decimal comma.

    Parameters
    ----------
    text : str
        TOML.
    reason : str
        Message of the reader, which ends with the line (the last one where it names none).
    where : str
        Place named in the fault.

    Raises
    ------
    InputError
        Names the field and the number.
    """
    lines = text.rstrip().split("\n")
    named = _LINE.search(reason)
    number = int(named[1]) if named else len(lines)
    if number <= len(lines) and (match := _GIVEN.search(lines[number - 1].partition("#")[0])):
        value = match[2] or match[3]
        raise InputError(
            Fault(where, match[1], value, comma_refused(value, number if named else 0))
        ) from None
