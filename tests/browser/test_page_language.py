"""The page in Chinese: nothing that is seen or read aloud is left in English; the language can be changed."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import TYPE_CHECKING

import pytest

from app.editing import form
from app.views.learn.lessons import lessons
from navcore.foundation.parameters import Parameters
from navcore.scenario.file import load, presets
from tests.browser.driver import Bench

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator

    from app.http.server import DashboardServer
    from app.serve import Dashboard

pytestmark = pytest.mark.browser

SEEN = """() => {
  const found = new Set();
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const parent = walker.currentNode.parentElement;
    const quiet = parent.closest('script, style, pre, math, [hidden], [data-sb-kind=hidden]');
    const seen = quiet === null && parent.checkVisibility({visibilityProperty: true});
    if (seen) found.add(walker.currentNode.data.trim());
  }
  for (const name of ['title', 'aria-label', 'placeholder']) {
    for (const one of document.querySelectorAll(`[${name}]`)) {
      if (!one.closest('[data-sb-kind=hidden]')) found.add(one.getAttribute(name));
    }
  }
  for (const {chart} of Object.values(window.__viserTestpoints?.uplots ?? {})) {
    for (const one of [...chart.series.slice(1), ...chart.axes]) found.add(one.label ?? '');
  }
  return [...found];
}"""
WORD = re.compile(r"[A-Za-z]{3,}")
KEY = re.compile(r"\b[a-z]+(?:[._][a-z0-9]+)+\b")
"""A field of the scenario file, a column, a file."""
RINGED = "() => document.querySelector('.sb-ring')?.getBoundingClientRect().width > 20"
REFUSED = (
    ("junk.txt", bytes(range(256)) * 9),
    ("log.csv", b"time_s,speed_mps\n1,2\n2,x\n"),
    ("wrong.toml", b"title = 3\n[run]\nduration_h = -1\n"),
)
STILL = load("zha-fast")
DIVERGES = load("zha-fast", ["method.2.network.sigma=1.0"])
SYMBOLS = frozenset(
    "Schuler Bench CSV SVG PNG TOML JSON HTML NMEA Parquet MAT PSINS arcsec arcmin min nmi MiB sin per "
    "log linear exact Deng Liu Zhao Sun Zha Sikuliaq fig eq theory md RMS GPS LQG IMU WGS ENE ESE SSE SSW "
    "WSW WNW NNW NNE Ctrl Shift Enter Esc English Viser WorldAxes light map metrics scenario toml json "
    "page state painted command serve host mas rms and pole2 imu reference".split()
)
"""Product, formats, symbols, units, keys, citations, the scene's nodes, the page's own hidden controls."""


@lru_cache(maxsize=1)
def as_written() -> frozenset[str]:
    """Words of a scenario file, which stay as they are: fields, choices, names and units."""
    words = set(SYMBOLS)
    scenarios = [load(name) for name in presets()]
    scenarios += [lesson.scenario_of(step) for lesson in lessons() for step in range(len(lesson.steps))]
    for name in presets():
        words |= set(re.findall(r"[A-Za-z]+", name))
    for scenario in scenarios:
        for method in scenario.method:
            words |= set(re.findall(r"[A-Za-z]+", method.name))
    for kind in models(Parameters):
        for info in kind.model_fields.values():
            words |= {
                part for one in form._literals(info.annotation) for part in re.findall("[A-Za-z]+", one)
            }
            words |= set(re.findall("[A-Za-z]+", str((info.json_schema_extra or {}).get("unit", ""))))
    return frozenset(words)


def models(base: type) -> list[type]:
    return [kind for inner in base.__subclasses__() for kind in (inner, *models(inner))]


def left_out(seen: Iterable[str]) -> list[str]:
    """Texts with a word of English in them, be the rest translated or not."""
    known = as_written()
    bare = {text: KEY.sub("", text) for text in seen}
    return sorted(text for text in seen if any(word not in known for word in WORD.findall(bare[text])))


_CHINESE = "?lang=zh&fixedDpr=0.25&start=no"


class Reader:
    """A visitor who reads Chinese, and notes what is seen or read aloud.

    Parameters
    ----------
    bench : Bench
        The page.
    """

    def __init__(self, bench: Bench) -> None:
        self.bench, self.page = bench, bench.page
        self.seen: set[str] = set()

    def look(self) -> None:
        """Note all texts that the page shows now."""
        self.seen |= set(self.page.evaluate(SEEN))

    def ask(self, *words: str) -> None:
        """Let the page carry out a command, and look at what comes of it."""
        self.page.evaluate("words => schuler.command(...words)", list(words))
        self.bench.settle()
        self.look()

    def dialog(self, *words: str) -> Locator:
        """Look at the dialog that a command opens."""
        self.page.evaluate("words => schuler.command(...words)", list(words))
        dialog = self.page.locator("dialog[open]")
        dialog.wait_for()
        self.look()
        return dialog

    def close(self) -> None:
        """Close what is open over the page."""
        self.page.keyboard.press("Escape")
        self.page.locator("dialog[open], .sb-tour, .mantine-Spotlight-search").first.wait_for(
            state="detached"
        )

    def judge(self) -> None:
        """Let nothing seen so far be English; forget it."""
        found, self.seen = left_out(self.seen), set()
        assert not found, "\n".join(found)
        assert self.bench.faults == []


@pytest.fixture(scope="module")
def reader(browser: Browser, dashboard: tuple[DashboardServer, Dashboard]) -> Iterator[Reader]:
    """A visitor with a Chinese page."""
    context = browser.new_context(viewport={"width": 1920, "height": 1080})
    bench = Bench(context.new_page(), dashboard[0].url, dashboard[1].sessions)
    yield Reader(bench.open(query=_CHINESE))
    context.close()


def test_what_is_left_out_is_found() -> None:
    assert left_out({"Undo", "撤销", "classic2", "φE (arcsec)", "3.3 h", "自 that error"}) == [
        "Undo",
        "自 that error",
    ]


def test_a_visitor_is_greeted_and_shown_around(reader: Reader) -> None:
    page = reader.page
    reader.bench.open(query="?lang=zh&fixedDpr=0.25")
    assert page.evaluate("document.documentElement.lang") == "zh-CN"
    page.locator("dialog[open] .sb-door").first.wait_for()
    reader.look()
    reader.close()
    reader.ask("tour")
    for number in range(6):
        page.get_by_text(f"第 {number + 1} 步，共 6 步", exact=True).wait_for()
        page.wait_for_function(RINGED)
        reader.look()
        page.keyboard.press("ArrowRight")
    reader.close()
    reader.judge()


def test_every_tab(reader: Reader) -> None:
    page = reader.page
    for tab in page.get_by_role("tab").all():
        tab.click()
        page.wait_for_function(
            "tab => tab.getAttribute('aria-selected') === 'true'", arg=tab.element_handle()
        )
        reader.bench.settle()
        reader.look()
    assert len(reader.seen) > 400
    reader.judge()


def test_dialogs_and_the_palette(reader: Reader) -> None:
    page, bench = reader.page, reader.bench
    bench.reset("sikuliaq-like", selected=2)
    assert reader.dialog("scenarios").locator(".sb-card").count() == len(presets())
    reader.close()
    assert reader.dialog("networks").locator(".sb-card[aria-pressed=true]").count() == 1
    reader.close()
    for name in ("keys", "share", "share-view"):
        reader.dialog(name)
        reader.close()
    page.keyboard.press("Control+k")
    search = page.get_by_placeholder(bench.said("Search commands..."))
    search.wait_for()
    reader.look()
    search.fill("xyzzy")
    page.get_by_text(bench.said("No matching commands...")).wait_for()
    reader.look()
    page.keyboard.press("Escape")
    search.wait_for(state="detached")
    bench.tab("Method")
    for id in ("", bench.id("network.zeta"), bench.box_id("network")):
        reader.ask("explain", id)
        page.wait_for_timeout(150)  # the panel asks for its text ten times a second
        reader.look()
    page.locator(".sb-explain .sb-close").click()
    reader.judge()


def test_what_is_refused_and_what_is_told(reader: Reader) -> None:
    page, bench = reader.page, reader.bench
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Method")
    zeta = bench.box("network.zeta")
    zeta.fill("-7")
    page.locator(".sb-note:visible").first.wait_for()
    reader.look()
    bench.type("network.zeta", "0.4")
    # a unit behind a number, and a double click on a name: the control is found, whatever it is called
    bench.tab("Run")
    zeta = bench.box("run.duration_h")
    zeta.press("Control+a")
    page.keyboard.type("540 min")
    reader.look()
    page.keyboard.press("Enter")
    # on a slow machine a run of 540 h has begun before the unit is typed
    bench.wait_until(lambda: bench.session.scenario.run.duration_h == 9.0)
    bench.settle()
    bench.tab("Compare")
    reader.ask("pin")
    bench.tab("Method")
    bench.type("network.zeta", "0.6")
    reader.ask("flip")
    reader.ask("flip")
    bench.tab("Metrics")
    reader.look()
    reader.ask("reset-all")
    reader.ask("reset-all")
    bench.notice("Nothing has been changed")
    reader.look()
    bench.close_notices()
    bench.tab("Files")
    for name, content in REFUSED:
        bench.upload({"name": name, "mimeType": "text/plain", "buffer": content})
        bench.notice("The file cannot be used; nothing was changed")
        reader.look()
        bench.close_notices()
    for pin in bench.session.pins.all:
        bench.session.pins.remove(pin.id)
    reader.judge()


def test_a_verification_and_a_run_that_diverges(reader: Reader) -> None:
    bench = reader.bench
    bench.put(load("sikuliaq-like", ["run.duration_h=1.0"]), origin="sikuliaq-like", selected=2)
    bench.tab("Errors", "Metrics")
    reader.ask("verify")
    bench.wait_until(lambda: bench.session.verifier.result is not None, 120.0)
    bench.settle()
    reader.look()
    bench.tab("Method", "Errors")
    bench.press("network.zeta")
    reader.look()
    for scenario in (DIVERGES, STILL):
        bench.put(scenario, origin="zha-fast")
        for tab in ("Errors", "Metrics", "Design", "Tune"):
            bench.tab(tab)
            reader.look()
    reader.judge()


@pytest.mark.parametrize("number", range(len(lessons())), ids=[lesson.id for lesson in lessons()])
def test_a_lesson(reader: Reader, number: int) -> None:
    reader.bench.tab("Learn")
    reader.ask("lesson", f"open {number}")
    for step in lessons()[number].steps:
        if step.question is not None:
            reader.ask("lesson", "show")
            for given in ("0", "1", "x"):
                reader.ask("lesson", f"answer {given}")
        reader.ask("lesson", "next")
    reader.ask("lesson", "list")
    reader.judge()


def test_presenting_and_presentation_size(reader: Reader) -> None:
    bench, page = reader.bench, reader.page
    reader.ask("preset-sikuliaq-like")
    watcher = Bench(page.context.new_page(), bench.url, bench.sessions)
    reader.ask("present")
    reader.seen |= set(watcher.open(f"s/{bench.session_id}/").page.evaluate(SEEN))
    reader.look()
    watcher.page.close()
    reader.ask("present")
    page.locator("body").press("l")
    page.wait_for_selector("#sb-size", state="attached")
    reader.look()
    page.locator("body").press("l")
    page.wait_for_selector("#sb-size", state="detached")
    reader.judge()


def test_a_choice_made_in_chinese_reaches_the_program(reader: Reader) -> None:
    bench, page = reader.bench, reader.page
    session_id = bench.session_id
    bench.tab("View")
    bench.box("Language").click()
    page.get_by_role("option", name="English", exact=True).click()
    page.wait_for_selector("html[lang=en]", state="attached")
    page.wait_for_selector("#sb-run[data-run]", state="attached")
    page.get_by_role("tab", name="View", exact=True).wait_for()
    bench.open(f"s/{session_id}/", _CHINESE)  # the reader of the other tests
