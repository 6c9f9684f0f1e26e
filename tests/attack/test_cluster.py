"""Heavy jobs on a Dask cluster of this machine: the same result, progress, cancel; a lost cluster is told."""

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.design.budget import budget
from navcore.engine.simulation import simulate
from navcore.foundation.errors import Fault, InputError
from navcore.questions.budget import BudgetQuestion
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.bench.process import Server, environment, free_port
from schuler_bench.jobs import cluster as module
from schuler_bench.jobs import envelopes
from schuler_bench.jobs.asking import Asker
from schuler_bench.jobs.cluster import Cluster
from schuler_bench.jobs.elsewhere import CLUSTER, LOST, cluster, note_of, use_cluster
from schuler_bench.jobs.envelopes import Envelopes
from schuler_bench.jobs.load import heavy_load
from schuler_bench.jobs.scheduler import Lane, scheduler
from schuler_bench.jobs.search import Search
from tests.attack.conftest import eventually
from tests.attack.wire import ask

pytest.importorskip("distributed", reason="the extra schuler-bench[cluster] is not installed")
pytestmark = [pytest.mark.attack, pytest.mark.timeout(400)]

SHORT = ("run.duration_h=1",)


class Machines:
    """A scheduler and one worker, each a process of its own."""

    def __init__(self, folder: Path) -> None:
        self.port, self._folder = free_port(), folder
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.scheduler = self._start(
            "distributed.cli.dask_scheduler", "--port", str(self.port), "--no-jupyter", "--no-show"
        )
        self.worker = self.start_worker()

    def start_worker(self, own: dict[str, str] | None = None) -> subprocess.Popen[bytes]:
        words = (self.address, "--no-nanny", "--nthreads", "1")
        return self._start("distributed.cli.dask_worker", *words, own=own)

    def _start(self, name: str, *words: str, own: dict[str, str] | None = None) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            [sys.executable, "-m", name, *words, "--host", "127.0.0.1", "--no-dashboard"],
            cwd=self._folder,
            env=own or environment(),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )

    def end(self) -> None:
        for process in (self.worker, self.scheduler):
            process.kill()
            process.wait()


@pytest.fixture(scope="module")
def machines(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Machines]:
    made = Machines(tmp_path_factory.mktemp("cluster"))
    yield made
    made.end()


@pytest.fixture
def there(machines: Machines, monkeypatch: pytest.MonkeyPatch) -> Iterator[Cluster]:
    monkeypatch.setattr(module, "_AGAIN_S", 0.5)
    use_cluster(machines.address)
    made = cluster()
    assert made is not None
    eventually(lambda: made.ready, 120.0)
    yield made
    use_cluster(None)


@pytest.fixture
def scenario() -> Scenario:
    return load("sikuliaq-like", SHORT)


def endless(folder: str, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> None:
    """Says where it is computed, and goes on until it is called back."""
    (Path(folder) / "begun").write_text(str(os.getpid()))
    while not cancelled():
        progress(0.25)
        time.sleep(0.01)
    (Path(folder) / "called-back").touch()


def nothing(item: None, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> None:
    """Done at once."""


@dataclass(frozen=True)
class Place:
    """Where the test itself runs, and the folder for notes."""

    here: int
    folder: str


def ends_here_only(place: Place, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> int:
    """Endless on a cluster; here done at once."""
    if os.getpid() != place.here:
        endless(place.folder, progress, cancelled)
    return os.getpid()


def refused(text: str, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> None:
    raise InputError([Fault("", text, 1, "must be 2")])


def test_a_heavy_job_is_done_there_with_the_same_result(there: Cluster, scenario: Scenario) -> None:
    assert heavy_load(scenario).lane is Lane.CLUSTER
    lanes: list[float] = []
    budgeter = Asker(lambda: lanes.append(scheduler().figures()["running_cluster"]), BudgetQuestion)
    budgeter.begin(BudgetQuestion(scenario=scenario))
    assert budgeter.wait_idle(120.0)
    assert budgeter.words == () and 1.0 in lanes
    found, here = budgeter.result, budget(scenario)
    assert found is not None and found.document() == here.document()
    budgeter.stop()


def test_bands_over_seeds_are_those_of_this_machine(
    there: Cluster, scenario: Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(envelopes, "SEEDS", 4)

    def bands_here() -> Any:
        told: list[bool] = []
        bands = Envelopes(simulate, lambda: told.append(True), lambda: None, still_s=0.0)
        bands.follow(scenario, "seeds")
        assert bands.wait_idle(120.0) and told
        found = bands.beside(scenario, "seeds")
        bands.stop()
        assert found is not None
        return asdict(found)

    on_cluster = bands_here()
    use_cluster(None)
    np.testing.assert_equal(on_cluster, bands_here())


def test_progress_comes_and_a_cancelled_job_is_called_back(
    there: Cluster, tmp_path: Path, machines: Machines
) -> None:
    seen: list[float] = []

    def cancelled() -> bool:
        return bool(seen)

    assert there.compute(endless, [str(tmp_path)], seen.append, cancelled) is None
    assert seen == [0.25] and int((tmp_path / "begun").read_text()) == machines.worker.pid
    eventually((tmp_path / "called-back").exists, 120.0)
    # Nothing stays behind: the next job is done at once.
    assert there.compute(nothing, [None], seen.append, lambda: False) == [None]


def test_what_a_job_refuses_is_refused_as_here(there: Cluster) -> None:
    with pytest.raises(InputError, match=r"run\.step_s = 1: must be 2"):
        there.compute(refused, ["run.step_s"], lambda _: None, lambda: False)
    assert there.ready


def test_a_scenario_with_files_is_computed_where_they_lie(there: Cluster) -> None:
    assert heavy_load(load("sikuliaq-recorded")).lane is Lane.SPARE


def test_a_lost_cluster_is_told_and_the_work_done_here(
    there: Cluster, scenario: Scenario, machines: Machines, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    told: list[tuple[str, ...]] = []
    search: Search[Place, int] = Search(
        lambda: told.append(search.words),
        ends_here_only,
        bool,
        "Stopped.",
        "x",
        lambda _: heavy_load(scenario),
    )
    search.begin(Place(os.getpid(), str(tmp_path)))
    eventually((tmp_path / "begun").exists, 120.0)
    machines.worker.kill()
    machines.worker.wait()
    assert search.wait_idle(120.0)
    assert search.result == os.getpid() and search.words == () and (LOST,) in told
    assert not there.ready and heavy_load(scenario).lane is Lane.SPARE
    assert any("heavy jobs are done here" in record.getMessage() for record in caplog.records)
    # It is used again once somebody works there.
    machines.worker = machines.start_worker()
    eventually(lambda: there.ready, 120.0)
    search.stop()


def changed_program(folder: Path, change: str) -> dict[str, str]:
    """Environment of a worker whose copy of the program differs in one place."""
    own = environment()
    root = Path(own["PYTHONPATH"].split(os.pathsep)[0])
    for package in ("schuler_bench", "navcore", "assets"):
        shutil.copytree(root / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    name, old, new = CHANGES[change]
    text = (folder / name).read_text("utf-8")
    assert text.count(old) == 1
    (folder / name).write_text(text.replace(old, new), "utf-8")
    return own | {"PYTHONPATH": str(folder), "SCHULER_CACHE_DIR": str(folder / "cache")}


CHANGES = {
    "version": ("navcore/foundation/version.py", '"0.1.0"', '"0.0.9"'),
    "kernels": ("navcore/foundation/units.py", "7.292115e-5", "7.292116e-5"),
    "sources": ("navcore/design/seeds.py", "SEEDS = 24", "SEEDS = 25"),
}
"""What differs first, and by which change in which file."""


@pytest.mark.slow
@pytest.mark.parametrize("change", CHANGES)
def test_a_worker_with_another_program_is_passed_over_and_named(
    there: Cluster,
    scenario: Scenario,
    machines: Machines,
    tmp_path: Path,
    change: str,
    caplog: pytest.LogCaptureFixture,
) -> None:
    other = machines.start_worker(changed_program(tmp_path, change))
    try:
        eventually(lambda: len(there.passed_over) == 1, 120.0)
        assert there.ready and there.threads == 1
        named = [record.getMessage() for record in caplog.records if "is passed over" in record.getMessage()]
        assert len(named) == 1 and "worker tcp://127.0.0.1:" in named[0] and f": {change} " in named[0]
        assert heavy_load(scenario).note.startswith(
            f"The Dask cluster passes over 1 of its 2 workers: {change} "
        )
        assert (
            there.compute(whereabouts, [None] * 6, lambda _: None, lambda: False) == [machines.worker.pid] * 6
        )
        # Alone it is of no use: the page says why, and the work is done here.
        machines.worker.kill()
        machines.worker.wait()
        eventually(lambda: not there.ready, 120.0)
        load = heavy_load(scenario)
        assert load.lane is Lane.SPARE and load.note.startswith(
            f"No worker of the Dask cluster fits: {change} "
        )
        budgeter = Asker(lambda: told.append(budgeter.words), BudgetQuestion)
        told: list[tuple[str, ...]] = []
        budgeter.begin(BudgetQuestion(scenario=scenario))
        assert budgeter.wait_idle(120.0) and budgeter.result is not None
        assert (load.note,) in told and budgeter.words == ()
        budgeter.stop()
    finally:
        other.kill()
        other.wait()
        if machines.worker.poll() is not None:
            machines.worker = machines.start_worker()
    eventually(lambda: there.ready and note_of(there) == "", 120.0)


def whereabouts(item: None, progress: Callable[[float], None], cancelled: Callable[[], bool]) -> int:
    """Process in which it is computed."""
    return os.getpid()


def test_a_server_says_how_many_threads_its_cluster_has(
    machines: Machines, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(CLUSTER, machines.address)
    with Server() as server:
        eventually(lambda: b"schuler_cluster_threads 1.0" in ask(server.port, "/metrics").body, 120.0)


def test_a_cluster_that_is_not_there_keeps_nobody_waiting(scenario: Scenario) -> None:
    use_cluster(f"tcp://127.0.0.1:{free_port()}")
    try:
        assert heavy_load(scenario).lane is Lane.SPARE
    finally:
        use_cluster(None)
