"""What is shown to whom: figures and the log without anybody's name, no path of the server, a full disk."""

import json
import logging
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import schuler_bench
from navcore.foundation import guarded
from schuler_bench.bench.visitor import PAGE_STATE
from schuler_bench.bench.visitor import Visitor as Page
from schuler_bench.dashboard import Dashboard
from schuler_bench.http.metrics import Metrics
from schuler_bench.http.server import DashboardServer
from schuler_bench.logs import begin_logging
from schuler_bench.serve import open_dashboard
from tests.attack.conftest import TOKEN, running
from tests.attack.wire import ask, upload, visit
from tests.browser.fields import label_of

pytestmark = pytest.mark.attack

EVERY_TAB = "1920x1080|Method|Frequency|Poles|Step|Errors|Metrics|Compare|Requirements|Scenario|Files"
LOG = b"t_s,speed_mps,heading_deg\n" + b"".join(b"%d,5.0,90.0\n" % t for t in range(7200))
BROKEN = b"t_s,speed_mps,heading_deg\n0,x,y\n"
NOT_SAVED = "Your work is not saved at present"
ZETA = label_of("network.zeta")


@pytest.fixture
def served(tmp_path: Path) -> Iterator[tuple[DashboardServer, Dashboard]]:
    server, dashboard = open_dashboard(port=0, state=tmp_path / "state")
    yield server, dashboard
    server.stop()
    dashboard.close()
    guarded.stop()


def test_figures_are_told_to_who_knows_the_token() -> None:
    metrics, known = Metrics(), {"Authorization": f"Bearer {TOKEN}"}
    with running(token=TOKEN, metrics=lambda: metrics) as bench:
        assert ask(bench.port, "/metrics").status == 401
        ask(bench.port, "/?token=wrong")
        metrics.answers.observe(0.07)
        with visit(bench.port, "somebody-by-name", additional_headers=known) as page:
            page.control("last")
            answer = ask(bench.port, "/metrics", known)
    text = answer.body.decode()
    figures = dict(re.findall(r"^schuler_(\w+) ([0-9.e+-]+)$", text, re.MULTILINE))
    assert answer.status == 200 and answer.headers["Content-Type"].startswith("text/plain; version=")
    counted = [float(figures[name]) for name in ("open_pages", "wrong_tokens_total", "answer_seconds_count")]
    assert counted == [1.0, 1.0, 1.0] and float(figures["threads"]) >= 2.0
    assert "somebody" not in text and TOKEN not in text


def test_a_log_line_for_programs_is_one_json_object(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    log = logging.getLogger("schuler")
    monkeypatch.setattr(log, "handlers", [])
    monkeypatch.setattr(log, "propagate", log.propagate)
    begin_logging("json")
    try:
        raise ValueError("two\nlines")
    except ValueError:
        logging.getLogger("schuler.test").exception("it failed: %s", "ä")
    (line,) = capsys.readouterr().err.splitlines()
    told = json.loads(line)
    assert (told["level"], told["logger"], told["message"]) == ("error", "schuler.test", "it failed: ä")
    assert "ValueError: two" in told["exception"] and told["time"].endswith("Z")


def test_the_log_goes_to_a_file_that_is_rotated_and_bounded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    log = logging.getLogger("schuler")
    for name in ("handlers", "propagate", "level"):
        monkeypatch.setattr(log, name, getattr(log, name))
    monkeypatch.setenv("SCHULER_LOG_FILE", str(tmp_path / "log"))
    monkeypatch.setenv("SCHULER_LOG_BYTES", "2000")
    begin_logging()
    for number in range(500):
        logging.getLogger("schuler.test").info("line %d", number)
    log.handlers[0].close()
    files = sorted(path.name for path in tmp_path.iterdir())
    assert files == ["log", "log.1", "log.2"]
    assert all(path.stat().st_size <= 2000 for path in tmp_path.iterdir())
    assert (tmp_path / "log").read_text().endswith("schuler.test: line 499\n")
    begin_logging(to_file=False)
    logging.getLogger("schuler.test").info("to the console")
    assert capsys.readouterr().err == "schuler.test: to the console\n"


def test_nothing_that_is_sent_holds_a_path_of_the_server(
    served: tuple[DashboardServer, Dashboard], tmp_path: Path
) -> None:
    port = served[0].port
    own = ask(port, "/").headers["Location"].split("/")[1]
    with visit(port, own) as page:
        page.set(page.control(PAGE_STATE), EVERY_TAB)
        page.wait_for(lambda m: 'data-run="1"' in str(m), 60.0)
        upload(page, "Upload a file", "broken.csv", [BROKEN])
        page.wait_for(lambda m: m["type"] == "NotificationShowMessage" and "broken" in str(m), 30.0)
        upload(page, "Upload a file", "log.csv", [LOG])
        page.wait_for(lambda m: "log.csv" in str(m) and "sb-file" in str(m), 30.0)
        page.set(page.control("Run on these files"), True)
        page.wait_for(lambda m: "log.csv" in str(m) and "[[method]]" in str(m), 60.0)
        # The file vanishes: what the run says of it is shown too.
        for path in (tmp_path / "state").rglob("log.csv"):
            path.unlink()
        before = len(page.received)
        page.set(page.control(ZETA), 0.43)
        page.wait_for(lambda m: m in page.received[before:] and m["type"] == "NotificationShowMessage", 30.0)
        sent = str(page.received)
    for secret in (str(tmp_path), str(Path(schuler_bench.__file__).parents[1]), str(Path.home()) + "/"):
        at = sent.find(secret)
        assert at < 0, sent[max(0, at - 200) : at + 200]


def test_a_page_is_told_of_a_failed_autosave(served: tuple[DashboardServer, Dashboard]) -> None:
    server, dashboard = served
    with Page(server.port, "on-a-full-disk") as page:
        page.set(PAGE_STATE, "1366x768|Method|Errors")
        page.wait_for_run(1)
        store = dashboard.sessions._store
        assert store is not None

        def move(value: float) -> None:
            number = page.run_number
            page.set(ZETA, value)
            page.wait(lambda: page.run_number > number, "an answer although nothing may be saved", 60.0)
            assert store.saving.flush(60.0)

        move(0.6)
        (session,) = dashboard.sessions._by_id.values()
        assert store.read(session.id) is not None and not page.notices

        execute = store.database._connection.execute
        execute(f"PRAGMA max_page_count = {execute('PRAGMA page_count').fetchone()[0]}")
        # Steps of their own, until the document no longer fits.
        for step in range(60):
            number = page.run_number
            with session.lock:
                longer = session.scenario.model_copy(update={"title": f"{step} " + "x" * 250})
                session.change(longer, None, name=f"step {step}")
            page.wait(lambda number=number: page.run_number > number, "an answer", 60.0)
            assert store.saving.flush(60.0)
            page.rest(0.05)
            if NOT_SAVED in dict(page.notices):
                break
        (told,) = [text for title, text in page.notices if title == NOT_SAVED]
        assert (
            "database or disk is full" in told
            and "Saving is tried again by itself" in told
            and "A download keeps the scenario" in told
        )
        assert str(store.folder) not in told

        move(0.7)
        execute("PRAGMA max_page_count = 1000000")
        move(0.8)
        after = store.read(session.id)
        assert after is not None and after["steps"][after["at"]]["name"].startswith("ζ")
