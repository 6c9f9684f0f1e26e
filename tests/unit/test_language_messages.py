"""What goes to a page and comes from it in its language, and how the language is chosen."""

import json
from typing import Any

import numpy as np
import pytest
from viser import _messages as messages
from websockets.datastructures import Headers

from navcore.foundation.text import Text
from schuler_bench.bridge.texts import Translator
from schuler_bench.http.running import language_of
from schuler_bench.languages.wording import Wording

WORDS = {
    "damping": "阻尼",
    "none": "无",
    "internal": "内",
    "Tilt": "失准角",
    "time ({name})": "时间 ({name})",
    "Errors": "误差",
    "Hello": "您好",
}


@pytest.fixture
def page() -> Translator:
    return Translator(Wording(WORDS, "zh-CN"))


def dropdown(**changes: Any) -> messages.GuiDropdownMessage:
    props = messages.GuiDropdownProps(
        order=1.0,
        label="damping",
        hint=None,
        visible=True,
        disabled=False,
        options=("none", "internal", "own name"),
    )
    return messages.GuiDropdownMessage(
        "a", **({"value": "none", "container_uuid": "root", "props": props} | changes)
    )


def test_options_are_shown_in_the_page_s_language_and_read_back(page: Translator) -> None:
    sent = dropdown()
    shown: Any = page.message(sent)
    assert (shown.value, shown.props.label) == ("无", "阻尼")
    assert shown.props.options == ("无", "内", "own name")
    assert [page.meant("a", word) for word in ("内", "own name", "无", "?", 3)] == [
        "internal",
        "own name",
        "none",
        "?",
        3,
    ]
    # What the program holds is English still.
    assert (sent.value, sent.props.label, sent.props.options[0]) == ("none", "damping", "none")
    update: Any = page.message(messages.GuiUpdateMessage("a", {"value": "internal"}))
    assert update.updates == {"value": "内"}
    update = page.message(messages.GuiUpdateMessage("a", {"options": ("internal",), "value": "internal"}))
    assert update.updates == {"options": ("内",), "value": "内"}
    assert page.meant("a", "无") == "无"


def test_changed_points_of_a_line_pass_as_they_are(page: Translator) -> None:
    points = np.zeros((4, 2, 3), dtype=np.float32)
    sent = messages.SceneNodeUpdateMessage("/map/grid", {"points": points})
    assert page.message(sent) is sent


def test_two_options_never_become_one() -> None:
    page = Translator(Wording({"one": "同", "two": "同"}, "zh-CN"))
    props = messages.GuiDropdownProps(
        order=1.0, label="", hint=None, visible=True, disabled=False, options=("one", "two")
    )
    shown: Any = page.message(messages.GuiDropdownMessage("a", "two", "root", props))
    assert shown.props.options == ("同", "two")
    assert (page.meant("a", "同"), page.meant("a", "two"), shown.value) == ("one", "two", "two")


def test_what_a_visitor_types_is_never_translated(page: Translator) -> None:
    props = messages.GuiTextProps(
        order=1.0, label="damping", hint=None, visible=True, disabled=False, multiline=False
    )
    shown: Any = page.message(messages.GuiTextMessage("t", "Hello", "root", props))
    assert (shown.value, shown.props.label) == ("Hello", "阻尼")
    typed: Any = page.message(messages.GuiUpdateMessage("t", {"value": "Hello"}))
    assert typed.updates == {"value": "Hello"}


def test_texts_of_figures(page: Translator) -> None:
    figure = {"data": [{"name": "Tilt", "x": [1, 2], "mode": "none", "hovertemplate": "Tilt %{y:.3g}"}],
              "layout": {"title": {"text": "Tilt"}, "meta": {"text": "Errors"}}}  # fmt: skip
    words = Wording(WORDS | {"Tilt {0}": "失准角 {0}"}, "zh-CN")
    props = messages.GuiPlotlyProps(order=1.0, _plotly_json_str=json.dumps(figure), aspect=1.0, visible=True)
    shown: Any = Translator(words).message(messages.GuiPlotlyMessage("p", "root", props))
    told = json.loads(shown.props._plotly_json_str)
    assert told["data"][0] == {
        "name": "失准角",
        "x": [1, 2],
        "mode": "none",
        "hovertemplate": "失准角 %{y:.3g}",
    }
    assert told["layout"] == {"title": {"text": "失准角"}, "meta": {"text": "Errors"}}
    update = messages.GuiUpdateMessage(
        "u", {"series": ({"label": Text("time ({name})", name="h")}, {"label": "Tilt", "stroke": "none"})}
    )
    sent: Any = page.message(update)
    assert sent.updates["series"] == (
        {"label": "时间 (h)"},
        {"label": "失准角", "stroke": "none"},
    )


def test_tabs_and_notifications(page: Translator) -> None:
    update = messages.GuiUpdateMessage("g", {"_tab_labels": ("Errors", "x"), "visible": True})
    sent: Any = page.message(update)
    assert sent.updates == {"_tab_labels": ("误差", "x"), "visible": True}
    props = messages.NotificationProps("Hello", "Errors", False, True, 3.0, None)
    shown: Any = page.message(messages.NotificationShowMessage("n", props))
    assert (shown.props.title, shown.props.body) == ("您好", "误差")
    other = messages.GuiRemoveMessage("g")
    assert page.message(other) is other


@pytest.mark.parametrize(
    ("headers", "language"),
    [
        ([], "en"),
        ([("Accept-Language", "zh-TW,zh;q=0.9,en;q=0.8")], "zh-CN"),
        ([("Accept-Language", "en-US,en;q=0.9,zh;q=0.8")], "en"),
        ([("Accept-Language", "fr;q=0.9, zh;q=0.3")], "zh-CN"),
        ([("Accept-Language", ";;q=zh, " * 500)], "en"),
        ([("Cookie", "a=b; schuler_language=zh-CN"), ("Accept-Language", "en")], "zh-CN"),
        ([("Cookie", "schuler_language=en"), ("Accept-Language", "zh")], "en"),
        ([("Cookie", "schuler_language=../../etc/passwd"), ("Accept-Language", "zh")], "en"),
    ],
)
def test_language_of_a_request(headers: list[tuple[str, str]], language: str) -> None:
    assert language_of(Headers(headers)) == language
