"""The 3D view: cameras, the computed ship, instruments; played, scrubbed, and the plots in step with it."""

import re
from typing import Any

import pytest

from schuler_bench.plots import style
from schuler_bench.shell.layout import layout_for
from schuler_bench.views.scene.playback import SPEEDS
from schuler_bench.views.scene.track import track
from tests.browser.conftest import Another
from tests.browser.driver import SIZES, Bench


def overlap(a: Any, b: Any) -> bool:
    """Whether two boxes lie over each other."""
    return a[0] < b[2] - 1 and b[0] < a[2] - 1 and a[1] < b[3] - 1 and b[1] < a[3] - 1


def now(bench: Bench) -> dict[str, Any]:
    return bench.page.evaluate("look.now")


def wait_for(bench: Bench, condition: str, arg: Any = None) -> None:
    """Wait until the playback's state ``n`` fulfils a condition."""
    bench.page.wait_for_function(
        f"arg => (n => {condition})(JSON.parse(document.getElementById('sb-playback').dataset.now))",
        arg=arg,
    )


def command(bench: Bench, *words: object) -> None:
    bench.page.evaluate("words => window.schuler.command(...words)", [str(word) for word in words])


@pytest.fixture
def still(moving: Bench) -> Bench:
    """Ten hours under way, nothing playing, at the end, seen as a map."""
    if now(moving)["playing"]:
        command(moving, "play")
    for words in (("loop", "off"), ("seek", 1e9), ("camera-map",)):
        command(moving, *words)
    wait_for(moving, "!n.playing && !n.loop && n.time === n.span && n.camera === 'map'")
    return moving


def seek(bench: Bench, time_s: float) -> None:
    """Show the ship at a time."""
    command(bench, "seek", time_s)
    wait_for(bench, "n.time === arg", time_s)


def picture(bench: Bench) -> bytes:
    """The middle of the 3D view as the screen shows it."""
    left, top, right, bottom = bench.page.evaluate("look.view")
    clip: Any = {"x": (left + right) / 2 - 150, "y": (top + bottom) / 2 - 150, "width": 300, "height": 300}
    return bench.page.screenshot(clip=clip)


def test_cameras_look_from_elsewhere(still: Bench) -> None:
    seen = [picture(still)]
    # twice "follow": the camera goes with the ship
    for camera, time_s in (("top", 6000), ("side", 6000), ("follow", 6000), ("follow", 12000)):
        command(still, f"camera-{camera}")
        seek(still, time_s)
        wait_for(still, "n.camera === arg", camera)
        seen.append(still.wait_for_change(lambda: picture(still), *seen))
    still.button("view: map").click()
    wait_for(still, "n.camera === 'map'")


def test_the_computed_ship_is_that_of_the_selected_method(moving: Bench) -> None:
    page, number = moving.page, moving.run
    assert tuple(page.evaluate("look.color")) == style.rgb(
        style.method_color(style.STANDING["complementary"])
    )
    moving.edit("classic2")
    wanted = ",".join(map(str, style.rgb(style.method_color(style.STANDING["classic2"]))))
    page.wait_for_function("c => String(look.color()) === c", arg=wanted)
    page.locator("#sb-stage table").get_by_text("classic2").wait_for()
    assert moving.run == number


@pytest.mark.slow
def test_the_last_frame_shows_the_last_change(still: Bench) -> None:
    page = still.page
    seek(still, 20000)
    page.evaluate("look.countFrames")
    before = picture(still)
    changes = (
        lambda: still.press("network.zeta", "End"),
        lambda: still.show(exaggeration=3000.0),
        lambda: seek(still, 9000),
        lambda: still.select(1),
        lambda: command(still, "camera-top"),
    )
    for number, change in enumerate(changes):
        change()
        still.settle()
        shown = still.wait_for_change(lambda: picture(still))
        assert shown != before, number
        frames = page.evaluate("look.frames")
        page.wait_for_timeout(1500)
        assert page.evaluate("look.frames") - frames <= 2, "at rest it is drawn once in ten seconds"
        page.evaluate("look.drawAgain")
        assert page.evaluate("look.frames") > frames
        assert picture(still) == shown, (number, "nothing was left to be drawn")
        before = shown
    command(still, "camera-map")


def test_a_pendulum_for_each_method(moving: Bench) -> None:
    page, pendulum = moving.page, moving.page.locator("#sb-stage .sb-pendulum")
    page.wait_for_function("() => document.querySelectorAll('#sb-stage .sb-bob').length === 3")
    caption = pendulum.locator("p").inner_text()
    assert "tilt x " in caption and "84.4 min" in caption
    for state in ("hidden", "visible"):
        moving.button("pendulum").click()
        pendulum.wait_for(state=state)


def test_a_narrow_readout_lies_clear_of_the_buttons(bench: Bench) -> None:
    bench.reset("zha-fast")
    layout = layout_for(*SIZES[0])
    place = [layout.left_px, SIZES[0][0] - layout.left_px - layout.right_px]
    boxes = bench.page.wait_for_function("look.placed", arg=place).json_value()[1]
    assert boxes[".sb-readout"][2] > boxes[".sb-readout"][0]
    assert not overlap(boxes[".sb-readout"], boxes[".sb-shown"])
    assert not overlap(boxes[".sb-pendulum"], boxes[".sb-shown"])


def test_errors_are_enlarged_in_3d(still: Bench) -> None:
    at_end, number, page = still.line("/error/method0"), still.run, still.page
    page.get_by_role("slider", name="time in the run").press("Home")
    page.wait_for_function("end => String(look.line('/error/method0')) !== String(end)", arg=at_end)
    before = still.line("/track/method0")
    still.tab("View")
    still.choose("enlarge errors in 3D", "50")
    page.locator("#sb-stage .sb-key [data-is=caption]", has_text="x 50").wait_for()
    page.wait_for_function("old => String(look.line('/track/method0')) !== String(old)", arg=before)
    assert still.run == number


def test_a_scrubbed_time_is_shown_everywhere(still: Bench) -> None:
    page, run = still.page, still.session.run
    before = still.line("/track/method2")
    slider = page.get_by_role("slider", name="time in the run")
    slider.focus()
    for _ in range(3):
        slider.press("PageDown")
    wait_for(still, "n.time < 0.75 * n.span")
    page.wait_for_timeout(700)  # whoever scrubs is not disturbed by the server's word
    still.settle()
    hours = now(still)["time"] / 3600.0
    page.wait_for_function("h => look.lines().every(at => at !== null && Math.abs(at - h) < 0.08)", arg=hours)
    assert len(page.evaluate("look.lines")) == 4
    # the whole track stays; the trail ends where the error vector from the true ship leads
    place = track(run).place(now(still)["time"])
    trail, vector = still.line("/trail/tip2"), still.line("/error/method2")
    assert vector == pytest.approx([*place.truth, *place.computed[2]], abs=1e-4)
    assert trail[-3:] == pytest.approx(vector[3:], abs=1e-4)
    assert still.line("/track/method2") == before
    # the readout is that of the run at this time
    still.button("readout").wait_for()
    text = page.locator("#sb-stage table").inner_text()
    assert f"{hours:.3g} h" in text and "heading" in text and "complement" in text
    metres = float(run.methods[2].rows[int(hours * 3600.0 / run.scenario.run.output_step_s), 7])
    value, unit = re.search(r"position\s+([\d.]+) (\w+)", text).groups()
    assert float(value) * {"m": 1.0, "km": 1e3, "nmi": 1852.0}[unit] == pytest.approx(metres, rel=0.02)
    # zoomed in beside it, a plot has no line; back again it has
    for end, without in ((0.5, ""), (10, "!")):
        page.evaluate(
            "max => Object.values(window.__viserTestpoints.uplots)[0].chart.setScale('x', {min: 0, max})", end
        )
        page.wait_for_function(f"() => {without}look.lines().includes(null)")


def test_play_pause_speed_and_loop(still: Bench) -> None:
    page, number, loop = still.page, still.run, still.button("begin anew at the end")
    page.get_by_role("combobox", name="speed of the playback").select_option(str(SPEEDS[-2]))
    wait_for(still, "n.speed === arg", SPEEDS[-2])
    svg = "() => document.querySelector('#sb-stage svg').innerHTML"
    swung = page.evaluate(svg)
    still.button("play").click()  # from the end it begins anew
    wait_for(still, "n.playing && n.time > 3600 && n.time < 0.9 * n.span")
    page.wait_for_function(f"old => ({svg})() !== old", arg=swung)
    assert page.locator("#sb-stage [data-command=play]").get_attribute("aria-label") == "pause"
    page.locator("body").press("Space")
    wait_for(still, "!n.playing")
    held = now(still)["time"]
    page.wait_for_timeout(300)
    assert now(still)["time"] == held
    # at the end: stop, or with the loop begin anew
    command(still, "seek", now(still)["span"] - 1000.0)
    loop.click()
    wait_for(still, "n.loop")
    page.locator("body").press("Space")
    wait_for(still, "n.playing && n.time < 0.5 * n.span")
    loop.click()
    wait_for(still, "!n.loop")
    command(still, "seek", now(still)["span"] - 1000.0)
    wait_for(still, "!n.playing && n.time === n.span")
    assert still.run == number


def test_a_slider_is_answered_while_it_plays(still: Bench) -> None:
    for words in (("speed", SPEEDS[0]), ("seek", 100.0), ("play",)):
        command(still, *words)
    wait_for(still, "n.playing && n.time > 100 && n.time < 3600")
    first, digests = now(still), {still.digest}
    for _ in range(3):
        still.press("network.zeta")
        digests.add(still.digest)
    last = now(still)
    assert len(digests) == 4
    assert last["playing"] and last["time"] > first["time"]
    wait_for(still, "n.count > arg", last["count"] + 2)
    command(still, "play")
    wait_for(still, "!n.playing")


def test_the_3d_view_is_small_until_the_page_is_there(another: Another) -> None:
    """Without a GPU each picture of a whole window took a tenth of a second while the page opened."""
    bench = another(1366, 768)
    bench.page.add_init_script("""
      window.widths = [];
      (function watch() {
        const view = document.querySelector("canvas[data-engine]");
        if (view && document.getElementById("sb-veil")) window.widths.push(view.clientWidth);
        requestAnimationFrame(watch);
      })();""")
    bench.open()
    widths = bench.page.evaluate("() => window.widths")
    assert widths and max(widths) <= 16
    assert bench.page.locator("canvas[data-engine]").bounding_box()["width"] > 200
