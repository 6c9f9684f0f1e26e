"""Verify with the full strapdown: progress, stop, dashed curves, differences, and results grown old."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest

from app.jobs.verifier import STOPPED
from navcore.scenario.file import load
from tests.browser.driver import Bench

pytestmark = pytest.mark.browser

VERIFY, STOP = "Verify with full strapdown", "Stop verifying"
_DASHED = """() => Object.values(window.__viserTestpoints?.uplots ?? {}).map(({chart}) =>
  chart.series.filter(s => (s.dash ?? []).length).map(s => s.stroke(chart, 1)))"""


@pytest.fixture
def short(bench: Bench) -> Iterator[Bench]:
    """An hour of the moving preset."""
    scenario = load("sikuliaq-like", ["run.duration_h=1.0"])
    bench.put(scenario, origin=f"test {bench.session.run_number}", selected=2)
    bench.tab("Method", "Errors")
    yield bench
    bench.session.verifier.cancel()
    bench.reset("sikuliaq-like")


def test_the_strapdown_is_drawn_dashed_and_becomes_old(short: Bench) -> None:
    number = short.run
    short.page.get_by_role("button", name=VERIFY).click()
    short.page.get_by_text("Verified. Largest difference").wait_for(timeout=120_000)
    assert short.run == number
    # the run's own curves stay as they are; both models are drawn apart
    assert not any(short.page.evaluate(_DASHED))
    short.choose("curves", "Verification")
    short.page.wait_for_function(f"() => ({_DASHED})().some(lines => lines.length === 3)")
    assert not short.page.get_by_role("button", name=STOP).is_visible()
    short.tab("View")
    short.choose("export plot", "Verification: Tilt about east φE, difference")
    with short.page.expect_download(timeout=60_000) as download:
        short.page.get_by_text("CSV", exact=True).click()
    saved = download.value.path().read_text()
    assert "strapdown minus linear model" in saved and len(saved.splitlines()) > 300
    short.tab("Method", "Metrics")
    table = short.page.locator(".sb-table")
    table.get_by_text("Full strapdown minus linear model").wait_for()
    result = short.session.verifier.result
    assert result is not None
    peak = result.differences[0]["phi_e_rad"].peak * 180.0 / 3.141592653589793 * 3600.0
    assert f"{peak:.3g}" in table.inner_text()
    assert len(table.inner_text().split("%)")) - 1 == 3 * 8
    short.tab("Errors")
    # the scenario changes: what was verified is of an earlier one, and says so
    short.press("network.zeta")
    short.page.get_by_text("The verification is of an earlier scenario: verify again.").wait_for()
    short.page.get_by_text("full strapdown of an earlier scenario").wait_for()
    short.page.wait_for_function(f"() => ({_DASHED})().flat().every(color => /66$/i.test(color))")
    short.press("network.zeta", "ArrowLeft")
    short.page.get_by_text("Verified. Largest difference").wait_for()
    assert short.faults == []


def test_a_verification_is_stopped(short: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    begun = threading.Event()

    def endless(scenario: Any, progress: Any, cancelled: Any) -> Any:
        begun.set()
        while not cancelled():
            progress(0.25)
            threading.Event().wait(0.01)
        raise AssertionError("its result is not asked for")

    verifier = short.session.verifier
    monkeypatch.setattr(verifier, "_compute", endless)
    short.page.get_by_role("button", name=VERIFY).click()
    assert begun.wait(60.0)
    stop = short.page.get_by_role("button", name=STOP)
    stop.wait_for()
    short.page.locator(".mantine-Progress-root:visible").first.wait_for()
    # a slider is answered meanwhile, and ends what has become useless
    stop.click()
    short.page.get_by_text(STOPPED).wait_for()
    assert verifier.wait_idle(60.0)
    assert short.page.get_by_role("button", name=VERIFY).is_visible()
    short.page.get_by_role("button", name=VERIFY).click()
    stop.wait_for()
    short.press("network.zeta")
    short.page.get_by_text("Stopped: the scenario was changed meanwhile.").wait_for()
    assert verifier.wait_idle(60.0)


def test_why_a_scenario_cannot_be_verified_is_said(bench: Bench) -> None:
    bench.reset("zha-fast", selected=2)
    bench.page.get_by_role("button", name=VERIFY).click()
    bench.page.get_by_text("leaves the Earth's rotation and the heading out").wait_for()
    bench.tab("Method")
    bench.press("network.xi")  # the next change takes the reason away
    bench.page.get_by_text("leaves the Earth's rotation").wait_for(state="detached")


def test_a_strapdown_scenario_runs_when_short_and_waits_when_long(bench: Bench) -> None:
    scenario = load("sikuliaq-like", ["run.duration_h=0.2", 'run.fidelity="strapdown"', "run.rate_hz=50"])
    bench.put(scenario, origin=f"test {bench.session.run_number}", selected=2)
    bench.tab("Method", "Errors")
    bench.press("network.zeta")
    assert bench.metrics["methods"][2]["status"] == "ok"
    bench.tab("Run")
    number = bench.run
    bench.box("run.duration_h").fill("6")
    run = bench.page.get_by_role("button", name="Run the strapdown")
    run.wait_for()
    assert f"pictures still show run {number}" in bench.status
    bench.type("run.duration_h", "0.1")  # short again: it follows
    run.wait_for(state="hidden")
    # the other fidelity gives up what only the strapdown has
    bench.choose_and_run("alignment", "compass")
    bench.choose_and_run("run.fidelity", "error_model")
    assert bench.session.scenario.alignment.kind == "none"
    assert bench.faults == []
    bench.reset("sikuliaq-like")
