"""From words to a command, by tyro; what it does not understand becomes one line."""

from __future__ import annotations

import contextlib
import io
import re
import sys
from collections.abc import Sequence
from typing import Annotated, Protocol

from app.cli.bench import BenchCommand
from app.cli.check import CheckCommand
from app.cli.network import NetworkCommand
from app.cli.presets import PresetsCommand
from app.cli.run import RunCommand
from app.cli.serve import ServeCommand
from app.cli.terminal import emit, lost
from navcore.errors import Fault, InputError

_DESCRIPTION = "Design and judge the damping of inertial navigation systems."
_NO_INT = re.compile(r"Error parsing (\S+): invalid literal for int\(\) with base 10: (.*)")
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_RULE = re.compile(r"[╰─-]{5,}╯?")


class Command(Protocol):
    """One parsed command."""

    def execute(self) -> int:
        """Carry it out; return the exit code."""
        ...


def parse(arguments: Sequence[str]) -> Command | None:
    """Parse a command line; None when it only asked for help or the version.

    Raises
    ------
    InputError
        The command line is not understood.
    """
    if list(arguments) == ["--version"]:
        from navcore import __version__

        emit(f"schuler {__version__}")
        return None
    import tyro
    from tyro.conf import FlagCreatePairsOff, subcommand

    commands = (
        Annotated[ServeCommand, subcommand("serve")]
        | Annotated[RunCommand, subcommand("run")]
        | Annotated[NetworkCommand, subcommand("network")]
        | Annotated[PresetsCommand, subcommand("presets")]
        | Annotated[CheckCommand, subcommand("check")]
        | Annotated[BenchCommand, subcommand("bench")]
    )
    complaint = io.StringIO()
    try:
        with contextlib.redirect_stderr(complaint):
            return tyro.cli(
                commands,  # pyright: ignore[reportArgumentType]
                prog="schuler",
                description=_DESCRIPTION,
                args=list(arguments),
                config=(FlagCreatePairsOff,),
            )
    except OSError as error:  # stdout does not take the help
        lost(sys.stdout, error)
        return None
    except SystemExit as leaving:
        if leaving.code in (0, None):
            return None
        raise InputError(Fault("schuler", "", None, one_line(complaint.getvalue()))) from None


def one_line(box: str) -> str:
    r"""Say in one line what tyro draws as a box: its text up to the first rule, and the nearest option.

    Examples
    --------
    >>> one_line("╭─ Bad ─╮\n│ no such  │\n│ thing    │\n│ ──────── │\n│ For more │\n╰──────────╯")
    'no such thing'
    """
    sections: list[list[str]] = [[]]
    for line in _COLOUR.sub("", box).strip().splitlines()[1:]:
        text = line.strip("│ ")
        if _RULE.fullmatch(text):
            sections.append([])
        elif text:
            sections[-1].append(text)
    sections = [section for section in sections if section] or [box.split()]
    message = _NO_INT.sub(r"\1 = \2: must be a whole number", " ".join(sections[0]))
    for section in sections[1:]:
        if section[0] == "Perhaps you meant:" and len(section) > 1:
            message += f"; perhaps {section[1]}"
        elif section[0].startswith("Available subcommands:"):
            message += f"; {' '.join(section).replace('Available subcommands', 'commands')}"
    return message
