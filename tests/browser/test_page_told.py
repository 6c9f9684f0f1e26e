"""What the page must say: a lost server, a link for this computer alone, a refused file; a key."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import app.shell
from app.http.server import DashboardServer, start
from app.views.files import view as files_view
from tests.browser.driver import Bench
from tests.browser.patience import PATIENCE_MS, THROTTLE_MS

if TYPE_CHECKING:
    import viser
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser

LOST = Path(app.shell.__file__).parent / "static" / "lost.js"


@pytest.fixture
def server() -> Iterator[DashboardServer]:
    def connected(client: viser.ClientHandle, session: str) -> None:
        del session
        client.gui.add_html('<div id="sb-run">run 1</div>')

    server = start(port=0, on_connect=connected, on_disconnect=lambda *_: None, page_scripts=[LOST])
    yield server
    server.stop()


def test_a_page_says_that_its_server_is_lost(browser: Browser, server: DashboardServer) -> None:
    page = browser.new_page(viewport={"width": 900, "height": 600})
    page.set_default_timeout(PATIENCE_MS)
    page.goto(f"{server.url}?fixedDpr=0.25")
    page.get_by_text("run 1").wait_for()
    page.wait_for_timeout(2500)
    assert page.locator("#sb-lost").count() == 0
    server.stop()
    banner = page.get_by_role("alert").filter(has_text="The connection to the server is lost")
    banner.wait_for()
    page.close()


def test_a_link_of_this_computer_alone_is_said_to_be_one(bench: Bench) -> None:
    bench.page.evaluate("() => schuler.command('share')")
    dialog = bench.page.get_by_role("dialog", name="Share this state")
    dialog.get_by_text("Only this computer can open this link").wait_for()
    dialog.get_by_role("button", name="Close").click()


def test_a_refused_file_is_not_called_a_success(bench: Bench) -> None:
    assert (Path(files_view.__file__).parent / "upload.js").is_file()
    bench.page.evaluate(
        """() => {
          window.told = new Set();
          const read = () => document.querySelectorAll('.mantine-Notification-root')
            .forEach(e => window.told.add(e.textContent));
          window.telling = setInterval(read, 10);
        }"""
    )
    bench.tab("Files")
    bench.upload({"name": "junk.txt", "mimeType": "text/plain", "buffer": bytes(range(256)) * 9})
    bench.notice("The file cannot be used; nothing was changed")
    bench.catch_up()
    bench.page.wait_for_function(
        "() => [...window.told].some(text => text.includes('The file has arrived and is being read.'))"
    )
    told = bench.page.evaluate("() => { clearInterval(window.telling); return [...window.told]; }")
    assert any("The file has arrived and is being read." in text for text in told)
    assert not any("successfully" in text for text in told)
    bench.close_notices()


@pytest.mark.parametrize("ends", ["", "Enter"])
def test_p_pins_after_a_typed_value(bench: Bench, ends: str) -> None:
    """With or without Enter, the pin is of the typed value, not of the run before it."""
    bench.reset("zha-fast", selected=2)
    bench.tab("Method")
    box = bench.box("network.xi")
    box.press("Control+a")
    bench.page.keyboard.type("0.53", delay=THROTTLE_MS)
    if ends:
        box.press(ends)
        bench.page.wait_for_function("() => document.activeElement === document.body")
    bench.page.keyboard.press("p")
    bench.wait_until(lambda: len(bench.session.pins.shown) == 1)
    [pin] = bench.session.pins.shown
    assert pin.scenario.method[2].network.values(pin.scenario.omega_s)["xi"] == 0.53
    assert box.input_value() == "0.53"
    bench.session.pins.remove(pin.id)


def test_the_error_of_a_recorded_log_is_fitted_by_a_button(bench: Bench) -> None:
    bench.reset("sikuliaq-recorded")
    bench.tab("Log")
    bench.page.get_by_role("button", name="Fit this log's error").click()
    bench.page.get_by_text("Error of the log along the ship's axes").wait_for()
    bench.page.get_by_role("button", name="Simulate a log with this error").click()
    bench.page.get_by_role("button", name="Fit this log's error").wait_for(state="hidden")
    assert bench.session.scenario.reference.kind == "log"
    assert bench.faults == []
