"""serving 1-6, 12, 16, 19: who gets in, under which name, and what every answer carries."""

from __future__ import annotations

import json
import logging
import re
import socket

import pytest

from navcore.foundation.errors import InputError
from tests.attack.conftest import TOKEN, Bench, eventually, running
from tests.attack.wire import SESSION, ask, shake_hands, visit

pytestmark = pytest.mark.attack


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
    origin = origin.format(port=bench.port)
    assert shake_hands(bench.port, Origin=origin).status == 403
    assert ask(bench.port, f"/s/{SESSION}/", {"Origin": origin}).status == 403


def test_two_origins_are_refused(bench: Bench) -> None:
    own = f"http://127.0.0.1:{bench.port}"
    assert ask(bench.port, "/", {"Origin": [own, own]}).status == 403


@pytest.mark.parametrize("name", ["127.0.0.1", "localhost", "[::1]"])
def test_own_origin_and_host_are_accepted(bench: Bench, name: str) -> None:
    own = f"{name}:{bench.port}"
    assert shake_hands(bench.port, Origin=f"http://{own}", Host=own).status == 101


def test_missing_origin_is_accepted_on_loopback(bench: Bench) -> None:
    assert shake_hands(bench.port).status == 101


@pytest.mark.parametrize(
    "host",
    ["evil.example", "evil.example:{port}", "127.0.0.1", "127.0.0.1:1", "localhost.evil.example:{port}", ""],
)
def test_wrong_host_is_refused(bench: Bench, host: str) -> None:
    host = host.format(port=bench.port)
    for path in ("/", f"/s/{SESSION}/", "/healthz"):
        assert ask(bench.port, path, {"Host": host}).status == 421
    assert shake_hands(bench.port, Host=host).status == 421


def test_no_host_and_two_hosts_are_refused(bench: Bench) -> None:
    own = f"127.0.0.1:{bench.port}"
    assert ask(bench.port, "/", {"Host": []}).status == 421
    assert ask(bench.port, "/", {"Host": [own, own]}).status == 421


def test_healthz_tells_the_version_and_nothing_else(bench: Bench) -> None:
    answer = ask(bench.port, "/healthz")
    assert answer.status == 200
    assert json.loads(answer.body).keys() == {"status", "version"}
    assert json.loads(answer.body)["status"] == "ok"


def test_every_answer_carries_the_headers(bench: Bench) -> None:
    for path in ("/", f"/s/{SESSION}/", "/healthz", "/nothing"):
        headers = ask(bench.port, path).headers
        assert headers["X-Content-Type-Options"] == "nosniff"
        assert headers["X-Frame-Options"] == "DENY"
        assert headers["Referrer-Policy"] == "no-referrer"
        assert headers["Server"] is None
        policy = headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy and "frame-ancestors 'none'" in policy
        scripts = next(part for part in policy.split("; ") if part.startswith("script-src"))
        assert "unsafe-inline" not in scripts and "'unsafe-eval'" not in scripts
    assert ask(bench.port, "/", {"Host": "evil.example"}).headers["X-Content-Type-Options"] == "nosniff"
    assert "evil" not in ask(bench.port, "/", {"Host": "evil.example"}).headers["Content-Security-Policy"]


def test_only_a_single_view_may_be_framed_and_only_by_named_origins() -> None:
    with running(frame_origins=["https://slides.example.org"]) as bench:
        for path, framed_by in (
            (f"/s/{SESSION}/?view=bode", "https://slides.example.org"),
            (f"/s/{SESSION}/?lang=en&view=bode", "https://slides.example.org"),
            (f"/s/{SESSION}/", "'none'"),
            (f"/s/{SESSION}/?tab=view", "'none'"),
        ):
            policy = ask(bench.port, path).headers["Content-Security-Policy"]
            assert f"frame-ancestors {framed_by}" in policy.split("; "), path
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
    ],
)
def test_unknown_and_malformed_paths_are_not_found(bench: Bench, path: str) -> None:
    assert ask(bench.port, path).status == 404
    assert shake_hands(bench.port, path).status == 404


def test_root_leads_to_a_fresh_session_each_time(bench: Bench) -> None:
    targets = [ask(bench.port, "/?fixedDpr=0.25") for _ in range(2)]
    places = [answer.headers["Location"] for answer in targets]
    assert all(answer.status == 302 for answer in targets)
    assert all(re.fullmatch(r"s/[A-Za-z0-9_-]{20,64}/\?fixedDpr=0\.25", place) for place in places)
    assert places[0] != places[1]
    assert ask(bench.port, f"/s/{SESSION}?a=b").headers["Location"] == f"{SESSION}/?a=b"


def test_page_and_its_scripts_are_served_plain_and_compressed(bench: Bench) -> None:
    import gzip

    plain = ask(bench.port, f"/s/{SESSION}/")
    zipped = ask(bench.port, f"/s/{SESSION}/", {"Accept-Encoding": "br, gzip"})
    assert plain.status == zipped.status == 200
    assert zipped.headers["Content-Encoding"] == "gzip"
    assert gzip.decompress(zipped.body) == plain.body
    assert b"<title>Schuler Bench</title>" in plain.body
    assert b"<script>" not in plain.body and b"javascript:" not in plain.body
    named = re.findall(rb'(?:src|href)="\.\./\.\./(static/[^"]+)"', plain.body)
    kinds = dict(js="text/javascript", css="text/css", wasm="application/wasm")
    assert {name.split(b".")[0] for name in named} == {
        b"static/bench", b"static/viser", b"static/zstd", b"static/start", b"static/plotly-basic",
    }  # fmt: skip
    for name in named:
        answer = ask(bench.port, "/" + name.decode())
        suffix = name.decode().rpartition(".")[2]
        assert answer.status == 200 and answer.headers["Content-Type"].startswith(kinds[suffix])
        assert "immutable" in answer.headers["Cache-Control"]


def test_session_of_the_path_reaches_the_callbacks(bench: Bench) -> None:
    bench.events.clear()
    with visit(bench.port, "first-visitor"), visit(bench.port, "second-visitor/"):
        eventually(lambda: {("connect", "first-visitor"), ("connect", "second-visitor")} <= set(bench.events))
    eventually(lambda: ("disconnect", "first-visitor") in bench.events)
    eventually(lambda: ("disconnect", "second-visitor") in bench.events)


def test_visitor_without_a_camera_is_no_session(bench: Bench) -> None:
    bench.events.clear()
    with visit(bench.port, "never-looked", camera=False):
        pass
    with visit(bench.port, "looked-later"):
        eventually(lambda: ("connect", "looked-later") in bench.events)
    eventually(lambda: ("disconnect", "looked-later") in bench.events)
    assert not any("never-looked" in event for event in bench.events)


class TestToken:
    def test_page_and_websocket_need_it(self, guarded: Bench) -> None:
        for path in (
            "/",
            f"/s/{SESSION}/",
            "/static/x.js",
            "/nothing",
            f"/s/{SESSION}/?token=",
            "/?token=wrong",
        ):
            answer = ask(guarded.port, path)
            assert answer.status == 401
            assert TOKEN not in answer.body.decode()
        assert shake_hands(guarded.port).status == 401
        assert shake_hands(guarded.port, f"/s/{SESSION}?token={TOKEN}").status == 401

    @pytest.mark.parametrize(
        "shown", ["Bearer wrong", f"Basic {TOKEN}", TOKEN, "Bearer", f"Bearer {TOKEN}x", "Bearer \u00e4"]
    )
    def test_wrong_ones_are_refused(self, guarded: Bench, shown: str) -> None:
        assert shake_hands(guarded.port, Authorization=shown).status == 401
        assert shake_hands(guarded.port, Cookie=f"schuler_{guarded.port}={shown}").status == 401
        assert shake_hands(guarded.port, Cookie=f"schuler_{guarded.port}={TOKEN}").status == 401

    def test_is_accepted_as_bearer(self, guarded: Bench) -> None:
        assert shake_hands(guarded.port, Authorization=f"Bearer {TOKEN}").status == 101
        assert ask(guarded.port, "/", {"Authorization": f"bearer {TOKEN}"}).status == 302

    @pytest.mark.parametrize("path", ["/", f"/s/{SESSION}/", f"/s/{SESSION}"])
    def test_is_exchanged_for_a_cookie(self, guarded: Bench, path: str) -> None:
        answer = ask(guarded.port, f"{path}?a=1&token={TOKEN}&b=%20")
        assert answer.status == 302
        assert (
            answer.headers["Location"]
            == ("" if path[-1] != "/" else "./") + path.rpartition("/")[2] + "?a=1&b=+"
        )
        cookie = answer.headers["Set-Cookie"]
        assert "HttpOnly" in cookie and "SameSite=Strict" in cookie and "Secure" not in cookie
        assert TOKEN not in cookie
        shown = "other=1; broken; " + cookie.partition(";")[0]
        assert ask(guarded.port, f"/s/{SESSION}/", {"Cookie": shown}).status == 200
        assert shake_hands(guarded.port, Cookie=shown).status == 101

    def test_link_from_another_site_moves_on_by_itself(self, guarded: Bench) -> None:
        answer = ask(guarded.port, f'/?token={TOKEN}&x="><script>', {"Sec-Fetch-Site": "cross-site"})
        assert answer.status == 200 and answer.headers["Set-Cookie"]
        assert b'content="0;url=./?' in answer.body and b"<script" not in answer.body

    def test_cookie_is_secure_behind_https(self, guarded: Bench) -> None:
        answer = ask(guarded.port, f"/?token={TOKEN}", {"Host": "bench.example.org"})
        assert "; Secure" in answer.headers["Set-Cookie"]
        own = {"Host": "bench.example.org", "Origin": "https://bench.example.org"}
        assert shake_hands(guarded.port, Authorization=f"Bearer {TOKEN}", **own).status == 101
        own["Origin"] = "http://bench.example.org"
        assert shake_hands(guarded.port, Authorization=f"Bearer {TOKEN}", **own).status == 403

    def test_healthz_needs_none(self, guarded: Bench) -> None:
        assert ask(guarded.port, "/healthz").status == 200

    def test_is_never_logged(self, guarded: Bench, caplog: pytest.LogCaptureFixture, capfd) -> None:
        with caplog.at_level(logging.DEBUG):
            ask(guarded.port, f"/?token={TOKEN}")
            shake_hands(guarded.port, f"/s/{SESSION}?token={TOKEN}", Authorization=f"Bearer {TOKEN}")
            with visit(guarded.port, additional_headers={"Authorization": f"Bearer {TOKEN}"}) as visitor:
                visitor.control("last")
        said = caplog.text + "".join(capfd.readouterr())
        assert "websockets.client" in {record.name for record in caplog.records}, (
            "nothing was recorded at all"
        )
        ours = [r.getMessage() for r in caplog.records if r.name != "websockets.client"]
        assert TOKEN not in "".join(ours)
        assert "Traceback" not in said


def test_other_addresses_need_a_token() -> None:
    with pytest.raises(InputError, match="--token") as error, running(host="0.0.0.0"):
        pass
    assert "\n" not in str(error.value)
    with running(host="0.0.0.0", token=TOKEN) as bench:
        assert shake_hands(bench.port).status == 401
        assert bench.server.url == f"http://127.0.0.1:{bench.port}/"
