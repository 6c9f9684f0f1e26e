"""Results that would mislead: verification, recordings, transients, limits, motions, lessons."""

from __future__ import annotations

import re

import pytest

from app.session.requirements import Requirements, verdicts
from app.session.shown import window_of
from app.views.errors.view import OWN_NOISE
from app.views.learn.lessons import MISSING, lessons
from app.views.metrics.table import verdict
from app.views.verification.view import VERIFY
from navcore.scenario.file import load
from tests.browser import test_page_lessons as learning
from tests.browser import test_page_playback as playing
from tests.browser.driver import Bench
from tests.browser.test_page_requirements import _SHAPES, ask, box, cells
from tests.browser.test_page_verification import _DASHED
from tests.browser.windows.seeing import read, see
from tests.recordings import OWN

pytestmark = pytest.mark.browser

# Where the bobs of the pendulum stand in its side view.
_BOBS = "() => [...document.querySelectorAll('#sb-stage .sb-bob')].map(bob => Number(bob.getAttribute('cx')))"
# In the front panel of the pole map: left and right end of its axis.
_NEAR = """() => [...document.querySelectorAll('.js-plotly-plot')]
  .find(p => p.offsetParent !== null && p._fullLayout?.meta?.view === 'Poles')?._fullLayout.xaxis2.range"""


def open_lesson(window: Bench, number: int) -> None:
    """Open a lesson at its first step, without having it shown."""
    window.tab("Learn")
    if window.page.locator("[data-command='lesson list']").count():
        learning.press(window, "list")
    learning.press(window, f"open {number}")
    learning.heading(window, lessons()[number].steps[0].title)


def test_a_verification_leaves_the_curves_of_the_run(window: Bench) -> None:
    page, verifier = window.page, window.session.verifier
    window.put(load("sikuliaq-like", ["run.duration_h=0.2", "run.rate_hz=50"]), origin="short", selected=2)
    before = window.curves()
    try:
        see(window, window.button(VERIFY)).click()
        window.wait_until(lambda: verifier.result is not None, 120.0)
        told = window.said(f"Verified. {verdict(verifier.result)}")
        read(window, page.locator(".sb-note:visible", has_text=told))
        assert window.curves() == before and not any(page.evaluate(_DASHED))
        window.choose("curves", "Verification")
        page.wait_for_function(f"() => ({_DASHED})().some(lines => lines.length === 3)")
        see(window, page.locator(".uplot"))
        read(window, page.locator(".sb-note:visible", has_text=window.said(OWN_NOISE)))
    finally:
        window.choose("curves", "Overview")
        verifier.forget()


def test_own_recordings_say_what_is_followed_and_how_short_they_are(window: Bench) -> None:
    page, session = window.page, window.session
    window.tab("Files")
    for file, told in (
        ("sikuliaq-log.csv", "follows the simulated motion"),
        ("sikuliaq-track.csv", "0.14 of"),
    ):
        number = window.run
        window.upload(str(OWN / file))
        read(window, page.locator(".mantine-Notification-root", has_text=file).last)
        window.wait_for_run(number)
        window.settle()
        window.close_notices()
        warnings = [text for text in session.run.warnings if told in text or "of a Schuler period" in text]
        assert any(told in text for text in warnings) and len(warnings) >= 1
        for text in warnings:
            read(window, page.locator(".sb-note:visible", has_text=window.said(text)))
    window.choose_and_run("scenario", "zha-fast")
    window.tab("Files")
    see(window, window.button("Remove the files")).click()
    window.button("Remove the files").wait_for(state="hidden")


def test_the_error_of_a_recorded_log_is_fitted(window: Bench) -> None:
    window.reset("sikuliaq-recorded")
    window.tab("Log")
    see(window, window.button("Fit this log's error")).click()
    use = see(window, window.button("Simulate a log with this error"))
    told = window.page.locator("[role=tabpanel] .sb-note:visible, .sb-note:visible").last
    read(window, told)
    number = window.run
    use.click()
    window.wait_for_run(number)
    assert window.session.scenario.reference.kind == "log"


def test_errors_are_measured_after_settling(window: Bench) -> None:
    window.tab("Metrics")
    whole = read(window, window.page.locator(".sb-table table"))
    try:
        window.choose("errors over", "after settling")
        measured = window_of(window.session.run, window.session.display)
        assert measured.from_s
        read(window, window.page.locator(".sb-note:visible", has_text=window.said(measured.told)))
        window.page.wait_for_function(
            "old => document.querySelector('.sb-table table').innerText !== old", arg=whole
        )
    finally:
        window.show(window="whole")


def test_a_velocity_is_required(window: Bench) -> None:
    window.tab("Requirements")
    try:
        see(window, box(window, "velocity RMS ≤ (m/s)"))
        ask(window, "velocity RMS ≤ (m/s)", "0.1")
        wanted = window.session.display.requirements
        (judged,) = [one for one in verdicts(window.session.run, wanted) if one.name == "velocity_rms_mps"]
        words = [("missed", "met")[met] for met in judged.passed]
        window.wait_until(lambda: [word for _, word, _ in cells(window, "velocity_rms_mps")] == words)
        for place in range(3):
            read(window, window.page.locator("[data-measure=velocity_rms_mps]").nth(place))
    finally:
        window.show(requirements=Requirements())


def test_a_plot_of_a_switching_that_is_not_there_is_not_saved(window: Bench) -> None:
    window.tab("View")
    try:
        window.choose("export plot", "Switching")
        window.page.get_by_text("CSV", exact=True).click()
        window.notice("Nothing to save")
        notice = window.page.locator(".mantine-Notification-root", has_text=window.said("Nothing to save"))
        assert window.said("No method of this scenario switches.") in read(window, notice)
    finally:
        window.close_notices()
        window.choose("export plot", "Frequency")


def test_a_limit_of_settling_is_one_edge_in_the_pole_map(window: Bench) -> None:
    window.show(requirements=Requirements(settling_min=90.0))
    window.tab("Poles")
    try:
        settling = window.said("settling")
        window.page.wait_for_function(f"name => ({_SHAPES})().some(s => s[0] === name)", arg=settling)
        shapes = window.page.evaluate(_SHAPES)
        (path,) = (path for name, across, _, _, path in shapes if (name, across) == (settling, "x2"))
        at = [float(corner.split()[0]) for corner in re.split("[MLZ]", path) if corner.strip()]
        low, high = window.page.evaluate(_NEAR)
        # of the four sides only the limit itself can be seen, whatever a zoom shows
        assert sum(low <= x <= high for x in set(at)) == 1
        assert all(low <= x <= high or x > 10.0 * abs(low) for x in set(at))
        see(window, window.page.locator(".js-plotly-plot:visible"))
    finally:
        window.show(requirements=Requirements())


def test_the_legs_come_back_after_another_motion(window: Bench) -> None:
    legs = window.session.scenario.motion
    window.tab("Run")
    about = window.page.get_by_text(window.said("6 legs, as the scenario file gives them."))
    read(window, about)
    window.choose_and_run("motion", "static")
    about.first.wait_for(state="hidden")
    window.choose_and_run("motion", "legs")
    read(window, about)
    assert window.session.scenario.motion == legs


def test_the_pendulum_of_the_first_lesson_swings(window: Bench) -> None:
    open_lesson(window, 0)
    learning.show_me(window, lessons()[0], 0)
    see(window, window.page.locator("#sb-stage .sb-pendulum svg"))
    places = set()
    for seconds in (600, 1800, 3000, 4200):
        playing.command(window, "seek", seconds)
        playing.wait_for(window, "n.time === arg", seconds)
        window.settle()
        places.add(tuple(window.page.evaluate(_BOBS)))
    across = [max(each) - min(each) for each in zip(*places, strict=True)]
    assert max(across) > 20.0, across
    window.page.wait_for_function(
        "point => document.querySelector('#sb-stage .sb-pendulum svg').textContent.includes(point)", arg="S"
    )


def test_a_lesson_tells_no_number_of_another_scenario(window: Bench) -> None:
    open_lesson(window, 0)
    live = window.page.evaluate(learning._LIVE)
    assert live and {text for _, text in live} == {window.said(MISSING)}
    see(window, window.page.locator(f"{learning.SECTION} .sb-live"))
    learning.show_me(window, lessons()[0], 0)
    window.page.wait_for_function(
        f"missing => ({learning._LIVE})().every(([_, text]) => text !== missing)", arg=window.said(MISSING)
    )
    read(window, window.page.locator(f"{learning.SECTION} .sb-live"))


def test_a_lesson_brings_to_the_front_what_it_speaks_of(window: Bench) -> None:
    open_lesson(window, 1)
    window.tab("Requirements")
    see(window, window.page.locator("[data-command='lesson show']"))
    learning.press(window, "show")
    window.page.locator("[data-command='lesson show'].sb-quiet").wait_for()
    window.settle()
    # of two tabs that share a panel the one whose curve the text explains; where there is room, both
    see(window, window.page.locator(".uplot"))
    if window.page.viewport_size["width"] == 1920:
        see(window, window.page.locator(".js-plotly-plot:visible"))
    read(window, window.page.locator(f"{learning.SECTION} h3"))
