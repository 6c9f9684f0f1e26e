"""Where the token comes from: the command line, the environment, a file, or made here."""

from __future__ import annotations

import os
import secrets
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text

_LONGEST = 4096


@dataclass(frozen=True)
class Token:
    """What a visitor must know.

    Attributes
    ----------
    value : str or None
        None: nothing.
    generated : bool
        It was made just now, and nobody knows it yet.
    """

    value: str | None
    generated: bool = False


def find_token(given: str | None, file: Path | None, generate: bool, environment: Mapping[str, str]) -> Token:
    """Find the token: what is given goes before SCHULER_TOKEN, a file before SCHULER_TOKEN_FILE.

    Parameters
    ----------
    given : str or None
        On the command line.
    file : Path or None
        Its first line is the token.
    generate : bool
        Make one when there is none; it is written to the file, if one is named.
    environment : mapping
        SCHULER_TOKEN, SCHULER_TOKEN_FILE.

    Raises
    ------
    InputError
        The file cannot be read or written, or holds no token.
    """
    if given is None and file is None:
        given = environment.get("SCHULER_TOKEN") or None
    if file is None and environment.get("SCHULER_TOKEN_FILE"):
        file = Path(environment["SCHULER_TOKEN_FILE"])
    if given is not None:
        return Token(given)
    if file is not None and (file.exists() or not generate):
        return Token(_first_line(file))
    if not generate:
        return Token(None)
    made = secrets.token_urlsafe(24)
    if file is not None:
        _write(file, made)
    return Token(made, generated=True)


def _first_line(file: Path) -> str:
    try:
        if not file.is_file():
            raise _fault(file, "must be a file that holds the token")
        with file.open("rb") as opened:
            line = opened.read(_LONGEST).partition(b"\n")[0].decode().strip()
    except UnicodeDecodeError:
        raise _fault(file, "must hold text") from None
    except OSError as error:
        raise _fault(file, Text("cannot be read: {strerror}", strerror=error.strerror or error)) from None
    if not line:
        raise _fault(file, "must hold the token in its first line")
    return line


def _write(file: Path, token: str) -> None:
    try:
        with os.fdopen(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w") as opened:
            opened.write(token + "\n")
    except OSError as error:
        raise _fault(file, Text("cannot be written: {strerror}", strerror=error.strerror or error)) from None


def _fault(file: Path, allowed: str) -> InputError:
    return InputError([Fault("serve", "--token-file", str(file), allowed)])
