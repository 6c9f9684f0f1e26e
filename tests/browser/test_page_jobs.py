"""What is computed in the background: verification, Sun's table, why, bands, sweeps, studies."""

import re
import threading
from pathlib import Path
from typing import Any

import pytest

from navcore.engine.measures import measure
from navcore.quantities import QUANTITIES
from navcore.questions.verify import VerifyQuestion
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits
from schuler_bench.views.appearance.view import BANDS
from schuler_bench.views.study import view as study
from schuler_bench.views.sweep.view import METRIC
from schuler_bench.views.sweep.view import SWEEP as RUN_SWEEP
from tests.browser.driver import Bench

VERIFY, STOP_VERIFYING = "Verify with full strapdown", "Stop verifying"
FIND, STOP, USE = "Find the table for this scenario", "Stop the search", "Use this table"


class Endless:
    """A search that goes on until it is told to stop; its result is not asked for."""

    def __init__(self) -> None:
        self.begun = threading.Event()

    def __call__(self, asked: Any, progress: Any, cancelled: Any) -> Any:
        self.begun.set()
        while not cancelled():
            progress(0.25)
            threading.Event().wait(0.01)
        raise AssertionError("its result is not asked for")


def test_the_strapdown_is_told_in_numbers_and_becomes_old(short: Bench) -> None:
    page = short.page
    short.button(VERIFY).click()
    page.get_by_text("Verified. Largest difference").wait_for(timeout=120_000)
    assert not short.button(STOP_VERIFYING).is_visible()
    short.choose("curves", "Verification")
    short.tab("View")
    short.choose("export plot", "Verification: Tilt about east φE, difference")
    with page.expect_download(timeout=60_000) as download:
        page.get_by_text("CSV", exact=True).click()
    saved = download.value.path().read_text()
    assert "strapdown minus linear model" in saved and len(saved.splitlines()) > 300
    short.tab("Method", "Metrics")
    table = page.locator(".sb-table:not(.sb-verdicts):visible").filter(
        has_text="Full strapdown minus linear model"
    )
    table.wait_for()
    peak = short.session.verifier.result.differences[0]["phi_e_rad"].peak
    assert f"{peak * 180.0 / 3.141592653589793 * 3600.0:.3g}" in table.inner_text()
    assert table.inner_text().count("%)") == 3 * 8
    short.tab("Errors")
    # the scenario changes: what was verified is of an earlier one, and says so
    short.press("network.zeta")
    page.get_by_text("The verification is of an earlier scenario: verify again.").wait_for()
    page.get_by_text("full strapdown of an earlier scenario").wait_for()
    page.wait_for_function("() => look.dashed().flat().every(color => /66$/i.test(color))")
    short.press("network.zeta", "ArrowLeft")
    page.get_by_text("Verified. Largest difference").wait_for()
    short.choose("curves", "Overview")


def test_a_verification_is_stopped(short: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    verifier, endless = short.session.verifier, Endless()
    verify, stop = short.button(VERIFY), short.button(STOP_VERIFYING)
    monkeypatch.setattr(verifier, "_compute", endless)
    verify.click()
    assert endless.begun.wait(60.0)
    short.page.locator(".mantine-Progress-root:visible").first.wait_for()
    stop.click()
    short.page.get_by_text(VerifyQuestion.stopped).wait_for()
    assert verifier.wait_idle(60.0)
    # a slider is answered meanwhile, and ends what has become useless
    verify.click()
    stop.wait_for()
    short.press("network.zeta")
    short.page.get_by_text("Stopped: the scenario was changed meanwhile.").wait_for()
    assert verifier.wait_idle(60.0)


def test_why_a_scenario_cannot_be_verified_is_said(fresh: Bench) -> None:
    fresh.button(VERIFY).click()
    fresh.page.get_by_text("leaves the Earth's rotation and the heading out").wait_for()
    fresh.press("network.xi")  # the next change takes the reason away
    fresh.page.get_by_text("leaves the Earth's rotation").wait_for(state="detached")


def test_a_strapdown_scenario_runs_when_short_and_waits_when_long(bench: Bench) -> None:
    scenario = load("sikuliaq-like", ["run.duration_h=0.2", 'run.fidelity="strapdown"', "run.rate_hz=50"])
    bench.put(scenario, "Method", "Errors", origin=f"test {bench.session.run_number}", selected=2)
    bench.press("network.zeta")
    assert bench.metrics["methods"][2]["status"] == "ok"
    bench.tab("Run")
    number, run = bench.run, bench.button("Run the strapdown")
    bench.box("run.duration_h").fill("6")
    run.wait_for()
    assert f"pictures still show run {number}" in bench.status
    bench.type("run.duration_h", "0.1")  # short again: it follows
    run.wait_for(state="hidden")
    # the other fidelity gives up what only the strapdown has
    bench.choose_and_run("alignment", "compass")
    bench.choose_and_run("run.fidelity", "error_model")
    assert bench.session.scenario.alignment.kind == "none"


# ------------------------------------------------------------ Sun's table, and why


@pytest.fixture
def adaptive(bench: Bench) -> Bench:
    """Three hours; the second method has Sun's table."""
    data = load("sikuliaq-like").canonical()
    data["run"] |= {"duration_h": 3.0, "step_s": 5.0}
    network = {"id": "unity2", "zeta": 0.5}
    switched = {"name": "sun", "damping": "external", "network": network, "policy": {"id": "adaptive"}}
    data["method"] = [{"name": "free"}, switched]
    bench.put(Scenario.parse(data), "Method", "Errors", origin=f"test {bench.session.run_number}", selected=1)
    folder = bench.page.get_by_text("Table by Sun's double loop", exact=True)
    folder.wait_for()
    if not bench.button(FIND).is_visible():
        folder.click()
        bench.button(FIND).wait_for()
    return bench


def table(bench: Bench) -> list[list[float]]:
    return [list(row) for row in edits.value_at(bench.session.scenario, ("method", 1, "policy", "table"))]


def test_a_table_is_found_and_taken_over_as_one_step(adaptive: Bench) -> None:
    page, session, step = adaptive.page, adaptive.session, adaptive.box("coefficient step")
    before, number, wrong = table(adaptive), adaptive.run, page.locator(".sb-note.sb-error:visible")
    step.fill("0.2")
    adaptive.button(FIND).click()
    page.locator(".sb-tuned svg").wait_for(timeout=120_000)
    found = session.searches.asking["adapt"].result
    assert found.settings.step == 0.2
    assert page.locator(".sb-tuned .sb-found").count() == len(found.pairs())
    assert adaptive.run == number and table(adaptive) == before  # nothing is changed unasked
    with adaptive.next_run():
        adaptive.button(USE).click()
    assert table(adaptive) == found.pairs()
    with adaptive.next_run():
        session.undo()
    assert table(adaptive) == before
    # a wrong setting is refused beside its box, and not used
    step.fill("7")
    wrong.get_by_text("must be").wait_for()
    step.fill("0.2")
    wrong.wait_for(state="detached")
    # where no policy has a table, there is nothing to find
    adaptive.choose_and_run("policy", "constant")
    page.get_by_text("Table by Sun's double loop", exact=True).wait_for(state="hidden")


def test_a_search_is_stopped(adaptive: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    tuner, endless = adaptive.session.searches.asking["adapt"], Endless()
    monkeypatch.setattr(tuner, "_compute", endless)
    adaptive.button(FIND).click()
    assert endless.begun.wait(60.0)
    adaptive.button(STOP).click()
    adaptive.page.get_by_text("Stopped: no table was found.").wait_for()
    assert tuner.wait_idle(60.0)
    assert adaptive.button(FIND).is_visible()


def test_why_is_said_once_the_run_stands_still(fresh: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    fresh.press("network.xi")
    explainer, page = fresh.session.searches.asking["why"], fresh.page
    asked = explainer.asked
    assert asked is None or asked.scenario != fresh.session.scenario, "nobody looks at it"
    assert explainer.under_way is None
    fresh.tab("Metrics")
    why = page.locator("#sb-why")
    page.wait_for_function("look.why", arg="1")
    text = why.evaluate("lines => (lines.open = true) && lines.innerText")  # a click is a choice, which stays
    assert "free: position error all from gyro bias" in text
    assert "tilt all from gyro bias, at the Schuler period (84.5 min)" in text
    # what is of an earlier run says so, until the new one has stood still
    hold, find = threading.Event(), explainer._compute

    def held(run: Any, progress: Any, cancelled: Any) -> Any:
        hold.wait(120.0)
        return find(run, progress, cancelled)

    with monkeypatch.context() as patch:
        patch.setattr(explainer, "_compute", held)
        fresh.press("network.xi")
        page.wait_for_function("look.why", arg="0")
        assert "of an earlier run" in why.inner_text() and why.locator(".sb-old").count() == 1
        hold.set()
    page.wait_for_function("look.why", arg="1")
    assert why.locator(".sb-old").count() == 0


# ------------------------------------------------------------ bands, budget, proposals, fronts


@pytest.mark.parametrize(
    ("band", "says"),
    [("±1σ by covariance", "band: ±1σ by covariance"), ("20 seeds, 5 to 95 %", "5 to 95 % of 20 seeds")],
    ids=["covariance", "seeds"],
)
def test_a_band_follows_the_scenario_and_says_what_it_is(moving: Bench, band: str, says: str) -> None:
    page, session = moving.page, moving.session
    moving.tab("View", "Errors")
    moving.choose(BANDS, band)
    page.wait_for_function("() => look.band()[0] === 3", timeout=120_000)
    assert says in page.evaluate("look.legend")
    before = page.evaluate("look.band")[1]
    moving.tab("Method")
    moving.press("network.zeta")
    # the band of the earlier scenario stays, marked, until that of the new one is there
    new = "old => !look.legend().includes('earlier') && look.band()[0] === 3 && look.band()[1] !== old"
    page.wait_for_function(new, arg=before, timeout=120_000)
    kind = session.display.envelope
    found = session.envelopes.beside(session.run.scenario, kind)
    assert found is not None and not found.old and found.high[2] is not None


def test_one_click_sweeps_four_quantities_and_a_change_makes_them_old(short: Bench) -> None:
    page, sweeper = short.page, short.session.searches.sweeper
    short.tab("Sweep")
    page.get_by_text("Sweep: one click runs all methods").wait_for()
    short.button(RUN_SWEEP).click()
    page.wait_for_function("() => look.sweep().length === 4 * 3", timeout=120_000)
    short.wait_until(lambda: sweeper.under_way is None)
    before = page.evaluate("look.sweep")
    assert [len(curve) for curve in before] == [
        len(one.values) for one in sweeper.known.values() for _ in range(3)
    ]
    short.choose(METRIC, QUANTITIES["position_max_m"].label)
    page.wait_for_function("old => look.sweep()[0][0] !== old", arg=before[0][0])
    assert not page.get_by_text("of an earlier scenario").is_visible()
    with short.next_run():
        short.press("network.zeta")
    page.get_by_text("of an earlier scenario: sweep again").wait_for()
    sweeper.forget()


@pytest.mark.slow
def test_a_study_is_run_stopped_gone_on_with_and_its_worst_run_opened(short: Bench, tmp_path: Path) -> None:
    page, session = short.page, short.session
    studier, before = session.searches.asking["study"], session.scenario
    session.show(None, study_x="latitude", study_y="log_bias", study_seeds=20)
    short.tab("Study")
    page.get_by_text("Run the study: every point of the grid").wait_for()
    planned = page.get_by_text(re.compile("[0-9]+ runs, each of 3 methods; about [0-9]+ s")).inner_text()
    short.button(study.RUN).click()
    short.wait_until(lambda: (studier.fraction or 0.0) > 0.05, seconds=60.0)
    short.button(study.STOP).click()
    page.get_by_text("Stopped after").wait_for(timeout=30_000)
    part = studier.result.summary["runs"]
    assert 0 < part < studier.result.summary["of"] == int(re.findall("([0-9]+) runs", planned)[0])
    short.button(study.GO_ON).click()
    short.wait_until(lambda: studier.result.complete, seconds=120.0)
    short.button(study.GO_ON).wait_for(state="hidden")
    page.wait_for_function("cells => look.mapped() === cells", arg=len(studier.result.summary["cells"]))
    # another quantity, then the tables
    first = page.evaluate("look.written()")
    short.choose(study.METRIC, QUANTITIES["position_max_m"].label)
    page.wait_for_function("old => look.written() !== old", arg=first)
    short.choose(study.SHOW, study.SHOWS["tables"])
    worst = page.locator(".sb-worst .sb-take")
    worst.first.wait_for()
    assert worst.count() == 5
    number = int(worst.first.get_attribute("data-command").split()[1])
    with short.next_run():
        worst.first.click()
    opened, worst_run = session.scenario, study_of(session)["worst"]["position_max_m"][0]
    assert worst_run["run"] == number and repr(opened.site.lat_deg) == worst_run["factors"]["latitude"]
    # the run on the page is the run of the study
    shown = next(one for one in session.run.methods if one.method.name == study_of(session)["name"])
    assert measure(shown, "position_max_m", 0.0) == worst_run["value"]
    page.get_by_text("of an earlier scenario").wait_for(state="detached")
    assert session.undo() and session.scenario == before
    # a study file is dropped on the page
    file = tmp_path / "mine.toml"
    file.write_text(
        'schema = 1\nscenario = "zha-fast"\nset = ["run.duration_h=0.1"]\n'
        '[[factor]]\nfield = "site.lat_deg"\nvalues = [10, 60]\n'
    )
    short.tab("Files")
    short.upload(file)
    short.wait_until(lambda: session.display.study == "uploaded")
    short.button(study.RUN).click()
    short.wait_until(lambda: studier.result.summary["of"] == 2, seconds=60.0)
    session.show(None, study="", study_shows="pictures")


def study_of(session: Any) -> dict[str, Any]:
    """Summary of the method that the tab "Study" shows."""
    document, wanted = session.searches.asking["study"].result.summary, session.display.study_method
    names = [one["name"] for one in document["methods"]]
    return document["methods"][names.index(wanted) if wanted in names else -1]
