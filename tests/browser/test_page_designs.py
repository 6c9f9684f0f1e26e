"""Proposals, designs and fronts: found in the background, taken with a click, taken back with undo."""

import re

import pytest

from navcore.design.designs import designs
from navcore.design.vary import tunable_fields
from navcore.questions.design import DesignQuestion
from navcore.questions.pareto import ParetoQuestion
from navcore.scenario.file import load
from navcore.study.robust_tune import TunedOver
from schuler_bench.shell.places import OVER, PLACES
from schuler_bench.views.design.view import BUDGET_OF, CHOICES
from schuler_bench.views.design.view import FIND as FIND_DESIGNS
from schuler_bench.views.design.view import STOP as STOP_DESIGNS
from schuler_bench.views.tune import finder
from schuler_bench.views.tune.setting import ACCEPT, DISCARD, TUNE, UNDO
from schuler_bench.views.tune.view import SEARCH_FOR, TuneView
from tests.browser.cases import SWEEP
from tests.browser.driver import Bench
from tests.limits import require


@pytest.fixture(params=SWEEP, ids=str)
def designing(request: pytest.FixtureRequest, moving: Bench) -> Bench:
    """The tab Design in a window of some size."""
    moving.resize(request.param)
    moving.tab("Design")
    return moving


def test_the_bars_follow_a_slider_and_the_run_has_four_panels(designing: Bench) -> None:
    page = designing.page
    designing.choose(BUDGET_OF, CHOICES["steady"])
    page.wait_for_function("() => look.bars() > 0")
    before = page.evaluate("look.bars")
    designing.press("network.zeta")
    page.wait_for_function("old => Math.abs(look.bars() - old) > 1e-4 * old", arg=before)
    designing.choose(BUDGET_OF, CHOICES["run"])
    page.wait_for_function("() => look.panels() === 4", timeout=60_000)


def test_without_limits_the_budget_is_shown_and_the_way_to_them(designing: Bench) -> None:
    page = designing.page
    page.wait_for_function("() => look.bars() > 0")
    page.get_by_text("This scenario has no limits yet").wait_for()
    page.locator(".sb-none").get_by_role("button", name="Requirements").click()
    designing.wait_for_front("Requirements")


@pytest.mark.slow
def test_a_proposal_is_accepted_and_undone_or_discarded(moving: Bench) -> None:
    page, session, accept = moving.page, moving.session, moving.button(ACCEPT)
    before = session.scenario
    moving.tab("Tune")
    moving.button(TUNE).click()
    accept.wait_for(timeout=120_000)
    told = page.locator(".sb-proposal")
    # the runs come before Accept
    assert "times the floor" in told.inner_text() and "Mean of 32 runs" in told.inner_text()
    assert session.scenario == before
    accept.click()
    accept.wait_for(state="hidden")
    assert session.scenario.method[2].network != before.method[2].network
    told.get_by_text("Accepted for complementary").wait_for()
    moving.button(UNDO).click()
    accept.wait_for()
    assert session.scenario == before
    moving.button(TUNE).click()
    moving.button(DISCARD).wait_for(timeout=120_000)
    moving.button(DISCARD).click()
    page.locator(".sb-proposal").wait_for(state="hidden")
    assert session.scenario == before


def test_curves_of_another_network_than_the_choosers_are_not_asked_for(
    moving: Bench,
) -> None:
    """The picture of a new scenario is made before the chooser follows: Tune failed for a moment."""
    moving.tab("Tune")
    tune = next(view for view in moving._pages[0]._views if isinstance(view, TuneView))
    asked, other = tune._setting.task(moving.session.scenario), load("zha-fast")
    assert asked is not None and asked.vary == ("method.2.network.zeta", "method.2.network.eta")
    task = tune._setting.task(other)
    assert task is None or set(task.vary) <= set(tunable_fields(other, 2))


def test_a_design_is_taken_from_the_table(moving: Bench) -> None:
    page, session = moving.page, moving.session
    moving.tab("Design")
    page.get_by_text("This scenario has no limits yet").wait_for()
    require(moving, tilt_max_arcsec=12.0)
    page.locator("[data-design=complementary]").wait_for()
    moving.button(FIND_DESIGNS).wait_for()
    before, limits = session.scenario, session.searches.asking["design"]
    # all networks take too long for a test
    limits.result, limits.asked = designs(before, 2, as_set=True), DesignQuestion(scenario=before)
    limits._tell()
    take = page.locator("[data-design=classic2] .sb-take")
    take.wait_for()
    with moving.next_run():
        take.click()
    assert session.scenario.method[2].network.id == "classic2"
    assert session.undo() and session.scenario == before
    limits.forget()


def test_designs_are_looked_for_over_the_points_of_the_tab_study(short: Bench) -> None:
    session, limits = short.session, short.session.searches.asking["design"]
    short.tab("Design")
    require(short, tilt_max_arcsec=12.0)
    short.choose(OVER, PLACES["study"])
    short.show(study_x="nothing-such", study_y="nothing")
    short.button(FIND_DESIGNS).click()
    short.page.get_by_text("The designs cannot be found").wait_for()
    short.close_notices()
    short.show(study_x="latitude")
    short.button(FIND_DESIGNS).click()
    short.button(STOP_DESIGNS).wait_for()
    task = limits.under_way
    assert task is not None and task.scenario == session.scenario
    assert task.over is not None and [one.fields for one in task.over.factor] == [("site.lat_deg",)]
    limits.cancel()
    short.button(FIND_DESIGNS).wait_for()


@pytest.mark.slow
def test_a_setting_is_tuned_over_the_points_of_the_tab_study(short: Bench) -> None:
    session, designer = short.session, short.session.searches.asking["tune"]
    before = session.scenario
    short.tab("Tune")
    short.choose(OVER, PLACES["study"])
    short.show(study_x="latitude", study_y="nothing")
    short.button(TUNE).click()
    short.button(ACCEPT).wait_for(timeout=120_000)
    told = short.page.locator(".sb-proposal").inner_text()
    assert isinstance(designer.result, TunedOver)
    assert f"Over {designer.result.points} points of the study the objective is at most" in told
    assert "the setting that is best here has" in told
    short.button(ACCEPT).click()
    short.button(UNDO).wait_for()
    # the method alone has changed: the proposal is put into this scenario
    assert session.scenario.site == before.site and session.scenario.method != before.method
    assert session.undo() and session.scenario == before
    designer.forget()


def test_a_click_on_a_point_of_the_fronts_is_one_step_of_undo(designing: Bench) -> None:
    page, session = designing.page, designing.session
    designing.tab("Tune")
    designing.choose(SEARCH_FOR, "Pareto fronts")
    designing.button(finder.FIND).click()
    designing.button(finder.STOP).click()
    ended = re.compile("Stopped: no fronts were found|The search was stopped: these are the fronts")
    page.get_by_text(ended).first.wait_for(timeout=60_000)
    # what the stopped search has found must not be clicked for what the next one finds
    session.searches.asking["pareto"].forget()
    session.searches.asking["pareto"]._tell()
    page.wait_for_function("() => look.frontSpot('classic3') === null")
    # all networks take too long for a test
    task = ParetoQuestion(scenario=session.scenario, method=2, network=("classic2", "classic3"))
    session.searches.asking["pareto"].begin(task)
    page.wait_for_function("look.frontRests", arg="classic3", timeout=60_000)
    before = session.scenario
    page.mouse.click(*page.evaluate("look.frontSpot", "classic3"))
    designing.notice("classic3 from the Pareto fronts")
    assert session.scenario.method[2].network.id == "classic3"
    assert session.undo() and session.scenario == before
