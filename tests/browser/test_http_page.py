"""The page in a real browser, under its session path and with the Content-Security-Policy on."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import viser

from app.http.server import DashboardServer, start
from tests.attack.conftest import eventually
from tests.browser.patience import PATIENCE_MS

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = pytest.mark.browser


class Figure:
    """A plotly figure as the dashboard sends it."""

    def to_json(self) -> str:
        return json.dumps({"data": [{"x": [1, 10], "y": [3, 4]}], "layout": {"xaxis": {"type": "log"}}})


@pytest.fixture
def visits() -> list[tuple[str, Any]]:
    return []


@pytest.fixture
def server(visits: list[tuple[str, Any]]) -> Iterator[DashboardServer]:
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
        button.on_click(
            lambda _: client.gui.add_html("<img src='x' onerror='window.harmed = true'><b>end</b>")
        )

    server = start(port=0, on_connect=connected, on_disconnect=lambda client, session: None)
    server.viser.scene.configure_environment_map(hdri=None)
    server.viser.scene.configure_default_lights(cast_shadow=False)
    yield server
    server.stop()


def test_page_works_under_its_session_path_with_the_policy_on(
    server: DashboardServer, page: Page, visits: list[tuple[str, Any]]
) -> None:
    faults: list[str] = []
    page.set_default_timeout(PATIENCE_MS)
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("console", lambda message: faults.append(message.text) if message.type == "error" else None)
    page.on("requestfailed", lambda request: faults.append(request.url))

    answer = page.goto(f"{server.url}?fixedDpr=0.25&websocket=ws://127.0.0.1:9/elsewhere")
    assert "script-src" in answer.headers["content-security-policy"]
    for drawn in ("canvas", ".js-plotly-plot .scatterlayer .trace", ".uplot canvas", "math"):
        page.wait_for_selector(drawn, state="attached")
    session = page.url.split("/s/")[1].split("/")[0]
    assert page.url == f"{server.url}s/{session}/?fixedDpr=0.25"
    assert page.title() == "Schuler Bench"
    assert page.evaluate("typeof Plotly") == "object"

    knob = page.get_by_text("gain", exact=True).first.evaluate("label => label.htmlFor")
    page.locator(f"[id='{knob}'] [role=slider]").press("ArrowRight")
    eventually(lambda: visits == [("connect", session), ("gain", 0.6)], 30.0)
    assert faults == []

    # The policy is what stops markup that reached the page: remove it, and this fails.
    page.get_by_role("button", name="inject").click()
    page.get_by_text("end", exact=True).wait_for()
    for _ in range(300):  # the browser tells of it once it has tried to load the image
        if any("inline event handler" in fault for fault in faults):
            break
        page.wait_for_timeout(100)
    assert any("inline event handler" in fault for fault in faults)
    assert page.evaluate("window.harmed") is None

    page.reload()
    page.wait_for_selector(".js-plotly-plot", state="attached")
    assert visits[-1] == ("connect", session)
