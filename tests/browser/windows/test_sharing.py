"""For the lecture and the review: links, watchers, refusals, presentation size, files of the session."""

import re
import struct
from collections.abc import Callable, Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest
import viser

import schuler_bench.shell
from navcore.scenario.model import Scenario
from schuler_bench.http.server import start
from schuler_bench.shell.layout import layout_for
from schuler_bench.views import load
from tests.browser.driver import Bench
from tests.browser.patience import THROTTLE_MS
from tests.browser.placing import place, ring_at
from tests.browser.test_page_layout import wait_until_it_fits
from tests.browser.test_page_state import away_from_text
from tests.browser.windows.seeing import read, see, speaks

STATIC = Path(schuler_bench.shell.__file__).parent / "static"
NAME = "<b>\u963b\u5c3c</b>"
DRAWING_MS = 300_000
"""A dozen plots are drawn one after the other: on a busy machine each takes seconds."""
PAPER_PX = (round(182 / 25.4 * 96), round(269 / 25.4 * 96))
"""A4 within its margins, as a browser counts."""
TOO_LARGE = """([width, height]) => {
  const found = [];
  for (const figure of document.querySelectorAll('figure')) {
    const { breakInside } = getComputedStyle(figure);
    if (figure.offsetHeight > height || breakInside !== 'avoid') found.push(figure.innerText);
  }
  for (const table of document.querySelectorAll('table')) {
    if (table.getBoundingClientRect().right > width) found.push(table.innerText.slice(0, 60));
  }
  return found;
}"""
DRAWN = """() => [...document.images].map(({naturalWidth, alt}) => naturalWidth > 100 ? alt : `no ${alt}`)"""
PLAIN = "?fixedDpr=0.25&start=no"
ROWS = 48.0
"""Lines of the smallest type in a window's height."""


def test_a_link_of_this_computer_alone_says_so(window: Bench) -> None:
    see(window, window.button("Share")).click()
    dialog = see(window, window.dialog("Share this state"))
    assert read(window, dialog.locator("[role=note]"))
    see(window, dialog.get_by_role("textbox"))
    see(window, dialog.get_by_role("button", name=window.said("Close"))).click()
    dialog.wait_for(state="detached")


def test_a_refused_file_is_told_with_one_limit(window: Bench) -> None:
    page = window.page
    window.tab("Files")
    see(window, window.button("Upload a file"))
    page.evaluate("look.noteAll")
    window.upload({"name": "junk.txt", "mimeType": "text/plain", "buffer": bytes(range(256)) * 9})
    assert "junk.txt" in window.notice("The file cannot be used; nothing was changed")
    refused = window.said("The file cannot be used; nothing was changed")
    read(window, page.locator(".mantine-Notification-root", has_text=refused))
    arrived = window.said("The file has arrived and is being read.")
    page.wait_for_function("text => [...window.told].some(told => told.includes(text))", arg=arrived)
    told = page.evaluate("look.noted")
    assert not [text for text in told if "successfully" in text]
    assert len(set(re.findall(r"(\d+) MiB", " ".join([page.locator("body").inner_text(), *told])))) == 1


def test_p_pins_a_typed_value(window: Bench) -> None:
    """The pin is of the typed value, not of the run before it; within the box a letter is text."""
    pins, box = window.session.pins, see(window, window.box("network.zeta"))
    box.press("Control+a")
    window.page.keyboard.type("0.53", delay=THROTTLE_MS)
    box.press("Enter")
    window.page.wait_for_function("() => document.activeElement === document.body")
    window.page.keyboard.press("p")
    window.wait_until(lambda: len(pins.shown) == 1)
    (pin,) = pins.shown
    assert pin.scenario.method[2].network.model_dump()["zeta"] == 0.53
    assert box.input_value() == "0.53"


@pytest.mark.slow
def test_a_watcher_is_told_and_follows_the_tabs(window: Bench, visitor: Bench) -> None:
    place(window, "Poles")
    visitor.open(f"s/{window.session_id}/")
    visitor.tab("Poles")
    ring_at(visitor)
    see(window, window.button("Present")).click()
    read(visitor, visitor.page.locator(".sb-banner"))
    assert visitor.said("Another page presents: you watch") in visitor.page.locator(".sb-banner").inner_text()
    read(window, window.page.locator(".sb-banner.sb-drives"))
    # who watches has no handle, who drives keeps it
    visitor.page.wait_for_function("look.away")
    see(visitor, visitor.page.locator(".js-plotly-plot:visible"))
    ring_at(window)
    for tab in ("Spectrum", "Errors"):
        window.tab(tab)
        visitor.page.wait_for_function("look.inFront", arg=[visitor.said(tab)])
    see(visitor, visitor.page.locator(".uplot"))
    window.button("Present").click()
    visitor.page.locator(".sb-banner").wait_for(state="hidden")
    visitor.tab("Poles")
    ring_at(visitor)


@pytest.fixture
def lost(visitor: Bench) -> Iterator[Callable[[], None]]:
    """A page of a server of its own, and how that server ends."""

    def connected(client: viser.ClientHandle, session: str) -> None:
        style = (STATIC / "commands.css").read_text("utf-8")
        client.gui.add_html(f'<style>{style}</style><div id="sb-run">1</div>')

    scripts = [STATIC / "lost.js"]
    server = start(port=0, on_connect=connected, on_disconnect=lambda *_: None, page_scripts=scripts)
    visitor.page.goto(f"{server.url}?fixedDpr=0.25")
    visitor.page.locator("#sb-run").wait_for()
    visitor.language = visitor.page.evaluate("() => schuler.language")
    yield server.stop
    server.stop()
    visitor.faults.clear()  # of the connection


def test_a_lost_server_is_told(visitor: Bench, lost: Callable[[], None]) -> None:
    visitor.page.wait_for_timeout(2500)  # it looks twice a second whether it is connected
    assert visitor.page.locator("#sb-lost").count() == 0
    lost()
    read(visitor, visitor.page.locator("#sb-lost[role=alert]"))


@pytest.mark.slow
def test_an_address_opens_tabs_and_one_view_alone(window: Bench, visitor: Bench) -> None:
    tabs = ["Setup", *(["Frequency"] if layout_for(*window.size).two else []), "Spectrum"]
    window.tab(*tabs)
    window.page.evaluate("() => schuler.command('share-view')")
    link = see(window, window.dialog("Share this state").get_by_role("textbox")).input_value()
    assert link.endswith(f"?tab={','.join(tabs)}")
    page = visitor.page
    page.goto(link.replace("?", f"{PLAIN}&tab=poles,Bodies&"))
    told = visitor.notice("'Bodies'")
    visitor.language = page.evaluate("() => schuler.language")
    assert all(visitor.said(kind.title) in told for kind in load() if kind.title)
    page.wait_for_selector("html[data-fronted]", state="attached")
    visitor.heard()
    assert page.evaluate("look.front") == [visitor.said(tab) for tab in tabs]
    assert visitor.session.display == window.session.display
    see(visitor, page.locator(".js-plotly-plot:visible"))
    visitor.close_notices()
    page.goto(f"{visitor.url}?fixedDpr=0.25&view=bode")
    page.wait_for_function("look.fills", arg="bode")
    assert page.evaluate("look.controls") == [] and not page.locator("#sb-stage").is_visible()
    titles = page.locator(".js-plotly-plot:visible .annotation-text").all_text_contents()
    assert titles
    speaks(visitor, "\n".join(titles))
    # one click copies a frame that shows this view of a copy of the state
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    embed = page.locator("#sb-embed")
    word = embed.inner_text()
    embed.click()
    page.wait_for_function("word => document.getElementById('sb-embed').textContent !== word", arg=word)
    copied = page.evaluate("() => navigator.clipboard.readText()")
    source = re.fullmatch(r'<iframe src="([^"]+)\?view=bode" title="[^"]+" [^>]+></iframe>', copied).group(1)
    assert source != visitor.url and source.split("/s/")[0] == visitor.url.split("/s/")[0].rstrip("/")


@pytest.mark.slow
def test_presentation_size_is_large_folded_and_whole(window: Bench) -> None:
    page, height = window.page, window.page.viewport_size["height"]
    window.tab("Run")
    away_from_text(window)
    page.locator("body").press("l")
    page.wait_for_selector("#sb-size", state="attached")
    window.heard()
    page.wait_for_function("() => look.shownLabels().includes('network')")
    for tab in ("Frequency", "Poles", "Step", "Errors", "Metrics"):
        window.tab(tab)
        wait_until_it_fits(window, tab, scrolls=tab == "Metrics")
        # without the "?" that comes with the pointer
        smallest, text = next(found for found in page.evaluate("look.type") if found[1] != "?")
        assert smallest >= height / ROWS, (tab, text)
        assert page.evaluate("look.textOutside") == [], tab
    hidden = {"scenario", "duration (h)", "enlarge errors in 3D"}
    assert page.locator(".sb-chip").count() == 3 and page.locator(".sb-menu, .sb-plus").count() == 0
    assert not hidden & set(page.evaluate("look.shownLabels"))
    for folded in ("[data-dock-region=left] [role=tablist]", "[data-command=undo]"):
        assert page.locator(folded).is_hidden()
    # a lesson's controls stand in the place of the method's
    page.evaluate("() => schuler.command('lesson', 'open 1')")
    page.locator(".sb-lesson h3").first.wait_for()
    assert "network" not in page.evaluate("look.shownLabels")
    see(window, window.button("Normal size")).click()
    page.wait_for_selector("#sb-size", state="detached")
    assert page.locator("[data-dock-region=left] [role=tablist]").is_visible()
    assert window.session.display.size == "normal"
    see(window, window.box("scenario"))


def test_the_session_is_saved_as_a_page_and_as_a_picture(window: Bench, tmp_path: Path) -> None:
    data = window.session.scenario.canonical()
    data["method"][1]["name"] = NAME
    window.put(Scenario.parse(data), "View", selected=2)
    window.show(theme="dark")
    for name, file in (("Save as one page (HTML)", "session.html"), ("Save all plots (PNG)", "overview.png")):
        with window.page.expect_download(timeout=DRAWING_MS) as download:
            see(window, window.button(name)).click()
        assert download.value.suggested_filename == file
        download.value.save_as(tmp_path / file)
        window.page.locator("#sb-export").wait_for(state="detached")
    picture = (tmp_path / "overview.png").read_bytes()
    assert picture.startswith(b"\x89PNG") and len(picture) > 100_000
    assert min(struct.unpack(">II", picture[16:24])) > 1000
    assert window.page.locator(".sb-making").text_content() == ""
    reader, asked = window.page.context.new_page(), []
    reader.on("request", lambda request: asked.append(request.url))
    reader.goto((tmp_path / "session.html").as_uri())
    reader.wait_for_function("() => [...document.images].every((image) => image.complete)")
    # the 3D view is saved as large as it is seen, and these pages are seen at a quarter of their pixels
    plots = reader.evaluate(DRAWN)[1:]
    assert len(plots) >= 7 and not [title for title in plots if title.startswith("no ")]
    speaks(window, "\n".join([*plots, *reader.locator("h1, h2, h3, th").all_inner_texts()]))
    assert reader.get_by_text(NAME, exact=True).count() >= 1
    assert reader.evaluate("() => document.querySelectorAll('script, b b').length") == 0
    ground = "() => getComputedStyle(document.body).backgroundColor"
    assert reader.evaluate(ground) == "rgb(255, 255, 255)"
    assert [url for url in asked if not url.startswith(("data:", "file:"))] == []
    reader.emulate_media(media="print")
    reader.set_viewport_size({"width": PAPER_PX[0], "height": PAPER_PX[1]})
    assert reader.evaluate(TOO_LARGE, list(PAPER_PX)) == []
    pages = reader.pdf(prefer_css_page_size=True)
    assert 4 <= len(re.findall(rb"/Type\s*/Page\b", pages)) <= 14
    assert re.search(rb"/MediaBox\s*\[\s*0 0 59[45](\.\d+)? 84[12]", pages)  # points
    reader.close()


def test_a_plot_behind_another_tab_is_saved_with_chinese_names_as_text(window: Bench) -> None:
    data = window.session.scenario.canonical()
    data["method"][1]["name"] = NAME
    window.put(Scenario.parse(data), "View", selected=2)
    window.choose("export plot", "Poles")
    with window.page.expect_download() as download:
        see(window, window.page.get_by_text("SVG", exact=True)).click()
    assert download.value.suggested_filename.endswith(".svg")
    text = "".join(ElementTree.fromstring(download.value.path().read_bytes()).itertext())
    names = [
        method.name.removeprefix("<b>").removesuffix("</b>") for method in window.session.scenario.method
    ]
    assert all(name in text for name in [*names, window.said("Near the Schuler frequency")])
    window.choose("export plot", "Frequency")
