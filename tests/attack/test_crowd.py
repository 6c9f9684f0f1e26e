"""serving 15: too many visitors, sockets, uploads, guesses; a page that never reads, one that floods."""

import hashlib
import hmac
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager

import pytest

from schuler_bench.http.limits import MIB, Limits
from tests.attack.conftest import TOKEN, Bench, eventually, running
from tests.attack.wire import SESSION, ask, raw, shake_hands, statuses, upload, visit

pytestmark = pytest.mark.attack


@contextmanager
def crowded(**limits: object) -> Iterator[tuple[Bench, ExitStack]]:
    """A server with these limits, and a crowd that leaves at the end."""
    with running(limits=Limits(**limits)) as bench, ExitStack() as crowd:
        yield bench, crowd


def test_visitors_beyond_the_limit_are_told() -> None:
    with crowded(visitors=5) as (bench, crowd):
        for number in range(5):
            crowd.enter_context(visit(bench.port, f"visitor-{number}"))
        assert shake_hands(bench.port).status == 503
        page = ask(bench.port, f"/s/{SESSION}/")
        assert page.status == 503 and b"All places are taken" in page.body
        assert page.headers["Retry-After"] and page.headers["X-Frame-Options"] == "DENY"
        assert ask(bench.port, "/healthz").status == 200
        crowd.close()
        eventually(lambda: ask(bench.port, f"/s/{SESSION}/").status == 200)


def test_silent_sockets_keep_nobody_out() -> None:
    with crowded(half_open=40) as (bench, crowd), visit(bench.port, "already-there") as visitor:
        gain = visitor.control("gain")
        silent = [
            crowd.enter_context(socket.create_connection(("127.0.0.1", bench.port))) for _ in range(200)
        ]
        # The oldest are told and closed; whoever asks for something gets it.
        assert {one.recv(100)[:12] for one in silent[:160]} == {b"HTTP/1.1 503"}
        assert ask(bench.port, "/healthz").status == 200
        assert shake_hands(bench.port).status == 101
        visitor.set(gain, 0.9)
        eventually(lambda: bench.of("already-there")["gain"].value == 0.9)


def test_renewed_sockets_do_not_stop_health_and_page(record_property: Callable[[str, object], None]) -> None:
    """260 sockets without a request, each opened anew as soon as it is closed."""
    with crowded() as (bench, crowd):
        ended = threading.Event()

        def renew() -> None:
            with ExitStack() as closing:
                held: list[socket.socket] = []
                while not ended.is_set():
                    try:
                        held.append(socket.create_connection(("127.0.0.1", bench.port), timeout=1))
                    except OSError:
                        continue
                    closing.callback(held[-1].close)
                    if len(held) > 65:
                        held.pop(0).close()

        attackers = [threading.Thread(target=renew) for _ in range(4)]
        for one in attackers:
            one.start()
            crowd.callback(one.join)
        crowd.callback(ended.set)
        time.sleep(0.3)
        slowest_s = 0.0
        for _ in range(10):
            began = time.monotonic()
            assert ask(bench.port, "/healthz").status == 200
            slowest_s = max(slowest_s, time.monotonic() - began)
            assert ask(bench.port, "/").status == 302
            assert shake_hands(bench.port).status == 101
        record_property("health_s", slowest_s)


def test_an_idle_page_gives_up_its_place_and_comes_back() -> None:
    with crowded(visitors=3, idle_s=0.2) as (bench, crowd):
        idle = [crowd.enter_context(visit(bench.port, f"idle-page-{number}")) for number in range(3)]
        for page in idle:
            page.control("last")
        time.sleep(0.3)
        # A page that connects by itself waits; one that a person has opened does not.
        assert shake_hands(bench.port, "/s/not-invited-1").status == 503
        assert ask(bench.port, "/s/newcomer-1/").status == 200
        with visit(bench.port, "newcomer-1") as newcomer:
            newcomer.control("last")
            assert idle[0].closed_with() == 1013
            assert shake_hands(bench.port, "/s/idle-page-0").status == 503
            # The person is back at the page that was closed (static/place.js).
            assert ask(bench.port, "/s/idle-page-0/place").status == 204
            with visit(bench.port, "idle-page-0") as back:
                back.control("last")
                assert idle[1].closed_with() == 1013


def test_a_page_that_is_used_keeps_its_place() -> None:
    with crowded(visitors=1, idle_s=30.0) as (bench, _), visit(bench.port, "in-use-1") as page:
        page.control("last")
        assert statuses(bench.port, "/s/newcomer-2/") == (503, 503)
        page.set(page.control("gain"), 0.9)
        eventually(lambda: bench.of("in-use-1")["gain"].value == 0.9)


def test_one_address_leaves_places_to_others() -> None:
    with crowded(visitors=10, pages_per_address=2) as (bench, crowd):
        for number in range(2):
            crowd.enter_context(visit(bench.port, f"neighbour-{number}"))
        assert shake_hands(bench.port).status == 503


def test_unfinished_uploads_of_all_together_are_bounded_and_released() -> None:
    limits = {"upload_bytes": MIB, "all_uploads_bytes": 3 * MIB, "upload_stall_s": 0.3}
    with crowded(**limits) as (bench, crowd):
        pages = [crowd.enter_context(visit(bench.port, f"uploader-{number}")) for number in range(4)]
        for number, page in enumerate(pages[:3]):
            upload(page, "log", f"t{number}", [b"x" * 1000], size=MIB)
            page.wait_for(lambda m: m["type"] == "FileTransferPartAck")
        upload(pages[3], "log", "t3", [], size=MIB)
        assert "other visitors" in pages[3].notice()
        time.sleep(0.4)
        upload(pages[3], "log", "t4", [b"x" * 1000], size=MIB)
        pages[3].wait_for(lambda m: m["type"] == "FileTransferPartAck" and m["transfer_uuid"] == "t4")
        states = [c.gui._current_file_upload_states for c in bench.server.viser.get_clients().values()]
        assert sum(map(len, states)) == 1


def test_wrong_tokens_are_slowed_down() -> None:
    with running(token=TOKEN, limits=Limits(token_guesses=5, token_refill_s=0.4)) as bench:
        cookie = ask(bench.port, f"/?token={TOKEN}").headers["Set-Cookie"].partition(";")[0]
        seen = [ask(bench.port, f"/?token=guess-{number}").status for number in range(8)]
        assert seen == [401] * 5 + [429] * 3
        # Neither is the right one told from a wrong one meanwhile, by whichever way it comes.
        late = ask(bench.port, "/", {"Authorization": f"Bearer {TOKEN}"})
        assert late.status == 429 and int(late.headers["Retry-After"]) >= 1
        # Whoever is in already is not kept out by a neighbour who guesses.
        assert ask(bench.port, "/", {"Cookie": cookie}).status == 302
        eventually(lambda: ask(bench.port, f"/?token={TOKEN}").status == 302)


def test_cookies_and_bearers_are_counted_with_the_tokens() -> None:
    with running(token=TOKEN, limits=Limits(token_guesses=20, token_refill_s=60.0)) as bench:
        cookie = ask(bench.port, f"/?token={TOKEN}").headers["Set-Cookie"].partition(";")[0]
        name, _, value = cookie.partition("=")
        # It is no function of the token alone: who guesses tokens cannot try them as cookies.
        old_way = hmac.new(TOKEN.encode(), b"schuler bench cookie", hashlib.sha256).hexdigest()
        assert old_way != value

        def tried(**headers: str | list[str]) -> int:
            return ask(bench.port, "/", {key: given for key, given in headers.items()}).status

        seen = [tried(Cookie=f"{name}={old_way}{number}") for number in range(30)]
        assert seen == [401] * 16 + [429] * 14
        # Many in one request are one guess, and none of them is compared.
        many = "; ".join([*(f"{name}={number}" for number in range(100)), cookie])
        assert tried(Cookie=many) == 429
        # Pages that go on showing a cookie of an earlier token leave room for the right token.
        assert ask(bench.port, f"/?token={TOKEN}").status == 302
        refused = ask(
            bench.port, "/", {"Authorization": [f"Bearer {n}" for n in range(99)] + [f"Bearer {TOKEN}"]}
        )
        assert refused.status == 401 and b"Show one token, once." in refused.body
        assert [tried(Authorization="Bearer wrong") for _ in range(5)] == [401] * 3 + [429] * 2
        assert ask(bench.port, f"/?token={TOKEN}").status == tried(Authorization=f"Bearer {TOKEN}") == 429
        assert shake_hands(bench.port, Cookie=f"{name}=wrong").status == 429
        assert (tried(Cookie=cookie), shake_hands(bench.port, Cookie=cookie).status) == (302, 101)


def test_guesses_of_all_addresses_together_are_slowed_down_and_nobody_is_locked_out() -> None:
    limits = Limits(token_guesses=10_000, all_guesses=10, all_refill_s=0.02)
    with running(token=TOKEN, limits=limits) as bench:
        began = time.monotonic()
        assert {ask(bench.port, f"/?token=guess-{number}").status for number in range(60)} == {401}
        assert time.monotonic() - began >= 0.9  # 50 turns of 0.02 s: a machine that is slow takes longer
        assert ask(bench.port, f"/?token={TOKEN}").status == 302


def test_a_page_that_never_reads_is_dropped() -> None:
    with crowded(ping_s=0.3) as (bench, crowd):
        crowd.enter_context(raw(bench.port, SESSION))
        places = bench.server.viser._websock_server._live_connections
        eventually(lambda: len(places) == 1)
        for _ in range(50):
            bench.server.viser.gui.add_markdown("x" * 100_000)
        eventually(lambda: len(places) == 0)


def test_a_flood_is_slowed_not_lost() -> None:
    with crowded(frames_per_second=50) as (bench, _), visit(bench.port, "the-flooder") as visitor:
        gain, last = visitor.control("gain"), visitor.control("last")
        started = time.monotonic()
        for number in range(120):
            visitor.set(gain, number / 1000)
        visitor.set(last, True)
        eventually(lambda: ("last", True) in bench.events)
        assert bench.of("the-flooder")["gain"].value == 0.119
        # Not a measure of speed: 120 messages at 50 a second cannot be read within one second.
        assert time.monotonic() - started > 1.0
