"""Pages of servers of their own: policy, places, a new tab, plain viser, a restart; and one view alone."""

import json
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import viser
from playwright.sync_api import Page

import schuler_bench.shell
from schuler_bench.bench.dashboard import ZETA
from schuler_bench.bench.process import Server, free_port
from schuler_bench.http.limits import Limits
from schuler_bench.http.server import DashboardServer, start
from schuler_bench.serve import open_dashboard
from schuler_bench.session.database import Database
from schuler_bench.session.session import Session
from schuler_bench.views import VIEWS
from tests.attack.conftest import eventually
from tests.browser.conftest import Another, Served
from tests.browser.test_page_state import wait_for_value
from tools.paint.measuring import served as served_apart

XI = "network.xi"


@contextmanager
def served(**options: Any) -> Iterator[DashboardServer]:
    """A server without a dashboard behind it."""
    server = start(port=0, **options)
    yield server
    server.stop()


# ------------------------------------------------------------ the policy


class Figure:
    """A plotly figure as the dashboard sends it."""

    def to_json(self) -> str:
        return json.dumps({"data": [{"x": [1, 10], "y": [3, 4]}], "layout": {"xaxis": {"type": "log"}}})


def test_page_works_under_its_session_path_with_the_policy_on(another: Another) -> None:
    visits: list[tuple[str, Any]] = []

    def connected(client: viser.ClientHandle, session: str) -> None:
        visits.append(("connect", session))
        client.scene.add_grid("/sea")
        client.scene.add_label("/name", "ship")
        slider = client.gui.add_slider("gain", 0.0, 1.0, 0.1, 0.5)
        slider.on_update(lambda event: visits.append(("gain", event.target.value)))
        client.gui.add_plotly(Figure())
        client.gui.add_uplot((np.arange(9.0), np.arange(9.0)), series=({}, {"stroke": "red"}))
        client.gui.add_html("<math><mi>&#x3c9;</mi></math>")
        button = client.gui.add_button("inject")
        harm = "<img src='x' onerror='window.harmed = true'><b>end</b>"
        button.on_click(lambda _: client.gui.add_html(harm))

    bench, faults = another(1366, 768), []
    page = bench.page
    page.on("requestfailed", lambda request: faults.append(request.url))
    with served(on_connect=connected, on_disconnect=lambda client, session: None) as server:
        server.viser.scene.configure_environment_map(hdri=None)
        server.viser.scene.configure_default_lights(cast_shadow=False)
        answer = page.goto(f"{server.url}?fixedDpr=0.25&websocket=ws://127.0.0.1:9/elsewhere")
        assert "script-src" in answer.headers["content-security-policy"]
        for drawn in ("canvas", ".js-plotly-plot .scatterlayer .trace", ".uplot canvas", "math"):
            page.wait_for_selector(drawn, state="attached")
        session = page.url.split("/s/")[1].split("/")[0]
        assert page.url == f"{server.url}s/{session}/?fixedDpr=0.25"
        assert (page.title(), page.evaluate("typeof Plotly")) == ("Schuler Bench", "object")

        knob = page.get_by_text("gain", exact=True).first.evaluate("label => label.htmlFor")
        page.locator(f"[id='{knob}'] [role=slider]").press("ArrowRight")
        eventually(lambda: visits == [("connect", session), ("gain", 0.6)], 30.0)
        assert faults == bench.faults == []

        # The policy is what stops markup that reached the page: remove it, and this fails.
        bench.button("inject").click()
        page.get_by_text("end", exact=True).wait_for()
        # the browser tells of it once it has tried to load the image
        bench.wait_until(lambda: any("inline event handler" in fault for fault in bench.faults))
        assert page.evaluate("window.harmed") is None

        page.reload()
        page.wait_for_selector(".js-plotly-plot", state="attached")
        assert visits[-1] == ("connect", session)
        bench.faults.clear()


FRAGMENTS = ("#", "#anything", "#a?b=c", "?fixedDpr=0.25#", "?fixedDpr=0.25#x/y")
"""Ends of an address that say nothing to a server: bookmarks, links and other programs add them."""


def test_a_page_connects_whatever_follows_the_hash_of_its_address(another: Another) -> None:
    visits: list[str] = []
    bench = another(900, 600)
    with served(
        on_connect=lambda client, session: visits.append(session), on_disconnect=lambda *_: None
    ) as server:
        bench.page.goto(f"{server.url}?fixedDpr=0.25")
        address, session = bench.page.url.partition("?")[0], bench.page.url.split("/s/")[1].split("/")[0]
        eventually(lambda: len(visits) == 1)
        for count, fragment in enumerate(FRAGMENTS, 2):
            bench.page.goto("about:blank")
            bench.page.goto(f"{address}{fragment}")
            eventually(lambda count=count: len(visits) == count, 20.0)
        # one that is put there while the page is open, before the server is started again
        bench.page.evaluate("location.hash = 'later'")
        bench.page.reload()
        eventually(lambda: len(visits) == len(FRAGMENTS) + 2, 20.0)
        assert set(visits) == {session} and bench.faults == []


# ------------------------------------------------------------ places


SCRIPT = Path(schuler_bench.shell.__file__).parent / "static" / "place.js"
QUIET_MS = 5500


@pytest.mark.slow
def test_an_idle_page_comes_back_by_itself_and_at_once_with_its_person(another: Another) -> None:
    open_now: list[str] = []

    def connected(client: viser.ClientHandle, session: str) -> None:
        open_now.append(session)
        client.gui.add_markdown("here")

    def visited() -> tuple[Page, str]:
        page = another(900, 600).page
        page.goto(f"{server.url}?fixedDpr=0.25&start=no")
        id = page.url.split("/s/")[1].split("/")[0]
        eventually(lambda: open_now == [id], 90.0)
        return page, id

    limits = Limits(visitors=1, idle_s=1.0)
    leaves: Callable[..., None] = lambda client, session: open_now.remove(session)  # noqa: E731
    with served(on_connect=connected, on_disconnect=leaves, page_scripts=[SCRIPT], limits=limits) as server:
        first, first_id = visited()
        first.wait_for_timeout(1500)
        second, _ = visited()
        second.context.close()
        eventually(lambda: open_now == [first_id], 90.0)
        first.wait_for_timeout(1500)
        _, third_id = visited()
        first.wait_for_timeout(QUIET_MS)
        assert open_now == [third_id], "a page that nobody looks at drives nobody out"
        with first.expect_response(lambda answer: answer.url.endswith("/place")) as asked:
            first.mouse.move(300, 300)
        assert asked.value.status == 204
        eventually(lambda: open_now == [first_id], 90.0)


# ------------------------------------------------------------ a new tab


VIEW = '''
"""Tab "Peaks": the largest position error of every method."""

from schuler_bench.shell.view import PictureView, if_user


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
def peaks(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A dashboard with one view more than ours: one folder with widgets, picture, script and style."""
    folder: Path = tmp_path_factory.mktemp("more") / "peaks_view"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "view.py").write_text(VIEW)
    (folder / "peaks.js").write_text('document.documentElement.dataset.peaks = "ran";')
    (folder / "peaks.css").write_text(".peak{letter-spacing:3px}")
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(folder.parent)
        server, dashboard = open_dashboard(port=0, views=(*VIEWS, "peaks_view"))
        yield server, dashboard
        server.stop()
        dashboard.close()


def peaks_of(session: Session, unit: float = 1.0) -> list[str]:
    assert session.run is not None
    return [f"{method.errors['position_m']['max_abs'] / unit:.6g}" for method in session.run.methods]


@pytest.mark.slow
def test_a_new_tab_follows_runs_and_its_own_control(another: Another, peaks: Served) -> None:
    bench = another(1920, 1080)
    bench.url, bench.sessions = peaks[0].url, peaks[1].sessions
    page, shown = bench.open().page, bench.page.locator(".peak")
    bench.tab("Method", "Peaks")
    bench.wait_until(lambda: shown.all_inner_texts() == peaks_of(bench.session))
    before = peaks_of(bench.session)
    bench.press("network.zeta")
    bench.wait_until(lambda: shown.all_inner_texts() == peaks_of(bench.session) != before)
    page.get_by_label("peaks in kilometres").check()
    bench.wait_until(lambda: shown.all_inner_texts() == peaks_of(bench.session, 1000.0))
    assert page.evaluate("document.documentElement.dataset.peaks") == "ran"
    assert shown.first.evaluate("e => getComputedStyle(e).letterSpacing") == "3px"


# ------------------------------------------------------------ no mends, a restart


@pytest.mark.slow
def test_a_slider_moves_the_picture_without_any_mend(
    another: Another, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SCHULER_PLAIN_VISER", "1")
    page = another(1920, 1080).page
    with Server() as server:
        page.goto(f"http://127.0.0.1:{server.port}/?start=no&fixedDpr=0.25")
        run = page.locator("#sb-run")
        run.wait_for(state="attached")
        page.locator(".js-plotly-plot").first.wait_for()
        program = page.evaluate("document.querySelector('link[data-program]').href")
        assert "schuler.fill" not in page.request.get(program).text(), "nothing was put in"
        before, number = run.text_content(), int(run.get_attribute("data-run") or 0)
        page.get_by_text(ZETA, exact=True).first.wait_for()
        name = page.get_by_text(ZETA, exact=True).first.get_attribute("for")
        for _ in range(5):
            page.locator(f"[id='{name}'] [role=slider]").press("ArrowRight")
        later = "number => Number(document.querySelector('#sb-run').dataset.run) > number"
        page.wait_for_function(later, arg=number)
        assert run.text_content() != before, "other metrics"
        page.close()


@pytest.mark.slow
@pytest.mark.timeout(600)  # three servers and pages
def test_the_work_survives_the_death_of_the_server(another: Another, tmp_path: Path, repo_root: Path) -> None:
    port, bench = free_port(), another()
    bench.sessions = None
    with served_apart(repo_root, tmp_path, port) as (bench.url, _):
        bench.open()
        bench.choose_and_run("scenario", "zha-fast")
        bench.tab("Method")
        bench.edit("fast (compass)")
        bench.type(XI, "0.6")
        digest, path = bench.digest, f"s/{bench.session_id}/"
        kept = Database(tmp_path / "schuler-bench" / "sessions")

        def last_step() -> str:
            document = json.loads(kept.read(bench.session_id) or '{"steps": [{"name": ""}], "at": 0}')
            return document["steps"][document["at"]]["name"]

        eventually(lambda: last_step().endswith("0.6"), 60.0)
        kept.close()
        # killed at the end: no chance to write anything
    with served_apart(repo_root, tmp_path, port) as (_, process):
        bench.open(path)
        assert (bench.digest, bench.value(XI)) == (digest, 0.6)
        assert bench.edited == "fast (compass)"
        bench.type(XI, "0.65")
        process.send_signal(signal.SIGTERM)  # at once: what waits is written
        process.wait(60.0)
    with served_apart(repo_root, tmp_path, port):
        bench.open(path)
        assert bench.value(XI) == 0.65
        bench.button("Undo").click()
        wait_for_value(bench, XI, 0.6)
        bench.page.close()
    bench.faults.clear()  # of connections that ended


# ------------------------------------------------------------ one view alone


@pytest.mark.slow
def test_one_view_fills_the_window_without_controls(another: Another) -> None:
    bench = another(600, 380)
    page = bench.page
    for name, width in (("bode", 500), ("errors", 600)):  # 500: there viser would leave the views out
        page.set_viewport_size({"width": width, "height": 380})
        page.goto(f"{bench.url}?fixedDpr=0.25&view={name}")
        page.wait_for_function("look.fills", arg=name)
        assert page.evaluate("look.controls") == []
        for key in ("Control+k", "?"):
            page.keyboard.press(key)
        bench.sent()
        assert page.get_by_role("dialog").count() == 0 and page.evaluate("look.controls") == []
    page.goto(f"{bench.url}?fixedDpr=0.25&view=boat")
    told = bench.notice("No such view")
    assert "'boat'" in told and "bode, poles, step" in told and "map, follow, top, side" in told
    assert page.evaluate("look.controls") == []
    page.goto(f"{bench.url}?fixedDpr=0.25&view=switching")
    assert "Switching" in bench.notice("Nothing to show")
    # the same session with all its controls: what is asked for above can be seen
    page.set_viewport_size({"width": 1280, "height": 720})
    bench.open(f"s/{bench.session_id}/")
    bench.heard()
    assert len(page.evaluate("look.controls")) > 20
    page.keyboard.press("?")
    page.get_by_role("dialog", name="Keys").wait_for()


@pytest.mark.slow
def test_the_map_fills_the_window_without_controls(another: Another) -> None:
    bench, looks = another(600, 380), []
    page = bench.page
    for camera in ("map", "top"):
        page.goto(f"{bench.url}?fixedDpr=0.25&view={camera}")
        page.wait_for_function("look.stage", arg=camera)
        page.wait_for_function("() => window.__viserSceneTree.getState()['/track/truth'] !== undefined")
        page.wait_for_function("() => document.querySelectorAll('#sb-stage .sb-entry').length > 0")
        buttons, entries = page.evaluate("look.stageButtons")
        assert buttons == entries and page.evaluate("look.controls") == []
        looks.append(bench.wait_for_change(page.screenshot, *looks))
