"""The page's own font; without it, the layout in a wide one, and at a zoom of 125 %."""

import os
import re
from collections.abc import Callable, Iterator
from functools import cache
from itertools import product
from pathlib import Path

import pytest
from fontpkg_arimo import FAMILY
from playwright.sync_api import Browser

from tests.browser import test_page_layout as layout
from tests.browser import test_page_scene as scene
from tests.browser import test_page_touch as touch
from tests.browser.cases import SIZES, first_of
from tests.browser.conftest import Served
from tests.browser.driver import Bench
from tests.browser.windows import test_comparing as comparing
from tests.browser.windows import test_opening as opening
from tests.browser.windows import test_sharing as sharing
from tests.browser.windows.seeing import see
from tools.chromium import FLAGS
from tools.fonts import FONTS, WIDE, one_font

TABLET = touch.WIDTH, touch.HEIGHT
TABLETS = TABLET, (1024, 768), (768, 1024)
SMALL = 1024, 576


@pytest.fixture(scope="module")
def wide(browser: Browser, chromium: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """A browser that has the wide font only."""
    font = one_font(WIDE, tmp_path_factory.mktemp("font"))
    if not font:
        pytest.skip(f"no {WIDE} here (Debian: apt-get install {FONTS[WIDE][1]})")
    launched = browser.browser_type.launch(executable_path=chromium, args=list(FLAGS), env=os.environ | font)
    yield launched
    launched.close()


@pytest.fixture(scope="module")
def opened(wide: Browser, dashboard: Served) -> Callable[[float, bool], Bench]:
    """Pages that are refused the page's font, one for each zoom and pointer, which stay open."""

    @cache
    def page(zoom: float, touch: bool) -> Bench:
        context = wide.new_context(device_scale_factor=zoom, has_touch=touch)
        context.route("**/arimo.*.ttf", lambda route: route.abort())
        return Bench(context.new_page(), dashboard[0].url, dashboard[1].sessions).open()

    return page


@pytest.fixture
def lettered(request: pytest.FixtureRequest, opened: Callable[[float, bool], Bench]) -> Iterator[Bench]:
    """A page in the wide font, of a window and a zoom that the test names; on a ship under way."""
    size, zoom = request.param
    bench = opened(zoom, size in TABLETS)
    width, height = bench.size = round(size[0] / zoom), round(size[1] / zoom)
    bench.page.set_viewport_size({"width": width, "height": height})
    bench.heard()
    bench.clean()
    bench.reset("sikuliaq-like", "Method", "Errors", selected=2)
    assert re.search(r" 1\.1[0-9]", bench.page.evaluate("schuler.state()")), "a tenth wider than Arial"
    yield bench
    assert bench.faults == []


def test_the_page_brings_its_font(wide: Browser, dashboard: Served) -> None:
    """It is as wide as Arial where the system has a wide one only."""
    context = wide.new_context(viewport={"width": 1366, "height": 768})
    bench = Bench(context.new_page(), dashboard[0].url, dashboard[1].sessions).open()
    bench.heard()
    assert bench.page.evaluate("schuler.state()").startswith("1366x768|")
    used = "() => [...document.fonts].map(font => [font.family, font.status])"
    assert bench.page.evaluate(used) == [[FAMILY, "loaded"]]
    assert bench.page.evaluate("look.otherFonts", FAMILY) == []
    assert bench.faults == []
    context.close()


def test_a_font_that_does_not_come_holds_nothing_up(wide: Browser, dashboard: Served) -> None:
    context = wide.new_context(viewport={"width": 1366, "height": 768})
    asked: list[str] = []
    context.route("**/arimo.*.ttf", lambda route: asked.append(route.request.url))
    page = Bench(context.new_page(), dashboard[0].url, dashboard[1].sessions).page
    page.goto(f"{dashboard[0].url}?fixedDpr=0.25&start=no", wait_until="commit")
    page.wait_for_function("() => document.querySelector('#sb-run[data-run]') && look.heard()")
    assert asked and re.match(r"1366x768 1\.1[0-9]\|", page.evaluate("schuler.state()"))
    context.close()


def in_windows(*windows: tuple[tuple[int, int], float]) -> pytest.MarkDecorator:
    """Run a test in windows with their zoom; what is slow, in all but the first."""
    return pytest.mark.parametrize("lettered", first_of(windows), ids=str, indirect=True)


@in_windows(*product((SIZES[2], SIZES[0]), (1.0, 1.25)))
def test_every_tab_has_room_for_its_texts(lettered: Bench) -> None:
    layout.test_every_tab_fits_its_panel(lettered)
    opening.test_every_tab_says_what_to_look_for(lettered)
    if lettered.size == SIZES[0]:
        scene.test_a_narrow_readout_lies_clear_of_the_buttons(lettered)


@pytest.mark.slow
@in_windows((SIZES[2], 1.0))
def test_rows_and_tables_have_room_for_their_texts(lettered: Bench) -> None:
    comparing.test_the_table_of_metrics_is_whole_rounded_aligned_and_marks_the_best(lettered)
    lettered.tab("Compare")
    lettered.button("Pin this run").click()
    see(lettered, lettered.page.locator(".sb-pins tbody tr").last)
    sharing.test_presentation_size_is_large_folded_and_whole(lettered)
    layout.test_tabs_tools_and_boxes_stand_in_one_row(lettered)


@in_windows((TABLET, 1.0))
def test_fingers_have_room(lettered: Bench) -> None:
    touch.test_fingers_have_room_and_nothing_is_cut(lettered)


@in_windows(*((size, 1.0) for size in (*TABLETS[1:], SMALL)))
def test_a_narrow_window_cuts_no_text_and_breaks_no_word(lettered: Bench) -> None:
    lettered.tab("Compare")
    lettered.button("Pin this run").click()
    lettered.page.locator(".sb-pins tbody tr").nth(1).wait_for(state="attached")
    for tab in ("Compare", "Method", "Log", "Tune"):
        lettered.tab(tab)
        layout.wait_until_it_fits(lettered, tab, scrolls=tab != "Tune" or lettered.size[0] < 1000)
        assert lettered.page.evaluate("look.clipped") == [], tab
        if tab == "Compare":
            assert lettered.page.evaluate("look.broken", ".sb-pins") == []
