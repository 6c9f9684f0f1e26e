"""Names in exported files: identifiers of every target."""

import keyword
import re

from navcore.exporting.words import RESERVED
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text

_IDENTIFIER = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_LONGEST = 40


def require_prefix(prefix: str) -> None:
    """Refuse a prefix that is no identifier in one of the targets.

    Raises
    ------
    InputError
        It names the option, the value and what is allowed.

    Examples
    --------
    >>> require_prefix("ship_law")
    """
    allowed = ""
    if not _IDENTIFIER.fullmatch(prefix):
        allowed = Text(
            "must be letters, digits and _ after a letter, such as {example}", example=_mended(prefix)
        )
    elif len(prefix) > _LONGEST:
        allowed = Text("must have at most {longest} letters", longest=_LONGEST)
    elif prefix in RESERVED or keyword.iskeyword(prefix):
        allowed = Text("is a word of C, MATLAB or Python: such as {example}", example=f"{prefix}_law")
    if allowed:
        raise InputError(Fault("", "--name", prefix, allowed))


def _mended(prefix: str) -> str:
    """A name like the one that was given."""
    plain = re.sub(r"[^A-Za-z0-9_]+", "_", prefix).strip("_")[:_LONGEST]
    return plain if _IDENTIFIER.fullmatch(plain) else f"law_{plain}".rstrip("_")
