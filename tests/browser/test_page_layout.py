"""At three window sizes nothing is clipped, empty or unlabelled; sliders and boxes stand in one row."""

import re
from typing import Any, Literal

import pytest
from playwright.sync_api import Locator
from playwright.sync_api import TimeoutError as PlaywrightTimeout

from navcore.scenario.file import load as load_preset
from navcore.scenario.model import Scenario
from schuler_bench.misprints import MISPRINTS
from schuler_bench.shell.layout import BAR_PX, STRIP_PX, layout_for
from schuler_bench.views import load
from schuler_bench.views.misprints.view import misprint_title
from schuler_bench.views.poles.figure import ZOOM
from tests.browser.cases import SIZES, SWEEP
from tests.browser.driver import Bench
from tests.browser.placing import place


@pytest.fixture(params=SWEEP, ids=str)
def sized(request: pytest.FixtureRequest, moving: Bench) -> Bench:
    """The shared page in a window of some size."""
    moving.resize(request.param)
    return moving


def wait_until_it_fits(bench: Bench, tab: str, *, scrolls: bool = False) -> None:
    """Wait until all is drawn and no panel on the right is cut off; one that ``scrolls`` may go on below."""
    bench.page.wait_for_function("look.drawn")
    fits = "scrolls => look.cut().every(([right, below]) => right <= 0 && (scrolls || below <= 0))"
    try:
        bench.page.wait_for_function(fits, arg=scrolls)
    except PlaywrightTimeout:
        cut = bench.page.evaluate("look.cut")
        raise AssertionError(f"{tab}: px cut off at the right and below: {cut}") from None


def test_every_tab_fits_its_panel(sized: Bench) -> None:
    page, size = sized.page, sized.page.viewport_size
    two = layout_for(size["width"], size["height"]).two
    wide = re.search(r" 1\.\d\d", page.evaluate("schuler.state()"))  # its letters
    small = size["height"] < SIZES[0 if two or wide else 2][1]  # in which a table goes on below
    for tab in (kind.title for kind in load() if kind.place in ("upper", "lower") and kind.always):
        sized.tab(tab)
        if tab == "Misprints":  # computed only now; a plot that goes while it is drawn is plotly's fault
            page.wait_for_function("look.misprintDrawn")
        if tab == "Metrics":  # its last lines come later than the run
            page.wait_for_function("look.why", arg="1")
        goes_on = "Scenario", "Requirements"  # a text, and a table below a box for each quantity
        wait_until_it_fits(sized, tab, scrolls=tab in goes_on or (small and tab == "Metrics"))
        assert page.evaluate("look.clipped") == [], tab
        if tab in ("Frequency", "Poles", "Step"):
            assert sized.plotly(), tab
            assert page.evaluate("look.textOutside") == [], tab
            for name, labelled in page.evaluate("look.axes"):
                assert labelled, f"{tab}: {name} has no title"
        if tab == "Poles":  # and as large as it is made, also when plotly has drawn it in another size before
            assert page.evaluate("look.zoomed") == pytest.approx([-ZOOM, ZOOM])
            assert page.evaluate("look.met", "Poles") == []
        if tab == "Errors":
            assert all("(" in chart["label"] for chart in sized.curves())
    for tab in ("Frequency", "Errors"):
        sized.tab(tab)
        page.wait_for_function("look.drawn")
    filled = [found for found in page.evaluate("look.filled") if found is not None]
    panels = 1 + layout_for(size["width"], size["height"]).two
    assert filled and min(filled) >= 0.9 * (size["height"] - BAR_PX - STRIP_PX) / panels - 60
    assert page.locator(".sb-table").first.inner_text()
    assert "schema = 1" in page.locator("pre").first.inner_text()


@pytest.mark.slow
def test_why_folds_where_its_panel_is_too_small_and_as_the_user_likes(moving: Bench) -> None:
    page, why = moving.page, moving.page.locator("#sb-why")
    line = why.locator("div").first

    def look(height: int, state: Literal["visible", "hidden"]) -> None:
        """The page measures its room after the lines have come: their state is waited for."""
        moving.resize((1920, height))
        moving.tab("Metrics")
        page.wait_for_function("look.why", arg="1")
        line.wait_for(state=state)

    look(1400, "visible")
    assert why.locator(".sb-short").is_hidden()
    look(900, "hidden")
    assert "complementary: position error mostly" in why.inner_text()
    why.locator("summary").click()
    line.wait_for()
    moving.press("network.zeta")
    page.wait_for_function("look.why", arg="1")
    assert line.is_visible(), "what is opened by hand stays open"
    why.locator("summary").click()
    line.wait_for(state="hidden")
    look(1400, "hidden")


def test_tabs_tools_and_boxes_stand_in_one_row(sized: Bench) -> None:
    page = sized.page
    sized.put(load_preset("liu-switching"), origin="liu-switching", selected=1)
    sized.tab_of("Switching").wait_for(state="attached")
    assert set(page.evaluate("look.rows")) == {1}
    sized.tab("Design")
    wait_until_it_fits(sized, "Design")
    sized.tab("Sensors")
    for label in ("imu.gyro_bias_dph.0", "imu.accel_vrw_ugpshz"):
        row = page.locator('[data-sb-kind="slider"]', has=sized.slider(label))
        track, box = row.locator(".mantine-Slider-track").bounding_box(), sized.box(label).bounding_box()
        assert 0 < track["y"] - (box["y"] + box["height"]) < 16, "the slider lies below its exact box"
        assert track["width"] >= 130 and box["width"] > 55
    # viser's own rounded box of a slider, and the page's report of its size, are out of sight
    assert not page.locator(".mantine-Slider-root ~ .mantine-NumberInput-root").first.is_visible()
    assert not page.get_by_text("page state", exact=True).is_visible()
    place(sized, "Poles")
    for tab in ("Frequency", "Poles", "Requirements"):
        sized.tab(tab)
        wait_until_it_fits(sized, tab, scrolls=tab == "Requirements")
        rows = page.evaluate("look.toolsInRow")
        assert tab == "Requirements" or rows, tab
        for apart, cut in rows:
            assert apart < 8 and cut <= 0, (tab, rows)


def middle(located: Locator) -> float:
    box = located.bounding_box()
    return box["y"] + box["height"] / 2


def test_tools_are_level_with_the_tabs_and_only_the_main_button_is_filled(bench: Bench) -> None:
    bench.reset("sikuliaq-like", "Poles", "Spectrum")
    for tab, tool in (("Poles", bench.button("Place")), ("Spectrum", bench.box("spectrum of"))):
        wait_until_it_fits(bench, tab)
        assert abs(middle(bench.tab_of(tab)) - middle(tool)) < 2, tab
    bench.tab("Metrics")
    wait_until_it_fits(bench, "Metrics", scrolls=True)
    assert bench.box("errors over").bounding_box()["width"] < 420
    fill = "node => getComputedStyle(node).backgroundColor"
    bench.tab("Compare")
    main, other = (bench.button(name).evaluate(fill) for name in ("Pin this run", "Flip to the baseline"))
    assert other == "rgb(255, 255, 255)" and main != other


def test_tools_do_not_lie_under_the_chooser_of_modes(moving: Bench) -> None:
    moving.tab("Frequency")
    modes = moving.page.locator(".sb-modes").first
    for width in (1300, 1240):
        moving.resize((width, 1080))
        wait_until_it_fits(moving, "Frequency")
        chooser, tool = modes.bounding_box(), moving.box("optimal H").bounding_box()
        beside, below = (
            chooser["x"] + chooser["width"] <= tool["x"],
            tool["y"] >= chooser["y"] + chooser["height"],
        )
        assert beside or below, (width, chooser, tool)


def uncovered(bench: Bench) -> int:
    """Number of labels in view on all tabs, the same one on each; none is covered by its "?"."""
    count = 0
    for name in bench.views:
        bench.tab(name)
        labels, covered = bench.page.evaluate("look.covered")
        assert (covered, bench.page.evaluate("look.torn")) == ([], []), name
        count += labels
    return count


def test_no_question_mark_covers_a_label(sized: Bench) -> None:
    assert uncovered(sized) > 100


@pytest.mark.slow
def test_no_question_mark_covers_a_label_in_chinese(chinese: Bench) -> None:
    chinese.size = SIZES[2]
    chinese.clean()
    chinese.reset("sikuliaq-like")
    assert uncovered(chinese) > 100
    assert chinese.faults == []


@pytest.mark.parametrize("size", [(1600, 900), (1280, 720)], ids=str)
def test_the_budgets_of_eight_methods_do_not_overlap(bench: Bench, size: tuple[int, int]) -> None:
    data = load_preset("sikuliaq-like").canonical()
    data["run"] |= {"duration_h": 2.0}
    data["method"] = [data["method"][i % 3] | {"name": f"method {i}"} for i in range(8)]
    bench.resize(size)
    bench.put(Scenario.parse(data), "Design", origin="eight methods")
    panels = """n => [...document.querySelectorAll('.js-plotly-plot')].some(p => p.offsetParent !== null
      && p._fullLayout?.meta?.view === 'Design' && p._fullLayout[`xaxis${n}`])"""
    for budget, last in (("steady", 2), ("run", 4)):
        bench.show(budget=budget)
        bench.page.wait_for_function(panels, arg=last)
        bench.page.wait_for_function("look.drawn")
        assert bench.page.evaluate("look.met", "Design") == []
        assert bench.page.evaluate("look.textOutside") == []


# ------------------------------------------------------------ misprints


def drawn(bench: Bench, id: str, shown: str) -> list[Any]:
    """Choose a misprint and a form of it; return name, dash and length of its curves, once they are drawn."""
    found = MISPRINTS[id]
    bench.choose("misprint", misprint_title(found))
    bench.choose("form shown", shown)
    return bench.page.wait_for_function("look.misprint", arg=[id, shown]).json_value()


def test_a_misprint_is_shown_as_printed_corrected_and_both(moving: Bench) -> None:
    moving.tab("Misprints")
    number, both = moving.run, drawn(moving, "zha-4.1", "both")
    assert [name for name, *_ in both] == ["K₂ = 156.063 (printed)", "K₂ = 202.52"]
    assert both[0][1] != "solid" and both[1][1] == "solid"
    assert drawn(moving, "zha-4.1", "as printed") == both[:1]
    assert drawn(moving, "zha-4.1", "corrected") == both[1:]
    words = moving.page.locator(".sb-misprint").inner_text()
    assert "K₂ = 156.063 for σ = 0.0088" in words and "as printed" in words
    assert moving.run == number


@pytest.mark.slow
def test_every_misprint_is_readable(moving: Bench) -> None:
    moving.tab("Misprints")
    for id in MISPRINTS:
        assert drawn(moving, id, "both"), id
        assert moving.page.evaluate("look.textOutside") == [], id
        words = moving.page.locator(".sb-misprint").inner_text()
        assert re.search(r"\b\w_\w|\de[+-]\d", words) is None, words
