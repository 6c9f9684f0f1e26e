"""serving 1-6, 12, 16, 19: who gets in, under which name, and what every answer carries."""

import gzip
import json
import logging
import re
import socket
from collections.abc import Iterator

import pytest

from navcore.foundation.errors import InputError
from schuler_bench.http.ids import SessionIds, copied_from, is_shared, new_shared_id
from tests.attack.conftest import TOKEN, Bench, eventually, running
from tests.attack.wire import SESSION, ask, shake_hands, statuses, visit

pytestmark = pytest.mark.attack

PAGE = f"/s/{SESSION}/"


def test_listens_on_loopback_only(bench: Bench) -> None:
    assert bench.server.url == f"http://127.0.0.1:{bench.port}/"
    try:
        other = socket.gethostbyname(socket.gethostname())
    except OSError:
        pytest.skip(f"this machine's own name, {socket.gethostname()}, has no address here")
    if other.startswith("127."):
        other = "127.0.0.2"
    with pytest.raises(OSError), socket.create_connection((other, bench.port), timeout=2):
        pass


@pytest.mark.parametrize(
    "origin",
    [
        "http://evil.example",
        "null",
        "http://127.0.0.1",
        "http://127.0.0.1:1",
        "https://127.0.0.1:{port}",
        "http://127.0.0.1:{port}.evil.example",
        "http://127.0.0.1.evil.example:{port}",
        "http://localhost:{port}/",
        "HTTP://LOCALHOST:{port}",
        "",
    ],
)
def test_foreign_origin_is_refused(bench: Bench, origin: str) -> None:
    assert statuses(bench.port, Origin=origin.format(port=bench.port)) == (403, 403)


def test_two_origins_are_refused(bench: Bench) -> None:
    assert statuses(bench.port, Origin=[f"http://127.0.0.1:{bench.port}"] * 2) == (403, 403)


@pytest.mark.parametrize("name", ["127.0.0.1", "localhost", "[::1]", None])
def test_own_origin_and_host_are_accepted_and_on_loopback_none(bench: Bench, name: str | None) -> None:
    own = f"{name}:{bench.port}"
    headers = {} if name is None else {"Origin": f"http://{own}", "Host": own}
    assert statuses(bench.port, **headers) == (200, 101)


@pytest.mark.parametrize(
    "host",
    [
        ["evil.example"],
        ["evil.example:{port}"],
        ["127.0.0.1"],
        ["127.0.0.1:1"],
        ["localhost.evil.example:{port}"],
        [""],
        [],
        ["127.0.0.1:{port}", "127.0.0.1:{port}"],
    ],
    ids=" and ".join,
)
def test_wrong_host_is_refused(bench: Bench, host: list[str]) -> None:
    told = [each.format(port=bench.port) for each in host]
    assert {statuses(bench.port, path, Host=told) for path in ("/", PAGE, "/healthz")} == {(421, 421)}


def test_healthz_tells_the_version_and_nothing_else(bench: Bench) -> None:
    answer = ask(bench.port, "/healthz")
    told = json.loads(answer.body)
    assert (answer.status, told["status"], told.keys()) == (200, "ok", {"status", "version"})


def test_every_answer_carries_the_headers(bench: Bench) -> None:
    for path, host in (("/", []), (PAGE, []), ("/healthz", []), ("/nothing", []), ("/", ["evil.example"])):
        headers = ask(bench.port, path, {"Host": host} if host else None).headers
        names = ("X-Content-Type-Options", "X-Frame-Options", "Referrer-Policy", "Server")
        assert [headers[name] for name in names] == ["nosniff", "DENY", "no-referrer", None]
        policy = headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy and "frame-ancestors 'none'" in policy and "evil" not in policy
        scripts = [part for part in policy.split("; ") if part.startswith("script-src")]
        assert host or len(scripts) == 1
        assert "unsafe-inline" not in str(scripts) and "'unsafe-eval'" not in str(scripts)


def test_only_a_single_view_may_be_framed_and_only_by_named_origins() -> None:
    with running(frame_origins=["https://slides.example.org"]) as bench:
        for query, framed_by in (
            ("?view=bode", "https://slides.example.org"),
            ("?lang=en&view=bode", "https://slides.example.org"),
            ("", "'none'"),
            ("?tab=view", "'none'"),
        ):
            policy = ask(bench.port, PAGE + query).headers["Content-Security-Policy"]
            assert f"frame-ancestors {framed_by}" in policy.split("; "), query
    with pytest.raises(InputError, match="--frame-origin"), running(frame_origins=["*"]):
        pass


@pytest.mark.parametrize(
    "path",
    [
        "/../../etc/passwd",
        "/s/../../etc/passwd",
        f"/s/{SESSION}/../../../etc/passwd",
        f"/s/{SESSION}/%2e%2e/%2e%2e/etc/passwd",
        f"/s/{SESSION}/index.html",
        "/static/../site.py",
        "/static/",
        "/static/plotly.min.js",
        "/s/",
        "/s/short",
        "/s/short/",
        "/s/" + "x" * 65 + "/",
        "/s/with%20space/",
        "/s/with.dot.inside/",
        "/index.html",
        "//etc/passwd",
        "/metrics",  # a server without figures
    ],
)
def test_unknown_and_malformed_paths_are_not_found(bench: Bench, path: str) -> None:
    assert statuses(bench.port, path) == (404, 404)


def test_root_leads_to_a_fresh_session_each_time(bench: Bench) -> None:
    answers = [ask(bench.port, "/?fixedDpr=0.25") for _ in range(2)]
    places = {answer.headers["Location"] for answer in answers}
    assert [answer.status for answer in answers] == [302, 302] and len(places) == 2
    assert all(re.fullmatch(r"s/[A-Za-z0-9_-]{20,64}/\?fixedDpr=0\.25", place) for place in places)
    assert ask(bench.port, f"/s/{SESSION}?a=b").headers["Location"] == f"{SESSION}/?a=b"


def test_page_and_its_scripts_are_served_plain_and_compressed(bench: Bench) -> None:
    plain = ask(bench.port, PAGE)
    zipped = ask(bench.port, PAGE, {"Accept-Encoding": "br, gzip"})
    assert plain.status == zipped.status == 200
    assert zipped.headers["Content-Encoding"] == "gzip"
    assert gzip.decompress(zipped.body) == plain.body
    assert b"<title>Schuler Bench</title>" in plain.body
    assert b"<script>" not in plain.body and b"javascript:" not in plain.body
    names = re.findall(r'(?:src|href)="\.\./\.\./static/([^"]+)"', plain.body.decode())
    assert {name.split(".")[0] for name in names} == {
        "arimo", "bench", "viser", "zstd", "start", "plotly-basic",
    }  # fmt: skip
    kinds = {"js": "text/javascript", "css": "text/css", "wasm": "application/wasm", "ttf": "font/ttf"}
    for name in names:
        answer = ask(bench.port, f"/static/{name}")
        assert answer.status == 200 and "immutable" in answer.headers["Cache-Control"]
        assert answer.headers["Content-Type"].startswith(kinds[name.rpartition(".")[2]])


def test_session_of_the_path_reaches_the_callbacks_once_it_has_a_camera(bench: Bench) -> None:
    bench.events.clear()
    names = ("first-visitor", "second-visitor")
    with visit(bench.port, "never-looked", camera=False):
        pass
    with visit(bench.port, "first-visitor"), visit(bench.port, "second-visitor/"):
        eventually(lambda: {("connect", name) for name in names} <= set(bench.events))
    eventually(lambda: {("disconnect", name) for name in names} <= set(bench.events))
    assert not any("never-looked" in event for event in bench.events)


# ---------------------------------------------------------------- the token


class TestToken:
    @pytest.mark.parametrize(
        "path", ["/", PAGE, "/static/x.js", "/nothing", f"{PAGE}?token=", "/?token=wrong"]
    )
    def test_page_and_websocket_need_it(self, guarded: Bench, path: str) -> None:
        answer = ask(guarded.port, path)
        assert answer.status == 401 and TOKEN not in answer.body.decode()
        # In the address it lets a page in, which gets a cookie for it, but no websocket.
        for address in (path, f"/s/{SESSION}", f"/s/{SESSION}?token={TOKEN}"):
            assert shake_hands(guarded.port, address).status == 401
        assert ask(guarded.port, "/healthz").status == 200

    @pytest.mark.parametrize(
        "given", ["Bearer wrong", f"Basic {TOKEN}", TOKEN, "Bearer", f"Bearer {TOKEN}x", "Bearer \u00e4"]
    )
    def test_wrong_ones_are_refused(self, guarded: Bench, given: str) -> None:
        assert shake_hands(guarded.port, Authorization=given).status == 401
        assert shake_hands(guarded.port, Cookie=f"schuler_{guarded.port}={given}").status == 401

    def test_is_accepted_as_bearer(self, guarded: Bench) -> None:
        assert shake_hands(guarded.port, Authorization=f"Bearer {TOKEN}").status == 101
        assert ask(guarded.port, "/", {"Authorization": f"bearer {TOKEN}"}).status == 302

    @pytest.mark.parametrize(
        ("path", "location"),
        [("/", "./"), (PAGE, "./"), (f"/s/{SESSION}", SESSION)],
        ids=["root", "page", "id"],
    )
    def test_is_exchanged_for_a_cookie(self, guarded: Bench, path: str, location: str) -> None:
        answer = ask(guarded.port, f"{path}?a=1&token={TOKEN}&b=%20")
        assert (answer.status, answer.headers["Location"]) == (302, f"{location}?a=1&b=+")
        cookie = answer.headers["Set-Cookie"]
        assert "HttpOnly" in cookie and "SameSite=Strict" in cookie and "Secure" not in cookie
        assert TOKEN not in cookie
        assert statuses(guarded.port, Cookie=f"other=1; broken; {cookie.partition(';')[0]}") == (200, 101)

    def test_link_from_another_site_moves_on_by_itself(self, guarded: Bench) -> None:
        answer = ask(guarded.port, f'/?token={TOKEN}&x="><script>', {"Sec-Fetch-Site": "cross-site"})
        assert answer.status == 200 and answer.headers["Set-Cookie"]
        assert b'content="0;url=./?' in answer.body and b"<script" not in answer.body

    def test_cookie_is_secure_behind_https(self, guarded: Bench) -> None:
        own = {"Host": "bench.example.org", "Authorization": f"Bearer {TOKEN}"}
        assert "; Secure" in ask(guarded.port, f"/?token={TOKEN}", own).headers["Set-Cookie"]
        for scheme, status in (("https", 101), ("http", 403)):
            assert shake_hands(guarded.port, **own, Origin=f"{scheme}://bench.example.org").status == status

    def test_is_never_logged(self, guarded: Bench, caplog: pytest.LogCaptureFixture, capfd) -> None:
        bearer = {"Authorization": f"Bearer {TOKEN}"}
        with caplog.at_level(logging.DEBUG):
            ask(guarded.port, f"/?token={TOKEN}")
            shake_hands(guarded.port, f"/s/{SESSION}?token={TOKEN}", **bearer)
            with visit(guarded.port, additional_headers=bearer) as visitor:
                visitor.control("last")
        ours = [r.getMessage() for r in caplog.records if r.name != "websockets.client"]
        assert len(ours) < len(caplog.records), "nothing was recorded at all"
        assert TOKEN not in "".join(ours)
        assert "Traceback" not in caplog.text + "".join(capfd.readouterr())


def test_other_addresses_need_a_token() -> None:
    with pytest.raises(InputError, match="--token") as error, running(host="0.0.0.0"):
        pass
    assert "\n" not in str(error.value)
    with running(host="0.0.0.0", token=TOKEN) as bench:
        assert shake_hands(bench.port).status == 401
        assert bench.server.url == f"http://127.0.0.1:{bench.port}/"


# ---------------------------------------------------------------- ids of sessions: no stranger may choose


CHOSEN = "chosen-by-a-stranger-000"


@pytest.fixture(scope="module")
def strict() -> Iterator[Bench]:
    with running(session_ids=SessionIds()) as bench:
        yield bench


def own_id(bench: Bench, path: str = "/") -> tuple[str, str]:
    """Id of the session that a path leads to, and what follows it in the address."""
    answer = ask(bench.port, path)
    assert answer.status == 302
    own, _, rest = answer.headers["Location"].removeprefix("../").removeprefix("s/").partition("/")
    return own, rest


@pytest.mark.parametrize("slash", ["", "/"])
def test_a_chosen_id_is_answered_with_another(strict: Bench, slash: str) -> None:
    own, rest = own_id(strict, f"/s/{CHOSEN}{slash}?a=b")
    assert CHOSEN not in own and rest == "?a=b"
    assert ask(strict.port, f"/s/{own}/").status == 200


def test_a_websocket_with_a_chosen_id_gets_a_session_of_its_own(strict: Bench) -> None:
    with visit(strict.port, CHOSEN) as first, visit(strict.port, CHOSEN) as second:
        first.control("last")
        second.control("last")
        eventually(lambda: len(strict.handles) == 2)
        assert CHOSEN not in strict.handles
    assert ask(strict.port, f"/s/{CHOSEN}/place").status == 410


def test_an_id_of_the_server_is_accepted_and_kept_and_a_changed_one_is_none(strict: Bench) -> None:
    own, _ = own_id(strict)
    assert statuses(strict.port, f"/s/{own}/") == (200, 101)
    with visit(strict.port, own) as page:
        page.control("last")
        assert own in strict.handles
    for at in (0, 10, 16, 23):
        changed = own[:at] + ("A" if own[at] != "A" else "B") + own[at + 1 :]
        assert ask(strict.port, f"/s/{changed}/").status == 302


def test_a_copy_of_a_shared_state_cannot_be_named_by_a_stranger(strict: Bench) -> None:
    shared = new_shared_id()
    assert ask(strict.port, f"/s/{shared}-{CHOSEN}/").status == 302
    copy, _ = own_id(strict, f"/s/{shared}/")
    assert ask(strict.port, f"/s/{copy}/").status == 200


@pytest.mark.parametrize("slash", ["", "/"])
def test_a_shared_state_is_answered_with_a_copy_of_ones_own(bench: Bench, slash: str) -> None:
    """Nobody works on a shared state itself: neither does a websocket open it."""
    shared = new_shared_id()
    copies = [own_id(bench, f"/s/{shared}{slash}?fixedDpr=1") for _ in range(2)]
    assert {(copied_from(copy), is_shared(copy), rest) for copy, rest in copies} == {
        (shared, False, "?fixedDpr=1")
    }
    assert copies[0] != copies[1]
    assert statuses(bench.port, f"/s/{copies[0][0]}/") == (200, 101)
    assert shake_hands(bench.port, f"/s/{shared}{slash}").status == 404
