"""The page in Chinese: nothing that is seen or read aloud is left in English; the language can be changed."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from app.editing import form
from navcore.foundation.parameters import Parameters
from navcore.scenario.file import load, presets
from tests.browser.driver import Bench

if TYPE_CHECKING:
    from playwright.sync_api import Browser

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
CHINESE = re.compile("[\u4e00-\u9fff]")
SYMBOLS = frozenset(
    "Schuler Bench CSV SVG PNG TOML JSON arcsec arcmin min nmi "
    "page state painted "
    "command sin per log linear pole2 exact "
    "Deng Liu Zhao Sun Zha fig eq theory md starboard forward RMS".split()
)
"""Product, formats, symbols, units, citations, and the labels of the page's own hidden controls."""


def as_written() -> frozenset[str]:
    """Words of a scenario file, which stay as they are: choices, names of methods and presets, units."""
    words = set(SYMBOLS)
    for name in presets():
        words |= set(re.findall(r"[A-Za-z]+", name))
        for method in load(name).method:
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


def left_out(seen: set[str]) -> list[str]:
    known = as_written()
    return sorted(
        text
        for text in seen
        if CHINESE.search(text) is None and any(word not in known for word in WORD.findall(text))
    )


def test_what_is_left_out_is_found() -> None:
    assert left_out({"Undo", "撤销", "classic2", "φE (arcsec)", "3.3 h"}) == ["Undo"]


def test_nothing_is_left_in_english(browser: Browser, dashboard: tuple[DashboardServer, Dashboard]) -> None:
    context = browser.new_context(viewport={"width": 1920, "height": 1080})
    page = context.new_page()
    bench = Bench(page, dashboard[0].url, dashboard[1].sessions).open(query="?lang=zh&fixedDpr=0.25&start=no")
    assert page.evaluate("document.documentElement.lang") == "zh-CN"
    seen = set(page.evaluate(SEEN))
    for tab in page.get_by_role("tab").all():
        tab.click()
        page.wait_for_function(
            "tab => tab.getAttribute('aria-selected') === 'true'", arg=tab.element_handle()
        )
        bench.settle()
        seen |= set(page.evaluate(SEEN))
    assert len(seen) > 400
    assert left_out(seen) == []
    assert bench.faults == []
    # A choice made in Chinese reaches the program as it is meant; then the page is English again.
    page.get_by_role("tab", name="视图", exact=True).click()
    bench.box("语言").click()
    page.get_by_role("option", name="English", exact=True).click()
    page.wait_for_selector("html[lang=en]", state="attached")
    page.wait_for_selector("#sb-run[data-run]", state="attached")
    page.get_by_role("tab", name="View", exact=True).wait_for()
    context.close()
