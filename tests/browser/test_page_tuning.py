"""Sun's table as a tool, and the line that says why: found in the background, marked when old, cancelled."""

from __future__ import annotations

import threading
from typing import Any

import pytest

from app.editing import edits
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from tests.browser.driver import Bench

pytestmark = pytest.mark.browser

FIND, STOP, USE = "Find the table for this scenario", "Stop the search", "Use this table"
_WHY = "fits => document.querySelector('#sb-why')?.dataset.fits === fits"


@pytest.fixture
def adaptive(bench: Bench) -> Bench:
    """Three hours; the second method has Sun's table."""
    data = load("sikuliaq-like").canonical()
    data["run"] |= {"duration_h": 3.0, "step_s": 5.0}
    network = {"id": "unity2", "zeta": 0.5}
    switched = {"name": "sun", "damping": "external", "network": network, "policy": {"id": "adaptive"}}
    data["method"] = [{"name": "free"}, switched]
    bench.put(Scenario.parse(data), origin=f"test {bench.session.run_number}", selected=1)
    bench.tab("Method", "Errors")
    folder = bench.page.get_by_text("Table by Sun's double loop", exact=True)
    folder.wait_for()
    if not bench.page.get_by_role("button", name=FIND).is_visible():
        folder.click()
        bench.page.get_by_role("button", name=FIND).wait_for()
    return bench


def table(bench: Bench) -> list[list[float]]:
    rows = edits.value_at(bench.session.scenario, ("method", 1, "policy", "table"))
    return [list(row) for row in rows]


def test_a_table_is_found_and_taken_over_as_one_step(adaptive: Bench) -> None:
    page, session = adaptive.page, adaptive.session
    before, number = table(adaptive), adaptive.run
    adaptive.box("coefficient step").fill("0.2")
    page.get_by_role("button", name=FIND).click()
    page.locator(".sb-tuned svg").wait_for(timeout=120_000)
    found = session.searches.tuner.result
    assert found is not None and found.settings.step == 0.2
    assert page.locator(".sb-tuned .sb-found").count() == len(found.rows())
    assert adaptive.run == number and table(adaptive) == before  # nothing is changed unasked
    page.get_by_role("button", name=USE).click()
    adaptive.wait_for_run(number)
    assert table(adaptive) == found.rows()
    number = adaptive.run
    session.undo()
    adaptive.wait_for_run(number)
    adaptive.catch_up()
    assert table(adaptive) == before
    # a wrong setting is refused beside its box, and not used
    adaptive.box("coefficient step").fill("7")
    page.locator(".sb-note.sb-error").get_by_text("must be").wait_for()
    adaptive.box("coefficient step").fill("0.2")
    page.locator(".sb-note.sb-error").wait_for(state="detached")
    # where no policy has a table, there is nothing to find
    adaptive.choose_and_run("policy", "constant")
    page.get_by_text("Table by Sun's double loop", exact=True).wait_for(state="hidden")
    assert adaptive.faults == []


def test_a_search_is_stopped(adaptive: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    begun = threading.Event()

    def endless(asked: Any, progress: Any, cancelled: Any) -> Any:
        begun.set()
        while not cancelled():
            progress(0.25)
            threading.Event().wait(0.01)
        raise AssertionError("its result is not asked for")

    tuner = adaptive.session.searches.tuner
    monkeypatch.setattr(tuner, "_compute", endless)
    adaptive.page.get_by_role("button", name=FIND).click()
    assert begun.wait(60.0)
    stop = adaptive.page.get_by_role("button", name=STOP)
    stop.click()
    adaptive.page.get_by_text("Stopped: no table was found.").wait_for()
    assert tuner.wait_idle(60.0)
    assert adaptive.page.get_by_role("button", name=FIND).is_visible()


def test_why_is_said_once_the_run_stands_still(bench: Bench) -> None:
    bench.reset("zha-fast", selected=2)
    bench.tab("Errors", "Method")
    bench.press("network.xi")
    explainer, run = bench.session.searches.explainer, bench.session.run
    assert run not in (explainer.asked, explainer.under_way), "nobody looks at it"
    bench.tab("Metrics")
    page = bench.page
    page.wait_for_function(_WHY, arg="1")
    text = page.locator("#sb-why").inner_text()
    assert "free: position error all from gyro bias" in text
    assert "tilt all from gyro bias, at the Schuler period (84.5 min)" in text
    # what is of an earlier run says so, until the new one has stood still
    hold = threading.Event()
    find = explainer._compute

    def held(run: Any, progress: Any, cancelled: Any) -> Any:
        hold.wait(120.0)
        return find(run, progress, cancelled)

    explainer._compute = held
    try:
        bench.press("network.xi")
        page.wait_for_function(_WHY, arg="0")
        assert "of an earlier run" in page.locator("#sb-why").inner_text()
        assert page.locator("#sb-why .sb-old").count() == 1
    finally:
        hold.set()
        explainer._compute = find
    page.wait_for_function(_WHY, arg="1")
    assert page.locator("#sb-why .sb-old").count() == 0
    assert bench.faults == []
