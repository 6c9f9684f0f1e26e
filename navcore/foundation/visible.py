"""Text from outside as a terminal or a log may show it: its control characters are seen and do nothing."""

import re

_CONTROLS = re.compile(
    "[\x00-\x1f\x7f-\x9f\xad\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069\ufeff\ufff9-\ufffb]"
)
"""Controls of a terminal, breaks of lines, and what turns the direction of writing or is not seen at all."""


def visible(text: str) -> str:
    r"""Return one line of text in which each control character is written as its escape.

    Examples
    --------
    >>> visible("red \x1b[31m\n")
    'red \\x1b[31m\\n'
    >>> visible("compass ωₛ")
    'compass ωₛ'
    """
    return _CONTROLS.sub(_escape, text)


def _escape(found: re.Match[str]) -> str:
    return found.group().encode("unicode_escape").decode("ascii")
