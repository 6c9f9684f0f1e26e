"""What a slider does not move stays as it is, and what it moves is drawn as if it were drawn anew.

Only curves that have changed are sent: each page of a session still has all curves of the run.
"""

import base64
from typing import Any

import numpy as np
import pytest

from navcore.engine.measures import metrics
from schuler_bench.bridge.controls import in_single
from schuler_bench.editing import edits
from schuler_bench.session.display import CURVES
from schuler_bench.session.shown import shown
from schuler_bench.shell.reports import run_element
from schuler_bench.views.errors.view import error_curves
from schuler_bench.views.study.view import StudyView
from tests.browser.conftest import Another, Served
from tests.browser.driver import Bench

ZETA = "network.zeta"
# Titles and widths (px) of the figures, in the order in which they are drawn.
_DRAWN = """window.drawn = [];
addEventListener('drawn', ({target: {_fullLayout: {meta, width}}}) => drawn.push([meta.view, width]));"""
_LARGE = ".mantine-Modal-content .uplot canvas"


def drawn_as_anew(bench: Bench) -> None:
    """The lines in view are as plotly draws them when it draws the whole figure."""
    lines = bench.page.evaluate("look.paths")
    bench.page.evaluate("look.anew")
    for line, anew in zip(lines, bench.page.evaluate("look.paths"), strict=True):
        assert line == pytest.approx(anew, abs=0.02), "as plotly draws it"


def test_only_what_is_in_sight_is_drawn(another: Another) -> None:
    opened = another(1920, 1080)
    opened.page.add_init_script(_DRAWN)
    opened.open().settle()
    opened.heard()
    opened.plotly()
    drawn = opened.page.evaluate("window.drawn")
    assert {title for title, _ in drawn} == {"Frequency"}
    assert len({width for _, width in drawn}) == 1, "no figure is drawn before its width is known"
    opened.tab("Poles")
    opened.plotly()
    assert {title for title, _ in opened.page.evaluate("window.drawn")} == {"Frequency", "Poles"}


def test_an_axis_that_a_slider_step_changes_is_laid_out_alone(moving: Bench) -> None:
    page = moving.page
    moving.type(ZETA, "0.6")
    moving.plotly()
    before = page.evaluate("look.bodeAxes")
    page.evaluate("look.keep")
    for zeta in ("0.9", "1.6"):
        moving.type(ZETA, zeta)
        moving.plotly()
    axes = page.evaluate("look.bodeAxes")
    assert axes[1] != before[1], "otherwise nothing is shown here"
    assert page.evaluate("look.kept")
    assert page.evaluate("look.homes") == axes[1:3], "to which a double click goes back"
    labels = page.evaluate("look.labels")
    assert len(labels) > 3
    drawn_as_anew(moving)
    assert not page.evaluate("look.kept")
    assert (page.evaluate("look.bodeAxes"), page.evaluate("look.labels")) == (axes, labels)


def zoomed(bench: Bench, axes: str) -> tuple[Any, Any, tuple[float, float]]:
    """Zoom into the first panel in view; return its axes before and after, and its middle."""
    page, mouse = bench.page, bench.page.mouse
    box = page.locator(".js-plotly-plot:visible .nsewdrag").first.bounding_box()

    def at(part: float) -> tuple[float, float]:
        return box["x"] + part * box["width"], box["y"] + part * box["height"]

    home = page.evaluate(axes)
    mouse.move(*at(0.3))
    mouse.down()
    mouse.move(*at(0.7), steps=5)
    mouse.up()
    return home, bench.wait_for_change(lambda: page.evaluate(axes), home), at(0.5)


def axes_after_double_click(bench: Bench, axes: str, place: tuple[float, float]) -> Any:
    """Click twice; a busy page may take the second click too late for a double click."""
    bench.page.mouse.dblclick(*place)
    bench.settle()
    return bench.page.evaluate(axes)


def test_a_zoom_outlives_a_slider_step(moving: Bench) -> None:
    page = moving.page
    moving.press(ZETA)
    moving.plotly()
    _, axes, middle = zoomed(moving, "look.bodeAxes")
    for _ in range(3):
        moving.press(ZETA)
        moving.plotly()
    x_axis = page.evaluate("look.bodeAxes")[0]
    assert x_axis == pytest.approx(axes[0])

    moving.wait_until(lambda: axes_after_double_click(moving, "look.bodeAxes", middle)[0] != x_axis)


def test_a_double_click_goes_back_to_the_ranges_of_the_figure_that_is_shown(moving: Bench) -> None:
    """Both of a view's figures are drawn in one place: the first one's ranges would come back otherwise."""
    moving.show(poles="whole")
    moving.tab("Poles")
    moving.plotly()
    moving.show(poles="channel")
    moving.plotly()
    home, axes, middle = zoomed(moving, "look.mapAxes")

    assert axes != home
    moving.wait_until(lambda: axes_after_double_click(moving, "look.mapAxes", middle) == home)
    # one more leaves it there: all that is drawn, the ends of the rays with it, would be a point
    assert axes_after_double_click(moving, "look.mapAxes", middle) == home


@pytest.mark.slow
def test_of_two_hundred_steps_none_is_lost_and_everything_follows_at_rest(moving: Bench) -> None:
    session, thumb, start = moving.session, moving.slider(ZETA), moving.value(ZETA)
    session.pins.add(session.run, "sikuliaq-like")
    moving.press(ZETA)
    step = moving.value(ZETA) - start
    for key, count in (("ArrowRight", 119), ("ArrowLeft", 80)):
        for _ in range(count):
            thumb.press(key)
    moving.settle()
    before = moving.run, moving.digest
    for _ in range(3):  # nothing that is older comes after it
        moving.page.wait_for_timeout(400)
        assert (moving.run, moving.digest) == before
    zeta = edits.network_values(session.scenario, 2)["zeta"]
    assert (zeta, moving.value(ZETA)) == pytest.approx((start + 40 * step, start + 40 * step))
    assert float(thumb.get_attribute("aria-valuenow") or "nan") == pytest.approx(zeta, abs=0.006)
    assert moving.run == session.run_number and session.run.scenario == session.scenario
    assert f'data-digest="{moving.digest}"' in run_element(session.run, session.run_number)
    assert moving.metrics["methods"] == metrics(session.run)["methods"]
    assert moving.plotly()
    assert "moves" not in moving.status


def test_steps_that_a_busy_page_takes_late_are_not_lost(moving: Bench) -> None:
    start = moving.value(ZETA)
    moving.press(ZETA)
    wanted = start + 7 * (moving.value(ZETA) - start)
    moving.page.evaluate("look.busy", moving.id(ZETA))
    moving.settle()
    assert moving.value(ZETA) == pytest.approx(wanted)
    assert edits.network_values(moving.session.scenario, 2)["zeta"] == pytest.approx(wanted)


def test_a_curve_of_hairlines_is_as_wide_as_its_line(bench: Bench) -> None:
    for width in (1.5, 2.0):
        found = bench.page.evaluate("look.ink", width)
        assert found["left"] == width, "for the next curve"
        assert not found["same"] and 0.8 < found["ratio"] < 1.1
    for width in (1.0, 3.0):
        assert bench.page.evaluate("look.ink", width)["same"], "drawn as it is"


def test_the_picture_of_a_curve_that_stands_still_is_the_curve(bench: Bench) -> None:
    found = bench.page.evaluate("look.still")
    first, second, third, red = found["apart"]
    assert first == 0
    assert max(second, third) <= 8, "of 255: but for rounding where the hairlines overlap"
    assert red > 100, "another color is another picture"
    assert found["left"] == [[0.5, 0.5]] * 4, "for the next curve"


def test_of_a_block_of_html_only_what_differs_is_made_anew(moving: Bench) -> None:
    moving.press(ZETA)
    page, undo = moving.page, moving.page.locator("[data-command=undo]")
    page.evaluate("look.mark")
    marked, title = page.evaluate("look.marked"), undo.get_attribute("title")
    assert len(marked) > 8 and all(marked)
    moving.press(ZETA)
    moving.wait_for_change(lambda: undo.get_attribute("title"), title)
    assert page.evaluate("look.marked") == marked


def test_html_that_is_put_into_the_page_in_pieces_is_the_whole(bench: Bench) -> None:
    found = bench.page.evaluate("look.fill")
    assert found["stays"]
    assert found["seen"] == [
        '<p title="a" lang="en">one <b>1</b></p><i>two</i>',
        '<p title="b">one <b>2</b></p><i>two</i>',
        '<p title="b">one <b>3</b></p><i>zwei</i>',
        '<p title="b">one</p><u>two</u><i>two</i>',
        '<p title="b">one</p><s>two</s><i>three</i>',
        '<button data-command="undo">four</button>',
        '<button data-command="redo">four</button>',
    ]
    assert not found["pressed"], "what does something else is another button"
    assert found["other"] == "<i>four</i>"


# ------------------------------------------------------------ curves of each page


def wrong_curves(page: Bench) -> list[str]:
    """Name the curves of the session's run that a page does not show, or shows otherwise."""
    plots = error_curves(shown(page.session), CURVES["overview"]).plots.values()
    found, wrong = page.page.evaluate("look.curves"), []
    for plot in plots:
        label, names = plot.axes()[1]["label"], ("time", *plot.names)
        held = [np.frombuffer(base64.b64decode(curve), np.float32) for curve in found.get(label, ())]
        if len(held) != len(names):
            wrong.append(f"{label}: {len(held)} curves")
            continue
        each = zip(names, held, in_single(plot.data), strict=True)
        wrong += [f"{label}: {name}" for name, *pair in each if not np.array_equal(*pair, equal_nan=True)]
    return wrong


def has_all_curves(page: Bench) -> None:
    """Wait until a page shows the session's run, which is not to change meanwhile."""
    assert page.session.wait_idle(60.0)
    try:
        page.wait_until(lambda: wrong_curves(page) == [])
    except AssertionError as error:
        raise AssertionError(f"{wrong_curves(page)}: {error}") from None


def test_every_page_has_all_curves_after_a_drag_and_after_its_connection_was_lost(
    moving: Bench, another: Another, dashboard: Served
) -> None:
    moving.press(ZETA)
    has_all_curves(moving)
    (first,) = moving._pages

    moving.page.evaluate("look.drag", moving.id(ZETA))
    late = another(1920, 1080).open(path=f"s/{moving.session_id}/")
    moving.page.evaluate("() => clearInterval(window.drag)")
    moving.settle()
    has_all_curves(moving)
    has_all_curves(late)

    (second,) = (view for view in late._pages if view is not first)
    websockets: Any = dashboard[0].viser._websock_server
    lost = websockets._live_connections[second.client.client_id]
    lost.loop.call_soon_threadsafe(lost.transport.abort)
    # Meanwhile the session goes on; viser's page connects again by itself.
    moving.press(ZETA)
    late.wait_until(lambda: second not in late._pages and len(late._pages) > 1)
    has_all_curves(late)
    moving.press(ZETA)
    has_all_curves(moving)
    has_all_curves(late)
    late.faults.clear()


def test_a_curve_that_stands_still_keeps_its_path(moving: Bench) -> None:
    moving.press(ZETA)
    moving.page.evaluate("look.samePaths")
    moving.press(ZETA)
    assert moving.page.evaluate("look.samePaths") == [
        True,
        True,
        False,
    ]  # free, classic2, the selected method
    moving.press(ZETA, "ArrowLeft")
    has_all_curves(moving)


def test_a_plot_in_its_large_window_follows_the_run(moving: Bench) -> None:
    page, session, plot = moving.page, moving.session, moving.page.locator(".uplot-container").first
    plot.hover(position={"x": 30, "y": 30})
    plot.locator("button").click()
    page.wait_for_selector(_LARGE)
    small, large = (page.locator(each).first.bounding_box() for each in (".uplot canvas", _LARGE))
    assert small and large and all(large[side] > 1.5 * small[side] for side in ("width", "height"))
    before = page.evaluate(f"document.querySelector('{_LARGE}').toDataURL()")
    session.change(edits.with_value(session.scenario, ("method", 2, "network", "zeta"), 1.2), None)
    changed = f"before => document.querySelector('{_LARGE}').toDataURL() !== before"
    page.wait_for_function(changed, arg=before)
    page.keyboard.press("Escape")
    page.wait_for_selector(_LARGE, state="detached")


def test_a_tab_behind_others_catches_up_when_it_comes_to_the_front(moving: Bench, dashboard: Served) -> None:
    session = moving.session
    page = next(page for page in dashboard[1]._pages.values() if page.session.id == session.id)
    study = next(view for view in page._views if isinstance(view, StudyView))
    before = study._over.options
    with moving.next_run():
        unity = {"id": "unity2", "zeta": 0.5}
        session.change(edits.with_value(session.scenario, ("method", 2, "network"), unity), None)
    assert study._over.options == before, "nobody sees them"
    moving.tab("Study")
    assert {*study._options("study_x")} == {*study._over.options} != {*before}
