"""Pins: laid over every view, subtracted in the table, flipped to, gone back to, limited."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest

from app.editing import edits
from app.session.pins import MOST_PINS
from app.session.requirements import Requirements
from tests.browser.driver import Bench
from tests.browser.test_page_layout import SIZES, resize, wait_until_it_fits

if TYPE_CHECKING:
    from playwright.sync_api import Locator

pytestmark = pytest.mark.browser

ZETA = ("method", 2, "network", "zeta")
_UPLOT_NAMES = """() => Object.values(window.__viserTestpoints?.uplots ?? {})
  .map(entry => entry.chart.series.slice(1).map(s => s.label))"""
_BANNER = "() => getComputedStyle(document.body, '::after').content"


@pytest.fixture
def pinned(bench: Bench) -> Iterator[Bench]:
    """The shared page with one pin of zeta 0.5 and the present run with another zeta."""
    bench.reset("liu-networks", selected=2)
    bench.tab("Frequency", "Errors", "Method")
    session = bench.session
    bench.page.keyboard.press("Escape")
    bench.page.locator("#sb-status").click()
    bench.page.keyboard.press("p")
    bench.page.wait_for_function(
        f"() => ({_UPLOT_NAMES})().some(names => names.includes('pin 1: complementary'))"
    )
    before = edits.value_at(session.scenario, ZETA)
    for _ in range(4):
        bench.press("network.zeta")
    bench.settle()
    assert bench.session.pins.all[0].method == "complementary"
    # it is called by what differs
    bench.page.wait_for_function(
        f"label => ({_UPLOT_NAMES})().some(names => names.includes(label))",
        arg=f"ζ {before:g}: complementary",
    )
    yield bench
    for pin in session.pins.all:
        session.pins.remove(pin.id)
    session.pins._next = 1
    bench.show(flipped=False, baseline=None, delta="rms")


def text_box(bench: Bench, label: str) -> Locator:
    """A text box: viser gives it no id."""
    row = "xpath=ancestor::*[contains(@class, 'mantine-Flex-root')][1]//input"
    return bench.page.locator(f'label:text-is("{label}")').locator(row)


def names(bench: Bench) -> list[list[str]]:
    return bench.page.evaluate(_UPLOT_NAMES)


def test_a_pin_lies_over_every_view(pinned: Bench) -> None:
    session = pinned.session
    (pin,) = session.pins.all
    assert pin.run is not None and session.run is not None
    assert edits.value_at(pin.scenario, ZETA) != edits.value_at(session.scenario, ZETA)
    # only the method that was edited is laid over: the others are as they were
    label = f"ζ {edits.value_at(pin.scenario, ZETA):g}: complementary"
    count = len(pin.run.methods)
    for plot in names(pinned):
        assert plot[count:] == [label]
    curves = {chart["label"]: chart["data"] for chart in pinned.curves()}
    axis, data = next((axis, data) for axis, data in curves.items() if axis.startswith("δVE"))
    assert len(data) == 1 + count + 1
    assert data[3] != pytest.approx(data[4], rel=1e-3), axis
    line = pinned.line("/track/pinned0")
    assert line and line != pytest.approx(pinned.line("/track/method2"), abs=1e-3), "on the map too"
    assert pinned.line("/track/pinned1") is None
    for tab in ("Frequency", "Poles", "Step", "Spectrum"):
        pinned.tab(tab)
        assert label in {trace["name"] for trace in pinned.plotly()}, tab
    pinned.tab("Frequency", "Errors")
    assert pinned.faults == []


def test_the_table_says_what_has_changed(pinned: Bench) -> None:
    session = pinned.session
    pinned.tab("Metrics")
    cells = pinned.page.locator(".sb-delta")
    cells.first.wait_for()
    (pin,) = session.pins.all
    assert pin.run is not None and session.run is not None
    new, old = (run.methods[2].errors["phi_e_rad"]["rms"] for run in (session.run, pin.run))
    percent = f"({100.0 * (new / old - 1.0):+.1f} %)"
    row = pinned.page.locator(".sb-table tr", has_text="tilt φE")
    assert any(percent in text for text in row.locator(".sb-delta").all_inner_texts())
    pinned.tab("Compare")
    pinned.choose("Δ of", "final")
    pinned.tab("Metrics")
    pinned.page.get_by_text("Δ final").first.wait_for()


def test_b_flips_between_the_present_run_and_the_pin(pinned: Bench) -> None:
    pinned.tab("Frequency", "Errors")
    page, session = pinned.page, pinned.session
    before = pinned.curves()
    page.locator("#sb-status").click()
    page.keyboard.press("b")
    page.wait_for_selector("#sb-flip", state="attached")
    assert "ζ" in page.evaluate(_BANNER)
    page.wait_for_function(f"() => !({_UPLOT_NAMES})().some(names => names.some(n => n.startsWith('ζ')))")
    (pin,) = session.pins.all
    assert pin.run is not None
    peak = pin.run.methods[2].errors["position_m"]["max_abs"]
    data = next(chart["data"] for chart in pinned.curves() if chart["label"].startswith("position"))
    ratio = max(value for value in data[3] if value is not None) / peak
    assert min(abs(ratio - 1.0), abs(ratio * 1000.0 - 1.0), abs(ratio * 1852.0 - 1.0)) < 1e-6
    outlined = "() => getComputedStyle(document.querySelector('.uplot')).outlineStyle"
    assert page.evaluate(outlined) == "solid"
    page.keyboard.press("b")
    page.wait_for_selector("#sb-flip", state="detached")
    page.wait_for_function(f"() => ({_UPLOT_NAMES})().some(names => names.some(n => n.startsWith('ζ')))")
    assert page.evaluate(_BANNER) in ("none", "normal")
    assert pinned.curves() == before


def test_a_pin_is_renamed_hidden_gone_back_to_and_removed(pinned: Bench) -> None:
    page, session = pinned.page, pinned.session
    pinned.tab("Compare")
    text_box(pinned, "pin name").fill('<b>"old"</b>')
    text_box(pinned, "pin note").fill("as delivered")
    page.wait_for_function("() => document.querySelector('.sb-pins')?.innerText.includes('as delivered')")
    assert '<b>"old"</b>' in page.locator(".sb-pins").inner_text()
    pinned.tab("Errors")
    page.wait_for_function(f"() => ({_UPLOT_NAMES})().some(names => names.some(n => n.includes('\"old\"')))")
    pinned.tab("Compare")
    pinned.box("pin shown").click()
    page.wait_for_function("() => document.querySelector('.sb-pins')?.innerText.includes('hidden')")
    assert session.pins.shown == ()
    (pin,) = session.pins.all
    number = pinned.run
    page.get_by_role("button", name="Go back to this pin").click()
    pinned.wait_for_run(number)
    pinned.settle()
    assert session.scenario == pin.scenario
    page.get_by_role("button", name="Remove this pin").click()
    page.get_by_text("Nothing is pinned yet").wait_for()
    assert len(session.pins) == 0 and pinned.faults == []


def test_the_pins_are_sorted_and_judged(pinned: Bench) -> None:
    page, session = pinned.page, pinned.session
    pinned.show(requirements=Requirements(settling_min=1.0))
    pinned.tab("Compare")
    runs = "() => [...document.querySelectorAll('.sb-pins tbody tr b')].map(b => b.textContent)"
    page.wait_for_function(f"() => ({runs})().length === 2")
    (pin,) = session.pins.all
    assert pin.run is not None and session.run is not None
    names = {"present run": session.run, next(n for n in page.evaluate(runs) if n != "present run"): pin.run}
    settles = {name: run.methods[2].loop.settling_s for name, run in names.items()}
    for turned in (False, True):
        page.get_by_role("button", name="settles to 2 %").click()
        wanted = sorted(settles, key=lambda name: settles[name] or 0.0, reverse=turned)
        page.wait_for_function(f"wanted => String(({runs})()) === String(wanted)", arg=wanted)
    assert page.locator(".sb-pins").get_by_text("✗ misses 1 of 1").count() == 2
    pinned.tab("Requirements")
    page.locator(".sb-verdicts th", has_text="ζ").wait_for()
    pinned.show(requirements=Requirements(), pins_by="pinned")


def test_more_pins_than_the_most_are_refused_in_words(pinned: Bench) -> None:
    session = pinned.session
    pinned.tab("Compare")
    while len(session.pins) < MOST_PINS:
        assert session.run is not None
        session.pins.add(session.run, "liu-networks")
    pinned.page.get_by_role("button", name="Pin this run").click()
    assert "Remove one" in pinned.notice("Not pinned")
    assert len(session.pins) == MOST_PINS
    pinned.close_notices()


@pytest.mark.parametrize("size", SIZES[1:], ids=lambda size: f"{size[0]}x{size[1]}")
def test_two_pins_fit_in_small_windows(pinned: Bench, size: tuple[int, int]) -> None:
    session = pinned.session
    assert session.run is not None
    session.pins.add(session.run, "liu-networks", "a second one")
    try:
        resize(pinned, size)
        for tab in ("Compare", "Errors", "Spectrum"):
            pinned.tab(tab)
            wait_until_it_fits(pinned, tab, scrolls=tab == "Compare")
    finally:
        resize(pinned, SIZES[0])


def test_two_hundred_slider_steps_in_twenty_seconds_end_in_agreement(pinned: Bench) -> None:
    page, session = pinned.page, pinned.session
    pinned.tab("Errors", "Method")
    # Pressed in the page, at even times; those that fell due while the page was drawing come one after the
    # other, as a browser hands over what its user did meanwhile.
    moved = """async ([id, count, every]) => {
      const thumb = document.querySelector(`[id='${id}'] [role=slider]`);
      const pause = (ms) => new Promise(resolve => setTimeout(resolve, ms));
      const start = performance.now();
      for (let step = 0; step < count; step++) {
        await pause(Math.max(0, start + every * step - performance.now()));
        const key = step < count / 2 ? 'ArrowRight' : (step % 3 ? 'ArrowLeft' : 'ArrowRight');
        thumb.focus();
        thumb.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true, cancelable: true}));
      }
    }"""
    seen = []
    session_number = session.run_number
    page.evaluate(moved, [pinned.id("network.zeta"), 200, 100])
    pinned.settle()
    for _ in range(3):  # nothing that is older comes after it
        page.wait_for_timeout(400)
        seen.append((pinned.run, pinned.digest))
    assert len(set(seen)) == 1 and pinned.run > session_number
    assert session.run is not None and session.run.scenario == session.scenario
    zeta = edits.value_at(session.scenario, ZETA)
    assert pinned.value("network.zeta") == pytest.approx(zeta)
    assert float(pinned.slider("network.zeta").get_attribute("aria-valuenow") or "nan") == pytest.approx(
        zeta, abs=0.006
    )
    from app.shell.reports import run_element

    assert f'data-digest="{pinned.digest}"' in run_element(session.run, session.run_number)
    assert pinned.metrics["methods"][2]["errors"] == _metrics(session.run)
    assert pinned.faults == []


def _metrics(run) -> dict:
    from navcore.engine.measures import metrics

    return metrics(run)["methods"][2]["errors"]
