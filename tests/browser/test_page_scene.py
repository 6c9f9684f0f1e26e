"""The 3D view: cameras, the computed ship of the method in hand, instruments clear of the bar."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from app.shell.layout import layout_for
from tests.browser.driver import Bench
from tests.browser.test_page_layout import SIZES, resize
from tests.browser.test_page_playback import command, now, wait_for

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from app.http.server import DashboardServer
    from app.serve import Dashboard

pytestmark = pytest.mark.browser

_COLOR = "() => window.__viserSceneTree.getState()['/computed/hull'].message.props.color"
# Counts the frames of the 3D view from now on: each begins by clearing its picture.
_COUNT = """() => {
  const { clear } = WebGL2RenderingContext.prototype;
  window.framesOf3D = 0;
  WebGL2RenderingContext.prototype.clear = function (...what) {
    window.framesOf3D += 1;
    return clear.apply(this, what);
  };
}"""
_FRAMES = "() => window.framesOf3D"
_DRAW_AGAIN = """() => new Promise(done => {
  window.__viserMutable.requestRender();
  requestAnimationFrame(() => requestAnimationFrame(done));
})"""
_VIEW = """() => {
  const box = document.querySelector('canvas[data-engine]').getBoundingClientRect();
  return [box.left, box.top, box.right, box.bottom];
}"""
# The view and what stands over it, read in one moment; false until both stand where the layout puts them.
_PLACED = """([left, width]) => {
  const view = document.querySelector('canvas[data-engine]').getBoundingClientRect();
  const stage = document.querySelector('#sb-stage').getBoundingClientRect();
  const there = Math.abs(view.left - left) < 12 && Math.abs(view.width - width) < 24
    && Math.abs(view.left - stage.left) < 2 && Math.abs(view.top - stage.top) < 2
    && Math.abs(view.width - stage.width) < 2 && Math.abs(view.height - stage.height) < 2;
  const sides = box => [box.left, box.top, box.right, box.bottom];
  const parts = ['.sb-pendulum', '.sb-readout', '.sb-bar', '.sb-shown'].map(
    name => [name, sides(document.querySelector(`#sb-stage ${name}`).getBoundingClientRect())]);
  return there && [sides(view), Object.fromEntries(parts)];
}"""


@pytest.fixture
def moving(bench: Bench) -> Bench:
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Method", "Errors")
    return bench


def test_cameras_look_from_elsewhere(moving: Bench) -> None:
    page = moving.page
    left, top, right, bottom = page.evaluate(_VIEW)
    middle = {"x": (left + right) / 2 - 150, "y": (top + bottom) / 2 - 150, "width": 300, "height": 300}
    seen = [page.screenshot(clip=middle)]  # pyright: ignore[reportArgumentType]

    def look(camera: str, time_s: float) -> None:
        command(moving, f"camera-{camera}")
        command(moving, "seek", time_s)
        wait_for(moving, "n.camera === arg[0] && n.time === arg[1]", [camera, time_s])
        seen.append(moving.wait_for_change(lambda: page.screenshot(clip=middle), *seen))  # pyright: ignore[reportArgumentType]

    look("top", 6000)
    look("side", 6000)
    look("follow", 6000)
    look("follow", 12000)  # the camera goes with the ship
    assert len(set(seen)) == 5
    page.get_by_role("button", name="view: map").click()
    wait_for(moving, "n.camera === 'map'")
    command(moving, "seek", 1e9)


def test_the_computed_ship_is_that_of_the_method_in_hand(moving: Bench) -> None:
    from app.plots import style

    page, number = moving.page, moving.run
    assert tuple(page.evaluate(_COLOR)) == style.rgb(style.method_color(2))
    moving.choose("method", "classic2")
    page.wait_for_function(
        f"c => String(({_COLOR})()) === c", arg=",".join(map(str, style.rgb(style.method_color(1))))
    )
    page.locator("#sb-stage table").get_by_text("classic2").wait_for()
    assert moving.run == number


def test_the_last_frame_shows_the_last_change(moving: Bench) -> None:
    page = moving.page
    left, top, right, bottom = page.evaluate(_VIEW)
    view: Any = {"x": left, "y": top, "width": right - left, "height": bottom - top}

    def seek(time_s: float) -> None:
        command(moving, "seek", time_s)
        wait_for(moving, "n.time === arg", time_s)

    seek(20000)
    page.evaluate(_COUNT)
    before = page.screenshot(clip=view)
    changes = (
        lambda: moving.press("network.zeta", "End"),
        lambda: moving.show(exaggeration=3000.0),
        lambda: seek(9000),
        lambda: moving.select(1),
        lambda: command(moving, "camera-top"),
    )
    try:
        for number, change in enumerate(changes):
            change()
            moving.settle()
            shown = moving.wait_for_change(lambda: page.screenshot(clip=view))
            assert shown != before, number
            frames = page.evaluate(_FRAMES)
            page.wait_for_timeout(1500)
            assert page.evaluate(_FRAMES) - frames <= 2, "at rest it is drawn once in ten seconds"
            page.evaluate(_DRAW_AGAIN)
            assert page.evaluate(_FRAMES) > frames
            assert page.screenshot(clip=view) == shown, (number, "nothing was left to be drawn")
            before = shown
    finally:
        command(moving, "camera-map")
        command(moving, "seek", 1e9)
        moving.show(exaggeration=None)
    assert moving.faults == []


def test_a_pendulum_for_each_method(moving: Bench) -> None:
    page = moving.page
    page.wait_for_function("() => document.querySelectorAll('#sb-stage .sb-bob').length === 3")
    caption = page.locator("#sb-stage .sb-pendulum p").inner_text()
    assert "tilt x " in caption and "84.4 min" in caption
    page.get_by_role("button", name="pendulum", exact=True).click()
    page.locator("#sb-stage .sb-pendulum").wait_for(state="hidden")
    page.get_by_role("button", name="pendulum", exact=True).click()
    page.locator("#sb-stage .sb-pendulum").wait_for()


def overlap(a: Any, b: Any) -> bool:
    return a[0] < b[2] - 1 and b[0] < a[2] - 1 and a[1] < b[3] - 1 and b[1] < a[3] - 1


def test_a_narrow_readout_lies_clear_of_the_buttons(moving: Bench) -> None:
    moving.reset("zha-fast", selected=0)
    for hidden in moving.page.locator("#sb-stage [data-shows][aria-pressed=false]").all():
        hidden.click()
    layout = layout_for(*SIZES[0])
    place = [layout.left_px, SIZES[0][0] - layout.left_px - layout.right_px]
    boxes = moving.page.wait_for_function(_PLACED, arg=place).json_value()[1]
    assert boxes[".sb-readout"][2] > boxes[".sb-readout"][0]
    assert not overlap(boxes[".sb-readout"], boxes[".sb-shown"])
    assert not overlap(boxes[".sb-pendulum"], boxes[".sb-shown"])


def test_instruments_and_bar_fit_the_view(moving: Bench) -> None:
    try:
        for size in SIZES:
            resize(moving, size)
            layout = layout_for(*size)
            place = [layout.left_px, size[0] - layout.left_px - layout.right_px]
            view, boxes = moving.page.wait_for_function(_PLACED, arg=place).json_value()
            names = [name for name, box in boxes.items() if box[2] > box[0]]
            assert ".sb-bar" in names and ".sb-pendulum" in names
            for name in names:
                box = boxes[name]
                assert box[0] >= view[0] - 1 and box[2] <= view[2] + 1, (size, name, box, view)
                assert box[1] >= view[1] - 1 and box[3] <= view[3] + 1, (size, name, box, view)
            pairs = [(a, b) for i, a in enumerate(names) for b in names[i + 1 :]]
            assert not [pair for pair in pairs if overlap(boxes[pair[0]], boxes[pair[1]])], size
            assert boxes[".sb-bar"][3] - boxes[".sb-bar"][1] < 110, size
            both = moving.page.locator("#sb-stage [data-shows][aria-pressed=true]").count()
            assert both == (2 if size == SIZES[0] else 1), "a small view has room for one instrument"
    finally:
        resize(moving, SIZES[0])
    assert now(moving)["span"] > 0.0
    assert moving.faults == []


def test_the_key_below_the_map_hides_a_track(moving: Bench) -> None:
    page = moving.page
    entries = page.locator("#sb-stage .sb-entry")
    names = [method.name for method in moving.session.scenario.method]
    page.wait_for_function(f"() => document.querySelectorAll('#sb-stage .sb-entry').length === {len(names)}")
    assert [text.split("\n")[0] for text in entries.all_inner_texts()] == names
    assert moving.line("/track/method0")
    try:
        for state in ("unscaled", "dimmed", "hidden"):
            entries.first.click()
            page.wait_for_selector(f"#sb-stage .sb-entry[data-state={state}]")
        moving.catch_up()
        assert moving.line("/track/method0") is None and moving.line("/track/method1")
    finally:
        moving.show(legend=())
    assert moving.line("/track/method0")
    assert moving.faults == []


@pytest.mark.parametrize(("language", "said"), [("en", "3D drawn in software"), ("zh", "三维以软件绘制")])
def test_software_rendering_is_told_below_the_map(
    browser: Browser, dashboard: tuple[DashboardServer, Dashboard], language: str, said: str
) -> None:
    context = browser.new_context(viewport={"width": 1280, "height": 720})
    page = context.new_page()
    page.goto(f"{dashboard[0].url}?lang={language}&start=no")
    page.wait_for_selector("#sb-run[data-run]", state="attached")
    page.wait_for_function(
        "said => document.querySelector('#sb-stage [data-is=caption]').textContent.includes(said)", arg=said
    )
    page.wait_for_function(
        "() => [...document.querySelectorAll('.mantine-Notification-root')].every(n => !n.checkVisibility())"
    )
    context.close()
