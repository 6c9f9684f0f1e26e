"""The first five minutes and the languages; a new page in a browser of its own."""

import pytest

from navcore.scenario.file import presets
from tests.browser.driver import Bench
from tests.browser.windows.seeing import read, see, speaks

CARD = "dialog[open][aria-label='Schuler Bench']"


def links(window: Bench, name: str) -> None:
    """Press one of the links of the menu."""
    see(window, window.button("Menu")).click()
    found = window.page.locator(".sb-links").get_by_role("button", name=window.said(name), exact=True)
    see(window, found).click()


@pytest.mark.slow
def test_a_newcomer_is_greeted_in_the_language_of_the_browser_and_can_change_it(visitor: Bench) -> None:
    page = visitor.page
    page.goto(f"{visitor.url}?fixedDpr=0.25")
    page.wait_for_selector("#sb-run[data-run]", state="attached")
    visitor.language = language = page.evaluate("() => schuler.language")
    card = see(visitor, page.locator(CARD))
    assert not page.evaluate("look.veiled")
    assert card.locator(".sb-door").count() == 4
    for place in range(4):
        read(visitor, card.locator(".sb-door").nth(place))
    page.keyboard.press("Escape")
    card.wait_for(state="detached")
    see(visitor, page.locator(".uplot"))
    # nothing lies over the pendulum, and that 3D is drawn in software is said below the map
    see(visitor, page.locator("#sb-stage .sb-pendulum svg"))
    caption = page.locator("#sb-stage [data-is=caption]")
    software = {"en": "3D drawn in software"}.get(language, "三维以软件绘制")
    visitor.wait_until(lambda: software in caption.inner_text())
    read(visitor, caption)
    page.wait_for_function("look.hiddenNotices")
    # another session in the same browser: the card has been seen
    visitor.open(query="?fixedDpr=0.25")
    page.wait_for_selector("#sb-start[data-fresh='1']", state="attached")
    visitor.settle()
    assert card.count() == 0
    visitor.tab("View")
    before = page.evaluate("look.titles")
    see(visitor, visitor.box("language")).click()
    other = {"en": "中文（简体）", "zh-CN": "English"}[language]
    see(visitor, page.get_by_role("option", name=other, exact=True)).click()
    page.wait_for_selector(f"html[lang={'en' if language != 'en' else 'zh-CN'}]", state="attached")
    page.wait_for_selector("#sb-run[data-run]", state="attached")
    page.wait_for_function("before => look.titles().length === before", arg=len(before))
    visitor.language = page.evaluate("() => schuler.language")
    after = page.evaluate("look.titles")
    assert not set(before) & set(after)
    speaks(visitor, "\n".join(after))


def test_each_door_leads_to_what_it_says(window: Bench) -> None:
    page = window.page
    links(window, "Start")
    see(window, page.locator(f"{CARD} [data-command=door-swing]")).click()
    page.wait_for_selector("#sb-stage .sb-play:text('❚❚')")
    read(window, page.locator(".sb-lesson h3"))
    see(window, page.locator("#sb-stage .sb-play")).click()
    links(window, "Start")
    see(window, page.locator(f"{CARD} [data-command=door-tune]")).click()
    read(window, page.locator(".sb-tour"))
    page.keyboard.press("Escape")
    page.locator(".sb-tour").wait_for(state="detached")
    window.wait_until(lambda: window.session.origin == "liu-networks")
    links(window, "Start")
    see(window, page.locator(f"{CARD} [data-command=door-files]")).click()
    see(window, window.button("Upload a file"))
    window.settle()
    links(window, "Start")
    see(window, page.locator(f"{CARD} [data-command=door-limits]")).click()
    form = see(window, page.locator("dialog form.sb-ship"))
    form.locator("select").first.select_option("Honeywell HG9900")
    form.locator("select").last.select_option("Teledyne RDI Explorer 1200")
    see(window, form.locator("button")).click()
    window.wait_until(lambda: window.session.scenario.imu.part == "Honeywell HG9900")
    window.wait_for_front("Design")
    search = window.session.searches.asking["design"]
    window.wait_until(lambda: search.under_way is not None or search.result is not None)
    search.cancel()


def test_the_tour_has_six_steps_beside_what_they_speak_of(window: Bench) -> None:
    page = window.page

    def step(number: int) -> None:
        read(window, page.locator(".sb-tour", has_text=window.said(f"Step {number} of 6")))
        page.wait_for_function("look.clear")

    links(window, "Start")
    guided = window.said("Guided tour, six steps")
    see(window, page.locator(CARD).get_by_role("button", name=guided)).press("Enter")
    page.locator(CARD).wait_for(state="detached")
    for number in range(1, 7):
        step(number)
        page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowLeft")
    step(5)
    see(window, page.locator(".sb-tour .sb-next")).click()
    step(6)
    page.keyboard.press("Escape")
    page.locator(".sb-tour").wait_for(state="detached")


@pytest.mark.parametrize(
    ("name", "pick", "selected"), [("Scenarios", "zha-fast", 0), ("Networks", "pole2", 1)]
)
def test_cards_have_a_picture_and_a_sentence(window: Bench, name: str, pick: str, selected: int) -> None:
    session, cards = window.session, window.page.locator("dialog .sb-card")
    links(window, name)
    cards.first.wait_for()
    for place in range(min(3, cards.count())):
        read(window, cards.nth(place))
        see(window, cards.nth(place).locator("svg"))
        assert len(cards.nth(place).locator("span").inner_text()) > 8
    speaks(window, "\n".join(cards.all_inner_texts()))
    assert name != "Scenarios" or cards.count() == len(presets())
    chosen = window.page.locator("dialog .sb-card[aria-pressed=true]")
    assert name != "Networks" or chosen.locator("svg").count() == 1
    with window.next_run():
        see(window, window.page.locator(f"dialog [data-command$='{pick}']")).click()
    assert pick == (session.origin, session.scenario.method[min(2, session.selected)].network.id)[selected]


def test_to_verify_is_a_small_button_and_lessons_are_one_press_away(window: Bench) -> None:
    weights = {command: weight for command, *weight in window.page.evaluate("look.weights")}
    assert weights["verify"] == weights["share"]
    see(window, window.page.locator("[data-command=verify]"))
    links(window, "Learn")
    read(window, window.page.locator(".sb-lesson h3, [data-command^='lesson open']"))
    window.wait_for_front("Learn")
    see(window, window.tab_of("Learn"))


def test_every_tab_says_what_to_look_for(window: Bench) -> None:
    """In a line of its own, or where that has no room by the tab's title."""
    page = window.page
    high = page.viewport_size["height"] >= 900
    for name in ("Frequency", "Poles", "Step", "Errors", "Metrics", "Compare", "Spectrum", "Requirements"):
        window.tab(name)
        looks = page.locator(".sb-look:visible")
        assert looks.count() == (2 if high else 0), name
        for place in range(looks.count()):
            read(window, looks.nth(place))
        tab = window.tab_of(name)
        window.wait_until(lambda tab=tab: len(tab.get_attribute("title") or "") > 20)
        speaks(window, tab.get_attribute("title") or "")
