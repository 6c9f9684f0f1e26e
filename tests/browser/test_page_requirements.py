"""Requirements as the user sets them: numbers in, regions and verdicts out, bad input refused."""

from __future__ import annotations

import math
from typing import Any

import pytest

from app.session.requirements import Requirements, verdicts
from app.session.shown import window_of
from tests.browser.driver import Bench
from tests.browser.test_page_layout import SIZES, resize, wait_until_it_fits

pytestmark = pytest.mark.browser

_CELLS = """() => [...document.querySelectorAll('.sb-verdicts [data-measure]')]
  .filter(e => e.offsetParent !== null)
  .map(e => [e.dataset.measure, Number(e.dataset.value), e.dataset.passed, e.textContent.trim()])"""
_SHAPES = """() => [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null)
  .flatMap(p => (p._fullLayout?.shapes ?? []).filter(s => s.name))
  .map(s => [s.name, s.xref, s.x0 ?? null, s.y1 ?? null, s.path ?? null])"""
_CUT = """() => [...document.querySelectorAll('.mantine-ScrollArea-viewport')]
  .filter(e => e.clientHeight > 0 && e.querySelector('.sb-verdicts'))
  .map(e => [e.scrollWidth - e.clientWidth, e.scrollHeight - e.clientHeight])"""


@pytest.fixture
def asked(bench: Bench) -> Bench:
    """The shared page with no requirement, the tab in front."""
    bench.reset("sikuliaq-like", selected=1)
    bench.show(requirements=Requirements(), locus="")
    bench.tab("Requirements")
    bench.page.wait_for_function("() => document.querySelectorAll('.sb-verdicts [data-measure]').length > 0")
    return bench


def box(bench: Bench, label: str) -> Any:
    return (
        bench.page.get_by_text(bench.said(label), exact=True)
        .locator("xpath=ancestor::div[2]")
        .locator("input")
    )


def ask(bench: Bench, label: str, text: str) -> None:
    box(bench, label).fill(text)
    bench.settle()


def cells(bench: Bench, measure: str) -> list[tuple[float, str, str]]:
    """Value, verdict and text of each method."""
    return [(value, word, text) for name, value, word, text in bench.page.evaluate(_CELLS) if name == measure]


def wait_for(bench: Bench, measure: str, words: list[str]) -> None:
    found = f"({_CELLS})().filter(c => c[0] === m).map(c => c[2])"
    bench.page.wait_for_function(f"([m, words]) => String({found}) === String(words)", arg=[measure, words])


def test_limits_give_verdicts_with_the_measured_values(asked: Bench) -> None:
    wait_for(asked, "settling_min", ["", "", ""])
    ask(asked, "settling ≤ (min)", "90")
    wait_for(asked, "settling_min", ["missed", "met", "missed"])
    ask(asked, "damping ratio ≥", "0.6")
    wait_for(asked, "damping_ratio", ["missed", "met", "missed"])
    ask(asked, "position RMS ≤ (m)", "1")
    wait_for(asked, "position_rms_m", ["missed"] * 3)
    run, wanted = asked.session.run, asked.session.display.requirements
    assert wanted == Requirements(settling_min=90.0, damping_ratio=0.6, position_rms_m=1.0)
    for verdict in verdicts(run, wanted):
        shown = [value for value, _, _ in cells(asked, verdict.name)]
        assert shown == pytest.approx(list(verdict.measured), rel=1e-6)
    # in words, not by colour alone
    assert "✗ missed" in cells(asked, "position_rms_m")[0][2]
    table = asked.page.locator(".sb-verdicts").inner_text()
    assert "✗ misses 3 of 3" in table and "✗ misses 1 of 3" in table
    # another run is judged anew: a slower network
    asked.tab("Method")
    asked.select(2)
    before = cells(asked, "overshoot_percent")[2][0]
    asked.press("network.zeta")
    asked.page.wait_for_function(
        f"old => Math.abs(({_CELLS})().filter(c => c[0] === 'overshoot_percent')[2][1] - old) > 1e-6",
        arg=before,
    )
    assert asked.faults == []


def test_limits_are_drawn_as_regions_and_lines(asked: Bench) -> None:
    for label, text in (
        ("settling ≤ (min)", "90"),
        ("overshoot ≤ (%)", "30"),
        ("damping ratio ≥", "0.5"),
        ("tilt after log step ≤ (arcsec)", "10"),
        ("largest tilt ≤ (arcsec)", "12"),
    ):
        ask(asked, label, text)
    asked.tab("Poles")
    asked.plotly()
    shapes = asked.page.evaluate(_SHAPES)
    edges = [
        float(path.split()[1]) for name, xref, _, _, path in shapes if (name, xref) == ("settling", "x2")
    ]
    omega_s = asked.session.scenario.omega_s
    assert edges == [pytest.approx(-math.log(50.0) / (90.0 * 60.0 * omega_s))]
    assert {name for name, *_ in shapes} == {"settling", "damping"}
    asked.tab("Step")
    asked.page.wait_for_function(f"() => ({_SHAPES})().some(s => s[0] === 'overshoot')")
    shapes = asked.page.evaluate(_SHAPES)
    assert ["overshoot", "x", 0, -0.3, None] in shapes
    assert {x0 for name, _, x0, _, _ in shapes if name == "settling"} == {90}
    asked.tab("Errors")
    lines = """() => Object.values(window.__viserTestpoints?.uplots ?? {}).map(({chart}) => [
      chart.axes[1].label,
      chart.series.map((s, i) => s.label === 'limit' ? chart.data[i][0] : null).filter(v => v !== null)])
      .filter(([label, found]) => found.length)"""
    asked.page.wait_for_function(f"() => ({lines})().length >= 2")
    drawn = dict(asked.page.evaluate(lines))
    assert {label.split()[0] for label in drawn} == {"φE", "φN"}
    assert all(sorted(found) == pytest.approx([-12.0, 12.0]) for found in drawn.values())
    # and gone with the limit
    asked.tab("Requirements")
    ask(asked, "overshoot ≤ (%)", "")
    asked.page.wait_for_function(f"() => !({_SHAPES})().some(s => s[0] === 'overshoot')")


@pytest.mark.parametrize("text", ["soon", "-5", "1e9"])
def test_bad_input_is_refused_beside_the_boxes_and_the_old_limit_kept(asked: Bench, text: str) -> None:
    ask(asked, "settling ≤ (min)", "90")
    wait_for(asked, "settling_min", ["missed", "met", "missed"])
    box(asked, "settling ≤ (min)").fill(text)
    note = asked.page.locator(".sb-note:visible").filter(has_text="settling ≤ (min)")
    note.wait_for()
    assert "was not taken over" in note.inner_text() and "<= 100000 (min)" in note.inner_text()
    assert "90 is kept" in note.inner_text()
    assert box(asked, "settling ≤ (min)").input_value() == "90"
    assert asked.session.display.requirements.settling_min == 90.0


def test_a_reload_keeps_the_requirements(asked: Bench) -> None:
    ask(asked, "overshoot ≤ (%)", "36")
    wait_for(asked, "overshoot_percent", ["missed", "met", "missed"])
    asked.page.reload()
    asked.page.wait_for_selector("#sb-run[data-run]", state="attached")
    asked.tab("Requirements")
    wait_for(asked, "overshoot_percent", ["missed", "met", "missed"])
    assert box(asked, "overshoot ≤ (%)").input_value() == "36"


def test_boxes_and_table_fit_every_window(asked: Bench) -> None:
    try:
        for size in reversed(SIZES):
            resize(asked, size)
            asked.tab("Requirements")
            asked.page.wait_for_function(f"() => ({_CUT})().length > 0")
            wait_until_it_fits(asked, f"Requirements at {size}")
    finally:
        resize(asked, SIZES[0])


def test_errors_after_settling_are_measured_without_the_transient(asked: Bench) -> None:
    asked.tab("Metrics")
    asked.choose("errors over", "after settling")
    note = asked.page.locator(".sb-note:visible").filter(has_text="the slowest damped method has settled")
    note.first.wait_for()
    asked.tab("Requirements")
    note.first.wait_for()
    window = window_of(asked.session.run, asked.session.display)
    wanted = verdicts(window.run, asked.session.display.requirements)
    (velocity,) = [one for one in wanted if one.name == "velocity_rms_mps"]
    shown = asked.page.locator('[data-measure="velocity_rms_mps"]')
    assert [float(v) for v in shown.evaluate_all("all => all.map(e => e.dataset.value)")] == pytest.approx(
        velocity.measured
    )
    asked.tab("Metrics")
    asked.choose("errors over", "chosen hours")
    asked.page.get_by_label("measured from (h)").wait_for()
    asked.choose("errors over", "the whole run")
    note.first.wait_for(state="detached")
    assert asked.faults == []
