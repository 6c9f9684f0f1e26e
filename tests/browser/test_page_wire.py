"""The page seen from the wire: what a websocket gets, without a browser."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Callable
from html import unescape
from typing import TYPE_CHECKING, Any

import pytest

from app.bench.visitor import decoded as decode
from app.editing import edits
from app.shell.page import Page
from app.shell.plotly_view import PlotlyView
from app.shell.reports import PAGE_STATE
from app.views import load
from app.views.tune.view import TuneView
from tests.attack.wire import Visitor, visit
from tests.browser.fields import label_of

if TYPE_CHECKING:
    from app.http.server import DashboardServer
    from app.serve import Dashboard

Served = tuple["DashboardServer", "Dashboard"]
WIDE = "1920x1080|Method|Frequency|Errors"


def is_run(message: dict[str, Any]) -> bool:
    content = (message.get("updates") or {}).get("content")
    return isinstance(content, str) and content.startswith('<div id="sb-run"')


def runs(visitor: Visitor, seconds: float) -> list[dict[str, Any]]:
    """All runs that come within a time."""
    until = time.monotonic() + seconds
    while (left := until - time.monotonic()) > 0.0:
        try:
            visitor.received += decode(visitor.socket.recv(timeout=left))
        except TimeoutError:
            break
    return [message for message in visitor.received if is_run(message)]


def number(message: dict[str, Any]) -> int:
    return int(re.search(r'data-run="(\d+)"', message["updates"]["content"])[1])


def eventually(true: Callable[[], bool], seconds: float = 60.0) -> None:
    until = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < until, "did not happen"
        time.sleep(0.02)


def ready(visitor: Visitor, state: str = WIDE) -> None:
    visitor.set(visitor.control(PAGE_STATE), state)
    visitor.wait_for(is_run, 60.0)


def named(dashboard: Served, id: str) -> str:
    """Let there be a session of that name: a websocket alone cannot choose one."""
    dashboard[1].sessions.get(id)
    return id


def test_a_visitor_without_our_script_gets_all_figures(dashboard: Served) -> None:
    server, _ = dashboard
    with visit(server.port, named(dashboard, "no-script-here")) as visitor:
        visitor.wait_for(is_run, 60.0)
        kinds = [message["type"] for message in visitor.received]
        # Tune has a figure only once Pareto fronts are searched for.
        drawn = [kind for kind in load() if kind.always and kind is not TuneView]
        plotly = [kind for kind in drawn if issubclass(kind, PlotlyView)]
        assert kinds.count("GuiPlotlyMessage") == len(plotly) >= 4
        assert kinds.count("GuiUplotMessage") == 6


def test_figures_out_of_sight_are_not_sent_until_their_tab_comes(dashboard: Served) -> None:
    server, _ = dashboard
    with visit(server.port, named(dashboard, "front-tabs-only")) as visitor:
        ready(visitor)
        runs(visitor, 0.5)
        assert [m["type"] for m in visitor.received].count("GuiPlotlyMessage") == 1
        visitor.received.clear()
        visitor.set(next(iter(_ids(dashboard, "front-tabs-only"))), WIDE.replace("Frequency", "Poles"))
        visitor.wait_for(lambda message: message["type"] == "GuiPlotlyMessage", 10.0)


def test_a_page_that_opens_has_the_pictures_in_front_before_all_else(dashboard: Served) -> None:
    server, _ = dashboard
    with visit(server.port, named(dashboard, "front-comes-first")) as visitor:
        ready(visitor, "1920x1080")  # the tabs are not there yet
        kinds = [message["type"] for message in visitor.received]
        assert (kinds.count("GuiPlotlyMessage"), kinds.count("GuiUplotMessage")) == (1, 6)
        assert kinds.index("GuiUplotMessage") < kinds.index("MeshMessage"), "the 3D view"


def _pages(served: Dashboard, session_id: str) -> list[Page]:
    """Open pages of a session: one is listed once it is built, just after its first run is sent."""
    return [page for page in list(served._pages.values()) if page.session.id == session_id]


def _ids(dashboard: Served, session_id: str) -> list[str]:
    eventually(lambda: bool(_pages(dashboard[1], session_id)))
    return [page._reports.window_id for page in _pages(dashboard[1], session_id)]


def test_a_flood_of_slider_moves_becomes_a_few_runs_and_the_last_wins(dashboard: Served) -> None:
    server, served = dashboard
    with visit(server.port, named(dashboard, "flood-of-moves")) as visitor:
        ready(visitor)
        zeta = visitor.control(label_of("network.zeta"))
        visitor.received.clear()
        for step in range(200):
            visitor.set(zeta, 0.5 + 0.005 * step)
        session = served.sessions.get("flood-of-moves")
        eventually(lambda: edits.network_values(session.scenario, session.selected)["zeta"] == 1.495)
        eventually(lambda: session.run is not None and session.run.scenario == session.scenario)
        assert session.wait_idle(20.0)
        visitor.wait_for(lambda message: is_run(message) and number(message) == session.run_number, 30.0)
        shown = [message for message in visitor.received if is_run(message)]
        assert 1 <= len(shown) <= 60
        document = json.loads(unescape(re.sub(r"<[^>]*>", "", shown[-1]["updates"]["content"])))
        assert document["scenario_sha256"] == _hash(session.run.scenario)
        assert session.run.scenario == session.scenario


def _hash(scenario: Any) -> str:
    from navcore.scenario.file import scenario_hash

    return scenario_hash(scenario)


def test_one_visitor_cannot_move_the_controls_of_another(dashboard: Served) -> None:
    server, served = dashboard
    with (
        visit(server.port, named(dashboard, "the-owner-of-it")) as owner,
        visit(server.port, named(dashboard, "someone-curious")) as other,
    ):
        ready(owner)
        ready(other)
        before = served.sessions.get("the-owner-of-it").scenario
        other.set(owner.control(label_of("network.zeta")), 1.5)
        assert runs(other, 0.8)[-1] is not None
        assert served.sessions.get("the-owner-of-it").scenario == before
        assert served.sessions.get("someone-curious").scenario == before


@pytest.mark.parametrize("text", ["", "x", "1e9x3", "-5x3", "99999x99999", "1920x1080|" * 300])
def test_a_strange_report_of_the_page_does_no_harm(dashboard: Served, text: str) -> None:
    server, served = dashboard
    with visit(server.port, named(dashboard, "strange-reports")) as visitor:
        ready(visitor, text)
        eventually(lambda: bool(_pages(served, "strange-reports")))
        assert 640 <= _pages(served, "strange-reports")[0]._window[0] <= 7680


def test_writing_to_a_visitor_who_has_just_gone_is_no_fault(dashboard: Served) -> None:
    server, served = dashboard
    with visit(server.port, named(dashboard, "gone-in-a-moment")) as visitor:
        ready(visitor)
        eventually(lambda: bool(_pages(served, "gone-in-a-moment")))
        page = _pages(served, "gone-in-a-moment")[0]
        session = page.session
    eventually(lambda: page._closed)
    # The test run turns every warning into an error.
    page.header.show_stopped(1)
    page.gui.add_html("to nobody")
    assert session.open_pages == 0
    assert page not in served._pages.values()
