"""A text with named values: English as it stands, translated where its template is."""

import pickle
from typing import Any

import pytest

from navcore.foundation.text import Text, quoted
from schuler_bench.languages.wording import Wording
from schuler_bench.plots.plotly_data import PlotlyFigure

SAY = Wording(
    {
        "{count} run in {time:.1f} s": "{time:.1f} s 内 {count} 次运行",
        "error": "误差",
        "Run {number}": "第 {number} 次运行",
        "See <b>this</b> and {what:html}": "参见 {what:html} 和<b>这</b>",
        "must be > {bound:g}": "须大于 {bound:g}",
    }
)
RUN = Text("Run {number}", number=3)


@pytest.mark.parametrize(
    ("text", "english", "chinese"),
    [
        (
            Text.plural("{count} run in {time:.1f} s", "{count} runs in {time:.1f} s", count=2, time=0.25),
            "2 runs in 0.2 s",
            "0.2 s 内 2 次运行",
        ),
        (Text("{run}: {what}", run=RUN, what="error"), "Run 3: error", "第 3 次运行：误差"),
        (Text.joined(", ", [RUN, "error", "x"]), "Run 3, error, x", "第 3 次运行，误差，x"),
        (RUN + " (" + "error" + ")", "Run 3 (error)", "第 3 次运行 (误差)"),
        ("a " + RUN, "a Run 3", "a 第 3 次运行"),
        # A text without a translation stays English whole, and so do the values in it.
        (
            Text("Largest {what} of every run", what="error"),
            "Largest error of every run",
            "Largest error of every run",
        ),
        (
            Text("<b>{run}</b><p>Largest {what}</p>", run=RUN, what="error"),
            "<b>Run 3</b><p>Largest error</p>",
            "<b>第 3 次运行</b><p>Largest error</p>",
        ),
        (
            Text(
                '<p class="{look}" title="{run:html}">See <b>this</b> and {what:html}</p>',
                look="error",
                run=RUN,
                what="a < b",
            ),
            '<p class="error" title="Run 3">See <b>this</b> and a &lt; b</p>',
            '<p class="error" title="第 3 次运行">参见 a &lt; b 和<b>这</b></p>',
        ),
        (quoted("a <b>"), "a &lt;b&gt;", "a &lt;b&gt;"),
        (
            Text("{bound:sentence}", bound=Text("must be > {bound:g}", bound=1.5)),
            "Must be > 1.5.",
            "须大于 1.5。",
        ),
        (Text("{{x}} {run}", run=RUN), "{x} Run 3", "{x} 第 3 次运行"),
    ],
)
def test_a_text_is_translated_by_its_template_or_stays_whole(text: Text, english: str, chinese: str) -> None:
    assert (text, SAY.text(text)) == (english, chinese)


def test_a_name_that_a_user_gave_is_no_text() -> None:
    names = frozenset({"error"})
    assert SAY.text("error", names) == "error" and SAY.text("error") == "误差"
    assert SAY.text(Text("{run}: {name}", run=RUN, name="error"), names) == "第 3 次运行：error"


def test_a_pickled_text_keeps_what_it_consists_of() -> None:
    text: Any = pickle.loads(pickle.dumps(Text("{run}: {count}", run=RUN, count=2)))
    assert (text, SAY.text(text)) == ("Run 3: 2", "第 3 次运行：2")


def test_a_figure_keeps_its_texts() -> None:
    json = PlotlyFigure(
        data=[{"name": RUN, "x": [1.5]}], layout={"title": {"text": "error"}}, config={}
    ).to_json()
    assert json == '{"data":[{"name":"Run 3","x":[1.5]}],"layout":{"title":{"text":"error"}},"config":{}}'
    assert json.texts == {"Run 3": RUN} and isinstance(json.texts["Run 3"], Text)
