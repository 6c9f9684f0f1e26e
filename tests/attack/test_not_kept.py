"""Where nothing is kept, or not all can be read: health, terminal and page say so, why, and what to do."""

import json
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing
from pathlib import Path

import pytest

from navcore.foundation import guarded
from schuler_bench.bench.process import environment
from schuler_bench.bench.visitor import PAGE_STATE
from schuler_bench.dashboard import Dashboard
from schuler_bench.http.ids import SessionIds
from schuler_bench.serve import open_dashboard
from schuler_bench.session.store import open_store, session_key
from tests.attack.conftest import eventually, running
from tests.attack.wire import ask, visit
from tests.browser.fields import label_of

pytestmark = pytest.mark.attack

ZETA = label_of("network.zeta")
HELD = "another server uses the same state folder"
READ_ONLY = "the state folder: Read-only file system"


def health(port: int) -> dict[str, str]:
    answer = ask(port, "/healthz")
    assert answer.status == 200
    return json.loads(answer.body)


def test_health_says_when_nothing_is_kept_and_when_it_is_again() -> None:
    with running() as bench:
        well = health(bench.port)
        bench.server.keeps_nothing(("there is no room", "Make room."))
        told = health(bench.port)
        expected = {"status": "nothing is kept", "reason": "there is no room", "remedy": "Make room."}
        assert told == expected | {"version": well["version"]}
        bench.server.keeps_nothing(None)
        assert health(bench.port) == well


@pytest.fixture
def serving(tmp_path: Path) -> Iterator[Callable[[], tuple[int, Dashboard]]]:
    with ExitStack() as ended:

        def start() -> tuple[int, Dashboard]:
            server, dashboard = open_dashboard(port=0, state=tmp_path / "state")
            ended.callback(dashboard.close)
            ended.callback(server.stop)
            return server.port, dashboard

        yield start
    guarded.stop()


def a_second_server(folder: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setattr(sys, "_held_by_the_test", open_store(folder), raising=False)
    return HELD


def a_read_only_folder(_: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    def refused(*_: object, **__: object) -> None:
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(tempfile, "TemporaryFile", refused)
    return READ_ONLY


@pytest.mark.parametrize("why", [a_second_server, a_read_only_folder])
def test_page_and_health_say_why_nothing_is_kept(
    serving: Callable[[], tuple[int, Dashboard]],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    why: Callable[[Path, pytest.MonkeyPatch], str],
) -> None:
    reason = why(tmp_path / "state", monkeypatch)
    port, _ = serving()
    eventually(lambda: health(port)["status"] == "nothing is kept", 30.0)
    told = health(port)
    assert told["reason"] == reason and "XDG_STATE_HOME" in told["remedy"]
    own = ask(port, "/").headers["Location"].split("/")[1]
    with visit(port, own) as page:
        page.set(page.control(PAGE_STATE), "1366x768|Method|Errors")
        page.wait_for(lambda m: 'data-run="1"' in str(m), 60.0)
        shown = str(page.received)
    assert 'data-sb-part="unkept"' in shown
    assert "Your work is not saved at present" in shown and reason[1:] in shown
    assert str(tmp_path) not in shown + str(told)


def test_work_is_kept_once_the_other_server_has_ended(
    serving: Callable[[], tuple[int, Dashboard]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What was known at the start was never tried again; and what the other server had kept must stay."""
    monkeypatch.setattr("schuler_bench.dashboard.AGAIN_AFTER_S", 0.2)
    other = open_store(tmp_path / "state")
    assert other is not None
    ids = SessionIds(session_key(tmp_path / "state"))
    new, old = ids.new(), ids.new()
    other.write(old, {"id": old, "work": "of before"})
    port, dashboard = serving()
    eventually(lambda: health(port)["status"] == "nothing is kept", 30.0)
    with visit(port, new) as page, visit(port, old) as again:
        for one in (page, again):
            one.set(one.control(PAGE_STATE), "1366x768|Method|Errors")
            one.wait_for(lambda m: 'data-run="1"' in str(m), 60.0)
            one.set(one.control(ZETA), 0.6)
            one.wait_for(lambda m: 'data-run="2"' in str(m), 60.0)
        other.close()
        eventually(lambda: health(port)["status"] == "ok", 30.0)
        again.wait_for(lambda m: "This session was kept earlier" in str(m), 30.0)
        kept = dashboard.store
        assert kept is not None and kept.saving.flush(20.0)
        for id in (new, old):
            written = kept.read(id)
            assert written is not None and "0.6" in str(written["scenarios"])
        (aside,) = kept.database.asides(old)
        assert json.loads(kept.database.aside(old, aside.number) or b"")["work"] == "of before"
        assert not kept.database.asides(new)


NO_HOME = """
import os, pwd, sys
def nobody(_):
    raise KeyError("no such user")
pwd.getpwuid = nobody
for name in ("HOME", "XDG_STATE_HOME"):
    os.environ.pop(name, None)
from schuler_bench.cli import main
sys.exit(main(["serve", "--port", "0"]))
"""


def test_without_a_home_terminal_health_and_page_say_that_nothing_is_kept() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", NO_HOME],
        env=environment(),
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    ) as server:
        assert server.stdout is not None
        threading.Timer(120.0, server.kill).start()
        try:
            lines = iter(server.stdout)
            port = int(next(line for line in lines if "http://" in line).split("/")[2].partition(":")[2])
            said = next(line for line in lines if "kept" in line)
            assert "nothing is kept: the user of the server has no home folder. Set XDG_STATE_HOME" in said
            told = health(port)
            assert told["status"] == "nothing is kept" and "no home folder" in told["reason"]
            with visit(port, ask(port, "/").headers["Location"].split("/")[1]) as page:
                page.set(page.control(PAGE_STATE), "1366x768|Method|Errors")
                page.wait_for(lambda m: 'data-run="1"' in str(m), 60.0)
                assert "The user of the server has no home folder" in str(page.received)
        finally:
            server.terminate()


def test_the_terminal_says_it_at_the_start(tmp_path: Path) -> None:
    folder = tmp_path / "schuler-bench" / "sessions"
    store = open_store(folder)
    assert store is not None
    with (
        closing(store),
        subprocess.Popen(
            [sys.executable, "-m", "schuler_bench", "serve", "--port", "0"],
            env=environment() | {"XDG_STATE_HOME": str(tmp_path)},
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        ) as server,
    ):
        assert server.stdout is not None
        threading.Timer(60.0, server.kill).start()
        said = next(line for line in server.stdout if "kept" in line)
        server.terminate()
    assert said.startswith(f"Schuler Bench: nothing is kept: {HELD}. End that server, or set XDG_STATE_HOME")


def test_a_session_that_cannot_be_read_is_offered_for_download_and_never_written_over(
    serving: Callable[[], tuple[int, Dashboard]], tmp_path: Path
) -> None:
    id = SessionIds(session_key(tmp_path / "state")).new()
    strange = json.dumps({"schema": 9, "id": id, "work": "of the version to come"}).encode()
    store = open_store(tmp_path / "state")
    assert store is not None
    store.database.write(id, strange)
    store.close()
    port, dashboard = serving()
    with visit(port, id) as page:
        page.set(page.control(PAGE_STATE), "1366x768|Method|Errors")
        page.wait_for(lambda m: 'data-run="1"' in str(m), 60.0)
        assert "written by another version of this program" in str(page.received)
        page.set(page.control(ZETA), 0.6)
        page.wait_for(lambda m: 'data-run="2"' in str(m), 60.0)
        offered = page.control("Download session-1.json")
        page.set(offered, True)
        page.wait_for(lambda m: m["type"].startswith("FileTransfer") and "session-1.json" in str(m), 20.0)
        kept = dashboard.store
        assert kept is not None and kept.saving.flush(20.0)
        (session,) = dashboard.sessions._by_id.values()
        (aside,) = session.keeping.aside
        assert aside.content() == strange
        written = kept.read(id)
        assert written is not None and written["schema"] == 1
