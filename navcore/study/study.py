"""carry_out(plan) -> summary: a study's unfinished runs on threads, each part kept as soon as it is there."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from navcore.engine.drivers.common import Cancelled, Progress
from navcore.mechanization.error_batch import WIDTH
from navcore.study.plan import Plan
from navcore.study.results import Folder
from navcore.study.running import Engine, Row, run_points
from navcore.study.summary import summary

_PART_S = 0.3
"""Time after which the rows that a worker has are kept."""
_BLOCK_S = 2.0
"""Work of a block, which one worker does: long enough that neighbours share, short enough for an even end."""
_LARGEST_BLOCK = 4096


def carry_out(
    plan: Plan,
    folder: Folder,
    workers: int,
    progress: Progress | None = None,
    stopped: Cancelled | None = None,
    engine: Engine | None = None,
) -> dict[str, Any]:
    """Run what is missing in a folder, join the parts and sum up.

    Parameters
    ----------
    plan : Plan
        The study.
    folder : Folder
        Opened. A run that it holds is not run again.
    workers : int
        Threads; the compiled kernels and the random numbers run without Python's lock.
    progress, stopped : callable, optional
        As of `navcore.engine.simulation.simulate`. What is complete when it stops is kept.
    engine : callable, optional
        Carries a block of runs out, ``workers`` of them at a time; by default here, by `run_points`.

    Returns
    -------
    dict
        Content of ``summary.json``.

    Raises
    ------
    OSError
        The folder cannot be written; the parts that are there stay.
    """
    before = folder.summary()
    if before is not None:
        return before
    missing = folder.missing()
    left = sum(end - first for first, end in missing)
    blocks = _blocks(plan, missing, left, workers)
    lock, failed = threading.Lock(), threading.Event()
    done = plan.runs - left

    def ended() -> bool:
        return failed.is_set() or (stopped is not None and stopped())

    def keep(rows: list[Row], runs: int) -> None:
        nonlocal done
        if rows:
            folder.write_part(rows[0]["run"], rows)
            with lock:
                done += runs
                if progress is not None:
                    progress(done / plan.runs)

    def work() -> None:
        try:
            while not ended():
                with lock:
                    block = next(blocks, None)
                if block is None:
                    return
                rows, runs, began = [], 0, time.monotonic()
                for _, some in (engine or run_points)(plan, block, ended):
                    rows += some
                    runs += 1
                    if time.monotonic() - began > _PART_S:
                        keep(rows, runs)
                        rows, runs, began = [], 0, time.monotonic()
                keep(rows, runs)
        except BaseException:
            failed.set()
            raise

    if left:
        if progress is not None:
            progress(done / plan.runs)
        with ThreadPoolExecutor(workers) as pool:
            for worker in [pool.submit(work) for _ in range(workers)]:
                worker.result()
    document = summary(plan, folder.join(), "complete" if done == plan.runs else "stopped", done)
    folder.finish(document)
    return document


def _blocks(plan: Plan, missing: list[tuple[int, int]], left: int, workers: int) -> Iterator[range]:
    size = int(min(_BLOCK_S * plan.runs / plan.seconds(), left / (4 * workers), _LARGEST_BLOCK)) + 1
    size = max(size - size % WIDTH, min(size, WIDTH))  # runs of other seeds go side by side
    for begin, end in missing:
        for first in range(begin, end, size):
            yield range(first, min(first + size, end))
