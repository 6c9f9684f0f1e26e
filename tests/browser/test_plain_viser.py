"""The page with viser as it is: no mend of its program or its server."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from app.bench.dashboard import ZETA
from app.bench.process import Server
from tests.browser.patience import PATIENCE_MS

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = pytest.mark.browser


def test_a_slider_moves_the_picture_without_any_mend(page: Page, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SCHULER_PLAIN_VISER", "1")
    with Server() as server:
        page.set_viewport_size({"width": 1920, "height": 1080})
        page.goto(f"http://127.0.0.1:{server.port}/?start=no&fixedDpr=0.25")
        run = page.locator("#sb-run")
        run.wait_for(state="attached", timeout=PATIENCE_MS)
        page.locator(".js-plotly-plot").first.wait_for(timeout=PATIENCE_MS)
        program = page.evaluate("document.querySelector('link[data-program]').href")
        assert "schuler.fill" not in page.request.get(program).text(), "nothing was put in"
        before, number = run.text_content(), int(run.get_attribute("data-run") or 0)
        page.get_by_text(ZETA, exact=True).first.wait_for(timeout=PATIENCE_MS)
        name = page.get_by_text(ZETA, exact=True).first.get_attribute("for")
        thumb = page.locator(f"[id='{name}'] [role=slider]")
        for _ in range(5):
            thumb.press("ArrowRight")
        page.wait_for_function(
            "number => Number(document.querySelector('#sb-run').dataset.run) > number",
            arg=number,
            timeout=PATIENCE_MS,
        )
        assert run.text_content() != before, "other metrics"
