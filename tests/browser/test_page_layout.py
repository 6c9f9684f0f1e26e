"""At three window sizes nothing is clipped, empty or unlabelled; sliders and boxes stand in one row."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest
from playwright.sync_api import TimeoutError as PlaywrightTimeout

from app.shell.layout import WIDE_FROM_PX, layout_for
from app.views import load
from app.views.poles.figure import ZOOM
from navcore.scenario.file import load as load_preset
from navcore.scenario.model import Scenario
from tests.browser.driver import Bench

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser

SIZES = [(1920, 1080), (1366, 768), (1280, 720)]

# Of every scrolling area in view: how much is cut off to the right and below.
_CUT = """() => [...document.querySelectorAll('.mantine-ScrollArea-viewport')]
  .filter(e => e.clientHeight > 0 && e.getBoundingClientRect().left > innerWidth / 3)
  .map(e => [e.scrollWidth - e.clientWidth, e.scrollHeight - e.clientHeight])"""
# Every plotly figure in view is laid out, and the browser has painted it.
_DRAWN = """async () => {
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  if (!plots.every(p => p._fullLayout && p.querySelector('.cartesianlayer'))) return false;
  for (let i = 0; i < 2; i++) await new Promise(requestAnimationFrame);
  return true;
}"""
# Plots in view, with the part of their panel's height that they fill together.
_FILLED = """() => [...document.querySelectorAll('.mantine-ScrollArea-viewport')]
  .filter(e => e.clientHeight > 0 && e.getBoundingClientRect().left > innerWidth / 3)
  .map(e => [...e.querySelectorAll('.js-plotly-plot, .uplot')].map(p => p.getBoundingClientRect()))
  .map((boxes, i, all) => boxes.length
    ? Math.max(...boxes.map(b => b.bottom)) - Math.min(...boxes.map(b => b.top)) : null)"""
_MISPRINT_DRAWN = """() => [...document.querySelectorAll('.js-plotly-plot')]
  .some(p => p.offsetParent !== null && p._fullLayout?.meta?.misprint && p.querySelector('.trace'))"""
# Texts of the plots in view that reach beyond their plot.
_TEXT_OUTSIDE = """() => {
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  const beyond = (b, f) =>
    b.left < f.left - 1 || b.right > f.right + 1 || b.bottom > f.bottom + 1 || b.top < f.top - 1;
  return plots.flatMap(plot => {
    const frame = plot.getBoundingClientRect();
    const texts = [...plot.querySelectorAll('text')].map(t => [t.textContent, t.getBoundingClientRect()]);
    return texts.filter(([_, box]) => box.width > 0 && beyond(box, frame)).map(([text]) => text);
  });
}"""

# Texts of the figure of a view that lie over each other.
_MET = """view => {
  const plot = [...document.querySelectorAll('.js-plotly-plot')].find(
    p => p.offsetParent !== null && p._fullLayout?.meta?.view === view);
  const texts = [...plot.querySelectorAll('text')].map(t => [t.textContent, t.getBoundingClientRect()])
    .filter(([text, box]) => text.trim() !== '' && box.width > 0);
  const met = (a, b) => a.left < b.right - 2 && b.left < a.right - 2
    && a.top < b.bottom - 3 && b.top < a.bottom - 3;
  return texts.flatMap(([text, box], i) =>
    texts.slice(i + 1).filter(([_, other]) => met(box, other)).map(([other]) => `${text} | ${other}`));
}"""
# Ends of the imaginary axis of the right one of the pole maps.
_ZOOMED = """() => [...document.querySelectorAll('.js-plotly-plot')]
  .find(p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Poles')._fullLayout.yaxis2.range"""
# Labels in view that the "?" covers when the pointer comes to their control, or to which none comes.
_COVERED = """() => {
  const met = (a, b) => b.width > 1 && a.left < b.right - 0.5 && b.left < a.right - 0.5
    && a.top < b.bottom - 0.5 && b.top < a.bottom - 0.5;
  const seen = l => l.offsetParent !== null && l.getBoundingClientRect().width > 2
    && !l.closest('[data-sb-kind=slider] + [data-sb-kind=number], [data-sb-kind=hidden]');
  const labels = [...document.querySelectorAll('label[for]')].filter(seen);
  const found = [];
  for (const label of labels) {
    label.dispatchEvent(new PointerEvent('pointerover', {bubbles: true}));
    const mark = document.querySelector('.sb-mark');
    const text = document.createRange();
    text.selectNodeContents(label);
    const box = mark?.getBoundingClientRect();
    if (!mark || [...text.getClientRects()].some(each => met(box, each))) found.push(label.textContent);
  }
  return [labels.length, found];
}"""
# Labels in view whose unit, in parentheses at their end, stands in two lines.
_TORN = """() => [...document.querySelectorAll('label[for]')].filter(label => {
  const text = label.firstChild;
  const from = text?.data?.lastIndexOf('(') ?? -1;
  if (label.offsetParent === null || from < 0 || !text.data.endsWith(')')) return false;
  const unit = document.createRange();
  unit.setStart(text, from);
  unit.setEnd(text, text.data.length);
  return new Set([...unit.getClientRects()].map(box => Math.round(box.top))).size > 1;
}).map(label => label.textContent)"""
# Rows in which the tabs of each panel stand.
_ROWS = """() => [...document.querySelectorAll('[role=tablist]')].map(list => {
  const boxes = [...list.querySelectorAll('[role=tab]')].map(tab => tab.getBoundingClientRect());
  const tops = boxes.map(box => Math.round(box.top));
  return new Set(tops).size;
})"""


def panels(width: int) -> int:
    """Number of panels with results in a window of this width."""
    return 2 if width >= WIDE_FROM_PX else 1


@pytest.fixture(scope="module")
def resized(opened: Bench) -> Iterator[Bench]:
    """The shared page; its window has its old size afterwards."""
    opened.reset("sikuliaq-like", selected=2)
    yield opened
    resize(opened, SIZES[0])


@pytest.fixture(params=SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def sized(request: pytest.FixtureRequest, resized: Bench) -> Bench:
    resize(resized, request.param)
    return resized


def resize(bench: Bench, size: tuple[int, int]) -> None:
    """Give the window another size and wait until the page is laid out anew."""
    width, height = size
    layout = layout_for(width, height)
    bench.page.set_viewport_size({"width": width, "height": height})
    bench.page.wait_for_function(
        """([panels, right]) => {
          const lists = [...document.querySelectorAll('[role=tablist]')].map(l => l.getBoundingClientRect());
          const beside = lists.filter(box => box.left > innerWidth / 3);
          const wide = beside.every(box => Math.abs(innerWidth - box.left - right) < 12);
          return beside.length === panels && wide;
        }""",
        arg=[panels(width), layout.right_px],
    )
    bench.heard()


def wait_until_it_fits(bench: Bench, tab: str, *, scrolls: bool = False) -> None:
    """Wait until all is drawn and no panel on the right is cut off; one that ``scrolls`` may go on below."""
    bench.page.wait_for_function(_DRAWN)
    fits = f"scrolls => ({_CUT})().every(([right, below]) => right <= 0 && (scrolls || below <= 0))"
    try:
        bench.page.wait_for_function(fits, arg=scrolls)
    except PlaywrightTimeout:
        cut = bench.page.evaluate(_CUT)
        raise AssertionError(f"{tab}: px cut off at the right and below: {cut}") from None


def test_every_tab_fits_its_panel(sized: Bench) -> None:
    for tab in (kind.title for kind in load() if kind.place in ("upper", "lower") and kind.always):
        sized.tab(tab)
        if tab == "Misprints":  # computed only now; a plot that goes while it is drawn is plotly's fault
            sized.page.wait_for_function(_MISPRINT_DRAWN)
        wait_until_it_fits(sized, tab, scrolls=tab == "Scenario")
        if tab in ("Frequency", "Poles", "Step"):
            assert sized.plotly(), tab
            assert sized.page.evaluate(_TEXT_OUTSIDE) == [], tab
        if tab == "Poles":  # and as large as it is made, also when plotly has drawn it in another size before
            assert sized.page.evaluate(_ZOOMED) == pytest.approx([-ZOOM, ZOOM])
            assert sized.page.evaluate(_MET, "Poles") == []
    assert sized.page.locator(".sb-table").first.inner_text()
    assert "schema = 1" in sized.page.locator("pre").first.inner_text()
    assert sized.faults == []


def test_plots_fill_their_panels(sized: Bench) -> None:
    size = sized.page.viewport_size
    for tab in ("Frequency", "Errors"):
        sized.tab(tab)
        sized.page.wait_for_function(_DRAWN)
    filled = [height for height in sized.page.evaluate(_FILLED) if height is not None]
    assert filled
    for height in filled:
        assert height >= 0.75 * size["height"] / panels(size["width"]) - 60


def test_all_tabs_stand_in_one_row(sized: Bench) -> None:
    try:
        sized.put(load_preset("liu-switching"), origin="liu-switching", selected=1)
        sized.page.get_by_role("tab", name="Switching", exact=True).wait_for()
        assert set(sized.page.evaluate(_ROWS)) == {1}
        sized.tab("Design")
        wait_until_it_fits(sized, "Design")
    finally:
        sized.put(load_preset("sikuliaq-like"), origin="sikuliaq-like", selected=2)


@pytest.mark.parametrize("sized", [SIZES[-1]], indirect=True)
def test_every_axis_is_labelled_with_its_unit(sized: Bench) -> None:
    for tab in ("Frequency", "Poles", "Step"):
        sized.tab(tab)
        sized.plotly()
        titles = sized.page.evaluate(
            """() => [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null)
              .flatMap(p => Object.entries(p._fullLayout).filter(([k]) => /^[xy]axis/.test(k))
              .map(([k, a]) => [k, a.title?.text ?? '', a.matches ?? '', a.showticklabels]))"""
        )
        assert titles
        for name, title, matches, ticks in titles:
            assert title or matches or not ticks, f"{tab}: {name} has no title"
    sized.tab("Errors")
    for chart in sized.curves():
        assert "(" in chart["label"]


@pytest.mark.parametrize("sized", [SIZES[-1]], indirect=True)
def test_a_slider_and_its_exact_box_stand_in_one_row(sized: Bench) -> None:
    sized.tab("Sensors")
    for label in ("imu.gyro_bias_dph.0", "imu.accel_vrw_ugpshz"):
        slider, box = sized.slider(label).bounding_box(), sized.box(label).bounding_box()
        assert abs((slider["y"] + slider["height"] / 2) - (box["y"] + box["height"] / 2)) < 16
        assert slider["x"] + slider["width"] < box["x"]
        assert box["width"] > 55
    # viser's own rounded box of a slider, and the page's report of its size, are out of sight
    assert not sized.page.locator(".mantine-Slider-root ~ .mantine-NumberInput-root").first.is_visible()
    assert not sized.page.get_by_text("page state", exact=True).is_visible()


def uncovered(bench: Bench) -> int:
    """Number of labels in view on all tabs, the same one on each; none is covered by its "?"."""
    count = 0
    for place in range(bench.page.locator("[role=tab]").count()):
        tab = bench.page.locator("[role=tab]").nth(place)
        tab.click()
        bench.heard()
        labels, covered = bench.page.evaluate(_COVERED)
        assert covered == [], tab.inner_text()
        assert bench.page.evaluate(_TORN) == [], tab.inner_text()
        count += labels
    return count


def test_no_question_mark_covers_a_label(sized: Bench) -> None:
    assert uncovered(sized) > 100
    assert sized.faults == []


def test_no_question_mark_covers_a_label_in_chinese(browser: Browser, resized: Bench) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 720})
    try:
        bench = Bench(context.new_page(), resized.url, resized.sessions)
        bench.open(query="?fixedDpr=0.25&start=no&lang=zh")
        bench.heard()
        assert uncovered(bench) > 100
        assert bench.faults == []
    finally:
        context.close()


@pytest.mark.parametrize("size", [(1600, 900), (1280, 720)], ids=str)
def test_the_budgets_of_eight_methods_do_not_overlap(resized: Bench, size: tuple[int, int]) -> None:
    data = load_preset("sikuliaq-like").canonical()
    data["run"] |= {"duration_h": 2.0}
    data["method"] = [data["method"][i % 3] | {"name": f"method {i}"} for i in range(8)]
    resize(resized, size)
    resized.put(Scenario.parse(data), origin="eight methods")
    resized.tab("Design")
    panels = """n => [...document.querySelectorAll('.js-plotly-plot')].some(p => p.offsetParent !== null
      && p._fullLayout?.meta?.view === 'Design' && p._fullLayout[`xaxis${n}`])"""
    try:
        for budget, last in (("steady", 2), ("run", 4)):
            resized.show(budget=budget)
            resized.page.wait_for_function(panels, arg=last)
            resized.page.wait_for_function(_DRAWN)
            assert resized.page.evaluate(_MET, "Design") == []
            assert resized.page.evaluate(_TEXT_OUTSIDE) == []
        assert resized.faults == []
    finally:
        resized.show(budget="steady")
        resized.put(load_preset("sikuliaq-like"), origin="sikuliaq-like", selected=2)
