"""What users have called something stays as they wrote it on a page in another language; sentences do not."""

from contextlib import closing
from pathlib import Path
from typing import Any, cast

import pytest
from viser import _messages as messages

from navcore.foundation.text import Text
from navcore.scenario.file import load
from schuler_bench.bridge.texts import Translator
from schuler_bench.languages.wording import Wording, wording
from schuler_bench.plots.plotly_data import PlotlyFigure
from schuler_bench.session.names import GivenNames
from schuler_bench.session.session import Session

CHINESE = cast("Wording", wording("zh-CN"))
GIVEN = ("drift of log", "position", "log", "must be 3", "step / output", "reset", "a & b", "a <b>log</b> c")

RECORDING = b"time_s,speed_mps\n" + b"".join(b"%d,2.0\n" % second for second in range(60))


def named(text: str) -> str:
    return CHINESE.text(text, frozenset(GIVEN))


@pytest.mark.parametrize("name", GIVEN)
def test_a_name_stays_as_it_is_and_the_sentence_around_it_is_translated(name: str) -> None:
    assert named(name) == name
    html = Text("<td>{name:html}</td>", name=name)
    assert named(html) == str(html)
    value = Text("{label} was {value}", label="position error", value=name)
    assert named(value) == f"位置误差 原为 {name}"


def test_the_program_s_own_sentences_are_translated_beside_names() -> None:
    for text in ("position error", "nothing to undo", "Undo"):
        assert named(text) == CHINESE.text(text) != text


def test_names_of_a_session_reach_the_page(tmp_path: Path) -> None:
    scenario = load("zha-fast", ['method.0.name="drift of log"', 'method.1.name="run with DVL"'])
    page = Translator(CHINESE)

    def updates(**fields: Any) -> dict[str, Any]:
        message: Any = page.message(messages.GuiUpdateMessage("u", fields))
        return message.updates

    with closing(Session("a" * 22, scenario, "zha-fast", tmp_path)) as session:
        session.redo_run()
        assert session.wait_idle(60.0) and session.run is not None
        for name in ("Tilt", ""):
            session.pins.add(session.run, "zha-fast", name)
        page.names = names = GivenNames(session)
        figure = PlotlyFigure(data=[{"name": "drift of log"}, {"name": "Tilt"}, {"name": "Poles"}])
        lines = page.figure(figure.to_json())
        assert lines == '{"data":[{"name":"drift of log"},{"name":"Tilt"},{"name":"极点"}]}'
        session.uploads.add("speed.log", RECORDING)
        assert {"speed.log", "Tilt"} < names() and "pin 2" not in names()
        # A method called like a control does not keep the control in English.
        session.change(load("zha-fast", ['method.0.name="damping"']), None)
        assert {"drift of log", "damping"} < names()
        assert updates(label="damping") == {"label": "阻尼"}
        assert updates(hint="damping") == {"hint": "damping"}
