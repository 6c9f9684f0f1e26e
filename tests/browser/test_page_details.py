"""Small things of the page: what is typed, printed, hovered, and where cards and handles stand."""

import re
from typing import Any

import pytest

from schuler_bench.session.session import Session
from tests.browser.conftest import Another
from tests.browser.driver import Bench
from tests.browser.placing import place


def boxes(bench: Bench, *selectors: str) -> list[Any]:
    """Where the first visible element of each selector stands, CSS px."""
    found = [bench.page.locator(f"{selector} >> visible=true").first for selector in selectors]
    return [locator.bounding_box() or {} for locator in found]


def overlap(one: dict[str, float], other: dict[str, float]) -> bool:
    return all(
        one[at] < other[at] + other[size] and other[at] < one[at] + one[size]
        for at, size in (("x", "width"), ("y", "height"))
    )


def test_a_value_that_begins_with_the_default_can_be_typed(bench: Bench, session: Session) -> None:
    bench.reset("sikuliaq-like", "Log", selected=2)
    bench.box("reference.delay_s").click()
    bench.page.keyboard.press("Control+a")
    with bench.next_run():
        bench.page.keyboard.type("0")
    bench.page.keyboard.type(".8")
    bench.wait_until(lambda: session.scenario.reference.delay_s == 0.8, 10.0)


def test_a_number_whose_unit_follows_starts_no_run(fresh: Bench, session: Session) -> None:
    durations: list[float] = []
    change = session.change

    def noted(scenario: Any, *rest: Any, **more: Any) -> Any:
        durations.append(scenario.run.duration_h)
        return change(scenario, *rest, **more)

    fresh.tab("Run")
    session.change = noted  # type: ignore[method-assign]
    try:
        box = fresh.box("run.duration_h")
        box.click()
        fresh.page.keyboard.press("Control+a")
        fresh.page.keyboard.type("540 min", delay=40)
        fresh.page.keyboard.press("Enter")
        fresh.wait_until(lambda: session.scenario.run.duration_h == 9.0)
        fresh.settle()
        assert set(durations) <= {4.0, 9.0}
        # after a pause the number alone counts, until the unit comes; Escape leaves what was there before it
        box.click()
        fresh.page.keyboard.press("Control+a")
        fresh.page.keyboard.type("12")
        fresh.wait_until(lambda: session.scenario.run.duration_h == 12.0)
        fresh.page.keyboard.type(" m")
        fresh.page.keyboard.press("Escape")
        fresh.wait_until(lambda: session.scenario.run.duration_h == 9.0)
        fresh.settle()
        assert box.input_value() == "9"
    finally:
        del session.change


def test_the_window_is_printed_on_one_sheet(fresh: Bench) -> None:
    pdf = fresh.page.pdf(prefer_css_page_size=True)
    assert re.findall(rb"/Count (\d+)", pdf) == [b"1"]
    ((width, height),) = re.findall(rb"/MediaBox ?\[0 0 ([\d.]+) ([\d.]+)\]", pdf)
    assert float(width) / float(height) == pytest.approx(1920 / 1080, rel=0.01)


def test_the_card_of_the_tour_leaves_the_sliders_free_and_goes_with_its_subject(fresh: Bench) -> None:
    fresh.page.evaluate("schuler.command('tour')")
    card = fresh.page.locator(".sb-tour")
    card.wait_for()
    card.get_by_role("button", name="Next").click()
    fresh.page.wait_for_timeout(400)
    ring, told = boxes(fresh, ".sb-ring", ".sb-tour")
    sliders = fresh.page.locator(".mantine-Slider-root >> visible=true").all()
    assert len(sliders) == 5 and ring["x"] < told["x"]
    assert not any(overlap(told, slider.bounding_box() or {}) for slider in sliders)
    fresh.tab("Sensors")
    card.wait_for(state="detached")
    controls = fresh.page.locator('[data-dock-region="left"]').bounding_box() or {}
    for step in range(6):
        fresh.page.evaluate("step => schuler.command('tour', step)", str(step))
        fresh.page.wait_for_timeout(400)
        (told,) = boxes(fresh, ".sb-tour")
        assert told["x"] >= controls["x"] + controls["width"], f"step {step} lies over the controls"


def test_the_help_of_a_control_covers_no_other_control(fresh: Bench) -> None:
    fresh.choose_and_run("network", "optimal")
    fresh.page.mouse.move(1000, 600)
    box = fresh.box("network.realisation")
    box.hover()
    fresh.page.locator(".mantine-Tooltip-tooltip").wait_for()
    fresh.page.wait_for_timeout(200)
    (told,) = boxes(fresh, ".mantine-Tooltip-tooltip")
    rows = fresh.page.locator("[data-sb-kind] label >> visible=true").all()
    column = [row.bounding_box() or {} for row in rows]
    column = [row for row in column if row["x"] < 40]
    assert len(column) > 10
    assert not any(overlap(told, row | {"width": 300.0}) for row in column)


def test_the_handle_of_the_bode_plot_stands_on_its_curve(bench: Bench) -> None:
    off = """() => {
      const rings = [...document.querySelectorAll('.sb-handle')];
      const ring = rings.find((each) => each.offsetParent && !each.hidden);
      const figure = ring.closest('.js-plotly-plot');
      const { handle } = figure._fullLayout.meta;
      const { xaxis2: across, yaxis3: up } = figure._fullLayout;
      const trace = figure._fullData.find((each) => each.yaxis === 'y3' && each.line?.color === handle.color);
      const omega = handle.pair[1] * handle.omega_s;
      const near = [...trace.x].reduce((best, x, i) => Math.abs(Math.log(x / omega)) <
        Math.abs(Math.log(trace.x[best] / omega)) ? i : best, 0);
      const box = figure.getBoundingClientRect();
      const spot = ring.getBoundingClientRect();
      return Math.abs(spot.top + spot.height / 2 - box.top - up._offset - up.d2p(trace.y[near]));
    }"""
    # of a pair at the Schuler frequency, where two points of the curve are the same
    bench.reset("sikuliaq-like", "Frequency", "Errors", "Method", selected=2)
    bench.wait_until(lambda: bench.page.evaluate(off) < 6.0, 3.0)
    place(bench, "Frequency")
    bench.page.locator(".sb-handle:visible").last.wait_for()
    bench.wait_until(lambda: bench.page.evaluate(off) < 6.0, 3.0)
    before = bench.session.scenario
    bench.page.locator(".sb-handle:visible").last.press("ArrowDown")
    bench.settle()
    assert bench.session.scenario != before
    bench.wait_until(lambda: bench.page.evaluate(off) < 6.0, 3.0)
    bench.reset("zha-fast", "Frequency", "Errors", "Method", selected=2)
    bench.wait_until(lambda: bench.page.evaluate(off) < 6.0, 3.0)


FIREFOX = (
    "anonymous@http://127.0.0.1/static/viser.js:1:2\n@http://127.0.0.1/static/viser.js:wasm-function[7]:0x1f"
)


@pytest.mark.parametrize(
    ("stack", "kept_off"),
    [("at wasm://wasm/0a:wasm-function[7]:0x1f", True), (FIREFOX, True), ("at draw (bench.js:1:2)", False)],
)
def test_the_sorters_complaint_alone_is_kept_off_the_console(
    bench: Bench, stack: str, kept_off: bool
) -> None:
    prevented = bench.page.evaluate(
        """stack => {
          const reason = Object.defineProperty(new EvalError("no eval"), "stack", { value: stack });
          const event = new Event("unhandledrejection", { cancelable: true });
          event.reason = reason;
          return !dispatchEvent(event);
        }""",
        stack,
    )
    assert prevented is kept_off


def test_a_browser_that_blocks_cookies_brings_the_tabs_of_the_address(another: Another) -> None:
    bench = another(1280, 720)
    bench.page.add_init_script(
        """const get = () => { throw new DOMException("blocked", "SecurityError"); };
        for (const store of ["sessionStorage", "localStorage"])
          Object.defineProperty(window, store, { get });"""
    )
    bench.open(query="?fixedDpr=0.25&start=no&tab=Poles,Sensors")
    for name in ("Poles", "Sensors"):
        bench.wait_for_front(name)


def test_forced_colours_leave_legends_and_slider_tracks(fresh: Bench) -> None:
    # names, of which the colour behind them is read
    shown = """() => Object.fromEntries([[".sb-tint", "::before"], [".mantine-Slider-track", "::before"],
      [".mantine-Slider-bar", null], [".mantine-Slider-thumb", null]].map(([where, part]) => [where,
        [...document.querySelectorAll(where)].filter((each) => each.getClientRects().length > 0)
          .map((each) => getComputedStyle(each, part).backgroundColor)]))"""
    page = fresh.page
    paper = """() => {
      const sample = document.body.appendChild(document.createElement("i"));
      sample.style.color = "Canvas";
      return getComputedStyle(sample).color;
    }"""
    curves = fresh.page.evaluate(shown)[".sb-tint"]
    page.emulate_media(forced_colors="active")
    try:
        held, canvas = page.evaluate(shown), page.evaluate(paper)
        assert held[".sb-tint"] == curves and len(set(curves)) >= 3
        nothing = {canvas, "rgba(0, 0, 0, 0)"}
        gone = {where: nothing.intersection(found) for where, found in held.items()}
        assert gone == dict.fromkeys(held, set()) and all(held.values())
    finally:
        page.emulate_media(forced_colors="none")


WITHOUT_WEBGL = """
const real = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return kind.includes("webgl") ? null : real.call(this, kind, ...rest);
};
"""
"""As a browser without WebGL answers."""


def test_without_webgl_the_page_comes_without_3d_and_says_so(another: Another) -> None:
    bench = another(1280, 720)
    bench.page.add_init_script(WITHOUT_WEBGL)
    bench.open()
    bench.page.get_by_text("No 3D view: this browser has no WebGL.").wait_for()
    bench.reset("zha-fast", "Errors", "Method", selected=2)
    bench.type("network.xi", "0.6")
    bench.tab("Metrics")
    assert bench.page.locator(".sb-t >> visible=true").count() > 0


def test_without_webgl_the_map_is_drawn_flat_and_follows_the_time(another: Another) -> None:
    bench = another(1366, 768)
    bench.page.add_init_script(WITHOUT_WEBGL)
    bench.open()
    bench.reset("sikuliaq-like", "Errors", "Method", selected=2)
    drawn = bench.page.locator(".sb-flat")
    ends = [f"[data-line='/track/{name}']" for name in ("truth", "method0", "method1", "method2")]
    for part in (*ends, "[data-ship='/ship']", "[data-ship='/computed']"):
        drawn.locator(part).wait_for(state="attached")
    # the picture lies within the view, above its caption, and so do all words of it
    holds = """() => {
      const box = one => one.getBoundingClientRect();
      const [map, key] = ['.sb-flat', '.sb-key'].map(name => box(document.querySelector(name)));
      const within = ({left, right, top, bottom}) =>
        left >= map.left && right <= map.right && top >= map.top - 1 && bottom <= map.bottom + 1;
      const parts = [...document.querySelectorAll('.sb-flat :is(text, path, rect)')];
      return map.bottom <= key.top && parts.every(one => within(box(one)));
    }"""
    assert bench.page.evaluate(holds)
    assert "48°10′N" in drawn.inner_text()
    ship = drawn.locator("[data-ship='/ship']")
    at_the_end = ship.get_attribute("transform")
    bench.page.get_by_label("time in the run").fill("250")
    bench.wait_until(lambda: ship.get_attribute("transform") != at_the_end)
    assert not bench.page.locator(".sb-cameras").is_visible()


def test_a_lost_context_is_told_and_the_page_goes_on(another: Another) -> None:
    bench = another(1280, 720).open()
    bench.page.evaluate(
        """() => document.querySelector("canvas[data-engine]").getContext("webgl2")
          .getExtension("WEBGL_lose_context").loseContext()"""
    )
    bench.page.get_by_text("The 3D view is lost").wait_for()
    bench.page.locator(".sb-flat [data-line='/track/truth']").wait_for(state="attached")
    bench.reset("zha-fast", "Errors", "Method", selected=2)
    bench.type("network.xi", "0.6")
    bench.faults.clear()  # the browser itself tells of the lost context
