"""Rules of entry apart from any server: what follows from host, port, token and origins."""

from __future__ import annotations

import pytest
from websockets.datastructures import Headers

from app.http.access import Access, access_rules, refuse_address, refuse_unknown
from navcore.foundation.errors import InputError


def rules(**changes: object) -> Access:
    given = {
        "host": "127.0.0.1",
        "port": 8080,
        "loopback": True,
        "token": None,
        "origins": frozenset(),
    } | changes
    return access_rules(given.pop("host"), given.pop("port"), **given)


def test_hosts_are_loopback_names_own_name_and_allowed_origins() -> None:
    access = rules(
        host="bench", loopback=False, token="long-enough", origins=frozenset({"https://nav.example.org"})
    )
    assert access.hosts == {"127.0.0.1:8080", "localhost:8080", "[::1]:8080", "bench:8080", "nav.example.org"}
    assert "https://nav.example.org" in access.origins and "http://bench:8080" in access.origins


def test_port_80_stands_in_no_host() -> None:
    assert "localhost" in rules(port=80).hosts and "localhost:80" not in rules(port=80).hosts


def test_host_is_compared_without_regard_to_case() -> None:
    assert refuse_address(rules(), Headers(Host="LocalHost:8080")) is None


def test_no_token_and_no_loopback_refuses_to_start() -> None:
    with pytest.raises(InputError, match="add --token"):
        rules(host="10.0.0.1", loopback=False)


@pytest.mark.parametrize("token", ["", "  "])
def test_empty_token(token: str) -> None:
    with pytest.raises(InputError, match="--token"):
        rules(token=token)


def test_missing_origin_passes_only_on_loopback_or_with_a_token() -> None:
    headers = Headers(Host="127.0.0.1:8080")
    assert refuse_address(rules(), headers) is None
    assert refuse_address(rules(loopback=False, token="long-enough"), headers) is None
    # No server starts like this; the rule holds all the same.
    open_to_all = Access(rules().hosts, rules().origins, loopback=False, token=None, cookie_name="c")
    assert refuse_address(open_to_all, headers).status == 403


def test_token_outside_ascii_is_compared_not_crashed_on() -> None:
    access = rules(token="geheimnis-\u00fc")
    # As websockets hands over bytes outside ASCII.
    for sent, passes in (("geheimnis-\udcc3\udcbc", True), ("\udcff", False)):
        headers = Headers()
        headers.set_insecure("Authorization", f"Bearer {sent}")
        assert (refuse_unknown(access, headers) is None) is passes
    assert access.token_is_right("geheimnis-\u00fc")


def test_every_candidate_is_compared_in_constant_time(monkeypatch: pytest.MonkeyPatch) -> None:
    import hmac

    compared = []
    honest = hmac.compare_digest
    monkeypatch.setattr(hmac, "compare_digest", lambda a, b: (compared.append((a, b)), honest(a, b))[1])
    access = rules(token="t")
    headers = Headers([("Cookie", "schuler_8080=a; schuler_8080=b"), ("Authorization", "Bearer t")])
    assert refuse_unknown(access, headers) is None
    assert len(compared) == 3
    assert not access.token_is_right("x") and len(compared) == 4
