"""The tab Ask: a question without a tab of its own is asked, and what its answer shows is played."""

from navcore.questions.worst import WorstQuestion
from schuler_bench.shell.control import EXACT
from schuler_bench.views.ask.view import ASK, PLAY, QUESTION, SHOWN
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
