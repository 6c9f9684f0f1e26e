"""The command ``schuler``: one file a command, run by `main`.

Exit codes: 0 done; 2 the input is wrong (one line per fault on stderr); 3 the run was stopped or diverged.
"""

from collections.abc import Sequence

from schuler_bench.cli.codes import STOPPED, WRONG_INPUT
from schuler_bench.cli.installed import foreign_navcore, missing, tell


def main(arguments: Sequence[str] | None = None) -> int:
    """Carry out one command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows the program's name; by default that of this process.

    Returns
    -------
    int
        The exit code. Faults of the input are printed, never raised; so is a package that cannot be loaded.
    """
    if complaint := foreign_navcore():
        tell(complaint)
        return WRONG_INPUT
    try:
        # Only now: without navcore or a package that it needs, not even this can be imported.
        from schuler_bench.cli.carried_out import carried_out

        return carried_out(arguments)
    except ImportError as error:
        tell(missing(error))
        return WRONG_INPUT
    except KeyboardInterrupt:
        tell("stopped")
        return STOPPED
