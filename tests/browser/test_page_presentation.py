"""Presentation size: type for the back row, the controls of the lesson or of the method, nothing cut off."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.browser.driver import Bench
from tests.browser.fields import label_of
from tests.browser.test_page_layout import _TEXT_OUTSIDE, resize, wait_until_it_fits

pytestmark = pytest.mark.browser

SIZES = [(1920, 1080), (1366, 768), (1280, 720)]
ROWS = 48.0
"""Lines of the smallest type in a window's height."""

# Sizes of the type in the panels (px of the window) with its text, the smallest first.
_TYPE = """() => {
  const seen = e => e.offsetParent !== null || e instanceof SVGElement;
  const written = e => [...e.childNodes].some(n => n.nodeType === 3 && n.textContent.trim() !== '');
  const here = ({width, height, top, bottom}) => width > 1 && height > 1 && bottom > 0 && top < innerHeight;
  const small = ['SUB', 'SUP', 'tspan', 'OPTION', 'STYLE'];
  const html = [...document.querySelectorAll('[data-dock-column] *')]
    .filter(e => seen(e) && written(e) && !small.includes(e.tagName) && !e.closest('math, [hidden]'))
    .filter(e => here(e.getBoundingClientRect()))
    .map(e => [parseFloat(getComputedStyle(e).fontSize) * e.currentCSSZoom, e.textContent.slice(0, 40)]);
  const charts = Object.values(window.__viserTestpoints?.uplots ?? {}).map(entry => entry.chart);
  const drawn = charts.filter(c => c.root.offsetParent !== null && c.axes[0].label)
    .map(c => [parseFloat(c.axes[0].font[0]) / devicePixelRatio, 'axis of a time plot']);
  return [...html, ...drawn].sort((a, b) => a[0] - b[0]);
}"""
_SHOWN_LABELS = """() => [...document.querySelectorAll('[data-dock-region=left] label')]
  .filter(l => l.offsetParent !== null).map(l => schuler.english(l.textContent))"""


@pytest.fixture
def large(bench: Bench) -> Iterator[Bench]:
    """The shared page with the first preset and no lesson open; afterwards in its normal size and window."""
    bench.reset("sikuliaq-like", selected=2)
    bench.page.evaluate("() => schuler.command('lesson', 'list')")
    bench.settle()
    yield bench
    bench.show(size="normal")
    resize(bench, (1920, 1080))


@pytest.mark.parametrize("size", SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def test_type_is_large_and_nothing_is_cut(large: Bench, size: tuple[int, int]) -> None:
    resize(large, size)
    large.show(size="presentation")
    large.heard()
    for tab in ("Frequency", "Poles", "Step", "Errors", "Metrics"):
        large.tab(tab)
        wait_until_it_fits(large, tab, scrolls=tab == "Metrics")
        if tab in ("Frequency", "Poles", "Step"):
            assert large.plotly(), tab
            assert large.page.evaluate(_TEXT_OUTSIDE) == [], tab
        smallest, text = large.page.evaluate(_TYPE)[0]
        assert smallest >= size[1] / ROWS, (tab, text)
    assert large.faults == []


def test_the_controls_are_those_of_the_method_and_then_of_the_lesson(large: Bench) -> None:
    page = large.page
    large.tab("Run")
    page.keyboard.press("Escape")
    page.locator("body").press("l")
    page.wait_for_selector("#sb-size", state="attached")
    large.heard()
    page.wait_for_function(f"() => ({_SHOWN_LABELS})().includes('network')")
    labels = page.evaluate(_SHOWN_LABELS)
    assert not {"scenario", "methods", "as text", label_of("run.duration_h"), "enlarge errors in 3D"} & set(
        labels
    )
    assert page.locator("[data-dock-region=left] [role=tablist]").is_hidden()
    assert page.locator("[data-command=undo]").is_hidden()
    page.evaluate("() => schuler.command('lesson', 'open 1')")
    page.locator(".sb-lesson h3").first.wait_for()
    assert "network" not in page.evaluate(_SHOWN_LABELS)
    page.get_by_role("button", name="Normal size").click()
    page.wait_for_selector("#sb-size", state="detached")
    assert page.locator("[data-dock-region=left] [role=tablist]").is_visible()
    assert large.session.display.size == "normal"
    assert large.faults == []
