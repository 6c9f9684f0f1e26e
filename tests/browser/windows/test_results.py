"""Results that would mislead: verification, recordings, transients, limits, motions, lessons."""

import math
import re
from typing import Any

import pytest

from navcore.foundation.text import Text
from navcore.scenario.file import load
from schuler_bench.session.requirements import verdicts
from schuler_bench.session.shown import window_of
from schuler_bench.views.errors.view import OWN_NOISE
from schuler_bench.views.learn.lessons import MISSING, lessons
from schuler_bench.views.metrics.table import verdict
from schuler_bench.views.verification.view import VERIFY
from tests.browser import test_page_lessons as learning
from tests.browser import test_page_scene as playing
from tests.browser.driver import Bench
from tests.browser.windows.seeing import read, see
from tests.limits import require
from tests.recordings import OWN


def box(bench: Bench, label: str) -> Any:
    return bench.page.get_by_label(bench.said(label), exact=True)


def ask(bench: Bench, label: str, text: str) -> None:
    if not box(bench, label).is_visible():
        bench.page.locator(".sb-unfold button").click()
    box(bench, label).fill(text)
    box(bench, label).press("Enter")
    bench.settle()


def cells(bench: Bench, measure: str) -> list[tuple[float, str, str]]:
    """Value, verdict and text of each method."""
    return [
        (value, word, text)
        for name, value, word, text in bench.page.evaluate("look.cells")
        if name == measure
    ]


def wait_for(bench: Bench, measure: str, words: list[str]) -> None:
    found = "look.cells().filter(c => c[0] === m).map(c => c[2])"
    bench.page.wait_for_function(f"([m, words]) => String({found}) === String(words)", arg=[measure, words])


def open_lesson(window: Bench, number: int) -> None:
    """Open a lesson at its first step, without having it shown."""
    window.tab("Learn")
    learning.press(window, f"open {number}")
    learning.heading(window, lessons()[number].steps[0].title)


def test_a_verification_leaves_the_curves_of_the_run(window: Bench) -> None:
    page, verifier = window.page, window.session.verifier
    window.put(load("sikuliaq-like", ["run.duration_h=0.2", "run.rate_hz=50"]), origin="short", selected=2)
    before, number = window.curves(), window.run
    see(window, window.button(VERIFY)).click()
    window.wait_until(lambda: verifier.result is not None, 120.0)
    verified = Text("Verified. {verdict}", verdict=verdict(verifier.result))
    read(window, page.locator(".sb-note:visible", has_text=window.said(verified)))
    assert (window.curves(), window.run) == (before, number) and not any(page.evaluate("look.dashed"))
    window.choose("curves", "Verification")
    page.wait_for_function("() => look.dashed().some(lines => lines.length === 3)")
    see(window, page.locator(".uplot"))
    read(window, page.locator(".sb-note:visible", has_text=window.said(OWN_NOISE)))
    window.choose("curves", "Overview")


def test_own_recordings_say_what_is_followed_and_how_short_they_are(window: Bench) -> None:
    page, session = window.page, window.session
    window.tab("Files")
    for file, told in (
        ("sikuliaq-log.csv", "follows the simulated motion"),
        ("sikuliaq-track.csv", "0.14 of"),
    ):
        with window.next_run():
            window.upload(str(OWN / file))
            read(window, page.locator(".mantine-Notification-root", has_text=file).last)
        window.close_notices()
        warnings = [text for text in session.run.warnings if told in text or "of a Schuler period" in text]
        assert any(told in text for text in warnings)
        for text in warnings:
            read(window, page.locator(".sb-note:visible", has_text=window.said(text)))
    window.choose_and_run("scenario", "zha-fast")
    window.tab("Files")
    see(window, window.button("Remove the files")).click()
    window.button("Remove the files").wait_for(state="hidden")


def test_the_error_of_a_recorded_log_is_fitted(window: Bench) -> None:
    window.reset("sikuliaq-recorded", "Log")
    see(window, window.button("Fit this log's error")).click()
    use = see(window, window.button("Simulate a log with this error"))
    read(window, window.page.locator("[role=tabpanel] .sb-note:visible, .sb-note:visible").last)
    with window.next_run():
        use.click()
    window.button("Fit this log's error").wait_for(state="hidden")
    assert window.session.scenario.reference.kind == "log"


def test_errors_are_measured_after_settling(window: Bench) -> None:
    page, session = window.page, window.session
    window.tab("Metrics")
    whole = read(window, page.locator(".sb-table table"))
    window.choose("errors over", "after settling")
    measured = window_of(session.run, session.display)
    assert measured.from_s
    note = page.locator(".sb-note:visible", has_text=window.said(measured.told))
    read(window, note)
    page.wait_for_function("old => document.querySelector('.sb-table table').innerText !== old", arg=whole)
    window.choose("errors over", "chosen hours")
    page.get_by_label(window.said("measured from (h)")).wait_for()
    window.choose("errors over", "the whole run")
    note.first.wait_for(state="detached")


def test_a_velocity_is_required(window: Bench) -> None:
    window.tab("Requirements")
    wait_for(window, "settling_s", ["", "", ""])
    limits = {
        "velocity RMS per axis of this run ≤ (m/s)": "0.1",
        "settling ≤ (min)": "90",
        "position RMS of this run ≤ (m)": "1",
    }
    see(window, box(window, "velocity RMS per axis of this run ≤ (m/s)"))
    for label, text in limits.items():
        ask(window, label, text)
    wanted = window.session.scenario.requirement
    assert [(one.quantity, one.limit) for one in wanted] == [
        ("velocity_rms_mps", 0.1),
        ("settling_s", 5400.0),
        ("position_rms_m", 1.0),
    ]
    for judged in verdicts(window.session.run, wanted):
        key = judged.quantity.key
        if judged.limit is not None:
            wait_for(window, key, [("missed", "met")[met] for met in judged.passed])
        values = [value for value, *_ in cells(window, key)]
        assert values == pytest.approx(list(judged.measured), rel=1e-6, nan_ok=True)
    wait_for(window, "settling_s", ["missed", "met", "missed"])
    # the share of seeds stands beside the tick
    share = window.page.locator(".sb-share").first
    share.wait_for(timeout=120_000)
    assert " %" in share.inner_text()
    # in words, not by colour alone
    assert "✗" in cells(window, "position_rms_m")[0][2]
    for place in range(3):
        read(window, window.page.locator("[data-measure=velocity_rms_mps]").nth(place))


def test_a_plot_of_a_switching_that_is_not_there_is_not_saved(window: Bench) -> None:
    window.tab("View")
    window.choose("export plot", "Switching")
    window.page.get_by_text("CSV", exact=True).click()
    window.notice("Nothing to save")
    notice = window.page.locator(".mantine-Notification-root", has_text=window.said("Nothing to save"))
    assert window.said("No method of this scenario switches.") in read(window, notice)
    window.close_notices()
    window.choose("export plot", "Frequency")


def test_a_limit_of_settling_is_one_edge_in_the_pole_map(window: Bench) -> None:
    require(window, settling_s=90.0, damping_ratio=0.5)
    window.tab("Poles")
    settling = window.said("settling")
    window.page.wait_for_function("name => look.shapes().some(s => s[0] === name)", arg=settling)
    shapes = window.page.evaluate("look.shapes")
    assert {name for name, *_ in shapes} == {settling, window.said("damping")}
    (path,) = (path for name, across, _, _, path in shapes if (name, across) == (settling, "x2"))
    at = [float(corner.split()[0]) for corner in re.split("[MLZ]", path) if corner.strip()]
    low, high = window.page.evaluate("look.near")
    # of the four sides only the limit itself can be seen, whatever a zoom shows
    (edge,) = {x for x in at if low <= x <= high}
    assert edge == pytest.approx(-math.log(50.0) / (90.0 * 60.0 * window.session.scenario.omega_s))
    assert all(low <= x <= high or x > 10.0 * abs(low) for x in set(at))
    see(window, window.page.locator(".js-plotly-plot:visible"))


def test_the_legs_come_back_after_another_motion(window: Bench) -> None:
    legs: Any = window.session.scenario.motion
    window.tab("Motion")
    about = window.page.get_by_text(window.said("add behind"))
    read(window, about)
    window.choose_and_run("motion", "static")
    about.first.wait_for(state="hidden")
    window.choose_and_run("motion", "legs")
    read(window, about)
    assert window.session.scenario.motion == legs
    with window.next_run():
        about.first.click()
    added: Any = window.session.scenario.motion
    assert len(added.leg) == 7 and added.leg[1] == legs.leg[0]
    with window.next_run():
        window.page.get_by_text(window.said("take out"), exact=True).first.click()
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
        places.add(tuple(window.page.evaluate("look.bobs")))
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
    for told in ("!==", "==="):  # Show me, and another scenario
        if told == "!==":
            learning.show_me(window, lessons()[0], 0)
        else:
            window.reset("sikuliaq-like")
        missing = f"missing => ({learning._LIVE})().every(([_, text]) => text {told} missing)"
        window.page.wait_for_function(missing, arg=window.said(MISSING))
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
    window.page.wait_for_timeout(500)
    assert window.page.evaluate("look.inFront", [window.said("Errors")])
    read(window, window.page.locator(f"{learning.SECTION} h3"))


def test_the_line_that_says_why_stands_below_the_table(window: Bench) -> None:
    window.tab("Metrics")
    window.page.wait_for_selector("#sb-why[data-fits='1']")
    assert "complementary" in read(window, window.page.locator("#sb-why"))
