"""For the lecture and the review: links, watchers, refusals, presentation size, files of the session."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

import pytest

import app.shell
from app.http.server import DashboardServer, start
from app.shell.layout import WIDE_FROM_PX
from navcore.scenario.model import Scenario
from tests.browser.driver import Bench
from tests.browser.patience import THROTTLE_MS
from tests.browser.test_page_layout import _TEXT_OUTSIDE, wait_until_it_fits
from tests.browser.test_page_lessons import _IN_FRONT
from tests.browser.test_page_links import _CONTROLS, _FILLS, PLAIN, fronted
from tests.browser.test_page_presentation import _SHOWN_LABELS, _TYPE, ROWS
from tests.browser.test_page_sheet import DRAWN, NAME, saved
from tests.browser.test_page_state import away_from_text
from tests.browser.windows.conftest import LOCALES, Open
from tests.browser.windows.seeing import read, see, speaks

if TYPE_CHECKING:
    import viser
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser

STATIC = Path(app.shell.__file__).parent / "static"


def test_a_link_of_this_computer_alone_says_so(window: Bench) -> None:
    see(window, window.button("Share")).click()
    dialog = window.dialog("Share this state")
    see(window, dialog)
    assert read(window, dialog.locator("[role=note]"))
    see(window, dialog.get_by_role("textbox"))
    see(window, dialog.get_by_role("button", name=window.said("Close"))).click()
    dialog.wait_for(state="detached")


def test_a_refused_file_is_told_with_one_limit(window: Bench) -> None:
    page = window.page
    window.tab("Files")
    see(window, window.button("Upload a file"))
    limits = set(re.findall(r"(\d+) MiB", page.locator("body").inner_text()))
    content = bytes(range(256)) * 9
    window.upload({"name": "junk.txt", "mimeType": "text/plain", "buffer": content})
    window.notice("The file cannot be used; nothing was changed")
    told = window.said("The file cannot be used; nothing was changed")
    read(window, page.locator(".mantine-Notification-root", has_text=told))
    for text in page.locator(".mantine-Notification-root").all_inner_texts():
        assert "successfully" not in text
        limits |= set(re.findall(r"(\d+) MiB", text))
    assert len(limits) == 1
    window.close_notices()


def test_p_pins_a_typed_value(window: Bench) -> None:
    pins, box = window.session.pins, see(window, window.box("network.zeta"))
    try:
        box.press("Control+a")
        window.page.keyboard.type("0.53", delay=THROTTLE_MS)
        window.page.keyboard.press("p")
        window.wait_until(lambda: len(pins.shown) == 1)
        (pin,) = pins.shown
        assert pin.scenario.method[2].network.model_dump()["zeta"] == 0.53
        assert box.input_value() == "0.53"
    finally:
        for pin in pins.all:
            pins.remove(pin.id)
        pins._next = 1


def test_a_watcher_is_told_and_follows_the_tabs(window: Bench, another: Open) -> None:
    other = another(f"s/{window.session_id}/")
    try:
        see(window, window.button("Present")).click()
        watches = other.page.locator(".sb-banner")
        read(other, watches)
        assert other.said("Another page presents: you watch") in watches.inner_text()
        read(window, window.page.locator(".sb-banner.sb-drives"))
        for tab in ("Spectrum", "Errors"):
            window.tab(tab)
            other.page.wait_for_function(_IN_FRONT, arg=[other.said(tab)])
        see(other, other.page.locator(".uplot"))
    finally:
        window.session.present(None)


def test_a_lost_server_is_told(browser: Browser, language: str, size: tuple[int, int]) -> None:
    def connected(client: viser.ClientHandle, session: str) -> None:
        style = (STATIC / "commands.css").read_text("utf-8")
        client.gui.add_html(f'<style>{style}</style><div id="sb-run">1</div>')

    scripts = [STATIC / "lost.js"]
    server: DashboardServer = start(
        port=0, on_connect=connected, on_disconnect=lambda *_: None, page_scripts=scripts
    )
    viewport = {"width": size[0], "height": size[1]}
    context = browser.new_context(viewport=viewport, locale=LOCALES[language])
    try:
        bench = Bench(context.new_page(), server.url, None)
        bench.page.goto(f"{server.url}?fixedDpr=0.25")
        bench.page.locator("#sb-run").wait_for()
        bench.language = bench.page.evaluate("() => schuler.language")
        bench.page.wait_for_timeout(1200)  # it looks twice a second whether it is connected
        assert bench.page.locator("#sb-lost").count() == 0
        server.stop()
        read(bench, bench.page.locator("#sb-lost"))
    finally:
        server.stop()
        context.close()


def test_an_address_opens_tabs_and_one_view_alone(window: Bench, another: Open) -> None:
    wide = window.page.viewport_size["width"] >= WIDE_FROM_PX
    tabs = ["Sensors", *(["Frequency"] if wide else []), "Spectrum"]
    window.tab(*tabs)
    window.page.evaluate("() => schuler.command('share-view')")
    dialog = window.dialog("Share this state")
    link = see(window, dialog.get_by_role("textbox")).input_value()
    window.page.keyboard.press("Escape")
    assert link.endswith(f"?tab={','.join(tabs)}")
    path, _, query = link.removeprefix(window.url).partition("?")
    other = another(path, f"{PLAIN}&{query}")
    assert fronted(other) == [other.said(tab) for tab in tabs]
    see(other, other.page.locator(".js-plotly-plot:visible"))
    other.page.goto(f"{other.url}?fixedDpr=0.25&view=bode")
    other.page.wait_for_function(_FILLS, arg="bode")
    assert other.page.evaluate(_CONTROLS) == []
    titles = other.page.locator(".js-plotly-plot:visible .annotation-text").all_text_contents()
    assert titles
    speaks(other, "\n".join(titles))


def test_presentation_size_is_large_folded_and_whole(window: Bench) -> None:
    page, height = window.page, window.page.viewport_size["height"]
    try:
        away_from_text(window)
        page.locator("body").press("l")
        page.wait_for_selector("#sb-size", state="attached")
        window.heard()
        for tab in ("Frequency", "Errors"):
            window.tab(tab)
            wait_until_it_fits(window, tab)
            # without the "?" that comes with the pointer
            smallest, text = next(found for found in page.evaluate(_TYPE) if found[1] != "?")
            assert smallest >= height / ROWS, (tab, text)
        assert page.evaluate(_TEXT_OUTSIDE) == []
        assert "scenario" not in page.evaluate(_SHOWN_LABELS)
        assert page.locator("[data-dock-region=left] [role=tablist]").is_hidden()
        see(window, window.button("Normal size")).click()
        page.wait_for_selector("#sb-size", state="detached")
        see(window, window.box("scenario"))
    finally:
        window.show(size="normal")
        window.heard()


def test_the_session_is_saved_as_a_page_and_as_a_picture(window: Bench, tmp_path: Path) -> None:
    window.tab("View")
    for name, file in (("Save as one page (HTML)", "session.html"), ("Save all plots (PNG)", "overview.png")):
        see(window, window.button(name))
        path = saved(window, window.said(name), tmp_path)
        assert path.name == file
    assert path.read_bytes().startswith(b"\x89PNG") and path.stat().st_size > 100_000
    reader = window.page.context.new_page()
    try:
        reader.goto((tmp_path / "session.html").as_uri())
        reader.wait_for_function("() => [...document.images].every((image) => image.complete)")
        titles = reader.evaluate(DRAWN)
        # the 3D view is saved as large as it is seen, and these pages are seen at a quarter of their pixels
        plots = titles[1:]
        assert len(plots) >= 7 and not [title for title in plots if title.startswith("no ")]
        speaks(window, "\n".join([*plots, *reader.locator("h1, h2, h3, th").all_inner_texts()]))
        reader.emulate_media(media="print")
        assert (
            reader.evaluate("() => getComputedStyle(document.querySelector('figure')).breakInside") == "avoid"
        )
    finally:
        reader.close()


def test_a_plot_behind_another_tab_is_saved_with_chinese_names_as_text(window: Bench) -> None:
    data = window.session.scenario.canonical()
    data["method"][1]["name"] = NAME
    window.put(Scenario.parse(data), selected=2)
    window.tab("View")
    try:
        window.choose("export plot", "Poles")
        with window.page.expect_download() as download:
            see(window, window.page.get_by_text("SVG", exact=True)).click()
        text = "".join(ElementTree.fromstring(download.value.path().read_bytes()).itertext())
        assert NAME.removeprefix("<b>").removesuffix("</b>") in text
        assert window.said("Near the Schuler frequency") in text
    finally:
        window.choose("export plot", "Frequency")
