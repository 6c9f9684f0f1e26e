"""A text with named values: English as it stands, translated where its template is."""

import pickle

from app.languages.wording import Wording
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
