"""A text with named values: English as it stands, translated where its template is."""

import pickle
from concurrent.futures import ThreadPoolExecutor

import pytest

from app.languages.wording import Wording
from navcore.foundation import text as texts
from navcore.foundation.text import Text, origin_of


def test_a_text_is_translated_by_its_template_or_stays_whole():
    say = Wording({"{count} run in {time:.1f} s": "{time:.1f} s 内 {count} 次运行", "error": "误差"})
    text = Text.plural("{count} run in {time:.1f} s", "{count} runs in {time:.1f} s", count=2, time=0.25)
    assert text == "2 runs in 0.2 s" and say.text(f"<b>{text}</b>") == "<b>0.2 s 内 2 次运行</b>"
    assert say.text(Text("Largest position error of every {what}", what="method")) == (
        "Largest position error of every method"
    )


def test_a_pickled_text_is_known_where_it_arrives():
    text = pickle.loads(pickle.dumps(Text("chosen from {names}", names="a, b")))
    assert (origin_of("chosen from  a, b"), text.values) == (text, {"names": "a, b"})


def test_texts_made_in_many_threads_are_kept_up_to_a_bound(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(texts, "_origins", {})
    monkeypatch.setattr(texts, "_MOST_KEPT", 100)
    with ThreadPoolExecutor(8) as pool:
        made = list(pool.map(lambda number: Text("text {number}", number=number), range(20_000)))
    assert len(texts._origins) == 100
    assert made[-1] == "text 19999"
    assert all(origin_of(sentence) is kept for sentence, kept in texts._origins.items())
