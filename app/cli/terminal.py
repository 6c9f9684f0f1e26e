"""stdout and stderr: results, one JSON document, notes; none can end in a traceback or steer the terminal."""

import io
import json
import os
import sys
from collections.abc import Callable, Iterable
from typing import Any, TextIO

from navcore.foundation.visible import visible

_OF_A_NOTEBOOK = "JPY_PARENT_PID"
"""Variable that Jupyter sets for its kernels: a cell keeps every state of a bar, and its control codes."""
_lost: list[str] = []


def prepare_streams() -> None:
    """Let no character that the terminal cannot show end the command."""
    _lost.clear()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")


def emit(text: str) -> None:
    """Print a result to stdout; a reader that went away is no fault of ours."""
    _write(sys.stdout, text)


def emit_result(as_json: bool, document: Any, lines: Callable[[], Iterable[str]]) -> None:
    """Print a result to stdout: one JSON document, without NaN and infinity, or its lines for people.

    Names, titles and whatever else the lines quote from a file do nothing to the terminal.
    """
    emit(json.dumps(document, indent=2, allow_nan=False) if as_json else "\n".join(map(visible, lines())))


def say(text: str) -> None:
    """Print one line to stderr; what it quotes does nothing to the terminal."""
    _write(sys.stderr, visible(text))


def finish() -> bool:
    """Flush both streams; False when stdout took no more for another reason than that its reader left."""
    for stream in (sys.stdout, sys.stderr):
        _write(stream, None)
    for reason in _lost:
        _write(sys.stderr, f"standard output: cannot be written: {reason}")
    return not _lost


def on_terminal() -> bool:
    """True when someone watches stderr on a terminal, which a notebook only pretends to its cells to be."""
    try:
        return sys.stderr is not None and sys.stderr.isatty() and _OF_A_NOTEBOOK not in os.environ
    except ValueError:
        return False


def lost(stream: TextIO, error: OSError) -> None:
    """Note that a stream took no more, and write nothing further to it."""
    if stream is sys.stdout and not isinstance(error, BrokenPipeError):
        _lost.append(error.strerror or str(error))
    _silence(stream)


def _write(stream: TextIO | None, text: str | None) -> None:
    if stream is None:
        return
    try:
        if text is None:
            stream.flush()
        else:
            print(text, file=stream, flush=True)
    except OSError as error:
        lost(stream, error)
    except ValueError:  # closed by whoever called us
        return


def _silence(stream: TextIO) -> None:
    """Send what is still buffered nowhere, or Python complains about it on its way out."""
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)
    except (OSError, ValueError):
        return
