"""Questions on the page: what the answer of the tab Ask shows is played; a method is exported as a ZIP."""

import zipfile

from navcore.exporting.exported import exported
from navcore.questions.worst import WorstQuestion
from schuler_bench.shell.control import EXACT
from schuler_bench.views.ask.view import ASK, PLAY, QUESTION, SHOWN
from schuler_bench.views.method.taking import EXPORT
from tests.browser.driver import Bench


def test_the_worst_log_is_asked_for_and_played_and_undone(short: Bench) -> None:
    page, session = short.page, short.session
    before = session.scenario
    short.tab("Ask")
    short.choose(QUESTION, WorstQuestion.title)
    box = short.box("log within (m/s)" + EXACT)
    box.fill("0.5")
    box.press("Enter")
    short.settle()
    short.button(ASK).click()
    short.button(PLAY).wait_for(timeout=60_000)
    page.get_by_text("worst log within 0.5 m/s on each axis, 1 h").wait_for()
    answer = session.searches.asking["worst"].result
    short.choose(SHOWN, answer.plays()[4])
    with short.next_run():
        short.button(PLAY).click()
    largest = session.run.methods[0].errors["dvn_mps"]["max_abs"]
    method = next(one for one in answer.methods if one.name == session.run.methods[0].method.name)
    assert abs(largest / method.largest[4] - 1.0) < 1e-3
    assert session.undo() and session.scenario == before


def test_a_method_is_downloaded_as_code_and_its_equations_are_copied(short: Bench) -> None:
    """The archive is what the command writes; a name that is none is refused in words, then mended."""
    page, session = short.page, short.session
    short.tab("Method")
    page.get_by_text("Law for a navigation computer").click()
    assert short.value("rate of the law (Hz)") == 1.0 / session.scenario.law_step_s
    short.choose("as", "matlab")
    label = page.locator("label").get_by_text("name in the files", exact=True)
    box = label.locator("xpath=ancestor::div[.//input][1]").locator("input")
    box.fill("2fast")
    box.press("Enter")
    short.button(EXPORT).click()
    page.get_by_text("must be letters, digits and _ after a letter, such as law_2fast").wait_for()
    box.fill("ship")
    box.press("Enter")
    short.settle()
    with page.expect_download(timeout=60_000) as download:
        short.button(EXPORT).click()
    assert download.value.suggested_filename == "ship.zip"
    method = session.scenario.method[session.selected].label()
    files = exported(session.scenario, method, target="matlab", prefix="ship").files
    with zipfile.ZipFile(download.value.path()) as archive:
        assert {name: archive.read(name).decode() for name in archive.namelist()} == files
    page.get_by_text("replay.m").wait_for()
    page.get_by_text("Equations with these numbers").click()
    short.button("copy as LaTeX").click()
    text = short.dialog("Copied as LaTeX").get_by_role("textbox").input_value()
    assert text.startswith("\\begin{gather*}") and "H(s) = \\frac{" in text
    page.keyboard.press("Escape")
    short.choose_and_run("scenario", "sun-step")
    short.tab("Method")
    page.get_by_text("replay.m").wait_for(state="hidden")
