"""Carry out one job on a worker of a Dask cluster: report its progress, end it when nobody waits for it."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from navcore.foundation.version import __version__

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


def carry_out(version: str, report: tuple[str, str, int], function: Compute, item: Any) -> Outcome:
    """Carry a job out; what it raises comes back as its outcome, any other fault is the cluster's.

    Parameters
    ----------
    version : str
        Of the server's program.
    report : (str, str, int)
        Topic to which progress is told; name of the job, number of its part.
    function, item
        ``function(item, progress, cancelled)`` is called.

    Raises
    ------
    RuntimeError
        This worker has another version of the program.
    """
    from distributed import get_worker

    if version != __version__:
        raise RuntimeError(f"a worker has version {__version__}, the server {version}")
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


def nothing(item: None, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> None:
    """Show that a worker has this program."""
