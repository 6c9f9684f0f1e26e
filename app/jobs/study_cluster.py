"""A study on a Dask cluster: blocks of runs go there, rows of results come back, the same as here."""

from __future__ import annotations

import time
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import lru_cache

from navcore.foundation.errors import Fault, InputError
from navcore.study.file import to_toml
from navcore.study.model import Study
from navcore.study.plan import Plan
from navcore.study.running import Row, Stopped, run_points
from schuler_bench.jobs.cluster import Cluster, check_address
from schuler_bench.jobs.worker import ElsewhereLost

OPTION = "--scheduler"
_CONNECT_S, _LOST_S, _LOOK_S = 40.0, 30.0, 0.1
"""So long an answer is waited for at the start, and after a loss; between two looks."""
_AHEAD = 2
"""Blocks that each thread of a worker has at a time: the next one is there when the one before is done."""

Item = tuple[str, str, int, int]
"""Study as TOML, its name in faults, and the first run and the one after the last."""


class StudyCluster:
    """Engine of a study (`navcore.study.running.Engine`) on the workers of one cluster.

    Parameters
    ----------
    cluster : Cluster
        Ready.
    address : str
        Named when it is lost.
    plan : Plan
        The study that travels with each block.
    """

    def __init__(self, cluster: Cluster, address: str, plan: Plan) -> None:
        self._cluster, self._address = cluster, address
        self._study = to_toml(plan.study), plan.where

    @property
    def workers(self) -> int:
        """Blocks at a time."""
        return _AHEAD * max(self._cluster.threads, 1)

    def __call__(self, plan: Plan, numbers: range, stopped: Stopped) -> Iterator[tuple[int, list[Row]]]:
        """Carry a block out on the cluster; once more where a worker or the connection was lost.

        Raises
        ------
        InputError
            The cluster stays away.
        """
        del plan  # it is the one that this engine was made for
        item = *self._study, numbers.start, numbers.stop
        while not stopped():
            try:
                found = self._cluster.compute(_rows_of, [item], lambda _: None, stopped)
            except ElsewhereLost:
                if not _waited(lambda: self._cluster.ready, stopped, _LOST_S) and not stopped():
                    raise _unreachable(self._address, self._cluster.trouble) from None
                continue
            if found is not None:
                yield from found[0]
            return


@contextmanager
def study_cluster(address: str, plan: Plan) -> Iterator[StudyCluster]:
    """Connect to a cluster for a study.

    Raises
    ------
    InputError
        The address is none, the extra is not installed, no worker fits or answers, or the study reads
        recordings, which lie on this machine.
    """
    check_address(address, OPTION, "study")
    if any(_recordings(plan)):
        allowed = "cannot run a study of recordings, which lie on this machine: run it without --scheduler"
        raise InputError(Fault("study", OPTION, address, allowed))
    cluster = Cluster(address, otherwise="")
    try:
        if not _waited(lambda: cluster.ready or cluster.lost, lambda: False, _CONNECT_S) or not cluster.ready:
            raise _unreachable(address, cluster.trouble)
        yield StudyCluster(cluster, address, plan)
    finally:
        cluster.close()


def _unreachable(address: str, why: str) -> InputError:
    return InputError(Fault("study", OPTION, address, why or "gives no answer"))


def _waited(condition: Callable[[], bool], stopped: Stopped, longest_s: float) -> bool:
    """Wait for a condition; say whether it came."""
    end = time.monotonic() + longest_s
    while not condition():
        if stopped() or time.monotonic() > end:
            return False
        time.sleep(_LOOK_S)
    return True


def _recordings(plan: Plan) -> Iterator[bool]:
    blocks = plan.scenario.motion, plan.scenario.reference, plan.scenario.imu
    return (getattr(block, "file", None) is not None for block in blocks)


# ------------------------------------------------------------ on the worker


@lru_cache(maxsize=4)
def _plan(text: str, where: str) -> Plan:
    return Plan(Study.parse(tomllib.loads(text), where), where)


def _rows_of(
    item: Item, progress: Callable[[float], None], cancelled: Callable[[], bool]
) -> list[tuple[int, list[Row]]]:
    """Rows of a block of runs."""
    text, where, first, end = item
    found = []
    for number, rows in run_points(_plan(text, where), range(first, end), cancelled):
        found.append((number, rows))
        progress((number + 1 - first) / (end - first))
    return found
