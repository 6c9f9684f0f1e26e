"""A class in the browser: one page leads, another follows, draws, and is seen by the one who leads."""

import math
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, Page

from schuler_bench.serve import open_dashboard
from schuler_bench.session.classroom import Classroom
from schuler_bench.views.learn.lessons import lessons

pytestmark = pytest.mark.slow
CODE = "123456"
SKETCH = "svg[data-sketch]"


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """Address of a server whose visitors form a class."""
    server, dashboard = open_dashboard(port=0, classroom=Classroom(CODE))
    yield f"http://127.0.0.1:{server.port}/?start=no"
    server.stop()
    dashboard.close()


def visitor(browser: Browser, address: str) -> Page:
    page = browser.new_context(viewport={"width": 1366, "height": 768}).new_page()
    page.goto(address)
    page.locator("#sb-run[data-run]").wait_for(state="attached", timeout=90_000)
    return page


def draw(page: Page, swings: float) -> None:
    """Draw a cosine from one end of the axes to the other."""
    sketch = page.locator(SKETCH)
    sketch.scroll_into_view_if_needed()
    box = sketch.bounding_box()
    assert box is not None
    at = [(0.14 + 0.84 * i / 60, 0.46 - 0.24 * math.cos(2.0 * math.pi * swings * i / 60)) for i in range(61)]
    points = [(box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in at]
    page.mouse.move(*points[0])
    page.mouse.down()
    for point in points[1:]:
        page.mouse.move(*point)
    page.mouse.up()


def test_a_class_follows_draws_and_is_shown_to_the_one_who_leads(browser: Browser, address: str) -> None:
    leader, pupil = visitor(browser, address), visitor(browser, address)
    try:
        leader.get_by_role("tab", name="Learn", exact=True).click()
        box = leader.get_by_label("Code of the class")
        box.fill("000000")
        box.press("Enter")
        leader.get_by_text("That is not the code of the class.").wait_for()
        box.fill(CODE)
        box.press("Enter")
        leader.get_by_text("You lead.").wait_for()
        leader.locator("[data-command='lesson open 0']").click()
        pupil.get_by_text("This page follows the class.").wait_for()
        pupil.locator(SKETCH).wait_for()
        draw(pupil, swings=4.97)
        leader.locator(".sb-theirs").wait_for(state="attached")
        leader.get_by_text("1 sketched").wait_for()
        leader.locator("[data-command='lesson reveal']").click()
        pupil.locator(".sb-runs").wait_for(state="attached")
        assert pupil.locator(".sb-predicts").get_attribute("data-right") == "true"
        # By keys: the middle of a curve that begins anew.
        pupil.locator("[data-command='lesson again']").click()
        sketch = pupil.locator(SKETCH)
        sketch.focus()
        for _ in range(48):
            sketch.press("ArrowRight")
        sketch.press("ArrowUp")
        sketch.press("Enter")
        pupil.locator("[data-command='lesson reveal']").click()
        pupil.get_by_text("and crosses zero 0 times").wait_for()
        # Show me: the pupil's own scenario and run; the task is met with the pupil's own slider.
        last = len(lessons()[0].steps) - 1
        leader.locator(f"[data-command='lesson step {last}']").click()
        pupil.locator(".sb-task").wait_for()
        leader.locator("[data-command='lesson show']").click()
        pupil.locator("[data-command='lesson show'].sb-quiet").wait_for()
        assert pupil.locator(".sb-task").get_attribute("data-right") == "false"
        drift = pupil.locator("label", has_text="try: gyro bias").locator(
            "xpath=ancestor::div[.//input][1]//input"
        )
        drift.last.fill("0.003")
        drift.last.press("Enter")
        pupil.locator(".sb-task[data-right=true]").wait_for()
        leader.get_by_text("1 met the task").wait_for()
    finally:
        leader.context.close()
        pupil.context.close()
