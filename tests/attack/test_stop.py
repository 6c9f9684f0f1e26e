"""serving 17, 18 and a quiet console: the server as a process of its own."""

import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager

import pytest

from app.bench.process import environment
from app.http.server import start
from tests.attack.conftest import eventually, running
from tests.attack.wire import ask, shake_hands, visit

pytestmark = pytest.mark.attack

PROGRAM = """
import signal, threading, time
from app.http.server import start
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
BUSY_PORT = """
import sys
from app.http.server import start
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


def test_a_failing_callback_is_shown_in_the_page(caplog: pytest.LogCaptureFixture) -> None:
    def fail(client: object, session: str) -> None:
        raise RuntimeError("no picture")

    gone: list[str] = []
    server = start(port=0, on_connect=fail, on_disconnect=lambda client, session: gone.append(session))
    try:
        with visit(server.port) as visitor:
            assert visitor.notice() == "RuntimeError: no picture"
        eventually(lambda: gone)
    finally:
        server.stop()
    assert "a session callback failed" in caplog.text
