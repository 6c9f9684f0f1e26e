"""Parts of a session's study outlive the server, however it ends; the page offers to run the rest."""

import io
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import pytest

from navcore.questions.study import StudyQuestion
from navcore.scenario.file import load
from navcore.study.crossed import crossed
from schuler_bench.bench.process import environment
from schuler_bench.jobs.scheduler import Lane
from schuler_bench.session import folder, store
from schuler_bench.session.kept_study import keep_study
from schuler_bench.session.sessions import Sessions
from schuler_bench.session.store import open_store
from schuler_bench.session.studying import left_of
from tests.waiting import until

ID = "a" * 24
SHORT = ["run.duration_h=0.2", "reference.noise_mps=0.1"]
KILLED = """
import os, sys
from pathlib import Path
import navcore.study.study
from tests.unit.test_kept_study import ID, opened_sessions, task
real, ran = navcore.study.study.run_points, []
def counted(plan, numbers, stopped):
    for number, rows in real(plan, numbers, stopped):
        ran.append(number)
        yield number, rows
        if len(ran) == 3:
            os.kill(os.getpid(), 9)
navcore.study.study.run_points, navcore.study.study._PART_S = counted, 0.0
session = opened_sessions(Path(sys.argv[1])).get(ID)
session.on_change()
session.searches.asking["study"].begin(task())
session.searches.asking["study"].wait_idle(60.0)
"""


def task() -> StudyQuestion:
    """Three latitudes, two seeds each."""
    ship = load("sikuliaq-like", SHORT)
    return StudyQuestion(study=crossed(ship, ["latitude"], 2), scenario=ship, workers=1)


def opened_sessions(path: Path) -> Sessions:
    """Sessions of a server on a state folder."""
    kept = open_store(path)
    assert kept is not None
    return Sessions(lambda: (load("sikuliaq-like", SHORT), "sikuliaq-like"), kept)


@pytest.fixture
def sessions(tmp_path: Path) -> Any:
    sessions = opened_sessions(tmp_path)
    yield sessions
    sessions.close()


def test_the_parts_of_a_study_survive_a_killed_server(tmp_path: Path) -> None:
    command = [sys.executable, "-c", KILLED, str(tmp_path)]
    assert subprocess.run(command, env=environment(), cwd=Path(__file__).parents[2]).returncode == -9
    sessions = opened_sessions(tmp_path)
    try:
        studier = sessions.get(ID).searches.asking["study"]
        assert studier.result is not None and not studier.result.complete
        left, before = left_of(studier), studier.result
        assert left is not None and before.summary["runs"] >= 2
        assert left.scenario == task().scenario
        studier.begin(left)  # the button that runs the rest
        assert studier.wait_idle(60.0) and studier.result.complete
        table = pq.read_table(io.BytesIO(studier.result.runs))
        kept = pq.read_table(io.BytesIO(before.runs))
        assert table.slice(0, len(kept)) == kept, "what was there is not run again"
        assert sorted(set(table["run"].to_pylist())) == [*range(studier.result.summary["of"])]
    finally:
        sessions.close()
    again = opened_sessions(tmp_path)
    found = again.get(ID).searches.asking["study"]
    assert found.result is not None and found.result.complete and left_of(found) is None
    again.close()


def test_another_study_takes_the_place_of_the_one_before(sessions: Sessions, tmp_path: Path) -> None:
    studier = sessions.get(ID).searches.asking["study"]
    for seeds in (1, 2):
        ship = load("sikuliaq-like", SHORT)
        studier.begin(StudyQuestion(study=crossed(ship, ["latitude"], seeds), scenario=ship))
        assert studier.wait_idle(60.0) and studier.result is not None and studier.result.complete
        found = pq.read_table(tmp_path / f"{ID}.study" / "runs.parquet")
        assert set(found["run"].to_pylist()) == {*range(studier.result.summary["of"])}


def test_what_cannot_be_read_is_left_out_and_told(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    place = tmp_path / f"{ID}.study"
    place.mkdir()
    (place / "study.toml").write_text("schema = 99\n")
    sessions = opened_sessions(tmp_path)
    studier = sessions.get(ID).searches.asking["study"]
    assert studier.result is None and "cannot be resumed" in caplog.text and ID not in caplog.text
    assert vars(studier.prepared(task()))["folder"] == place and not [*place.iterdir()]
    sessions.close()


def test_a_study_on_a_cluster_is_not_sent_a_folder_of_the_server(tmp_path: Path) -> None:
    from schuler_bench.jobs.asking import Asker
    from schuler_bench.jobs.worker import Watch

    studier, sent = Asker(lambda: None, StudyQuestion), list[StudyQuestion]()
    keep_study(studier, tmp_path / f"{ID}.study", "")
    for lane in (Lane.CLUSTER, Lane.SPARE):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr("schuler_bench.jobs.search.carried_out", lambda _, asked, *rest: sent.append(asked))
            studier._carry_out(task(), lambda _: None, Watch(lambda: False, lane=lane))
    assert [one.folder for one in sent] == [None, tmp_path / f"{ID}.study"]
    studier.stop()


def test_kept_studies_are_bounded_and_go_with_their_sessions(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = open_store(tmp_path)
    assert kept is not None
    for number, name in enumerate("abc"):
        parts = tmp_path / f"{name * 24}.study" / "parts"
        parts.mkdir(parents=True)
        (parts / "000000000000-000000000001.parquet").write_bytes(bytes(1000))
        (parts.parent / "study.toml").write_bytes(bytes(10))
        os.utime(parts.parent, (1e9 + number, 1e9 + number))
        kept.write(name * 24, {"id": name * 24})
    assert folder.bytes_of(tmp_path / f"{'a' * 24}.study") == 1010
    monkeypatch.setattr(store, "LARGEST_STUDIES", 2500)
    kept.remove_old()
    assert sorted(path.name[0] for path in tmp_path.glob("*.study")) == ["b", "c"]
    monkeypatch.setattr(store, "MOST_KEPT", 1)
    kept.remove_old()
    until(lambda: len([*tmp_path.glob("*.study")]) == 1)
    kept.close()
