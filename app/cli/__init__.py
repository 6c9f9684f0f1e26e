"""The command ``schuler``: one file a command, run by `main`.

Exit codes: 0 done; 2 the input is wrong (one line per fault on stderr); 3 the run was stopped or diverged.
"""

import sys
from collections.abc import Sequence

from navcore.foundation.cores import one_blas_thread
from navcore.foundation.errors import InputError, StoppedError, UnstableError
from schuler_bench.cli.terminal import finish, prepare_streams, say

DONE, WRONG_INPUT, STOPPED = 0, 2, 3


def main(arguments: Sequence[str] | None = None) -> int:
    """Carry out one command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows the program's name; by default that of this process.

    Returns
    -------
    int
        The exit code. Faults of the input are printed, never raised.
    """
    prepare_streams()
    one_blas_thread()
    try:
        # Only now: a Ctrl-C while the commands are imported is no traceback either.
        from schuler_bench.cli.parse import parse

        command = parse(sys.argv[1:] if arguments is None else arguments)
        code = DONE if command is None else command.execute()
    except InputError as error:
        for fault in error.faults:
            say(str(fault))
        code = STOPPED if isinstance(error, UnstableError | StoppedError) else WRONG_INPUT
    except KeyboardInterrupt:
        say("stopped")
        code = STOPPED
    return code if finish() else WRONG_INPUT
