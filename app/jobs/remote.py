"""Carry out one job on a worker of a Dask cluster: report its progress, end it when nobody waits for it."""

import platform
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numba

from navcore.foundation.kernel_cache import kernel_hash
from navcore.foundation.kernel_digest import source_digest
from navcore.foundation.text import Text
from navcore.foundation.version import __version__
from schuler_bench.memory import keep_freed

NO_PROGRAM = Text("no program that answers")
_REPORT_S = 0.2

Compute = Callable[[Any, Callable[[float], None], Callable[[], bool]], Any]


@dataclass(frozen=True)
class Outcome:
    """Result of a job, or its error.

    Attributes
    ----------
    found
        What the function has returned.
    error : Exception or None
        What it has raised.
    """

    found: Any = None
    error: Exception | None = None


@cache
def program() -> dict[str, str]:
    """Everything that decides the numbers of this process, from the coarsest to the digests."""
    return {
        "version": __version__,
        "Python": platform.python_version(),
        "Python build": sys.version,
        "numba": numba.__version__,
        "machine": platform.machine(),
        "kernels": kernel_hash(),
        "sources": source_digest(),
    }


def misfit(theirs: dict[str, str], ours: dict[str, str]) -> str:
    """Say in what a worker's `program` differs from that of the server; empty where it does not.

    Examples
    --------
    >>> misfit({"version": "0.1.0", "kernels": "8ae2"}, {"version": "0.1.0", "kernels": "90f1"})
    'kernels 8ae2, the server 90f1'
    """
    for what, own in ours.items():
        if (other := theirs.get(what, "?")) != own:
            return Text("{what} {other}, the server {own}", what=what, other=other, own=own)
    return ""


def carry_out(ours: dict[str, str], report: tuple[str, str, int], function: Compute, item: Any) -> Outcome:
    """Carry a job out; what it raises comes back as its outcome, any other fault is the cluster's.

    Parameters
    ----------
    ours : dict of str
        The server's `program`.
    report : (str, str, int)
        Topic to which progress is reported; name of the job, number of its part.
    function, item
        ``function(item, progress, cancelled)`` is called.

    Raises
    ------
    RuntimeError
        This worker has another program.
    """
    from distributed import get_worker

    if why := misfit(program(), ours):
        raise RuntimeError(f"a worker has {why}")
    keep_freed()
    worker, (topic, name, number) = get_worker(), report
    key, last_s = worker.get_current_task(), 0.0

    def progress(fraction: float) -> None:
        nonlocal last_s
        if time.monotonic() - last_s >= _REPORT_S:
            last_s = time.monotonic()
            worker.log_event(topic, (name, number, float(fraction)))

    def cancelled() -> bool:
        """Whether the server has cancelled the job, or is gone: then nobody waits for this task."""
        task = worker.state.tasks.get(key)
        return task is None or task.state == "cancelled"

    try:
        return Outcome(function(item, progress, cancelled))
    except Exception as error:
        return Outcome(error=error)
