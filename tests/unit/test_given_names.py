"""What users have called something stays as they wrote it on a page in another language; sentences do not."""

import json
from contextlib import closing
from pathlib import Path
from typing import Any, cast

import pytest
from viser import _messages as messages

from app.bridge.texts import Translator
from app.languages.names import Names
from app.languages.wording import Wording, wording
from app.session.names import GivenNames
from app.session.session import Session
from navcore.scenario.file import load

CHINESE = cast("Wording", wording("zh-CN"))
GIVEN = (
    "drift of log",
    "run with DVL",
    "tilt and drift",
    "gain of log: fast",
    "position",
    "log",
    "north, south or both",
    "method 1",
    "must be 3",
    "log error (new)",
    "step / output",
    "reset",
    "a & b",
)

RECORDING = b"time_s,speed_mps\n" + b"".join(b"%d,2.0\n" % second for second in range(60))


def named(text: str, *names: str) -> str:
    return CHINESE.text(text, Names(names or GIVEN))


@pytest.mark.parametrize("name", GIVEN)
def test_a_name_alone_stays_as_it_is(name: str) -> None:
    assert named(name) == name
    assert named(f"<td>{name.replace('&', '&amp;')}</td>") == f"<td>{name.replace('&', '&amp;')}</td>"


@pytest.mark.parametrize("name", GIVEN)
@pytest.mark.parametrize(
    ("english", "chinese"),
    [
        ("ζ of {}: 0.7 → 0.9", "{}的ζ: 0.7 → 0.9"),
        ("{}, wanted", "{}，期望"),
        ("{}: no band, the errors are not random.", "{}：无色带"),
        ("{} (ended)", "{} （已结束）"),
        ("Showing the pin “{}”, not the present run. Key B flips back.", "“{}”，不是本次运行"),
        ("tilt of {}", "{}的失准角"),
    ],
)
def test_the_sentence_around_a_name_is_translated(name: str, english: str, chinese: str) -> None:
    assert chinese.format(name) in named(english.format(name), name)


def test_the_program_s_own_sentences_are_translated_beside_names() -> None:
    for text in ("tilt from log error", "position error", "Nothing to undo", "Undo"):
        assert named(text) == CHINESE.text(text) != text
    # the network "optimal" names the method in which it is chosen
    assert named("optimal H", "optimal") == "最优 H"


def test_markup_in_a_name_is_no_markup() -> None:
    assert named("a <b>log</b> c", "a <b>log</b> c") == "a <b>log</b> c"
    assert named("ζ of a <b>: 0.7 → 0.9", "a <b>") == "a <b>的ζ: 0.7 → 0.9"
    html = "<th>a &lt;b></th><th>largest tilt</th>"
    assert "<th>a &lt;b" in named(html, "a <b>", "th") and "largest" not in named(html, "a <b>", "th")


def test_names_of_a_session_reach_the_page(tmp_path: Path) -> None:
    scenario = load("zha-fast", ['method.0.name="drift of log"', 'method.1.name="run with DVL"'])
    page = Translator(CHINESE)

    def updates(**fields: Any) -> dict[str, Any]:
        message: Any = page.message(messages.GuiUpdateMessage("u", fields))
        return message.updates

    with closing(Session("a" * 22, scenario, "zha-fast", tmp_path)) as session:
        session.redo_run()
        assert session.wait_idle(60.0) and session.run is not None
        for name in ("tilt and drift", ""):
            session.pins.add(session.run, "zha-fast", name)
        page.names = names = GivenNames(session)
        figure = {"data": [{"name": "drift of log"}, {"name": "tilt and drift"}, {"name": "Tilt"}]}
        props = messages.GuiPlotlyProps(
            order=1.0, _plotly_json_str=json.dumps(figure), aspect=1.0, visible=True
        )
        plot: Any = page.message(messages.GuiPlotlyMessage("p", "root", props))
        lines = json.loads(plot.props._plotly_json_str)["data"]
        assert [line["name"] for line in lines] == ["drift of log", "tilt and drift", "水平失准角"]
        session.uploads.add("speed.log", RECORDING)
        assert names().are("speed.log") and page.text("speed.log: heading") == "speed.log：航向"
        series = updates(series=({"label": "time (h)"}, {"label": "run with DVL"}))["series"]
        assert [line["label"] for line in series] == ["时间 (h)", "run with DVL"]
        # A method called like a control does not keep the control in English.
        assert names().are("drift of log") and not names().are("pin 2")
        box = {"label": "damping", "hint": "drift of log"}
        assert updates(**box) == box | {"label": "阻尼"}
        session.change(load("zha-fast", ['method.0.name="damping"']), None)
        assert names().are("drift of log") and names().are("damping")
        assert updates(label="damping") == {"label": "阻尼"}


def test_without_names_nothing_changes() -> None:
    words = Wording({"Tilt": "失准角", "{0} of {1}": "{1}的{0}"})
    assert words.text("Tilt of log", Names(())) == words.text("Tilt of log") == "log的失准角"
    assert words.text("drift of log", Names(["drift of log"])) == "drift of log"
