"""Listening to a ship's INS: what is listened to, what is dropped, and that it goes on whatever comes."""

import socket
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from navcore.foundation.errors import InputError
from schuler_bench.cli.serve import ServeCommand
from schuler_bench.live import inlet as inlets
from schuler_bench.live.addresses import Datagrams, Growing, sources_of, target_of
from schuler_bench.live.inlet import LARGEST_DATAGRAM, MOST_WAITING, Inlet, Listener
from schuler_bench.live.live import Live, listening, present
from schuler_bench.live.settings import settings_of
from schuler_bench.views.files.live import status_html, status_lines
from tests.sentences import seconds


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.fixture
def out() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        yield one


def until(told: object, seconds_s: float = 20.0) -> None:
    """Wait until a condition holds."""
    ends = time.monotonic() + seconds_s
    while not told():  # pyright: ignore[reportCallIssue]
        assert time.monotonic() < ends, "it did not come to pass"
        time.sleep(0.02)


def test_addresses_are_read() -> None:
    assert sources_of(["udp://127.0.0.1:10110", "udp://:10111"]) == (
        Datagrams("127.0.0.1", 10110),
        Datagrams("127.0.0.1", 10111),
    )
    assert sources_of(["udp://0.0.0.0:1?from=192.0.2.7"]) == (Datagrams("0.0.0.0", 1, "192.0.2.7"),)
    (growing,) = sources_of(["file:/var/log/ins.nmea"])
    assert growing == Growing(Path("/var/log/ins.nmea")) and str(growing) == "file:ins.nmea"
    assert str(target_of("udp://[::1]:7", ())) == "udp://[::1]:7"


@pytest.mark.parametrize(
    ("text", "allowed"),
    [
        ("10110", "must be udp://HOST:PORT"),
        ("udp://127.0.0.1", "the port is a whole number"),
        ("udp://127.0.0.1:0", "the port is a whole number"),
        ("udp://127.0.0.1:70000", "must be udp://HOST:PORT"),
        ("udp://127.0.0.1:x", "must be udp://HOST:PORT"),
        ("tcp://127.0.0.1:10110", "must be udp://HOST:PORT"),
        ("udp://127.0.0.1:10110/path", "must be udp://HOST:PORT"),
        ("udp://127.0.0.1:10110?form=1", "must be udp://HOST:PORT"),
        ("udp://0.0.0.0:10110?from=bow", "numeric address of the sender"),
        ("udp://no such:10110", "must be udp://HOST:PORT"),
        ("udp://0.0.0.0:10110", "is open to others"),
        ("udp://192.0.2.1:10110", "is open to others"),
        ("file:", "must name a file"),
        ("file:/dev/null", "must name a file"),
        ("file:/tmp", "must name a file"),
    ],
)
def test_what_is_no_address_is_refused(text: str, allowed: str) -> None:
    with pytest.raises(InputError, match=allowed) as refused:
        sources_of([text])
    assert refused.value.faults[0].field == "--listen"


def test_options_that_need_another_one_are_refused() -> None:
    for command, field in (
        (ServeCommand(send="udp://127.0.0.1:1"), "--send"),
        (ServeCommand(listen=("udp://:9",), workers=2), "--workers"),
        (ServeCommand(listen=("udp://:9",), send_method="x"), "--send-method"),
        (ServeCommand(listen=("udp://:9", "udp://127.0.0.1:9")), "--listen"),
        (ServeCommand(listen=("udp://:9",), send="udp://127.0.0.1:9"), "--send"),
        (ServeCommand(listen=("udp://0.0.0.0:9?from=192.0.2.7",), send="udp://127.0.0.1:9"), "--send"),
        (ServeCommand(live_scenario="zha-fast"), "--live-scenario"),
    ):
        with pytest.raises(InputError) as refused:
            command.execute()
        assert refused.value.faults[0].field == field


def test_a_port_in_use_is_named(out: socket.socket) -> None:
    out.bind(("127.0.0.1", 0))
    with pytest.raises(InputError, match="is in use"):
        Listener([Datagrams("127.0.0.1", out.getsockname()[1])], Inlet())


def test_what_is_too_much_is_dropped_and_counted() -> None:
    inlet = Inlet()
    inlet.take(b"$A" * 2000 + b"\n$INHDT,1.0,T\n\n  \n\xff\x00\n")
    assert inlet.dropped == 1 and inlet.drain() == "$INHDT,1.0,T\n\ufffd\x00\n"
    inlet.take(b"x\n" * (MOST_WAITING + 50))
    assert inlet.dropped == 51 and len(inlet.drain()) == 2 * MOST_WAITING
    assert inlet.drain() == ""


def test_strangers_and_giants_are_dropped(out: socket.socket) -> None:
    inlet = Inlet()
    mine, other = Datagrams("127.0.0.1", free_port()), Datagrams("127.0.0.1", free_port(), "192.0.2.7")
    listener = Listener([mine, other], inlet)
    try:
        out.sendto(b"$INHDT,1.0,T\r\n", ("127.0.0.1", other.port))
        out.sendto(b"x" * (LARGEST_DATAGRAM + 1), ("127.0.0.1", mine.port))
        out.sendto(b"", ("127.0.0.1", mine.port))
        until(lambda: inlet.dropped == 2)
        out.sendto(b"$INHDT,2.0,T", ("127.0.0.1", mine.port))
        text = ""

        def came() -> bool:
            nonlocal text
            text += inlet.drain()
            return text == "$INHDT,2.0,T\n"

        until(came)
    finally:
        listener.close()


def test_a_file_that_grows_is_followed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inlets, "_PAUSE_S", 0.01)
    file, inlet, text = tmp_path / "ins.nmea", Inlet(), ""
    file.write_text("before\n")
    listener = Listener([Growing(file)], inlet)

    def came(wanted: str) -> bool:
        nonlocal text
        text += inlet.drain()
        return text == wanted

    try:
        time.sleep(0.1)
        with file.open("a") as stream:
            stream.write("a\nb")
            stream.flush()
            until(lambda: came("a\n"))
            stream.write("c\n")
        until(lambda: came("a\nbc\n"))
        file.write_text("d\n")  # begun anew
        until(lambda: came("a\nbc\nd\n"))
        file.rename(tmp_path / "ins.1")
        time.sleep(0.05)
        (tmp_path / "new").write_text("e\n")
        (tmp_path / "new").rename(file)  # replaced, as a logger does at midnight
        until(lambda: came("a\nbc\nd\ne\n"))
    finally:
        listener.close()


def test_listens_damps_and_sends_on(out: socket.socket, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("schuler_bench.live.live.TICK_S", 0.05)
    monkeypatch.setattr("navcore.foundation.kernel_cache.ready", lambda: True)
    port = free_port()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as box:
        box.bind(("127.0.0.1", 0))
        box.settimeout(5.0)
        target = f"udp://127.0.0.1:{box.getsockname()[1]}"
        settings = settings_of([f"udp://:{port}"], target, "compass")
        assert settings is not None
        with listening(settings) as live:
            assert live is not None
            assert present() is live
            _send(out, port, [*seconds(60), ["$INHDT,1.0,T*00"]])
            until(lambda: live.status.sent > 50)
            first = box.recv(200)
            assert first.startswith(b"$INRMC,") and first.endswith(b"\r\n")
            _send(out, port, seconds(120)[60:])
            until(lambda: live.status.sentences == 480 and live.status.delay_s < 12.0)
            status = live.status
            said = " ".join(map(str, status_lines(status)))
            assert "480 in all; 0 dropped, 1 malformed" in said and "s behind" in said
            assert "position IN" in said and f"compass to {target}" in said
            html = status_html(status, live.curves())
            assert "<svg" in html and html.count("<tr") == 6 and len(live.curves().time_s) >= 10
            assert live.recording().count(b"\n") == 481
            number, _ = live.wait(0, 1.0)
            assert live.wait(number - 1, 1.0)[0] >= number
        assert present() is None and live.ended


def _send(out: socket.socket, port: int, each: list[list[str]]) -> None:
    for second in each:
        out.sendto("\r\n".join(second).encode(), ("127.0.0.1", port))
        time.sleep(0.002)


def test_an_error_of_ours_does_not_end_it(out: socket.socket, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("schuler_bench.live.live.TICK_S", 0.05)
    monkeypatch.setattr("navcore.foundation.kernel_cache.ready", lambda: True)
    port, calls = free_port(), list[int]()

    def fails(self: Live, text: str) -> None:
        calls.append(len(text))
        raise ZeroDivisionError

    settings = settings_of([f"udp://:{port}"])
    assert settings is not None
    with monkeypatch.context() as broken:
        broken.setattr(Live, "_take", fails)
        live = Live(settings.scenario, settings.sources)
        _send(out, port, seconds(2))
        until(lambda: len(calls) > 0 and live.status.told)
    try:
        assert "begins anew" in live.status.told
        _send(out, port, seconds(60))
        until(lambda: live.status.damped is not None)
    finally:
        live.close()
