"""The page for everybody: names, roles, keys, focus and contrast; light and dark; every control explained."""

import io
from importlib.resources import files
from typing import Any

import numpy as np
import pytest
from PIL import Image

from schuler_bench.plots.style import INK, method_color
from schuler_bench.shell.layout import layout_for
from schuler_bench.views.appearance.view import COLORS
from tests import dark_page as theme
from tests.browser.cases import SWEEP, first_of
from tests.browser.driver import Bench
from tests.browser.fields import label_of

RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]


@pytest.fixture(scope="module")
def axe() -> str:
    """axe-core, as the tests' packages bring it."""
    return files("axe_playwright_python").joinpath("axe.min.js").read_text(encoding="utf-8")


def violations(bench: Bench, axe: str) -> list[str]:
    """What axe-core finds wrong on the page as it is now."""
    bench.page.wait_for_function("look.named")
    if bench.page.evaluate("() => window.axe === undefined"):
        bench.page.evaluate(f"() => {{ {axe} }}")
    # what else axe finds is thousands of elements
    ask = "runOnly => axe.run(document, {runOnly, resultTypes: ['violations']}).then(all => all.violations)"
    found: list[dict[str, Any]] = bench.page.evaluate(ask, RULES)
    return [f"{v['id']}: {node['html'][:160]}" for v in found for node in v["nodes"]]


TABS = [
    ("Method", "Frequency", "Errors"),
    ("Sensors", "Poles", "Metrics"),
    ("Learn", "Step", "Scenario"),
    ("View", "Misprints", "Requirements"),
    ("Log", "Compare"),
    ("Run", "Spectrum"),
    ("Motion",),
    ("Files", "Diagram", "Design"),
    ("Tune",),
    ("Sweep",),
    ("Study",),
]
"""Tabs that are in front together, so that every tab is once."""


def settled_violations(bench: Bench, axe: str) -> list[str]:
    """What axe-core goes on finding once all names are given, which takes up to a second."""
    found: list[str] = []
    for _ in range(10):
        found = violations(bench, axe)
        if not found:
            break
        bench.page.wait_for_timeout(1000)
    return found


@pytest.mark.parametrize("tabs", first_of(TABS), ids=lambda tabs: tabs[0])
def test_axe_finds_nothing_wrong(moving: Bench, axe: str, tabs: tuple[str, ...]) -> None:
    moving.tab(*tabs)
    assert settled_violations(moving, axe) == []


@pytest.mark.slow
@pytest.mark.parametrize("look", ["dark", "forced colours", "Chinese"])
def test_axe_finds_nothing_wrong_in_other_colours_and_in_chinese(
    request: pytest.FixtureRequest, moving: Bench, axe: str, look: str
) -> None:
    bench = moving
    if look == "Chinese":
        bench = request.getfixturevalue("chinese")
        bench.clean()
        bench.reset("sikuliaq-like", "Method", "Errors", selected=2)
    media: Any = {"dark": {"color_scheme": "dark"}, "forced colours": {"forced_colors": "active"}}.get(
        look, {}
    )
    bench.page.emulate_media(**media)
    try:
        found = {}
        for tabs in TABS:
            bench.tab(*tabs)
            found[tabs] = settled_violations(bench, axe)
    finally:
        bench.page.emulate_media(color_scheme="light", forced_colors="none")
    assert {tabs: wrong for tabs, wrong in found.items() if wrong} == {}


def test_sliders_and_plots_say_what_they_are_and_show(moving: Bench) -> None:
    page = moving.page
    page.wait_for_function("look.named")
    names = page.evaluate("() => [...document.querySelectorAll('[role=figure]')].map(f => f.ariaLabel)")
    assert any("Damping network H" in name and "complementary" in name for name in names)
    assert any(name.startswith("Plot over time: |δV| (m/s)") and "classic2" in name for name in names)
    moving.tab("Sensors")
    slider = page.get_by_role("slider", name=label_of("imu.gyro_arw_dpsh"), exact=True)
    page.wait_for_function(
        "([slider, box]) => slider.getAttribute('aria-valuetext') === box.value",
        arg=[slider.element_handle(), moving.box("imu.gyro_arw_dpsh").element_handle()],
    )


def test_the_focus_is_seen(moving: Bench) -> None:
    moving.page.get_by_role("tab", name="Method", exact=True).focus()
    seen = []
    for _ in range(6):
        moving.page.keyboard.press("Tab")
        seen.append(tuple(moving.page.evaluate("look.focus")))
    assert {(style, wide) for style, wide, _ in seen} == {("solid", True)}
    assert len({element for *_, element in seen}) == 6


def test_the_first_slider_is_two_keys_away(moving: Bench) -> None:
    page, skip = moving.page, moving.page.locator("#sb-skip")
    assert page.evaluate("() => document.body.firstElementChild.id") == "sb-skip", "Tab leads to it first"
    skip.focus()
    box = skip.bounding_box()
    assert box is not None and box["y"] >= 0.0, "seen while it has the focus"
    page.keyboard.press("Enter")
    assert page.evaluate("() => document.activeElement.ariaLabel") == moving.said("damping ratio ζ")


def test_keys_on_a_control_do_not_move_the_camera(moving: Bench) -> None:
    """viser listens to arrows and letters on the whole document."""
    page = moving.page
    page.evaluate("look.reached")
    moving.press("network.zeta")
    page.get_by_role("tab", name="Method", exact=True).press("ArrowDown")
    page.locator("body").press("d")
    page.wait_for_selector("#sb-theme[data-theme=opposite]", state="attached")
    page.evaluate("() => document.activeElement.blur()")
    page.keyboard.press("ArrowUp")
    assert page.evaluate("() => window.reached") == ["ArrowUp"]


# ------------------------------------------------------------ light and dark


def pixels(bench: Bench, selector: str) -> np.ndarray:
    """Colours of an element as the screen shows them, shape (n, 3), 0..1."""
    shot = bench.page.locator(selector).first.screenshot()
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB"), dtype=float).reshape(-1, 3) / 255.0


def has(found: np.ndarray, color: theme.Color) -> bool:
    """Whether a colour is among pixels, within what rounding and smoothing do."""
    return bool(np.any(np.max(np.abs(found - np.array(color)), axis=1) < 0.05))


def test_the_whole_page_turns_dark_and_methods_keep_their_colours(moving: Bench) -> None:
    page, before, ground = moving.page, moving.run, theme.shown("#FFFFFF", "dark")
    for wanted in ("opposite", "system"):  # by the key there and back
        page.locator("body").press("d")
        page.wait_for_selector(f"#sb-theme[data-theme={wanted}]", state="attached")
    moving.tab("View")
    moving.choose(COLORS, "dark")
    page.wait_for_selector("#sb-theme[data-theme=dark]", state="attached")
    assert moving.session.display.theme == "dark"
    moving.settle()
    for selector in (".uplot", ".js-plotly-plot:visible"):
        found = np.array(moving.wait_for_change(lambda selector=selector: pixels(moving, selector).tolist()))
        assert np.max(np.abs(np.median(found, axis=0) - np.array(ground))) < 0.02
        shown = {method.name for method in moving.session.scenario.method}
        for name, place in moving.session.display.places:  # also of scenarios that were opened before
            assert name not in shown or has(found, theme.shown(method_color(place), "dark")), (selector, name)
    controls = pixels(moving, "#sb-status")
    assert has(controls, ground)
    text = max(theme.contrast((r, g, b), ground) for r, g, b in np.unique(controls.round(2), axis=0))
    assert text > 0.8 * theme.contrast(theme.shown(INK, "dark"), ground)
    assert moving.run == before


def test_the_page_is_dark_where_the_system_is(moving: Bench) -> None:
    page = moving.page

    def filtered() -> str:
        return page.evaluate("() => getComputedStyle(document.documentElement).filter")

    try:
        assert filtered() == "none"
        page.emulate_media(color_scheme="dark")
        assert filtered().startswith("invert")
        page.locator("body").press("d")  # the other way round
        page.wait_for_selector("#sb-theme[data-theme=opposite]", state="attached")
        assert filtered() == "none"
        page.emulate_media(color_scheme="light")
        assert filtered().startswith("invert")
    finally:
        page.emulate_media(color_scheme="light")


# ------------------------------------------------------------ explanations


def explained(bench: Bench, name: str) -> str:
    panel = bench.page.locator("#sb-explain")
    panel.locator("h2", has_text=label_of(name)).wait_for()
    return panel.inner_text()


def test_a_control_is_explained_by_key_mark_and_focus(moving: Bench) -> None:
    page, panel = moving.page, moving.page.locator("#sb-explain")
    moving.slider("network.zeta").focus()
    page.keyboard.press("e")
    told = explained(moving, "network.zeta")
    assert "Must be > 0 and <= 10 (no unit)" in told and "Liu 2021, eq. 5 and 11" in told
    assert panel.locator("math").count() == 1
    # an open panel follows the focus, also into a box, where "e" is a letter
    moving.tab("Sensors")
    moving.box("imu.gyro_bias_dph.0").focus()
    assert "0.6 nmi/h" in explained(moving, "imu.gyro_bias_dph.0")
    page.keyboard.press("Escape")
    panel.wait_for(state="detached")
    page.locator(f"label[for='{moving.id('imu.gyro_bias_dph.2')}']").hover()
    moving.button(f"Explain {label_of('imu.gyro_bias_dph.2')}").click()
    explained(moving, "imu.gyro_bias_dph.2")
    moving.button("Close the explanation").click()
    panel.wait_for(state="detached")
    # one that is no field is explained by its hint
    moving.box("scenario").focus()
    page.keyboard.press("F1")
    assert "A preset, or what was uploaded" in explained(moving, "scenario")


@pytest.mark.parametrize("size", SWEEP, ids=str)
def test_lesson_and_explanation_fit_the_window(moving: Bench, size: tuple[int, int]) -> None:
    page = moving.page
    moving.resize(size)
    moving.tab("Learn")
    page.locator("[data-command='lesson open 4']").click()
    page.locator(".sb-lesson h3").wait_for()
    assert max(page.evaluate("look.tooWide")) <= 0
    assert page.evaluate("look.tabRows") == 1, "the tabs of the left column stand in one row"
    moving.box("scenario").focus()
    page.keyboard.press("F1")
    explained(moving, "scenario")
    box: Any = page.locator("#sb-explain").bounding_box()
    assert box["x"] >= layout_for(*size).left_px and box["x"] + box["width"] <= size[0]
    assert box["y"] >= 0
    assert box["y"] + box["height"] <= size[1] - 60, "it leaves the playback free"
