"""The first five minutes and the languages; a new page in a browser of its own."""

from __future__ import annotations

import pytest

from tests.browser.driver import Bench
from tests.browser.test_page_start import _CLEAR, CARD
from tests.browser.windows.conftest import Open
from tests.browser.windows.seeing import read, see, speaks

pytestmark = pytest.mark.browser

_TITLES = "() => [...document.querySelectorAll('[role=tab]')].map(tab => tab.textContent)"
_VEILED = "() => document.getElementById('sb-veil') !== null"
# Buttons below the state of the run: each with its area and the colour of its ground.
_WEIGHTS = """() => [...document.querySelectorAll('.sb-row .sb-do')].filter(b => b.offsetParent !== null)
  .map(b => [b.dataset.command ?? '', b.offsetHeight, getComputedStyle(b).backgroundColor])"""


def links(window: Bench, name: str) -> None:
    """Press one of the links below the scenario."""
    found = window.page.locator(".sb-links").get_by_role("button", name=window.said(name), exact=True)
    see(window, found).click()


def test_a_newcomer_is_greeted_in_the_language_of_the_browser_and_can_change_it(another: Open) -> None:
    bench = another(query="?fixedDpr=0.25")
    page = bench.page
    see(bench, page.locator(CARD))
    assert not page.evaluate(_VEILED)
    doors = page.locator(f"{CARD} .sb-door")
    assert doors.count() == 3
    for place in range(3):
        read(bench, doors.nth(place))
    page.keyboard.press("Escape")
    page.locator(CARD).wait_for(state="detached")
    see(bench, page.locator(".uplot"))
    # nothing lies over the pendulum, and that 3D is drawn in software is said below the map
    see(bench, page.locator("#sb-stage .sb-pendulum svg"))
    caption = page.locator("#sb-stage [data-is=caption]")
    bench.wait_until(
        lambda: {"en": "3D drawn in software"}.get(bench.language, "三维以软件绘制") in caption.inner_text()
    )
    read(bench, caption)
    assert page.locator(".mantine-Notification-root:visible").count() == 0
    bench.tab("View")
    before, language = page.evaluate(_TITLES), page.evaluate("() => schuler.language")
    see(bench, bench.box("language")).click()
    other = {"en": "中文（简体）", "zh-CN": "English"}[language]
    see(bench, page.get_by_role("option", name=other, exact=True)).click()
    page.wait_for_selector(f"html[lang={'en' if language != 'en' else 'zh-CN'}]", state="attached")
    page.wait_for_selector("#sb-run[data-run]", state="attached")
    page.wait_for_function(f"before => ({_TITLES})().length === before", arg=len(before))
    bench.language = page.evaluate("() => schuler.language")
    after = page.evaluate(_TITLES)
    assert not set(before) & set(after)
    speaks(bench, "\n".join(after))


def test_each_door_leads_to_what_it_says(window: Bench) -> None:
    page = window.page
    links(window, "Start")
    see(window, page.locator(f"{CARD} [data-command=door-swing]")).click()
    page.wait_for_selector("#sb-stage .sb-play:text('❚❚')")
    read(window, page.locator(".sb-lesson h3"))
    see(window, page.locator("#sb-stage .sb-play")).click()
    links(window, "Start")
    see(window, page.locator(f"{CARD} [data-command=door-tune]")).click()
    card = page.locator(".sb-tour")
    read(window, card)
    page.keyboard.press("Escape")
    card.wait_for(state="detached")
    window.wait_until(lambda: window.session.origin == "liu-networks")
    links(window, "Start")
    see(window, page.locator(f"{CARD} [data-command=door-files]")).click()
    see(window, window.button("Upload a file"))
    window.settle()


def test_the_tour_has_six_steps_beside_what_they_speak_of(window: Bench) -> None:
    page = window.page
    links(window, "Tour")
    for number in range(1, 7):
        card = page.locator(".sb-tour", has_text=window.said(f"Step {number} of 6"))
        read(window, card)
        page.wait_for_function(_CLEAR)
        if number < 6:
            see(window, card.locator(".sb-next")).click()
    page.keyboard.press("Escape")
    page.locator(".sb-tour").wait_for(state="detached")


@pytest.mark.parametrize(("name", "pick"), [("Scenarios", "zha-fast"), ("Networks", "pole2")])
def test_cards_have_a_picture_and_a_sentence(window: Bench, name: str, pick: str) -> None:
    page, session, number = window.page, window.session, window.run
    links(window, name)
    cards = page.locator("dialog .sb-card")
    cards.first.wait_for()
    for place in range(min(3, cards.count())):
        read(window, cards.nth(place))
        see(window, cards.nth(place).locator("svg"))
        assert len(cards.nth(place).locator("span").inner_text()) > 8
    speaks(window, "\n".join(cards.all_inner_texts()))
    chosen = {"Scenarios": f"preset-{pick}", "Networks": f"network {pick}"}[name]
    see(window, page.locator(f"dialog [data-command='{chosen}']")).click()
    window.wait_for_run(number)
    assert pick in (session.origin, session.scenario.method[min(2, session.selected)].network.id)


def test_to_verify_is_a_small_button_and_lessons_are_one_press_away(window: Bench) -> None:
    weights = {command: weight for command, *weight in window.page.evaluate(_WEIGHTS)}
    assert weights["verify"] == weights["share"]
    see(window, window.page.locator("[data-command=verify]"))
    links(window, "Learn")
    read(window, window.page.locator(".sb-lesson h3, [data-command^='lesson open']"))
    see(window, window.page.get_by_role("tab", name=window.said("Learn"), exact=True, selected=True))


def test_every_tab_says_what_to_look_for(window: Bench) -> None:
    page = window.page
    wide = page.viewport_size["width"] == 1920
    for name in ("Frequency", "Poles", "Step", "Errors", "Metrics", "Compare", "Spectrum", "Requirements"):
        window.tab(name)
        looks = page.locator(".sb-look:visible")
        assert looks.count() == (2 if wide else 1), name
        for place in range(looks.count()):
            read(window, looks.nth(place))
