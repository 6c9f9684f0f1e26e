"""From words to a command, by tyro; a command line that is not understood becomes one line."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import fields
from difflib import get_close_matches
from itertools import zip_longest
from typing import TYPE_CHECKING, Annotated, Any, Protocol, Union

from navcore.foundation.errors import Fault, InputError
from navcore.questions import QUESTIONS
from schuler_bench.cli.asking import command_of
from schuler_bench.cli.bench import BenchCommand
from schuler_bench.cli.check import CheckCommand
from schuler_bench.cli.network import NetworkCommand
from schuler_bench.cli.parts import PartsCommand
from schuler_bench.cli.presets import PresetsCommand
from schuler_bench.cli.serve import ServeCommand
from schuler_bench.cli.study import SCHEDULER, OnCluster
from schuler_bench.cli.terminal import emit, lost

if TYPE_CHECKING:
    from tyro._arguments import ArgumentDefinition
    from tyro._errors import ParseErrorEvent

_DESCRIPTION = "Design and judge the damping of inertial navigation systems."
_COMMANDS = {
    "serve": ServeCommand,
    "network": NetworkCommand,
    "presets": PresetsCommand,
    "parts": PartsCommand,
    "check": CheckCommand,
    **{id: command_of(question) for id, question in QUESTIONS.items()},
    "study": command_of(QUESTIONS["study"], OnCluster, SCHEDULER),
    "bench": BenchCommand,
}
_PLACES = ("--out", "--scenario", "--write-map")
_NO_INT = "invalid literal for int() with base 10: "


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
        from navcore.foundation.version import __version__

        emit(f"schuler {__version__}")
        return None
    import tyro
    from tyro import _errors
    from tyro.conf import FlagCreatePairsOff, subcommand

    if empty := next(_empty(arguments), ""):
        raise InputError(Fault(empty, "", "", "must name a file or a folder"))
    commands: Any = Union[tuple(Annotated[command, subcommand(name)] for name, command in _COMMANDS.items())]  # noqa: UP007
    try:
        with _errors.on_parse_error(lambda event: _refuse(event, next(iter(arguments), ""))):
            return tyro.cli(
                commands,
                prog="schuler",
                description=_DESCRIPTION,
                args=list(arguments),
                config=(FlagCreatePairsOff,),
            )
    except OSError as error:  # stdout does not take the help
        lost(sys.stdout, error)
        return None
    except SystemExit:  # tyro has shown the help
        return None


def _empty(arguments: Sequence[str]) -> Iterator[str]:
    """Options for a path that are given an empty one, which would be the folder where the user stands."""
    for option, value in zip_longest(arguments, arguments[1:], fillvalue="."):
        if option in _PLACES and not value:
            yield option
        if option.endswith("=") and option[:-1] in _PLACES:
            yield option[:-1]


def _refuse(event: ParseErrorEvent, command: str) -> None:
    """Raise the `InputError` of a command line that tyro refuses, before tyro prints a word."""
    raise InputError(Fault("schuler", "", None, _complaint(event, command)))


def _complaint(event: ParseErrorEvent, command: str) -> str:
    """One line about a refused command line. Events of later versions of tyro get a general one."""
    from tyro import _errors

    if isinstance(event, _errors.MissingSubcommand) or command not in _COMMANDS:
        unknown = "" if command in ("", *_COMMANDS) else f", not {command!r}"
        return f"needs one of the commands {{{', '.join(_COMMANDS)}}}{unknown}"
    match event:
        case _errors.MissingArgs():
            return f"{command} needs {', '.join(_name(missing.arg) for missing in event.missing_arguments)}"
        case _errors.BadValue():
            verb = "takes no" if event.reason == "fixed" else "needs a"
            return f"{_name(event.argument)} {verb} value"
        case _errors.InvalidChoice():
            return f"{_name(event.argument)} = {event.value!r}: must be one of {', '.join(event.choices)}"
        case _errors.UnrecognizedArgs():
            options = [token for token in event.tokens if token.startswith("-")]
            return "; ".join(_unknown(token, command) for token in options or event.tokens)
        case _errors.InstantiationFailure():
            name = command if event.argument is None else _name(event.argument)
            value = event.message.removeprefix(_NO_INT)
            return (
                f"{name} = {value}: must be a whole number" if value != event.message else f"{name}: {value}"
            )
        case _:
            return f"the command line is not understood: see schuler {command} --help"


def _name(argument: ArgumentDefinition) -> str:
    """How an argument is written on the command line."""
    return str(argument.lowered.metavar) if argument.is_positional() else argument.lowered.name_or_flags[0]


def _unknown(token: str, command: str) -> str:
    """Say that a command does not know a word, with its nearest option if one is near."""
    options = [f"--{field.name.replace('_', '-')}" for field in fields(_COMMANDS[command])]
    near = get_close_matches(token, options, 1)
    return f"{command} does not know {token}" + (f"; perhaps {near[0]}" if near else "")
