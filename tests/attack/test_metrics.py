"""``/metrics`` and the log: behind the token, with figures and without anybody's name."""

from __future__ import annotations

import json
import logging
import re

import pytest

from app.http.metrics import Metrics
from app.logs import begin_logging
from tests.attack.conftest import TOKEN, running
from tests.attack.wire import ask, visit

pytestmark = pytest.mark.attack


def figures(text: str) -> dict[str, float]:
    return {
        name: float(value) for name, value in re.findall(r"^(schuler_\w+) ([0-9.e+-]+)$", text, re.MULTILINE)
    }


def test_figures_are_told_to_who_knows_the_token() -> None:
    made = Metrics()
    with running(token=TOKEN, metrics=lambda: made) as bench:
        assert ask(bench.port, "/metrics").status == 401
        ask(bench.port, "/?token=wrong")
        made.answers.observe(0.07)
        known = {"Authorization": f"Bearer {TOKEN}"}
        with visit(bench.port, "somebody-by-name", additional_headers=known) as page:
            page.control("last")
            answer = ask(bench.port, "/metrics", known)
        found = figures(answer.body.decode())
    assert answer.status == 200 and answer.headers["Content-Type"].startswith("text/plain; version=")
    assert found["schuler_open_pages"] == 1.0 and found["schuler_wrong_tokens_total"] == 1.0
    assert found["schuler_answer_seconds_count"] == 1.0 and found["schuler_threads"] >= 2.0
    assert "somebody" not in answer.body.decode() and TOKEN not in answer.body.decode()


def test_a_server_without_figures_has_no_such_page() -> None:
    with running() as bench:
        assert ask(bench.port, "/metrics").status == 404


def test_a_log_line_for_programs_is_one_json_object(capsys: pytest.CaptureFixture[str]) -> None:
    log = logging.getLogger("schuler")
    before = log.handlers, log.propagate
    try:
        begin_logging("json")
        try:
            raise ValueError("two\nlines")
        except ValueError:
            logging.getLogger("schuler.test").exception("it failed: %s", "ä")
        (line,) = capsys.readouterr().err.splitlines()
    finally:
        log.handlers, log.propagate = before
    told = json.loads(line)
    assert (told["level"], told["logger"], told["message"]) == ("error", "schuler.test", "it failed: ä")
    assert "ValueError: two" in told["exception"] and told["time"].endswith("Z")
