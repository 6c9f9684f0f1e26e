"""The page in other languages: every text is marked, nothing is left out, and what has gone is dropped."""

import ast
import re
from io import BytesIO
from pathlib import Path

import pytest
from babel.messages.mofile import write_mo

from navcore.foundation.text import Text as PageText
from schuler_bench.languages.wording import NAMES, Wording, read_texts
from schuler_bench.views import load
from tools.translating.__main__ import (
    LANGUAGES,
    missing,
    po_path,
    read,
    script,
    script_path,
    translations,
)  # fmt: skip
from tools.translating.extract import texts
from tools.translating.python import Text, texts_in
from tools.translating.scripts import is_prose

ROOT = Path(__file__).parents[2]
VALUE, ELEMENT = re.compile(r"\{[^{}]*\}"), re.compile(r"</?[a-z]+>")


@pytest.fixture(scope="module", params=LANGUAGES)
def language(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture(scope="module")
def catalogue(language: str) -> dict[str, str]:
    return translations(read(language))


@pytest.fixture(scope="module")
def found() -> list[Text]:
    return texts()


def test_a_text_without_a_translation_is_listed(found: list[Text], catalogue: dict[str, str]) -> None:
    """`make languages` lists it; the page shows it in English. It fails no test."""
    assert sum(text.prose for text in found) > 1500
    added = Text("Largest position error of every method", "app/views/peaks/view.py")
    assert missing([added, *found], catalogue)[0] == f"{added.where}: {added.key}"


def test_no_translation_is_of_a_text_that_has_gone(found: list[Text], catalogue: dict[str, str]) -> None:
    known = {text.key for text in found}
    assert [key for key in catalogue if key not in known] == []


def test_values_and_elements_of_a_text_stand_in_its_translation(catalogue: dict[str, str]) -> None:
    for key, said in catalogue.items():
        assert set(VALUE.findall(key)) == set(VALUE.findall(said)), key
        assert sorted(ELEMENT.findall(said)) == sorted(ELEMENT.findall(key)), key


def test_what_is_read_is_what_was_translated(language: str, catalogue: dict[str, str]) -> None:
    """`make languages` writes it all; the page's languages are English and those with a catalogue."""
    compiled = BytesIO()
    write_mo(compiled, read(language))
    assert po_path(language).with_suffix(".mo").read_bytes() == compiled.getvalue()
    assert script_path(language).read_text(encoding="utf-8") == script(read(language), language)
    assert read_texts(language.replace("_", "-")) == catalogue
    assert {"en", *(name.replace("_", "-") for name in LANGUAGES)} == NAMES.keys()


def test_no_text_stands_within_another_one() -> None:
    """pybabel passes over a call within the arguments of one that it extracts."""
    within = []
    for path in (*(ROOT / "app").rglob("*.py"), *(ROOT / "navcore").rglob("*.py")):
        values = [
            word.value for call in _texts_in(ast.parse(path.read_text("utf-8"))) for word in call.keywords
        ]
        within += [f"{path}:{one.lineno}" for value in values for one in _texts_in(value)]
    assert within == []


def _texts_in(tree: ast.AST) -> list[ast.Call]:
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    return [call for call in calls if ast.unparse(call.func) in ("Text", "Text.plural")]


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
        "def show(n, ended):\n"
        "    label('no text', Text('Largest tilt'), hint=Text.plural('{count} run', '{count} "
        "runs', count=n))\n"
        '    html(Text(\'<p class="x" title="Some hint">{n} <b>runs</b> in all</p>\'\n'
        "              '<i>{what:html}</i>', n=n, what=ended) + Text('a'\n  ' and b'))\n"
    )
    assert list(texts_in(file, "some.py")) == [
        Text("Largest tilt", "some.py"),
        Text("{count} run", "some.py", "{count} runs"),
        Text("Some hint", "some.py"),
        Text("{n} <b>runs</b> in all", "some.py"),
        Text("a and b", "some.py"),
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


SAY = Wording(
    {
        "damping ratio": "阻尼比",
        "See <b>this</b> and {0}": "参见{0}和<b>这</b>",
        "a hint": "提示",
        "must be {what}": "须为 {what}",
    }
)


@pytest.mark.parametrize(
    "text",
    [
        "classic2",
        "1.2e-3",
        "",
        "x",
        "omega_s < 3 & y",
        "no such text",
        "<br>",
        "a hint: must be 3",
        "a &lt; <b>b</b>",
    ],
)
def test_a_text_that_is_not_known_stays(text: str) -> None:
    """It is not taken apart."""
    assert SAY.text(text) == text


def test_texts_in_html_are_translated_and_the_rest_stays() -> None:
    html = (
        '<p class="a hint" title="a hint">See <b id="x">this</b> and <math>a</math></p><i>damping ratio</i>'
    )
    said = '<p class="a hint" title="提示">参见<math>a</math>和<b id="x">这</b></p><i>阻尼比</i>'
    assert SAY.text(html) == said
    hidden = '<div id="sb-run" hidden data-x="1">damping ratio</div><style>p {}</style>'
    assert SAY.text(hidden) == hidden


def test_a_translation_cannot_bring_in_elements() -> None:
    assert (
        Wording({"a text": "<script>x</script>"}).text("<p>a text</p>")
        == "<p>&lt;script&gt;x&lt;/script&gt;</p>"
    )


SYMBOLS = frozenset("TOML CSV RMS dB min Shift".split())


@pytest.mark.parametrize(
    "text",
    [
        *(kind.look_for for kind in load() if kind.look_for),
        PageText("{label} {sign} ({unit})", label="largest tilt", sign="≤", unit="m/s"),
        PageText(
            "{what}; the dashed line is the floor", what=PageText("standard deviation, steady state at rest")
        ),
        PageText("{source}, {how}", source="gyro white noise", how="as a constant"),
        PageText("output / step"),
    ],
)
def test_no_word_of_a_line_of_the_page_stays_english(language: str, text: str) -> None:
    said = Wording(read_texts(language), language).text(text)
    plain = re.sub(r"<[^>]*>|\([^()]*\)", "", said)
    assert set(re.findall(r"[A-Za-z]{3,}", plain)) <= SYMBOLS, said
