"""Rules of entry apart from any server: addresses, Host and Origin, the token, and guesses of it."""

import hmac
import socket
import stat
from pathlib import Path
from typing import Any

import pytest
from websockets.datastructures import Headers

from navcore.foundation.errors import InputError
from schuler_bench.http.access import Access, Throttle, access_rules, refuse_address, shown
from schuler_bench.http.address import authority, find_token, is_loopback, listen, parse_origins

# ------------------------------------------------------------ addresses


def test_the_port_asked_for_is_claimed_at_once() -> None:
    with listen("localhost", 0) as listener:
        port = listener.getsockname()[1]
        assert port > 0 and is_loopback(listener)
        socket.create_connection(("127.0.0.1", port), timeout=2).close()
        with pytest.raises(InputError, match=rf"--port = {port}: is in use"):
            listen("127.0.0.1", port)


def test_other_addresses_are_not_loopback() -> None:
    with listen("0.0.0.0", 0) as listener:
        assert not is_loopback(listener)


@pytest.mark.parametrize("port", [-1, 65536, True, "8080", 1.5, None])
def test_port_out_of_range(port: Any) -> None:
    with pytest.raises(InputError, match="from 0 to 65535"):
        listen("127.0.0.1", port)


@pytest.mark.parametrize(
    "host", ["", "no.such.host.invalid", "256.1.1.1", "x" * 300, "a..b", "198.51.100.7", "http://x"]
)
def test_host_that_cannot_be_bound(host: str) -> None:
    with pytest.raises(InputError) as error:
        listen(host, 0)
    assert [(fault.field, fault.value) for fault in error.value.faults] == [("--host", host)]
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
        "", "*", "null", "bench.example.org", "http://", "http://*.example.org", "ftp://x", "http://x/path",
        "http://x?y", "http://user@x", "http://x:", "http://x:99999", "http://x:a", "http://x y", "http://[::1",
        "http://x#y",
    ],
)  # fmt: skip
def test_malformed_origin(text: str) -> None:
    with pytest.raises(InputError) as error:
        parse_origins(["http://good", text])
    assert [fault.value for fault in error.value.faults] == [text]


def test_authority_leaves_out_the_default_port() -> None:
    assert [authority("Localhost", 80), authority("::1", 8080)] == ["localhost", "[::1]:8080"]


# ------------------------------------------------------------ rules of entry


def rules(host: str = "127.0.0.1", port: int = 8080, **changes: Any) -> Access:
    return access_rules(host, port, **({"loopback": True, "token": None, "origins": frozenset()} | changes))


def test_hosts_are_loopback_names_own_name_and_allowed_origins() -> None:
    origins = frozenset({"https://nav.example.org"})
    access = rules("bench", loopback=False, token="long-enough", origins=origins)
    assert access.hosts == {"127.0.0.1:8080", "localhost:8080", "[::1]:8080", "bench:8080", "nav.example.org"}
    assert access.origins >= {"https://nav.example.org", "http://bench:8080"}
    assert "localhost" in rules(port=80).hosts and "localhost:80" not in rules(port=80).hosts


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"host": "10.0.0.1", "loopback": False}, "add --token"),
        ({"token": ""}, "--token"),
        ({"token": "  "}, "--token"),
        ({"loopback": False, "token": "s3cret"}, "at least 8 characters, a shorter one is soon guessed"),
        ({"token": "s3cret"}, "at least 8 characters"),  # a proxy may stand before it
    ],
)
def test_without_a_good_token_it_does_not_start_and_shows_none(changes: dict[str, Any], match: str) -> None:
    with pytest.raises(InputError, match=match) as error:
        rules(**changes)
    assert "s3cret" not in str(error.value)


def test_missing_origin_passes_only_on_loopback_or_with_a_token() -> None:
    headers, own = Headers(Host="LocalHost:8080"), rules()
    assert refuse_address(own, headers) is None
    assert refuse_address(rules(loopback=False, token="long-enough"), headers) is None
    # No server starts like this; the rule holds all the same.
    open_to_all = Access(own.hosts, own.origins, loopback=False, token=None, cookie_name="c")
    assert refuse_address(open_to_all, headers).status == 403


def test_token_outside_ascii_is_compared_not_crashed_on() -> None:
    access = rules(token="geheimnis-\u00fc")
    # As websockets hands over bytes outside ASCII.
    for sent, passes in (("geheimnis-\udcc3\udcbc", True), ("\udcff", False)):
        headers = Headers()
        headers.set_insecure("Authorization", f"Bearer {sent}")
        judged = shown(access, headers)
        assert judged is not None and judged.right is passes
    assert shown(access, Headers(), ["geheimnis-\u00fc"]).right


def test_a_request_is_judged_by_one_comparison_in_constant_time(monkeypatch: pytest.MonkeyPatch) -> None:
    compared, honest = [], hmac.compare_digest
    monkeypatch.setattr(hmac, "compare_digest", lambda a, b: (compared.append((a, b)), honest(a, b))[1])
    access = rules(token="long-enough")
    bearer = ("Authorization", "Bearer long-enough")
    assert shown(access, Headers([bearer])).right and len(compared) == 1
    assert not shown(access, Headers([("Cookie", "schuler_8080=a"), bearer])).right and len(compared) == 2
    assert shown(access, Headers([("Cookie", f"schuler_8080={access.cookie}")])).right and len(compared) == 3
    several = Headers([("Cookie", f"schuler_8080=a; schuler_8080={access.cookie}")])
    for refused in (shown(access, several), shown(access, Headers([bearer, bearer]))):
        assert not refused.right and refused.reason == "Show one token, once."
    assert not shown(access, Headers([bearer]), ["long-enough", "wrong"]).right
    assert len(compared) == 3 and shown(access, Headers()) is None


def test_guesses_beyond_the_burst_wait_and_are_refilled() -> None:
    now = [100.0]
    throttle = Throttle(burst=3, refill_s=2.0, clock=lambda: now[0])
    for _ in range(3):
        assert throttle.wait_s("a") == 0.0
        throttle.failed("a")
    assert (throttle.wait_s("a"), throttle.wait_s("b")) == (pytest.approx(2.0), 0.0)
    now[0] += 2.0
    assert throttle.wait_s("a") == 0.0
    throttle.failed("a")
    assert throttle.wait_s("a") == pytest.approx(2.0)
    now[0] += 1000.0
    throttle.failed("a")
    # time without guesses is not saved up beyond the burst, nor held against
    assert throttle.wait_s("a") == 0.0


def test_a_right_guess_is_taken_back_and_cookies_leave_room_for_tokens() -> None:
    throttle = Throttle(burst=5, refill_s=2.0, clock=lambda: 100.0)
    for _ in range(9):
        throttle.failed("a")
        throttle.forgive("a")
    assert (throttle.wait_s("a"), throttle.guesses) == (0.0, 0)
    for _ in range(4):
        assert throttle.wait_s("a", by_cookie=True) == 0.0
        throttle.failed("a")
    assert throttle.wait_s("a", by_cookie=True) > 0.0 == throttle.wait_s("a")


def test_guesses_of_all_addresses_together_wait_for_their_turn_and_nobody_is_locked_out() -> None:
    now = [100.0]
    throttle = Throttle(all_burst=3, all_refill_s=0.5, clock=lambda: now[0])
    assert [throttle.turn_s(1.2) for _ in range(6)] == [0.0, 0.0, 0.0, 0.5, 1.0, None]
    assert [throttle.turn_s(1.2) for _ in range(1000)] == [None] * 1000  # these take no turns
    now[0] += 0.5
    assert throttle.turn_s(1.2) == 1.0
    now[0] += 1000.0
    assert [throttle.turn_s(0.0) for _ in range(4)] == [0.0, 0.0, 0.0, None]


def test_addresses_are_forgotten_beyond_a_bound() -> None:
    throttle = Throttle()
    for number in range(10_000):
        throttle.failed(str(number))
    assert len(throttle._spent) <= 4096


# ------------------------------------------------------------ where a token comes from


def test_order_of_the_sources(tmp_path: Path) -> None:
    file = tmp_path / "token"
    file.write_text("from-the-file\nsecond line")
    of_file, of_variable = {"SCHULER_TOKEN_FILE": str(file)}, {"SCHULER_TOKEN": "from-the-variable"}
    both = of_file | of_variable
    assert find_token("given", file, True, both).value == "given"
    assert find_token(None, file, False, both).value == "from-the-file"
    assert find_token(None, None, False, both).value == "from-the-variable"
    assert find_token(None, None, False, of_file).value == "from-the-file"
    assert find_token(None, None, False, {"SCHULER_TOKEN": ""}).value is None


def test_a_generated_token_is_long_new_and_kept_in_its_file(tmp_path: Path) -> None:
    file = tmp_path / "token"
    first, second = find_token(None, None, True, {}), find_token(None, file, True, {})
    assert first.generated and len(first.value) >= 32 and first.value != second.value
    assert second.generated and stat.S_IMODE(file.stat().st_mode) == 0o600
    again = find_token(None, file, True, {})
    assert (again.value, again.generated) == (second.value, False)


@pytest.mark.parametrize("content", [None, b"", b"\n", b"\xff"])
def test_a_file_without_a_token_is_refused(tmp_path: Path, content: bytes | None) -> None:
    if content is not None:
        (tmp_path / "token").write_bytes(content)
    with pytest.raises(InputError, match="--token-file"):
        find_token(None, tmp_path / "token", False, {})
