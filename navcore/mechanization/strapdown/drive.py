"""Drive several strapdown runs through one IMU: a chunk is made once, every run advances by it.

While the runs advance by one chunk, the calling thread makes the next one.
"""

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np

from navcore.mechanization.strapdown.run import StrapdownRun

PIECE = 100_000
"""Samples between two looks at the cancel flag, some 10 ms for each run."""


def drive(
    runs: Sequence[StrapdownRun],
    chunks: Iterable[np.ndarray],
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    workers: int = 2,
) -> bool:
    """Advance all runs to their end; False when cancelled (what was computed stays in the recorders).

    A run that diverges stops there; the others go on. A record that ends early leaves its runs under way.

    Parameters
    ----------
    runs : sequence of StrapdownRun
        All of the same length and rate.
    chunks : iterable of ndarray, shape (n, 6)
        Increments from the start on (`ImuSimulation.chunks` gives them first in each pair). A chunk must stay
        as it is until the one after the next is asked for.
    progress : callable, optional
        Called with the fraction done, 0..1.
    cancelled : callable, optional
        Asked after each piece of a chunk, at most `PIECE` samples.
    workers : int
        Threads.
    """
    total = max(runs[0].settings.samples, 1)
    done, active = 0, list(runs)
    remaining = iter(chunks)
    with ThreadPoolExecutor(max(1, min(workers, len(runs)))) as pool:
        chunk = next(remaining, None)
        while chunk is not None:
            following = None
            for first in range(0, len(chunk), PIECE):
                piece = chunk[first : first + PIECE]
                advancing = [pool.submit(run.advance, piece) for run in active]
                if first + PIECE >= len(chunk):
                    following = next(remaining, None)
                active = [run for run, end in zip(active, advancing, strict=True) if not end.result()]
                done += len(piece)
                if progress is not None:
                    progress(min(done / total, 1.0))
                if not active:
                    return True
                if cancelled is not None and cancelled():
                    return False
            chunk = following
    return True
