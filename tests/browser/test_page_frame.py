"""The frame of the page: top bar, strip of results, columns and their dividers, the folded 3D view."""

from typing import Any

import pytest
from playwright.sync_api import Locator

from navcore.engine.measures import measure
from schuler_bench.plots.units import relative
from schuler_bench.shell.layout import BAR_PX, RAIL_PX, STRIP_PX
from schuler_bench.shell.page import Page as OpenPage
from tests.browser.cases import SIZES, first_of
from tests.browser.conftest import Another
from tests.browser.driver import Bench
from tests.limits import require
from tools.paint.share import FRAMES, share


def box(found: Locator) -> dict[str, float]:
    """Where something lies in the window."""
    found.wait_for()
    lies: Any = found.bounding_box()
    assert lies is not None
    return dict(lies)


def server_side(bench: Bench) -> OpenPage:
    """The page as the server has it."""
    return bench._pages[-1]


@pytest.mark.parametrize(("size", "least"), [(SIZES[0], 0.48), (SIZES[1], 0.44)], ids=str)
def test_plots_fill_about_half_of_the_window(moving: Bench, size: tuple[int, int], least: float) -> None:
    moving.resize(size)
    moving.wait_until(lambda: share(moving.page) >= least)
    if size == SIZES[0]:
        frames = moving.page.evaluate(FRAMES)
        assert len(frames) == 5, "a Bode plot of four panels, four error plots"
        for across, down in frames:
            parts = 2.0 if across > 1000.0 else 1.0
            assert across / parts >= 520.0 and down / parts >= (170.0 if parts > 1.0 else 150.0), frames


@pytest.mark.parametrize("size", first_of([*SIZES, (1180, 820)]), ids=str)
def test_the_controls_begin_right_below_bar_and_strip(moving: Bench, size: tuple[int, int]) -> None:
    moving.resize(size)
    page = moving.page
    bar, strip = box(page.locator("[data-sb-holds~=topbar]")), box(page.locator("#sb-strip"))
    assert (bar["x"], bar["y"], bar["width"], bar["height"]) == (0, 0, size[0], BAR_PX)
    assert (strip["x"], strip["y"], strip["width"], strip["height"]) == (0, BAR_PX, size[0], STRIP_PX)
    tabs = box(page.get_by_role("tab", name="Method", exact=True))
    assert tabs["y"] - BAR_PX - STRIP_PX < 4
    assert box(page.locator(".sb-chips"))["y"] < BAR_PX + STRIP_PX + 70
    assert box(moving.slider("network.zeta"))["y"] <= 260
    for name in ("Undo", "Redo", "Share", "Present", "Menu", "Verify with full strapdown"):
        found = box(moving.button(name))
        assert found["y"] >= 0 and found["y"] + found["height"] <= BAR_PX, name
        assert found["x"] >= 0 and found["x"] + found["width"] <= size[0], name


def test_a_card_says_what_counts_and_selects_its_method(moving: Bench) -> None:
    page, run = moving.page, moving.session.run
    assert run is not None
    cards = page.locator("#sb-strip .sb-edit")
    for place, method in enumerate(run.methods):
        text = cards.nth(place).inner_text()
        assert method.method.name in text
        assert f"{measure(method, 'velocity_max_mps'):.3g}" in text
        assert f"{measure(method, 'tilt_max_arcsec') / 4.84813681109536e-06:.3g} arcsec" in text
    assert cards.nth(2).get_attribute("aria-pressed") == "true"
    moving.tab("Sensors")
    cards.nth(1).click()
    moving.wait_until(lambda: moving.session.selected == 1)
    page.wait_for_selector("#sb-strip .sb-result:nth-child(2) [aria-pressed=true]")
    moving.wait_for_front("Method")


def test_a_card_says_which_limits_are_met_and_what_has_changed_since_the_pin(moving: Bench) -> None:
    page, session = moving.page, moving.session
    require(moving, settling_s=1.0)
    card = page.locator("#sb-strip .sb-result").nth(2)
    card.get_by_text("0 of 1").wait_for()
    assert "misses settling" in (card.locator(".sb-fact").first.get_attribute("title") or "")
    assert "exceeds 2 % of it" in (card.locator(".sb-fact", has_text="settles").get_attribute("title") or "")
    assert session.run is not None
    session.pins.add(session.run, "sikuliaq-like", method="complementary")
    old = measure(session.run.methods[2], "settling_s")
    moving.type("network.zeta", "1.2")
    assert session.run is not None
    change = relative(measure(session.run.methods[2], "settling_s"), old)
    assert change
    card.get_by_text(change).wait_for()


def drag(bench: Bench, name: str, to: tuple[float, float]) -> None:
    """Pull a divider to a place of the window."""
    line = box(bench.page.get_by_role("separator", name=name))
    mouse = bench.page.mouse
    mouse.move(line["x"] + min(3, line["width"] / 2), line["y"] + min(3, line["height"] / 2))
    mouse.down()
    mouse.move(*to, steps=4)
    mouse.up()


def test_dividers_lay_the_page_out_anew_and_go_back(moving: Bench) -> None:
    page, plots = moving.page, moving.page.locator(".uplot").first
    before, plain = box(plots)["width"], server_side(moving).wanted_layout()
    try:
        drag(moving, "Width of the 3D view", (560, 500))
        moving.wait_until(lambda: abs(server_side(moving).wanted_layout().view_px[0] - 240) < 12)
        moving.heard()
        moving.wait_until(lambda: box(plots)["width"] > before + 60)
        upper = box(page.locator(".js-plotly-plot:visible").first)["height"]
        drag(moving, "Height of the upper plots", (1500, 700))
        moving.wait_until(lambda: box(page.locator(".js-plotly-plot:visible").first)["height"] > upper + 60)
        page.get_by_role("separator", name="Width of the controls").press("ArrowRight")
        moving.wait_until(lambda: server_side(moving).wanted_layout().left_px > 330)
    finally:
        for name in ("Width of the controls", "Width of the 3D view", "Height of the upper plots"):
            page.get_by_role("separator", name=name).press("Home")
            moving.heard()
    moving.wait_until(lambda: server_side(moving).wanted_layout() == plain)
    moving.wait_until(lambda: abs(box(plots)["width"] - before) < 3)


def test_a_tab_cannot_be_pulled_out_of_its_panel(moving: Bench) -> None:
    """A panel that floats over the page, as viser lets one, would lay nothing out anew."""
    page, tab = moving.page, box(moving.page.get_by_role("tab", name="Poles", exact=True))
    regions = """() => [...document.querySelectorAll('[data-dock-leaf]')]
      .map(each => each.getBoundingClientRect().width)"""
    before = page.evaluate(regions)
    page.mouse.move(tab["x"] + 20, tab["y"] + 12)
    page.mouse.down()
    page.mouse.move(tab["x"] - 300, tab["y"] + 300, steps=8)
    page.mouse.up()
    moving.heard()
    assert page.evaluate(regions) == before
    for grip in ("region-handle", "region-resize", "griphandle", "divider"):
        assert not page.locator(f"[data-dock-{grip}]").first.is_visible(), grip


def test_the_3d_view_folds_and_changes_places_with_the_plots(moving: Bench) -> None:
    page, view = moving.page, moving.page.locator("canvas[data-engine]")
    plain = box(view)["width"]
    moving.button("large 3D view").click()
    moving.wait_until(lambda: box(view)["width"] > 1000)
    moving.heard()
    assert box(page.locator("[data-dock-region=right]"))["width"] == pytest.approx(400, abs=12)
    moving.button("fold the 3D view").click()
    moving.wait_until(lambda: box(page.locator("#sb-stage"))["width"] == RAIL_PX)
    moving.heard()
    assert box(page.locator("[data-dock-region=right]"))["x"] == 320 + RAIL_PX
    moving.button("fold the 3D view").click()
    moving.wait_until(lambda: abs(box(view)["width"] - plain) < 3)
    moving.heard()


def test_menu_description_and_search_open_from_the_bar(moving: Bench) -> None:
    page, menu, about = moving.page, moving.page.locator("#sb-menu"), moving.page.locator("#sb-focus")
    moving.button("Menu").click()
    menu.wait_for()
    page.keyboard.press("Escape")
    menu.wait_for(state="hidden")
    moving.button("About the scenario").click()
    about.wait_for()
    assert "Sikuliaq" in about.inner_text()
    page.keyboard.press("Escape")
    page.locator("[data-palette]").click()
    page.get_by_placeholder("Search commands...").wait_for()
    page.keyboard.press("Escape")
    settings = page.get_by_text("Orbit Origin Tool")
    for state in ("visible", "hidden"):
        moving.button("Menu").click()
        menu.locator("[data-viewer]").click()
        settings.wait_for(state=state)


def test_who_presents_and_a_lesson_give_the_3d_view_the_room_of_the_plots(moving: Bench) -> None:
    width = "() => document.querySelector('[data-dock-region=\"right\"]').getBoundingClientRect().width"
    least = moving.page.evaluate(width)
    moving.tab("Poles")
    for large in (True, False):
        moving.button("Present").click()
        moving.page.wait_for_function(f"large => large === ({width})() < {least / 2}", arg=large)
    assert moving.page.evaluate("look.inFront", [moving.said("Poles")]), "the tabs in front stay"
    for lesson, large in (("5-foucault-beat", "view"), ("5-foucault-beat", "plots")):
        moving.session.show(None, lesson=lesson, large=large)
        moving.page.wait_for_function(f"large => large === ({width})() < {least / 2}", arg=large == "view")


def test_a_new_layout_keeps_the_tab_that_was_chosen_meanwhile(moving: Bench) -> None:
    """The server brings back the tabs that it has heard of; one that was chosen since stays in front."""
    moving.tab("Errors")
    page, server = moving.page, server_side(moving)
    with moving.session.lock:  # it does not hear of the tab yet
        page.evaluate("() => schuler.open(schuler.tab('Spectrum'))")
        page.wait_for_function("look.inFront", arg=["Spectrum"])
        server.commands.ask_page("front-again", "Method|Errors")
        server.client.flush()
        page.wait_for_function(
            "() => document.getElementById('sb-asked')?.dataset.asked.includes('Method|Errors')"
        )
        page.evaluate("look.nextFrame")
    moving.heard()
    assert page.evaluate("look.inFront", ["Spectrum"])


def test_a_window_that_is_too_small_says_so(another: Another) -> None:
    bench = another(390, 844)
    bench.page.goto(f"{bench.url}?start=no")
    told = bench.page.locator("#sb-too-small")
    told.wait_for()
    assert "700 px" in told.inner_text() and box(told) == {"x": 0, "y": 0, "width": 390, "height": 844}
    links = told.get_by_role("link").all()
    assert len(links) == 3 and all(box(link)["height"] >= 44 for link in links), "for a finger"
    session = bench.page.url.split("?")[0]
    told.get_by_role("link", name="Errors").click()
    bench.page.locator("[data-sb-alone] .uplot").first.wait_for()
    assert not told.is_visible(), "one view alone fits any window"
    assert bench.page.url.split("?")[0] == session and bench.page.locator("#sb-embed").count() == 0


def test_what_is_scrolled_away_does_not_show_through_the_tabs(moving: Bench) -> None:
    """Where a panel's tools stand beside its tabs, the panel reaches up behind these."""
    moving.resize(SIZES[1])
    moving.tab("Requirements")
    moving.tab("Design")
    moving.choose("show", "methods that meet the limits")
    panel = moving.page.locator("[data-sb-up] .mantine-ScrollArea-viewport:visible").last
    panel.evaluate("p => { p.firstElementChild.style.minHeight = '3000px'; p.scrollTop = 200; }")
    cut = """p => {
      const strip = p.closest('[data-dock-group]').querySelector('[data-dock-strip]').getBoundingClientRect();
      const cut = parseFloat(getComputedStyle(p).clipPath.match(/inset\\(([\\d.]+)px/)?.[1] ?? 0);
      return strip.bottom - p.getBoundingClientRect().top - cut;
    }"""
    moving.page.wait_for_function("p => p.dataset.sbScrolled !== undefined", arg=panel.element_handle())
    assert panel.evaluate(cut) <= 1.0
    panel.evaluate("p => { p.firstElementChild.style.minHeight = ''; p.scrollTop = 0; }")
    moving.page.wait_for_function("p => p.dataset.sbScrolled === undefined", arg=panel.element_handle())
    assert panel.evaluate("p => getComputedStyle(p).clipPath") == "none"
