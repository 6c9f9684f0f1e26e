"""Nine tabs hold all views, as modes or folds, but for those of the menu; each is opened by its title."""

from typing import Any

import pytest

from navcore.scenario.file import load as load_preset
from navcore.scenario.model import Scenario
from schuler_bench.shell.layout import layout_for
from schuler_bench.shell.tabs import standings, tabs
from schuler_bench.views import load
from tests.browser.cases import SWEEP
from tests.browser.driver import Bench

STANDINGS = standings(load())
TABS = list(tabs(load()))


@pytest.fixture(params=SWEEP, ids=str)
def sized(request: pytest.FixtureRequest, moving: Bench) -> Bench:
    """The shared page in a window of some size."""
    moving.resize(request.param)
    return moving


def strip_of(bench: Bench, tab: str) -> dict[str, Any]:
    """What is seen of the panel in which a tab stands."""
    return next(one for one in bench.page.evaluate("look.tabs") if tab in one["tabs"])


def test_the_page_has_nine_tabs(sized: Bench) -> None:
    page = sized.page
    sized.tab("Method", "Frequency", "Errors")
    size = page.viewport_size
    left, upper, lower = TABS[:3], TABS[3:5], TABS[5:]
    right = [upper, lower] if layout_for(size["width"], size["height"]).two else [upper + lower]
    sized.wait_until(lambda: [one["tabs"] for one in page.evaluate("look.tabs")] == [left, *right], 10.0)
    assert page.get_by_role("tab").count() == len(TABS) == 9
    assert set(page.evaluate("look.rows")) == {1}


def test_every_view_is_opened_by_its_title(moving: Bench) -> None:
    moving.put(load_preset("liu-switching"), origin="liu-switching", selected=1)
    moving.tab_of("Switching").wait_for(state="attached")
    there = [one for one in STANDINGS if moving.tab_of(one.title).count() > 0]
    assert {one.title for one in STANDINGS} - {one.title for one in there} <= {"Ask"}
    for one in there:
        moving.page.evaluate("title => schuler.command('tab', title)", one.title)
        moving.wait_for_front(one.title)
        if one.fold:
            head = moving.page.locator(f"[data-sb-fold='{one.title}'] > [aria-expanded]")
            assert head.get_attribute("aria-expanded") == "true"
            continue
        seen = strip_of(moving, one.tab or one.title)
        assert seen["front"] == [one.tab or one.title]
        if seen["modes"]:
            assert seen["pressed"] == [one.mode]
        # one of the menu has a tab only while it is in front
        of_menu = [seen["front"][0] not in TABS for seen in moving.page.evaluate("look.tabs")]
        assert moving.page.get_by_role("tab").count() == len(TABS) + sum(of_menu)


def test_a_mode_is_chosen_by_mouse_and_keys_and_stays_with_its_tab(moving: Bench) -> None:
    page = moving.page
    moving.tab("Frequency")
    strip = strip_of(moving, "Frequency")
    assert (strip["modes"], strip["pressed"]) == (["Bode", "Step", "Diagram"], ["Bode"])
    modes = page.get_by_role("radiogroup", name="Modes of Frequency")
    modes.get_by_role("radio", name="Step", exact=True).click()
    moving.wait_for_front("Step")
    moving.heard()
    assert moving.page.evaluate("look.front") == ["Method", "Step", "Errors"]
    assert {view for page in moving._pages for view in page._front} == {"Method", "Step", "Errors"}
    page.keyboard.press("ArrowRight")
    moving.wait_for_front("Diagram")
    assert modes.locator("[aria-checked=true]").inner_text() == "Diagram"
    # the arrow keys go from tab to tab past the views behind, and back to the mode that was left
    page.get_by_role("tab", name="Frequency", exact=True).press("ArrowRight")
    moving.wait_for_front("Poles")
    assert strip_of(moving, "Poles")["modes"] == []
    page.keyboard.press("ArrowLeft")
    moving.wait_for_front("Diagram")
    moving.heard()
    assert strip_of(moving, "Frequency")["pressed"] == ["Diagram"]
    # a window of another size makes the panels anew, and keeps the mode
    moving.resize((1366, 768))
    moving.wait_for_front("Diagram")


def test_the_mode_comes_with_the_scenario_that_opens_in_it(moving: Bench) -> None:
    moving.tab("Poles")
    moving.put(load_preset("sun-step"), origin="sun-step")
    moving.wait_for_front("Step")
    assert strip_of(moving, "Frequency")["pressed"] == ["Step"]


def test_the_strip_unfolds_into_the_table_of_all_numbers(moving: Bench) -> None:
    moving.button("All numbers of the run").click()
    moving.wait_for_front("Metrics")
    assert strip_of(moving, "Errors")["pressed"] == ["Metrics"]


def test_folds_open_for_what_the_scenario_sets_and_by_a_key(moving: Bench) -> None:
    page = moving.page

    def state() -> dict[str, str]:
        heads = page.locator("[data-sb-fold] > [aria-expanded]").all()
        return {head.inner_text(): head.get_attribute("aria-expanded") or "" for head in heads}

    moving.tab("Setup")
    moving.wait_until(lambda: set(state().values()) == {"true"}, 10.0)
    plain = load_preset("sikuliaq-like").canonical() | {"imu": {}, "motion": {"kind": "static"}}
    moving.put(Scenario.parse(plain), origin="at rest")
    moving.wait_until(lambda: (state()["Sensors"], state()["Motion"]) == ("false", "false"), 10.0)
    assert (state()["Log"], state()["Run"]) == ("true", "true")
    page.locator("[data-sb-fold=Sensors] > [aria-expanded]").press("Enter")
    moving.wait_until(lambda: state()["Sensors"] == "true", 10.0)
    assert moving.box("imu.gyro_bias_dph.0").is_visible()


def test_what_has_nothing_to_show_is_not_in_the_menu(moving: Bench) -> None:
    moving.button("Menu").click()
    links = moving.page.locator("#sb-menu")
    for one in STANDINGS:
        if not one.tab:
            entry = links.locator(f"[data-command='tab {one.title}']")
            assert entry.is_visible() == (moving.tab_of(one.title).count() > 0), one.title
    links.get_by_role("button", name="Misprints", exact=True).click()
    moving.wait_for_front("Misprints")
    assert not links.is_visible()
    moving.tab("Frequency")
    assert "Misprints" not in strip_of(moving, "Frequency")["tabs"]
