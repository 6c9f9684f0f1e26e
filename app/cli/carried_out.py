"""Carrying out one command line: faults and what the system refuses become one line and an exit code."""

import errno
import sys
from collections.abc import Sequence

from navcore.extending.plugins import load_plugins, name_plugin
from navcore.foundation.cores import one_blas_thread
from navcore.foundation.errors import InputError, StoppedError, UnstableError
from schuler_bench.cli.codes import DONE, STOPPED, WRONG_INPUT
from schuler_bench.cli.terminal import finish, prepare_streams, say

_NO_THREAD = "can't start new thread"
PLUGIN = "--plugin"
"""Option of every command: a file that registers methods of the user's own."""
_TOO_MANY = (errno.EAGAIN, errno.ENOMEM)


def carried_out(arguments: Sequence[str] | None) -> int:
    """Carry out a command line; by default that of this process. Return the exit code."""
    prepare_streams()
    one_blas_thread()
    try:
        # Only now: a Ctrl-C while the commands are imported is no traceback either.
        from schuler_bench.cli.parse import parse

        rest = with_plugins(sys.argv[1:] if arguments is None else arguments)
        command = parse(rest)
        code = DONE if command is None else command.execute()
    except InputError as error:
        for fault in error.faults:
            say(str(fault))
        code = STOPPED if isinstance(error, UnstableError | StoppedError) else WRONG_INPUT
    except KeyboardInterrupt:
        say("stopped")
        code = STOPPED
    except (MemoryError, OSError, RuntimeError) as error:
        if not (reason := refused_by_the_system(error)):
            raise
        say(f"schuler: stopped: {reason}")
        code = STOPPED
    return code if finish() else WRONG_INPUT


def with_plugins(arguments: Sequence[str]) -> list[str]:
    """Load the packages and files that bring methods, and say what is wrong with them; return the rest.

    ``--plugin FILE`` may stand anywhere on the command line, and more than once. A faulty one is left out.
    """
    rest, names, words = [], [], iter(arguments)
    for word in words:
        option, is_, name = word.partition("=")
        if option == PLUGIN:
            names.append(name if is_ else next(words, ""))
        else:
            rest.append(word)
    for name in names:
        name_plugin(name)
    for fault in load_plugins():
        say(str(fault))
    return rest


def refused_by_the_system(error: BaseException) -> str:
    """Say what the system has refused; empty where an error is none of its refusals.

    Examples
    --------
    >>> refused_by_the_system(RuntimeError("can't start new thread"))
    'the system allows no further thread or process (ulimit -u)'
    >>> refused_by_the_system(RuntimeError("a fault of the program"))
    ''
    """
    if isinstance(error, MemoryError):
        return "the memory is used up"
    if isinstance(error, OSError) and error.errno not in _TOO_MANY:
        return f"{error.strerror or error}{f': {error.filename}' if error.filename else ''}"
    if isinstance(error, OSError) or _NO_THREAD in str(error):
        return "the system allows no further thread or process (ulimit -u)"
    return ""
