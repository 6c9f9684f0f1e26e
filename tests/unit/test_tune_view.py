"""Tab Tune: making its picture starts no job and builds the figure once; its curves follow when shown."""

from types import SimpleNamespace
from typing import Any

import pytest

from navcore.engine.simulation import simulate
from navcore.questions import QUESTIONS
from navcore.scenario.file import load
from schuler_bench.jobs.asking import Asker
from schuler_bench.session.display import Display
from schuler_bench.session.shown import Shown
from schuler_bench.views.tune import view as module
from schuler_bench.views.tune.setting import ALL
from schuler_bench.views.tune.view import TuneView

FIELD = "method.2.network.zeta"
RUN = simulate(load("liu-networks", ["run.duration_h=0.1"]))


@pytest.fixture
def shown() -> Any:
    """A view without a browser, the run that it shows, and what was asked."""
    asked: list[Any] = []
    askers = {id: Asker(lambda: None, question) for id, question in QUESTIONS.items()}
    askers["profile"].follow = asked.append  # type: ignore[method-assign]
    layout = SimpleNamespace(
        aspect=lambda above_px: 0.5, alone=False, text_px=900.0, scale=1.0, letter=1.0, wide=True
    )
    session: Any = SimpleNamespace(
        searches=SimpleNamespace(asking=askers), display=Display(), selected=2, scenario=RUN.scenario, run=RUN
    )
    commands = SimpleNamespace(register=lambda *given: None)
    frame: Any = SimpleNamespace(session=session, commands=commands, layout=lambda: layout)
    view = TuneView(frame)
    setting: Any = view._setting
    setting._fields, setting._vary = {ALL: (FIELD,)}, SimpleNamespace(value=ALL)
    yield view, Shown(RUN, 1, session.display, selected=2), askers["profile"], asked
    for asker in askers.values():
        asker.stop()


def test_the_picture_is_made_once_and_starts_nothing(shown: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    view, found, profiles, asked = shown
    made: list[int] = []
    real = module.profiles_figure

    def counted(*given: Any) -> Any:
        made.append(1)
        return real(*given)

    monkeypatch.setattr(module, "profiles_figure", counted)
    assert not view.picture(found) and made == [] and asked == []
    view.show(view.picture(found))  # in front: now the curves are asked for
    (question,) = asked
    assert (question.objective, question.vary, question.scenario) == ("tilt_rms", (FIELD,), RUN.scenario)
    profiles.result, profiles.asked = question.answer(), question
    asked.clear()
    picture = view.picture(found)
    assert len(made) == 1 and asked == [] and len(picture["data"]) == 2
