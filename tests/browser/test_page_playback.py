"""Play, pause, scrub, speed, loop: ship, trail, pendulum, readout and the lines of the plots in step."""

from __future__ import annotations

import json
import re
import threading
from typing import Any

import pytest

from app.views.scene.playback import SPEEDS
from app.views.scene.track import track
from tests.browser.driver import Bench

pytestmark = pytest.mark.browser

_NOW = "() => JSON.parse(document.getElementById('sb-playback').dataset.now)"
# Time in hours at which each plot over time has its line; null where there is none.
_LINES = """() => Object.values(window.__viserTestpoints.uplots).map(({chart}) => {
  const line = chart.over.querySelector('.sb-time');
  if (!line || line.style.display === 'none') return null;
  const x = new DOMMatrix(getComputedStyle(line).transform).m41;
  return chart.posToVal(x, 'x');
})"""


def now(bench: Bench) -> dict[str, Any]:
    return bench.page.evaluate(_NOW)


def wait_for(bench: Bench, condition: str, arg: Any = None) -> None:
    """Wait until the playback's state ``n`` fulfils a condition."""
    bench.page.wait_for_function(
        f"arg => (n => {condition})(JSON.parse(document.getElementById('sb-playback').dataset.now))",
        arg=arg,
    )


def command(bench: Bench, *words: object) -> None:
    bench.page.evaluate("words => window.schuler.command(...words)", [str(word) for word in words])


@pytest.fixture
def still(bench: Bench) -> Bench:
    """Ten hours under way, nothing playing, at the end."""
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Method", "Errors")
    if now(bench)["playing"]:
        command(bench, "play")
    command(bench, "loop", "off")
    command(bench, "seek", 1e9)
    wait_for(bench, "!n.playing && !n.loop && n.time === n.span")
    return bench


def test_a_scrubbed_time_is_shown_everywhere(still: Bench) -> None:
    page, run = still.page, still.session.run
    assert run is not None
    before = still.line("/track/method2")
    slider = page.get_by_role("slider", name="time in the run")
    slider.focus()
    for _ in range(3):
        slider.press("PageDown")
    wait_for(still, "n.time < 0.75 * n.span")
    page.wait_for_timeout(700)  # whoever scrubs is not disturbed by the server's word
    still.settle()
    hours = now(still)["time"] / 3600.0
    page.wait_for_function(
        f"h => ({_LINES})().every(at => at !== null && Math.abs(at - h) < 0.08)", arg=hours
    )
    assert len(page.evaluate(_LINES)) >= 6
    # the whole track stays; the trail ends where the error vector from the true ship leads
    place = track(run).place(now(still)["time"])
    trail, vector = still.line("/trail/tip2"), still.line("/error/method2")
    assert trail is not None and vector is not None
    assert vector == pytest.approx([*place.truth, *place.computed[2]], abs=1e-4)
    assert trail[-3:] == pytest.approx(vector[3:], abs=1e-4)
    assert still.line("/track/method2") == before
    # the readout is that of the run at this time
    page.get_by_role("button", name="readout", exact=True).wait_for()
    text = page.locator("#sb-stage table").inner_text()
    assert f"{hours:.3g} h" in text and "heading" in text and "complement" in text
    row = int(hours * 3600.0 / run.scenario.run.output_step_s)
    metres = float(run.methods[2].rows[row, 7])
    found = re.search(r"position\s+([\d.]+) (\w+)", text)
    assert found is not None, text
    value, unit = found.groups()
    assert float(value) * {"m": 1.0, "km": 1e3, "nmi": 1852.0}[unit] == pytest.approx(metres, rel=0.02)
    # zoomed in beside it, a plot has no line; back again it has
    key = "Object.values(window.__viserTestpoints.uplots)[0].chart"
    page.evaluate(f"() => {key}.setScale('x', {{min: 0, max: 0.5}})")
    page.wait_for_function(f"() => ({_LINES})().includes(null)")
    page.evaluate(f"() => {key}.setScale('x', {{min: 0, max: 10}})")
    page.wait_for_function(f"() => !({_LINES})().includes(null)")
    assert still.faults == []


def test_play_pause_speed_and_loop(still: Bench) -> None:
    page, number = still.page, still.run
    page.get_by_role("combobox", name="speed of the playback").select_option(str(SPEEDS[-2]))
    wait_for(still, "n.speed === arg", SPEEDS[-2])
    svg = "() => document.querySelector('#sb-stage svg').innerHTML"
    swung = page.evaluate(svg)
    page.get_by_role("button", name="play", exact=True).click()  # from the end it begins anew
    wait_for(still, "n.playing && n.time > 3600 && n.time < 0.9 * n.span")
    page.wait_for_function(f"old => ({svg})() !== old", arg=swung)
    assert "pause" == page.locator("#sb-stage [data-command=play]").get_attribute("aria-label")
    page.locator("body").press("Space")
    wait_for(still, "!n.playing")
    held = now(still)["time"]
    page.wait_for_timeout(300)
    assert now(still)["time"] == held
    # at the end: stop, or with the loop begin anew
    command(still, "seek", now(still)["span"] - 1000.0)
    page.get_by_role("button", name="begin anew at the end").click()
    wait_for(still, "n.loop")
    page.locator("body").press("Space")
    wait_for(still, "n.playing && n.time < 0.5 * n.span")
    page.get_by_role("button", name="begin anew at the end").click()
    wait_for(still, "!n.loop")
    command(still, "seek", now(still)["span"] - 1000.0)
    wait_for(still, "!n.playing && n.time === n.span")
    assert still.run == number
    assert still.faults == []


def test_a_slider_is_answered_while_it_plays(still: Bench) -> None:
    command(still, "speed", SPEEDS[0])
    command(still, "seek", 100.0)
    command(still, "play")
    wait_for(still, "n.playing && n.time > 100 && n.time < 3600")
    frames: list[str] = []
    first = now(still)
    for _ in range(3):
        still.press("network.zeta")
        frames.append(still.digest or "")
    assert len(set(frames)) == 3
    last = now(still)
    assert last["playing"] and last["time"] > first["time"]
    wait_for(still, "n.count > arg", last["count"] + 2)
    command(still, "play")
    wait_for(still, "!n.playing")
    assert still.faults == []


def test_torn_or_hostile_commands_change_nothing(still: Bench) -> None:
    before = now(still)
    for words in (("seek", "nan"), ("seek", "x" * 500), ("speed", "1e9"), ("speed", ""), ("camera-up",)):
        command(still, *words)
    command(still, "seek", "10")  # the last one counts
    wait_for(still, "n.time === 10")
    after = now(still)
    assert (after["speed"], after["playing"]) == (before["speed"], before["playing"])
    assert json.dumps(after["camera"]) == json.dumps(before["camera"])


def test_the_playback_ends_with_its_page(still: Bench, dashboard: Any) -> None:
    page = still.page.context.new_page()
    other = Bench(page, dashboard[0].url, dashboard[1].sessions).open()
    running = sum(thread.name == "playback" for thread in threading.enumerate())
    command(other, "seek", "0")
    command(other, "play")
    wait_for(other, "n.playing && n.time > 0")
    assert sum(thread.name == "playback" for thread in threading.enumerate()) == running + 1
    page.close()
    for _ in range(600):
        if sum(thread.name == "playback" for thread in threading.enumerate()) == running:
            return
        threading.Event().wait(0.1)
    raise AssertionError("the playback goes on without its page")
