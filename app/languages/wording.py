"""One language: its catalogue, and how a text of the page is put into it.

A text is looked up by its template and its values are filled in, each translated as well. A text in HTML is
looked up piece by piece (`schuler_bench.languages.markup`). What has no translation stays English, the
values in it included.
"""

import gettext
import re
from functools import lru_cache
from pathlib import Path
from typing import Any

from navcore.foundation.text import WIDE, Text, Words, filled
from schuler_bench.languages import markup
from schuler_bench.languages.markup import CLOSE, OPEN

FOLDER = Path(__file__).parent
DOMAIN = "schuler"
NAMES = {"en": "English", "zh-CN": "中文（简体）"}
"""Languages of the page, each by its own name."""
NONE: frozenset[str] = frozenset()
"""No names."""
_VALUE = re.compile(r"\{([0-9]+|[a-z][^{}]*)\}")
_NAMED = re.compile(f"{OPEN}([a-z][^{CLOSE}]*){CLOSE}")
_JOINTS = {"; ": "；", ": ": "：", ", ": "，", " (": "（", ")": "）"}
_MOST_KEPT = 4_000
_LONGEST_KEPT = 50_000
"""Letters of a text with markup: a longer one, a whole page to be saved, is not kept with its translation."""


class Wording:
    """Texts of a language.

    Parameters
    ----------
    texts : dict of str to str
        English and its translation, both with their values in braces.
    name : str
        Of the language, as a browser tells it.
    """

    def __init__(self, texts: dict[str, str], name: str = "") -> None:
        self.name, self._texts = name, texts
        self._kept = lru_cache(maxsize=_MOST_KEPT)(self._in_html)

    def text(self, text: str, names: frozenset[str] = NONE) -> str:
        """Translate a text of the page, HTML or not; what has no translation stays as it is.

        Parameters
        ----------
        text : str
            In English; as a `Text` where there are values in it.
        names : frozenset of str
            What users have called something: a text or a value that is one of these stays as it is.
        """
        if isinstance(text, Text):
            return self._filled(text, names)
        if text in names or markup.LETTERS.search(text) is None:
            return text
        said = self._said(text)
        if said is None and markup.has_markup(text):
            return (self._kept if len(text) <= _LONGEST_KEPT else self._in_html)(text, names)
        return text if said is None else said

    def _said(self, key: str) -> str | None:
        """Translation of a text in whatever lines it was written."""
        return self._texts.get(key) or self._texts.get(" ".join(key.split()))

    def _in_html(self, text: str, names: frozenset[str]) -> str:
        return markup.translate(text, lambda piece: self._piece(piece, names) or piece)

    def _piece(self, piece: str, names: frozenset[str]) -> str | None:
        """Translate a piece of HTML, in which values stand between `OPEN` and `CLOSE`; None: no words."""
        if piece in names:
            return piece
        key, values = markup.key_of(piece)
        said = self._said(key)
        if said is not None:
            return _VALUE.sub(lambda match: _hidden(match[1], values), said)
        return piece if markup.has_words(key) else None

    def _filled(self, text: Text, names: frozenset[str]) -> str:
        """Fill the values, each in this language, into the translation of the template."""
        template = text.forms[0]
        said = self._said(template)
        in_html = said is None and markup.has_markup(template)
        if said is None and not in_html:
            if markup.has_words(template):
                return str(text)
            said = template
        values = {
            name: Words(self.text(value, names)) if isinstance(value, str) else value
            for name, value in text.values.items()
        }
        if said is None:
            return self._filled_html(text, values, names)
        if said is template and any(WIDE.search(str(value)) for value in values.values()):
            for joint, wide in _JOINTS.items():
                said = said.replace(joint, wide)
        return filled(said, values)

    def _filled_html(self, text: Text, values: dict[str, Any], names: frozenset[str]) -> str:
        """Translate a template in HTML piece by piece; an unknown piece keeps its values in English."""
        one, *many = text.forms
        template = many[0] if many and text.values["count"] != 1 else one

        def piece(key: str) -> str:
            said = self._piece(key, names)
            return _NAMED.sub(rf"{OPEN}!\1{CLOSE}", key) if said == key else key if said is None else said

        def value(match: re.Match[str]) -> str:
            name, _, spec = match[1].lstrip("!").partition(":")
            return filled(f"{{{name}:{spec}}}", text.values if match[1][0] == "!" else values)

        return markup.HIDDEN.sub(value, markup.translate(markup.for_scripts(markup.hidden(template)), piece))


def _hidden(field: str, values: list[str]) -> str:
    if field.isdigit():
        return values[int(field)]
    return f"{OPEN}{field}{'' if ':' in field else ':'}{CLOSE}"


def read_texts(language: str) -> dict[str, str]:
    """All texts of a language's catalogue with their translations; FileNotFoundError where there is none."""
    catalogue = gettext.translation(DOMAIN, FOLDER, [language.replace("-", "_")])
    texts: dict[str, str] = getattr(catalogue, "_catalog")  # noqa: B009 - the standard library lists them nowhere else
    return {key[0] if isinstance(key, tuple) else key: said for key, said in texts.items() if key and said}


@lru_cache(maxsize=8)
def wording(language: str) -> Wording | None:
    """Return the texts of a language; None for English and for a language without a catalogue."""
    return Wording(read_texts(language), language) if language in NAMES and language != "en" else None
