"""Where heavy jobs are computed: on the Dask cluster if one answers, else by a helper, or in this process."""

from collections.abc import Callable, Sequence

from navcore.foundation.text import Text
from schuler_bench.jobs import helper
from schuler_bench.jobs.cluster import Cluster, Compute, Found, Item
from schuler_bench.jobs.scheduler import Lane
from schuler_bench.jobs.worker import ElsewhereLost, Watch

CLUSTER = "SCHULER_CLUSTER"
"""In the environment: address of the scheduler of a Dask cluster."""
LOST = Text("The Dask cluster does not answer: this is now computed on the server.")

_one: list[Cluster] = []


def use_cluster(address: str | None) -> None:
    """Send heavy jobs to this cluster from now on; None: to none.

    Raises
    ------
    InputError
        As `Cluster`.
    """
    clusters = [Cluster(address)] if address else []
    before, _one[:] = list(_one), clusters
    for one in before:
        one.close()


def leave_cluster() -> None:
    """Send no more jobs to any cluster."""
    use_cluster(None)


def cluster_figures() -> dict[str, float]:
    """For ``/metrics``: threads of the workers that are used, and how many workers are passed over."""
    one = cluster()
    if one is None:
        return {}
    return {"cluster_threads": float(one.threads), "cluster_workers_passed_over": float(len(one.passed_over))}


def cluster() -> Cluster | None:
    """The cluster of this process, if there is one."""
    return _one[0] if _one else None


def note_of(there: Cluster) -> str:
    """Sentence for a page about what a cluster does not do; empty where all its workers fit."""
    misfits = there.passed_over
    if there.lost:
        if not misfits:
            return LOST
        return Text(
            "No worker of the Dask cluster fits: {why}. This is now computed on the server.", why=misfits[0]
        )
    if not misfits:
        return ""
    return Text(
        "The Dask cluster passes over {count} of its {whole} workers: {why}.",
        count=len(misfits),
        whole=there.workers,
        why=misfits[0],
    )


def carried_out(
    function: Compute[Item, Found], asked: Item, progress: Callable[[float], None], watch: Watch
) -> Found | None:
    """Carry a job out where its lane says: on the cluster, else here; None when it was cancelled there.

    Raises
    ------
    ElsewhereLost
        The cluster has not done it.
    """
    results = carried_out_all(function, [asked], progress, watch)
    return None if results is None else results[0]


def carried_out_all(
    function: Compute[Item, Found], items: Sequence[Item], progress: Callable[[float], None], watch: Watch
) -> list[Found] | None:
    """The same for several items; on the cluster side by side, else one after the other."""
    if watch.lane is Lane.CLUSTER:
        there = cluster()
        if there is None:
            raise ElsewhereLost
        return there.compute(function, items, progress, watch.unwanted)
    if helper.helps(function):
        return helper.compute(function, items, progress, watch.unwanted)
    results = []
    for number, item in enumerate(items):

        def partly(fraction: float, number: int = number) -> None:
            progress((number + fraction) / len(items))

        results.append(function(item, partly, watch.unwanted))
        if watch.unwanted() and len(items) > 1:
            return None
    return results
