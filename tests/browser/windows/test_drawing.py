"""While the hand moves: what is in front follows, the rest is marked, and at rest all is of one run."""

from tests.browser.driver import Bench
from tests.browser.test_page_redraw import drawn_as_anew
from tests.browser.windows.seeing import read, see, speaks


def test_what_is_in_front_follows_a_drag_and_the_rest_is_marked(window: Bench) -> None:
    page, number = window.page, window.run
    see(window, window.slider("network.zeta"))
    moving = window.said("The slider moves")
    page.evaluate("look.hold", window.id("network.zeta"))
    try:
        page.wait_for_function(
            "([before, moving]) => look.firstCurve() !== before && look.status() === moving",
            arg=[page.evaluate("look.firstCurve"), moving],
        )
    finally:
        page.evaluate("() => clearInterval(window.hand)")
    window.wait_for_run(number)
    window.settle()
    page.wait_for_function("moving => look.status() !== moving", arg=moving)
    window.settle()
    assert window.run == window.session.run_number
    read(window, page.locator("#sb-status"))
    speaks(window, moving)


def test_a_step_moves_the_lines_of_the_bode_plot_without_a_layout(window: Bench) -> None:
    page = window.page
    window.tab("Frequency")
    see(window, page.locator(".js-plotly-plot:visible"))
    window.press("network.zeta")
    window.plotly()
    page.evaluate("look.countLayouts")
    before, in_place = page.evaluate("look.paths"), 0
    for _ in range(4):
        was = page.evaluate("window.laidOut")
        window.press("network.zeta")
        window.plotly()
        in_place += page.evaluate("window.laidOut") == was
    assert in_place >= 2, "an axis may be laid out anew now and then, not at each step"
    assert page.evaluate("look.paths") != before
    held = window.plotly()
    drawn_as_anew(window)
    assert window.plotly() == held, "plotly holds the numbers that are drawn"


def test_a_tab_that_was_behind_shows_the_present_run(window: Bench) -> None:
    window.tab("Poles", "Metrics")
    window.press("network.zeta")
    window.tab("Step", "Errors")
    window.press("network.zeta")
    for tab in ("Step", "Frequency", "Poles"):
        window.tab(tab)
        assert window.plotly(), "of the run that is shown"
        see(window, window.page.locator(".js-plotly-plot:visible"))
    assert window.run == window.session.run_number
