"""Where the server listens: every address it must refuse, in one line."""

from __future__ import annotations

import socket

import pytest

from app.http.address import authority, is_loopback, listen, parse_origins
from navcore.foundation.errors import InputError


def test_any_free_port() -> None:
    with listen("127.0.0.1", 0) as listener:
        assert listener.getsockname()[1] > 0
        assert is_loopback(listener)


def test_the_port_asked_for_is_claimed_at_once() -> None:
    with listen("localhost", 0) as listener:
        port = listener.getsockname()[1]
        with socket.create_connection(("127.0.0.1", port), timeout=2):
            pass
        with pytest.raises(InputError, match=rf"--port = {port}: is in use"):
            listen("127.0.0.1", port)


def test_other_addresses_are_not_loopback() -> None:
    with listen("0.0.0.0", 0) as listener:
        assert not is_loopback(listener)


@pytest.mark.parametrize("port", [-1, 65536, True, "8080", 1.5, None])
def test_port_out_of_range(port: object) -> None:
    with pytest.raises(InputError, match="from 0 to 65535"):
        listen("127.0.0.1", port)


@pytest.mark.parametrize(
    "host", ["", "no.such.host.invalid", "256.1.1.1", "x" * 300, "a..b", "198.51.100.7", "http://x"]
)
def test_host_that_cannot_be_bound(host: str) -> None:
    with pytest.raises(InputError) as error:
        listen(host, 0)
    (fault,) = error.value.faults
    assert fault.field == "--host" and fault.value == host
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("text", "origin"),
    [
        ("https://bench.example.org", "https://bench.example.org"),
        ("https://Bench.Example.org:443/", "https://bench.example.org"),
        ("http://10.1.2.3:8080", "http://10.1.2.3:8080"),
        ("HTTP://x:80", "http://x"),
        ("https://x:80", "https://x:80"),
        ("http://[::1]:8080", "http://[::1]:8080"),
    ],
)
def test_origins_as_browsers_write_them(text: str, origin: str) -> None:
    assert parse_origins([text]) == {origin}


@pytest.mark.parametrize(
    "text",
    [
        "",
        "*",
        "null",
        "bench.example.org",
        "http://",
        "http://*.example.org",
        "ftp://x",
        "http://x/path",
        "http://x?y",
    ]
    + [
        "http://user@x",
        "http://x:",
        "http://x:99999",
        "http://x:a",
        "http://x y",
        "http://[::1",
        "http://x#y",
    ],
)
def test_malformed_origin(text: str) -> None:
    with pytest.raises(InputError) as error:
        parse_origins(["http://good", text])
    assert [fault.value for fault in error.value.faults] == [text]


def test_authority_leaves_out_the_default_port() -> None:
    assert authority("Localhost", 80) == "localhost"
    assert authority("::1", 8080) == "[::1]:8080"
