"""Guesses of the token are slowed down by address; where a token comes from."""

from __future__ import annotations

import stat
from pathlib import Path

import pytest

from app.http.access import Throttle, access_rules
from app.http.token import find_token
from navcore.foundation.errors import InputError


def test_guesses_beyond_the_burst_wait_and_are_refilled() -> None:
    now = [100.0]
    throttle = Throttle(burst=3, refill_s=2.0, clock=lambda: now[0])
    for _ in range(3):
        assert throttle.wait_s("a") == 0.0
        throttle.failed("a")
    assert throttle.wait_s("a") == pytest.approx(2.0)
    assert throttle.wait_s("b") == 0.0
    now[0] += 2.0
    assert throttle.wait_s("a") == 0.0
    throttle.failed("a")
    assert throttle.wait_s("a") == pytest.approx(2.0)
    now[0] += 1000.0
    throttle.failed("a")
    assert throttle.wait_s("a") == 0.0, (
        "time without guesses is not saved up beyond the burst, nor held against"
    )


def test_addresses_are_forgotten_beyond_a_bound() -> None:
    throttle = Throttle()
    for number in range(10_000):
        throttle.failed(str(number))
    assert len(throttle._spent) <= 4096


def test_order_of_the_sources(tmp_path: Path) -> None:
    file = tmp_path / "token"
    file.write_text("from-the-file\nsecond line")
    both = {"SCHULER_TOKEN": "from-the-variable", "SCHULER_TOKEN_FILE": str(file)}
    assert find_token("given", file, True, both).value == "given"
    assert find_token(None, file, False, both).value == "from-the-file"
    assert find_token(None, None, False, both).value == "from-the-variable"
    assert find_token(None, None, False, {"SCHULER_TOKEN_FILE": str(file)}).value == "from-the-file"
    assert find_token(None, None, False, {"SCHULER_TOKEN": ""}).value is None


def test_a_generated_token_is_long_new_and_kept_in_its_file(tmp_path: Path) -> None:
    first, second = (find_token(None, None, True, {}) for _ in range(2))
    assert first.generated and len(first.value) >= 32 and first.value != second.value
    file = tmp_path / "token"
    made = find_token(None, file, True, {})
    assert made.generated and stat.S_IMODE(file.stat().st_mode) == 0o600
    again = find_token(None, file, True, {})
    assert (again.value, again.generated) == (made.value, False)


@pytest.mark.parametrize("content", [None, "", "\n", "\xff"])
def test_a_file_without_a_token_is_refused(tmp_path: Path, content: str | None) -> None:
    file = tmp_path / "token"
    if content is not None:
        file.write_bytes(content.encode("latin-1"))
    with pytest.raises(InputError, match="--token-file"):
        find_token(None, file, False, {})


def test_a_short_token_is_refused_beyond_this_machine_and_not_shown() -> None:
    with pytest.raises(InputError, match="at least 8") as error:
        access_rules("10.0.0.1", 8080, loopback=False, token="s3cret", origins=frozenset())
    assert "s3cret" not in str(error.value)
    access_rules("127.0.0.1", 8080, loopback=True, token="s3cret", origins=frozenset())
