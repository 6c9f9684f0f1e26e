"""The page in other languages: nothing is left out, and a text is found again with values in it."""

import re
from io import BytesIO
from pathlib import Path

import pytest
from babel.messages.mofile import write_mo

from app.languages.wording import NAMES, Wording, read_texts, wording, words_of
from app.views import load
from tools.translating.__main__ import LANGUAGES, missing, po_path, read, script, script_path
from tools.translating.extract import texts
from tools.translating.python import Text, is_prose, texts_in

ROOT = Path(__file__).parents[2]
VALUE, ELEMENT = re.compile(r"\{\d+\}"), re.compile(r"</?[a-z]+>")


@pytest.fixture(scope="module", params=LANGUAGES)
def language(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(scope="module")
def catalogue(language: str) -> dict[str, str]:
    return {str(message.id): str(message.string) for message in read(language) if message.id}


@pytest.fixture(scope="module")
def found() -> list[Text]:
    return texts()


def test_a_text_without_a_translation_is_listed(found: list[Text], catalogue: dict[str, str]) -> None:
    """`make languages` lists it; the page shows it in English. It fails no test."""
    assert sum(text.prose for text in found) > 1500
    added = Text("Largest position error of every method", "app/views/peaks/view.py:1", prose=True)
    assert missing([added, *found], catalogue)[0] == f"{added.where}: {added.key}"


def test_no_translation_is_of_a_text_that_has_gone(found: list[Text], catalogue: dict[str, str]) -> None:
    known = {text.key for text in found}
    assert [key for key in catalogue if key not in known] == []


def test_values_and_elements_of_a_text_stand_in_its_translation(catalogue: dict[str, str]) -> None:
    for key, said in catalogue.items():
        values, kept = VALUE.findall(key), VALUE.findall(said)
        # A plural's ending is a value that other languages may leave out; no other value is.
        assert set(kept) <= set(values) and len(kept) >= len(values) - 1, key
        assert sorted(ELEMENT.findall(said)) == sorted(ELEMENT.findall(key)), key


def test_what_is_read_is_what_was_translated(language: str, catalogue: dict[str, str]) -> None:
    """`make languages` writes it all; the page's languages are English and those with a catalogue."""
    compiled = BytesIO()
    write_mo(compiled, read(language))
    assert po_path(language).with_suffix(".mo").read_bytes() == compiled.getvalue()
    assert script_path(language).read_text(encoding="utf-8") == script(read(language), language)
    assert read_texts(language.replace("_", "-")) == {key: said for key, said in catalogue.items() if said}
    assert {"en", *(name.replace("_", "-") for name in LANGUAGES)} == NAMES.keys()


def test_every_text_with_values_is_recognised(language: str, catalogue: dict[str, str]) -> None:
    say = wording(language.replace("_", "-"))
    assert say is not None
    wrong = []
    for key, said in catalogue.items():
        if not VALUE.search(key) or not words_of(key) or "}{" in key:  # where one ends cannot be seen there
            continue
        values = {mark: f"{7.5 + number:g}" for number, mark in enumerate(dict.fromkeys(VALUE.findall(key)))}
        filled = VALUE.sub(lambda found, values=values: values[found[0]], key)
        wanted = VALUE.sub(lambda found, values=values: values[found[0]], said)
        if say.say(filled) != wanted:
            wrong.append((key, say.say(filled)))
    assert wrong == []


def test_one_term_has_one_word(catalogue: dict[str, str]) -> None:
    table = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8").partition("| English | Chinese |")[2]
    terms = dict(re.findall(r"^\| ([^|]+?) \| ([^|]+?) \|$", table.partition("\n\n")[0], re.MULTILINE))
    assert len(terms) > 40
    for english, chinese in terms.items():
        if english in catalogue:
            assert chinese in catalogue[english], english


# ---------------------------------------------------------------- finding texts


def test_texts_are_found_in_python(tmp_path: Path) -> None:
    file = tmp_path / "some.py"
    file.write_text(
        '"""Not this."""\n'
        "def show(n, ended):\n"
        '    """Nor this one here."""\n'
        "    label('Largest tilt', hint=f'Run {n}: {n} method{\"s\" * (n != 1)}{ended}')\n"
        "    html(f'<p class=\"x\" title=\"Some hint\">{n} <b>runs</b> in all</p>' + note(f'{n} of them'))\n"
        "    raise ValueError(f'a fault of the program {n}')\n"
    )
    found = [text.key for text in texts_in(file, "some.py") if text.prose]
    assert found == [
        "Largest tilt",
        "Run {0}: {1} method{2}",
        "Run {0}: {1} methods{2}",
        "Some hint",
        "{0} <b>runs</b> in all",
        "{0} of them",
    ]


@pytest.mark.parametrize(
    ("text", "prose"),
    [
        *(
            (text, False)
            for text in ("color:red;", "a.b.c", "omega_s", "M 3 4 L 5", "{0}px {1}", "Zha 2019, eq. 2")
        ),
        *((text, True) for text in ("Undo", "settles to 2 %", "must be {0}")),
    ],
)
def test_code_is_no_prose(text: str, prose: bool) -> None:
    assert is_prose(text) == prose


# ---------------------------------------------------------------- translating


@pytest.fixture(scope="module")
def say() -> Wording:
    return Wording(
        {
            "Run {0}: {1} methods{2}": "第{0}次运行：{1}种方法{2}",
            "Run {0}: {1} methods, {2}": "第{0}次运行：{1}种方法，用时{2}",
            ", diverged": "，发散",
            "damping ratio": "阻尼比",
            "must be {0}": "须为{0}",
            "must be {0} and no more": "须不超过{0}",
            "one of {0}": "{0} 之一",
            "See <b>this</b> and {0}": "参见{0}和<b>这</b>",
            "a hint": "提示",
            "Damping ratio of the pair.": "极点对的阻尼比。",
        }
    )


@pytest.mark.parametrize(
    ("english", "chinese"),
    [
        ("Run 3: 2 methods, diverged", "第3次运行：2种方法，用时diverged"),
        ("Run 3: 2 methods", "第3次运行：2种方法"),
        ("must be one of a, b", "须为a, b 之一"),
        ("must be 5 and no more", "须不超过5"),
        ("Damping ratio of the pair. Must be > 0.", "极点对的阻尼比。须为> 0。"),
        ("damping ratio (1/s)", "阻尼比 (1/s)"),
        ("Damping ratio", "阻尼比"),
        ("<p>damping ratio</p>", "<p>阻尼比</p>"),
        ("a &lt; <b>b</b>", "a &lt; <b>b</b>"),
        # All of a sentence has a translation, or nothing of it.
        ("damping ratio of every method that runs, and a hint", None),
        ("a hint: largest damping ratio of every method", None),
        *(
            (text, None)
            for text in ("classic2", "1.2e-3", "", "x", "omega_s < 3 & y", "no such text", "<br>")
        ),
    ],
)
def test_a_text_is_translated_or_stays_whole(say: Wording, english: str, chinese: str | None) -> None:
    assert say.text(english) == (english if chinese is None else chinese)


def test_what_is_put_together_is_taken_apart() -> None:
    assert (chinese := wording("zh-CN")) is not None
    assert chinese.text("bias E / starboard (m/s)") == "零偏 E / 右舷 (m/s)"


def test_texts_in_html_are_translated_and_the_rest_stays(say: Wording) -> None:
    html = (
        '<p class="a hint" title="a hint">See <b id="x">this</b> and <math>a</math></p><i>damping ratio</i>'
    )
    said = '<p class="a hint" title="提示">参见<math>a</math>和<b id="x">这</b></p><i>阻尼比</i>'
    assert say.text(html) == said
    hidden = '<div id="sb-run" hidden data-x="1">damping ratio</div><style>p {}</style>'
    assert say.text(hidden) == hidden


def test_a_translation_cannot_bring_in_elements() -> None:
    assert (
        Wording({"a text": "<script>x</script>"}).text("<p>a text</p>")
        == "<p>&lt;script&gt;x&lt;/script&gt;</p>"
    )


SYMBOLS = frozenset("TOML CSV RMS dB min".split())


@pytest.mark.parametrize(
    "text",
    [
        *(kind.look_for for kind in load() if kind.look_for),
        "<b>φ/δV<sub>r</sub>: tilt from log error</b>",
        "standard deviation, steady state at rest; the dashed line is the floor",
        "2.65 = 1.68 × floor",
        "tilt most of all (45 %) from gyro white noise, as a constant",
        "position error mostly (68 %) from gyro white noise, as a slow drift",
        "output / step",
        "step (s)",
    ],
)
def test_no_word_of_a_line_of_the_page_stays_english(language: str, text: str) -> None:
    said = Wording(read_texts(language), language).text(text)
    plain = re.sub(r"<[^>]*>|\([^()]*\)", "", said)
    assert set(re.findall(r"[A-Za-z]{3,}", plain)) <= SYMBOLS, said
