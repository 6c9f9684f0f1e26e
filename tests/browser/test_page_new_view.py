"""A tab is added: one folder with widgets, picture, script and style, and one line in the registry."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from app.serve import open_dashboard
from app.shell.reports import PAGE_STATE
from app.views import VIEWS
from tests.attack.wire import visit
from tests.browser.driver import Bench
from tests.browser.fields import label_of

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from app.http.server import DashboardServer
    from app.serve import Dashboard
    from app.session.session import Session

VIEW = '''
"""Tab "Peaks": the largest position error of every method."""

from app.shell.view import PictureView, if_user


class PeaksView(PictureView):
    title = "Peaks"
    place = "lower"

    def build(self, tab):
        with tab:
            self._kilometres = self.frame.gui.add_checkbox("peaks in kilometres", False)
            self._list = self.frame.gui.add_html("")
        self._kilometres.on_update(if_user(self.frame.redraw))

    def picture(self, found):
        unit = 1000.0 if self._kilometres.value else 1.0
        peaks = [m.errors["position_m"]["max_abs"] / unit for m in found.run.methods]
        return "".join(f'<li class="peak">{peak:.6g}</li>' for peak in peaks)

    def show(self, picture):
        self._list.content = f"<ul>{picture}</ul>"


VIEW = PeaksView
'''


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[DashboardServer, Dashboard]]:
    """A dashboard with one view more than ours."""
    folder: Path = tmp_path_factory.mktemp("more") / "peaks_view"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "view.py").write_text(VIEW)
    (folder / "peaks.js").write_text('document.documentElement.dataset.peaks = "ran";')
    (folder / "peaks.css").write_text(".peak{letter-spacing:3px}")
    patch = pytest.MonkeyPatch()
    patch.syspath_prepend(folder.parent)
    server, dashboard = open_dashboard(port=0, views=(*VIEWS, "peaks_view"))
    yield server, dashboard
    server.stop()
    dashboard.close()
    patch.undo()


def peaks_of(session: Session, unit: float = 1.0) -> list[str]:
    assert session.run is not None
    return [f"{method.errors['position_m']['max_abs'] / unit:.6g}" for method in session.run.methods]


def eventually(true: Callable[[], bool]) -> None:
    until = time.monotonic() + 30.0
    while not true():
        assert time.monotonic() < until, "did not happen"
        time.sleep(0.02)


def test_a_new_tab_follows_runs_and_its_own_control(served: tuple[DashboardServer, Dashboard]) -> None:
    server, dashboard = served
    with visit(server.port, "the-new-tab") as visitor:
        visitor.set(visitor.control(PAGE_STATE), "1920x1080|Method|Frequency|Peaks")

        def shows(peaks: list[str]) -> None:
            text = "<ul>" + "".join(f'<li class="peak">{peak}</li>' for peak in peaks) + "</ul>"
            visitor.wait_for(lambda m: (m.get("updates") or {}).get("content") == text, 60.0)

        eventually(lambda: bool(dashboard._pages))
        session = next(iter(dashboard._pages.values())).session
        eventually(lambda: session.run is not None)
        before = peaks_of(session)
        shows(before)
        visitor.set(visitor.control(label_of("network.zeta")), 0.9)
        eventually(lambda: peaks_of(session) != before)
        shows(peaks_of(session))
        visitor.set(visitor.control("peaks in kilometres"), True)
        shows(peaks_of(session, 1000.0))


@pytest.mark.browser
def test_a_new_tab_stands_in_the_browser(browser: Browser, served: tuple[DashboardServer, Dashboard]) -> None:
    server, dashboard = served
    context = browser.new_context(viewport={"width": 1920, "height": 1080})
    page = context.new_page()
    bench = Bench(page, server.url, dashboard.sessions).open()
    bench.tab("Peaks")
    page.wait_for_selector(".peak")
    shown = [entry.inner_text() for entry in page.locator(".peak").all()]
    assert shown == peaks_of(bench.session)
    assert page.evaluate("document.documentElement.dataset.peaks") == "ran"
    assert page.locator(".peak").first.evaluate("e => getComputedStyle(e).letterSpacing") == "3px"
    assert bench.faults == []
    context.close()
