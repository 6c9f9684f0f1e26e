"""The disk fills up while a visitor works: the page says so once and goes on; later all is saved again."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.bench.visitor import PAGE_STATE, Visitor
from app.http.server import DashboardServer
from app.serve import Dashboard, open_dashboard
from navcore.foundation import guarded
from tests.browser.fields import label_of

pytestmark = pytest.mark.attack

WINDOW = "1366x768|Method|Errors"
TITLE = "Your work is not saved at present"


@pytest.fixture
def served(tmp_path: Path) -> Iterator[tuple[DashboardServer, Dashboard]]:
    server, dashboard = open_dashboard(port=0, state=tmp_path / "sessions")
    try:
        yield server, dashboard
    finally:
        server.stop()
        dashboard.close()
        guarded.stop()


def test_a_page_is_told_of_a_failed_autosave(served: tuple[DashboardServer, Dashboard]) -> None:
    server, dashboard = served
    with Visitor(server.port, "on-a-full-disk") as visitor:
        visitor.set(PAGE_STATE, WINDOW)
        visitor.wait(lambda: visitor.run_number >= 1, "its first run", 120.0)
        store = dashboard.sessions._store
        assert store is not None
        visitor.set(label_of("network.zeta"), 0.6)
        visitor.wait(lambda: visitor.run_number >= 2, "an answer", 60.0)
        assert store.flush(60.0)
        (session,) = dashboard.sessions._by_id.values()
        kept = store.read(session.id)
        assert kept is not None and not visitor.notices

        pages = store.database._connection.execute("PRAGMA page_count").fetchone()[0]
        store.database._connection.execute(f"PRAGMA max_page_count = {pages}")
        # Steps of their own, until the document no longer fits.
        for step in range(60):
            number = visitor.run_number
            with session.lock:
                scenario = session.scenario
                title = scenario.model_copy(update={"title": f"{step} " + "x" * 250})
                session.change(title, None, name=f"step {step}")
            visitor.wait(lambda number=number: visitor.run_number > number, "an answer", 60.0)
            assert store.flush(60.0)
            visitor.rest(0.05)
            if any(title == TITLE for title, _ in visitor.notices):
                break
        (told,) = [text for title, text in visitor.notices if title == TITLE]
        assert "database or disk is full" in told and "A download keeps the scenario" in told
        assert str(store.folder) not in told

        number = visitor.run_number
        visitor.set(label_of("network.zeta"), 0.7)
        visitor.wait(lambda: visitor.run_number > number, "an answer although nothing is saved", 60.0)
        store.database._connection.execute("PRAGMA max_page_count = 1000000")
        visitor.set(label_of("network.zeta"), 0.8)
        visitor.wait(lambda: visitor.run_number > number + 1, "an answer", 60.0)
        assert store.flush(60.0)
        after = store.read(session.id)
        assert after is not None and after["steps"][after["at"]]["name"].startswith("ζ")
