"""The page in other languages: nothing is left out, and a text is found again with values in it."""

from __future__ import annotations

import re
from io import BytesIO
from pathlib import Path

import pytest
from babel.messages.mofile import write_mo

from app.languages import markup
from app.languages.wording import FOLDER, NAMES, Wording, read_texts, wording, words_of
from app.views import load
from tests.translating.__main__ import LANGUAGES, missing, po_path, read, script, script_path
from tests.translating.extract import texts
from tests.translating.python import Text, is_prose, texts_in

ROOT = Path(__file__).parents[2]
VALUE = re.compile(r"\{\d+\}")


@pytest.fixture(scope="module", params=LANGUAGES)
def language(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(scope="module")
def catalogue(language: str) -> dict[str, str]:
    return {str(message.id): str(message.string) for message in read(language) if message.id}


@pytest.fixture(scope="module")
def found() -> list[Text]:
    return texts()


def test_the_languages_are_those_with_a_catalogue() -> None:
    assert {"en", *(name.replace("_", "-") for name in LANGUAGES)} == NAMES.keys()


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
        assert set(VALUE.findall(said)) <= set(VALUE.findall(key)), key
        assert sorted(re.findall(r"</?[a-z]+>", said)) == sorted(re.findall(r"</?[a-z]+>", key)), key
        # A plural's ending is a value that other languages may leave out; no other value is.
        assert len(VALUE.findall(said)) >= len(VALUE.findall(key)) - 1, key


def test_what_is_read_is_what_was_translated(language: str, catalogue: dict[str, str]) -> None:
    with BytesIO() as file:
        write_mo(file, read(language))
        assert po_path(language).with_suffix(".mo").read_bytes() == file.getvalue(), "make languages"
    assert script_path(language).read_text(encoding="utf-8") == script(read(language), language)
    assert read_texts(language.replace("_", "-")) == {key: said for key, said in catalogue.items() if said}


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
    table = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").partition("| English | Chinese |")[2]
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


def test_code_is_no_prose() -> None:
    assert not any(
        map(is_prose, ("color:red;", "a.b.c", "omega_s", "M 3 4 L 5", "{0}px {1}", "Zha 2019, eq. 2"))
    )
    assert all(map(is_prose, ("Undo", "settles to 2 %", "must be {0}")))


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


def test_values_are_translated_too(say: Wording) -> None:
    assert say.text("Run 3: 2 methods, diverged") == "第3次运行：2种方法，用时diverged"
    assert say.text("Run 3: 2 methods") == "第3次运行：2种方法"
    assert say.text("must be one of a, b") == "须为a, b 之一"


def test_the_text_that_says_more_is_meant(say: Wording) -> None:
    assert say.text("must be 5 and no more") == "须不超过5"


def test_what_is_put_together_is_taken_apart(say: Wording) -> None:
    assert say.text("Damping ratio of the pair. Must be > 0.") == "极点对的阻尼比。须为> 0。"
    assert say.text("damping ratio (1/s)") == "阻尼比 (1/s)"
    assert say.text("Damping ratio") == "阻尼比"
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
    assert say.text("a &lt; <b>b</b>") == "a &lt; <b>b</b>"


def test_what_has_no_translation_stays(say: Wording) -> None:
    for text in ("classic2", "1.2e-3", "", "x", "omega_s < 3 & y", "no such text at all", "<br>"):
        assert say.text(text) == text
    missed: list[str] = []
    Wording({"known": "知"}, missed=missed.append).text("known")
    Wording({"known": "知"}, missed=missed.append).text("quite unknown")
    assert missed == ["quite unknown"]


def test_a_translation_cannot_bring_in_elements() -> None:
    assert (
        Wording({"a text": "<script>x</script>"}).text("<p>a text</p>")
        == "<p>&lt;script&gt;x&lt;/script&gt;</p>"
    )


def test_pieces_of_html() -> None:
    assert markup.in_pieces("<table><tr><td>one</td><td>two <em>three</em></td></tr></table>") == [
        "one",
        "two <em>three</em>",
    ]


def test_catalogues_lie_in_the_package() -> None:
    assert (FOLDER / "zh_CN" / "LC_MESSAGES" / "schuler.mo").is_file()


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
