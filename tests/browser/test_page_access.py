"""The page for everybody: names, roles, keys, focus and contrast; light and dark; every control explained."""

from __future__ import annotations

import io
from collections.abc import Iterator
from importlib.resources import files
from typing import Any

import numpy as np
import pytest

from app.plots.style import INK, method_color
from app.views.appearance.view import DARK
from tests import dark_page as theme
from tests.browser.driver import Bench
from tests.browser.fields import label_of
from tests.browser.test_page_layout import SIZES, resize

pytestmark = pytest.mark.browser

RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]
_NAMED = """() => [...document.querySelectorAll('[role=slider]')].every(s => s.ariaLabel)
  && [...document.querySelectorAll('.js-plotly-plot, .uplot')].every(p => p.ariaLabel)"""


@pytest.fixture(scope="module")
def axe() -> str:
    """axe-core, as the tests' packages bring it."""
    return files("axe_playwright_python").joinpath("axe.min.js").read_text(encoding="utf-8")


@pytest.fixture
def light(bench: Bench) -> Iterator[Bench]:
    """The shared page with a preset; light again afterwards."""
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Method", "Frequency", "Errors")
    yield bench
    bench.show(theme="light")
    bench.page.wait_for_selector("#sb-theme[data-theme=light]", state="attached")
    bench.page.keyboard.press("Escape")


def violations(bench: Bench, axe: str) -> list[str]:
    """What axe-core finds wrong on the page as it is now."""
    bench.page.wait_for_function(_NAMED)
    bench.page.evaluate(f"() => {{ if (!window.axe) {{ {axe} }} }}")
    found: dict[str, Any] = bench.page.evaluate("rules => axe.run(document, {runOnly: rules})", RULES)
    return [f"{v['id']}: {node['html'][:160]}" for v in found["violations"] for node in v["nodes"]]


@pytest.mark.parametrize(
    "tabs",
    [
        ("Method", "Frequency", "Errors"),
        ("Sensors", "Poles", "Metrics"),
        ("Learn", "Step", "Scenario"),
        ("View", "Misprints", "Requirements"),
        ("Log", "Poles", "Compare"),
        ("Run", "Step", "Spectrum"),
    ],
    ids=lambda tabs: tabs[0],
)
def test_axe_finds_nothing_wrong(light: Bench, axe: str, tabs: tuple[str, ...]) -> None:
    light.tab(*tabs)
    found = violations(light, axe)
    for _ in range(10):
        if not found:
            break
        light.page.wait_for_timeout(1000)  # names are given every 0.7 s
        found = violations(light, axe)
    assert found == []


def test_a_slider_says_its_name_and_its_value_with_the_box(light: Bench) -> None:
    light.tab("Sensors")
    slider = light.page.get_by_role("slider", name=label_of("imu.gyro_arw_dpsh"), exact=True)
    box = light.box("imu.gyro_arw_dpsh")
    light.page.wait_for_function(
        "([slider, box]) => slider.getAttribute('aria-valuetext') === box.value",
        arg=[slider.element_handle(), box.element_handle()],
    )


def test_plots_say_what_they_show(light: Bench) -> None:
    light.page.wait_for_function(_NAMED)
    names = light.page.evaluate("() => [...document.querySelectorAll('[role=figure]')].map(f => f.ariaLabel)")
    assert any("Damping network H" in name and "complementary" in name for name in names)
    assert any(name.startswith("Plot over time: δVE (m/s)") and "classic2" in name for name in names)


def test_the_focus_is_seen(light: Bench) -> None:
    light.page.get_by_role("tab", name="Method", exact=True).focus()
    seen = set()
    for _ in range(6):
        light.page.keyboard.press("Tab")
        style = light.page.evaluate(
            """() => {
              const style = getComputedStyle(document.activeElement);
              return [style.outlineStyle, style.outlineWidth];
            }"""
        )
        seen.add(light.page.evaluate("() => document.activeElement.outerHTML.slice(0, 80)"))
        assert style[0] == "solid"
        assert float(style[1].removesuffix("px")) >= 2
    assert len(seen) == 6


def test_keys_on_a_control_do_not_move_the_camera(light: Bench) -> None:
    """viser listens to arrows and letters on the whole document."""
    reached = """() => {
      window.reached = [];
      document.addEventListener('keydown', event => window.reached.push(event.code), {once: false});
    }"""
    light.page.evaluate(reached)
    slider = light.slider("network.zeta")
    number = light.run
    slider.press("ArrowRight")
    light.wait_for_run(number)
    light.page.get_by_role("tab", name="Method", exact=True).press("ArrowDown")
    light.page.locator("body").press("d")
    light.page.wait_for_selector("#sb-theme[data-theme=dark]", state="attached")
    light.page.evaluate("() => document.activeElement.blur()")
    light.page.keyboard.press("ArrowUp")
    assert light.page.evaluate("() => window.reached") == ["ArrowUp"]


# ------------------------------------------------------------ light and dark


def pixels(bench: Bench, selector: str) -> np.ndarray:
    """Colours of an element as the screen shows them, shape (n, 3), 0..1."""
    from PIL import Image

    shot = bench.page.locator(selector).first.screenshot()
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB"), dtype=float).reshape(-1, 3) / 255.0


def has(found: np.ndarray, color: theme.Color) -> bool:
    """Whether a colour is among pixels, within what rounding and smoothing do."""
    return bool(np.any(np.max(np.abs(found - np.array(color)), axis=1) < 0.05))


@pytest.mark.parametrize("by", ["key", "switch"])
def test_the_whole_page_turns_dark_and_methods_keep_their_colours(light: Bench, by: str) -> None:
    before = light.run
    if by == "key":
        light.page.locator("body").press("d")
    else:
        light.tab("View")
        light.page.locator(f"[id='{light.id(DARK)}']").click(force=True)
    light.page.wait_for_selector("#sb-theme[data-theme=dark]", state="attached")
    assert light.session.display.theme == "dark"
    light.settle()
    ground = theme.shown("#FFFFFF", "dark")
    for selector in (".uplot", ".js-plotly-plot:visible"):
        found = np.array(light.wait_for_change(lambda selector=selector: pixels(light, selector).tolist()))
        assert np.max(np.abs(np.median(found, axis=0) - np.array(ground))) < 0.02
        for method in range(3):
            assert has(found, theme.shown(method_color(method), "dark")), (selector, method)
    controls = pixels(light, "#sb-status")
    assert has(controls, ground)
    text = max(theme.contrast((r, g, b), ground) for r, g, b in np.unique(controls.round(2), axis=0))
    assert text > 0.8 * theme.contrast(theme.shown(INK, "dark"), ground)
    assert light.run == before


def test_the_theme_survives_a_reload(light: Bench) -> None:
    light.page.locator("body").press("d")
    light.page.wait_for_selector("#sb-theme[data-theme=dark]", state="attached")
    light.page.reload()
    light.page.wait_for_selector("#sb-theme[data-theme=dark]", state="attached")
    light.page.wait_for_selector("#sb-run[data-run]", state="attached")
    light.page.locator("body").press("d")
    light.page.wait_for_selector("#sb-theme[data-theme=light]", state="attached")


# ------------------------------------------------------------ explanations


def explained(bench: Bench, name: str) -> str:
    panel = bench.page.locator("#sb-explain")
    panel.locator("h2", has_text=label_of(name)).wait_for()
    return panel.inner_text()


def test_a_control_is_explained_by_key_mark_and_focus(light: Bench) -> None:
    page = light.page
    light.slider("network.zeta").focus()
    page.keyboard.press("e")
    told = explained(light, "network.zeta")
    assert "Must be > 0 and <= 10 (no unit)" in told
    assert "Liu 2021, eq. 5 and 11" in told
    assert page.locator("#sb-explain math").count() == 1
    # an open panel follows the focus, also into a box, where "e" is a letter
    light.tab("Sensors")
    light.box("imu.gyro_bias_dph.0").focus()
    assert "0.6 nmi/h" in explained(light, "imu.gyro_bias_dph.0")
    page.keyboard.press("Escape")
    page.locator("#sb-explain").wait_for(state="detached")
    page.locator(f"label[for='{light.id('imu.gyro_bias_dph.2')}']").hover()
    page.get_by_role("button", name=f"Explain {label_of('imu.gyro_bias_dph.2')}").click()
    explained(light, "imu.gyro_bias_dph.2")
    page.get_by_role("button", name="Close the explanation").click()
    page.locator("#sb-explain").wait_for(state="detached")


def test_a_control_that_is_no_field_is_explained_by_its_hint(light: Bench) -> None:
    light.box("scenario").focus()
    light.page.keyboard.press("F1")
    assert "A preset, or what was uploaded" in explained(light, "scenario")
    light.page.keyboard.press("Escape")
    light.page.locator("#sb-explain").wait_for(state="detached")


@pytest.mark.parametrize("size", SIZES, ids=str)
def test_lesson_and_explanation_fit_the_window(light: Bench, size: tuple[int, int]) -> None:
    page = light.page
    try:
        resize(light, size)
        light.tab("Learn")
        if page.locator("[data-command='lesson list']").count():
            page.locator("[data-command='lesson list']").click()
        page.locator("[data-command='lesson open 4']").click()
        page.locator(".sb-lesson h3").wait_for()
        wide = page.evaluate(
            "() => [...document.querySelectorAll('.sb-lesson')].map(e => e.scrollWidth - e.clientWidth)"
        )
        assert max(wide) <= 0
        rows = page.evaluate(
            """() => {
              const boxes = [...document.querySelectorAll('[role=tab]')].map(t => t.getBoundingClientRect());
              return new Set(boxes.filter(b => b.left < innerWidth / 3).map(b => Math.round(b.top))).size;
            }"""
        )
        assert rows == 1, "the tabs of the left column stand in one row"
        light.box("scenario").focus()
        page.keyboard.press("F1")
        explained(light, "scenario")
        box = page.locator("#sb-explain").bounding_box()
        assert box["x"] >= 0.2 * size[0] * 0.9
        assert box["x"] + box["width"] <= size[0]
        assert box["y"] >= 0
        assert box["y"] + box["height"] <= size[1] - 60, "it leaves the playback free"
    finally:
        page.keyboard.press("Escape")
        resize(light, SIZES[0])
