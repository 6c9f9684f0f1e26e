"""The server as processes: serving 17, 18, a quiet console; ``serve --workers`` and a worker that crashes."""

import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest

from schuler_bench.bench.process import environment
from schuler_bench.bench.visitor import PAGE_STATE, Visitor
from schuler_bench.http.front import Front, _with_address
from schuler_bench.http.limits import Limits
from schuler_bench.http.server import start
from schuler_bench.session.store import open_store, session_key
from tests.attack.conftest import eventually, running
from tests.attack.wire import ask, shake_hands, statuses, visit
from tests.browser.fields import label_of

pytestmark = pytest.mark.attack

PROGRAM = """
import signal, threading, time
from schuler_bench.http.server import start
def connected(client, session):
    button = client.gui.add_button("last")
    @button.on_click
    def _(event):
        print("computing", flush=True)
        time.sleep(60)
server = start(port=0, on_connect=connected, on_disconnect=lambda client, session: None)
def announce():
    while signal.getsignal(signal.SIGTERM) is signal.SIG_DFL:
        time.sleep(0.01)
    print(server.port, flush=True)
threading.Thread(target=announce).start()
server.wait()
print("left", flush=True)
"""
NEVER_DONE = 'server.stop = lambda: (print("stopping", flush=True), time.sleep(60))\nserver.wait()'
ANNOUNCEMENT = "print(server.port, flush=True)"
HANDED_ELSEWHERE = "time.sleep(0.3); signal.pthread_kill(threading.get_ident(), signal.SIGTERM)"
BUSY_PORT = """
import sys
from schuler_bench.http.server import start
from navcore.foundation.errors import InputError
try:
    start(port=PORT, on_connect=None, on_disconnect=None)
except InputError as error:
    print(error)
print("viser" in sys.modules)
"""


@contextmanager
def process(program: str = PROGRAM) -> Iterator[subprocess.Popen[str]]:
    child = subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment() | {"PYTHONWARNINGS": "error"},
    )
    try:
        yield child
    finally:
        child.kill()
        child.communicate()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signal_ends_the_process_in_time_and_quietly(number: signal.Signals) -> None:
    with process() as child, ExitStack() as crowd:
        port = int(child.stdout.readline())
        for visitor in [crowd.enter_context(visit(port, f"visitor-{n}")) for n in range(8)]:
            visitor.control("last")
        child.send_signal(number)
        out, errors = child.communicate(timeout=5)
        assert (child.returncode, out, errors) == (0, "left\n", "")


def test_signal_that_another_thread_receives_ends_the_process_too() -> None:
    with process(PROGRAM.replace(ANNOUNCEMENT, HANDED_ELSEWHERE)) as child:
        out, errors = child.communicate(timeout=10)
        assert (child.returncode, out, errors) == (0, "left\n", "")


def test_signal_ends_the_process_although_a_callback_computes(
    record_property: Callable[[str, object], None],
) -> None:
    with process() as child, visit(int(child.stdout.readline())) as visitor:
        visitor.set(visitor.control("last"), True)
        assert child.stdout.readline() == "computing\n"
        began = time.monotonic()
        child.send_signal(signal.SIGTERM)
        assert child.wait(timeout=5) == 0
        record_property("ended_s", time.monotonic() - began)


def test_second_signal_ends_it_at_once() -> None:
    with process(PROGRAM.replace("server.wait()", NEVER_DONE)) as child:
        child.stdout.readline()
        child.send_signal(signal.SIGINT)
        assert child.stdout.readline() == "stopping\n"
        child.send_signal(signal.SIGINT)
        assert child.wait(timeout=2) == 0


def test_busy_port_is_refused_before_viser_is_imported() -> None:
    with socket.create_server(("127.0.0.1", 0)) as other:
        port = str(other.getsockname()[1])
        with process(BUSY_PORT.replace("PORT", port)) as child:
            out, errors = child.communicate(timeout=10)
    told, imported = out.splitlines()
    assert f"--port = {port}: is in use" in told
    assert (imported, errors) == ("False", "")


def test_stop_closes_pages_and_frees_the_port(capfd: pytest.CaptureFixture[str]) -> None:
    with running() as bench:
        with visit(bench.port) as visitor:
            visitor.control("last")
            bench.server.stop()
            bench.server.stop()
            assert visitor.closed_with() == 1001
        assert ("disconnect", "session-of-a-test") in bench.events
    with running() as next_one:
        assert ask(next_one.port, "/healthz").status == 200
    with pytest.raises(OSError):
        ask(bench.port, "/healthz")
    assert "".join(capfd.readouterr()) == ""


def test_strangers_leave_no_trace_on_the_console(capfd: pytest.CaptureFixture[str]) -> None:
    with running() as bench:
        for request in (
            b"POST / HTTP/1.1\r\n\r\n",
            b"\x16\x03\x01garbage\r\n",
            b"GET / HTTP/1.0\r\n\r\n",
            b"",
        ):
            with socket.create_connection(("127.0.0.1", bench.port)) as stranger:
                stranger.sendall(request)
        shake_hands(bench.port, Sec_WebSocket_Version="7")
        shake_hands(bench.port, Sec_WebSocket_Protocol="viser-v0.0.1")
        assert ask(bench.port, "/healthz").status == 200
    assert "".join(capfd.readouterr()) == ""


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (RuntimeError("no picture"), "RuntimeError: no picture"),
        (
            PermissionError(13, "Permission denied", "/opt/kernels/digests"),
            "PermissionError: Permission denied",
        ),
        (ValueError("in /opt/kernels/digests"), "ValueError: in digests"),
    ],
    ids=["words", "a file's", "a path"],
)
def test_a_failing_callback_is_shown_in_the_page(
    caplog: pytest.LogCaptureFixture, error: Exception, told: str
) -> None:
    def fail(client: object, session: str) -> None:
        raise error

    gone: list[str] = []
    server = start(port=0, on_connect=fail, on_disconnect=lambda client, session: gone.append(session))
    try:
        with visit(server.port) as visitor:
            assert visitor.notice() == told
        eventually(lambda: gone)
    finally:
        server.stop()
    assert "a session callback failed" in caplog.text


# ---------------------------------------------------------------- serve --workers


@dataclass
class Door:
    process: subprocess.Popen[str]
    port: int
    state: Path

    def workers(self) -> set[int]:
        """Process numbers of the workers that are there."""
        tasks = Path(f"/proc/{self.process.pid}/task").glob("*/children")
        return {int(pid) for task in tasks for pid in task.read_text().split()}

    def session(self) -> str:
        return ask(self.port, "/").headers["Location"].split("/")[1]

    def answers(self, path: str, status: int) -> bool:
        try:
            return ask(self.port, path).status == status
        except OSError:
            return False


def started(state: Path, *more: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "schuler_bench", "serve", "--port", "0", "--workers", "2", *more],
        env=environment() | {"XDG_STATE_HOME": str(state)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.fixture(scope="module")
def door(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Door]:
    if not Path("/proc/self/task").exists():
        pytest.skip("the workers are found through /proc")
    state = tmp_path_factory.mktemp("state")
    process = started(state)
    assert process.stdout is not None
    found = Door(process, int(process.stdout.readline().split("127.0.0.1:")[1].split("/")[0]), state)
    eventually(lambda: found.answers("/", 302))
    yield found
    process.terminate()
    process.communicate(timeout=10.0)
    assert process.returncode == 0


def test_page_and_websocket_come_through_the_door(door: Door) -> None:
    assert len(door.workers()) == 2
    own = f"/s/{door.session()}/"
    page = ask(door.port, own, {"Accept-Encoding": "gzip"})
    assert page.status == 200 and page.headers["Content-Security-Policy"]
    assert statuses(door.port, own, Origin=f"http://127.0.0.1:{door.port}") == (200, 101)
    assert statuses(door.port, own, Origin="http://evil.example") == (403, 403)
    assert statuses(door.port, own, Host="evil.example") == (421, 421)


@pytest.mark.slow
def test_sessions_of_a_crashed_worker_reopen(door: Door) -> None:
    own, before, zeta = door.session(), door.workers(), label_of("network.zeta")
    with Visitor(door.port, own) as page:
        page.set(PAGE_STATE, "1920x1080|Method|Errors")
        page.wait_for_run(1)
        page.set(zeta, 0.37)
        page.wait_for_run(2)
        page.rest(1.5)  # written down after half a second
    for pid in before:
        os.kill(pid, signal.SIGKILL)
    eventually(lambda: len(door.workers() - before) == 2 and door.answers(f"/s/{own}/", 200))
    with Visitor(door.port, own) as page:
        page.control(zeta)
        page.wait_for_run(1)
        assert page.held(zeta) == pytest.approx(0.37)


def test_silent_sockets_at_the_door_keep_nobody_out(door: Door) -> None:
    with ExitStack() as crowd:
        for _ in range(260):
            crowd.enter_context(socket.create_connection(("127.0.0.1", door.port)))
        assert ask(door.port, "/healthz").status == 200
        assert ask(door.port, "/").status == 302


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--workers", "0"], "--workers"),
        (["--workers", "65"], "--workers"),
        (["--workers", "-1"], "--workers"),
        (["--host", "0.0.0.0"], "--token"),
        ([], "another server keeps its sessions there"),
    ],
    ids=["none", "too many", "negative", "open without a token", "a folder in use"],
)
def test_what_cannot_be_served_is_one_line(door: Door, tmp_path: Path, words: list[str], told: str) -> None:
    process = started(tmp_path if words else door.state, *words)
    out, errors = process.communicate(timeout=30.0)
    assert (process.returncode, out) == (2, "")
    assert told in errors and "Traceback" not in errors
    assert len(errors.strip().splitlines()) == 1


def test_a_session_always_goes_to_the_same_worker_and_others_are_spread() -> None:
    front = Front([1, 2, 3], Limits())
    heads = [f"GET /s/{number:024d}/?a=b HTTP/1.1\r\n".encode() for number in range(300)]
    chosen = [front.worker_of(head) for head in heads]
    assert chosen == [front.worker_of(head.replace(b"/?a=b", b"")) for head in heads]
    assert min(chosen.count(port) for port in (1, 2, 3)) > 60
    assert {front.worker_of(b"GET / HTTP/1.1\r\n") for _ in range(3)} == {1, 2, 3}


def test_a_stranger_cannot_say_where_a_request_comes_from() -> None:
    head = b"GET / HTTP/1.1\r\nX-Schuler-Address: 1.2.3.4\r\nHost: a\r\nx-schuler-ADDRESS : 5.6.7.8\r\n\r\n"
    told = _with_address(head, "10.0.0.9").decode()
    assert told.lower().count("x-schuler-address") == 1 and "x-schuler-address: 10.0.0.9\r\n" in told
    assert "Host: a\r\n" in told and told.endswith("\r\n\r\n")


def test_workers_know_each_others_sessions(tmp_path: Path) -> None:
    """Two processes on one folder: what one has written the other reads."""
    first = open_store(tmp_path)
    assert first is not None
    first.write("a" * 24, {"id": "a" * 24})
    assert session_key(tmp_path) == session_key(tmp_path)
    code = (
        "from pathlib import Path; from schuler_bench.session.database import Database; import sys;"
        "print(Database(Path(sys.argv[1])).has('a' * 24))"
    )
    command = [sys.executable, "-c", code, str(tmp_path)]
    assert subprocess.check_output(command, env=environment(), text=True) == "True\n"
    first.close()
