"""The state folder cannot be written: the page says so, its visitor works on, and is saved again later."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from app.serve import open_dashboard
from tests.browser.driver import Bench

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from app.session.store import Store

pytestmark = pytest.mark.browser

TITLE = "Your work is not saved at present"
# A notice goes by itself; what was there for a moment counts too.
_NOTE_ALL = """() => {
  window.noticed = "";
  const look = () => document.querySelectorAll(".mantine-Notification-root").forEach(notice => {
    if (!window.noticed.includes(notice.innerText)) window.noticed += notice.innerText + "\\n";
  });
  new MutationObserver(look).observe(document.body, {childList: true, subtree: true, characterData: true});
}"""


@pytest.fixture
def kept(browser: Browser, tmp_path: Path) -> Iterator[tuple[Bench, Store]]:
    """A page of a server that keeps its sessions, and where it keeps them."""
    server, dashboard = open_dashboard(port=0, state=tmp_path / "sessions")
    context = browser.new_context(viewport={"width": 1366, "height": 768})
    try:
        page = context.new_page()
        bench = Bench(page, server.url, dashboard.sessions).open()
        store = dashboard.sessions._store
        assert store is not None
        yield bench, store
    finally:
        context.close()
        server.stop()
        dashboard.close()


def test_a_failed_autosave_is_told_on_the_page(kept: tuple[Bench, Store]) -> None:
    bench, store = kept
    bench.page.evaluate(_NOTE_ALL)
    assert store.flush(60.0)
    store.database._connection.execute("PRAGMA query_only = ON")
    bench.type("network.zeta", "0.6")
    bench.page.wait_for_function("title => window.noticed.includes(title)", arg=TITLE)
    bench.page.wait_for_function("() => window.noticed.includes('A download keeps the scenario.')")
    assert str(store.folder) not in bench.page.evaluate("() => window.noticed")

    bench.settle()
    assert bench.value("network.zeta") == 0.6
    assert store.flush(60.0)
    store.database._connection.execute("PRAGMA query_only = OFF")
    bench.type("network.zeta", "0.8")
    bench.settle()
    assert store.flush(60.0)
    document = store.read(bench.session_id)
    assert document is not None and document["steps"][document["at"]]["name"].startswith("ζ")
    assert bench.session.scenario.method[bench.session.selected].network.model_dump()["zeta"] == 0.8
    assert bench.faults == []
