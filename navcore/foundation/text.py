"""Texts with named values: English as a string, in another language where a page is sent it."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache
from html import escape
from typing import Any

WIDE = re.compile("[\u3000-\u9fff\uff00-\uffef]")
"""A letter or stop that Chinese is written in."""


class Words(str):
    """A string that a template can quote, ``{name:html}``, or make a sentence, ``{name:sentence}``."""

    def __format__(self, spec: str) -> str:
        """Format as `str` does; ``html`` quotes for HTML, ``sentence`` begins large and ends with a stop."""
        if spec == "html":
            return escape(str(self))
        if spec == "sentence":
            return f"{self[:1].upper()}{self[1:]}{'。' if WIDE.search(self) else '.'}"
        return super().__format__(spec)


class Text(Words):
    """A text in English, which keeps the template and the values that it consists of.

    `schuler_bench.languages.wording.Wording` looks the template up in a reader's language and fills the
    values in. A text that is put into another one must be a value of that one: an f-string keeps only the
    English.

    Parameters
    ----------
    template : str
        English, values in braces with a format if need be: ``"{count} runs in {time:.3g} s"``. It may hold
        HTML; a value that is no HTML is then quoted, ``"<b>{name:html}</b>"``.
    **values
        Values by name. A value that is a text, or a fixed text of the program, is translated too.

    Examples
    --------
    >>> text = Text("run {number}: {share:.0%}", number=3, share=0.25)
    >>> text, text.values["number"]
    ('run 3: 25%', 3)
    >>> Text("<b>{name:html}</b>", name="a & b")
    '<b>a &amp; b</b>'
    """

    forms: tuple[str, ...]
    values: dict[str, Any]

    def __new__(cls, template: str, /, *many: str, **values: Any) -> Text:
        """Fill the values in; ``many`` is given by `plural` alone."""
        one = not many or values["count"] == 1
        text = super().__new__(cls, filled(template if one else many[0], values))
        text.forms, text.values = (template, *many), values
        return text

    @classmethod
    def plural(cls, one: str, many: str, /, *, count: float, **values: Any) -> Text:
        """Make a text of which ``count``, a value in it, decides the form.

        Examples
        --------
        >>> Text.plural("{count} run", "{count} runs", count=2)
        '2 runs'
        """
        return cls(one, many, count=count, **values)

    @classmethod
    def joined(cls, joint: str, parts: Iterable[str]) -> Text:
        """Join texts, as `str.join` does.

        Examples
        --------
        >>> Text.joined("; ", ["a", "b"])
        'a; b'
        """
        values = {f"part{number}": part for number, part in enumerate(parts)}
        literal = joint.replace("{", "{{").replace("}", "}}")
        return cls(literal.join([f"{{{name}}}" for name in values]), **values)

    def __add__(self, other: str) -> Text:
        """Join with what follows."""
        return Text.joined("", (self, other))

    def __radd__(self, other: str) -> Text:
        """Join with what stands before."""
        return Text.joined("", (other, self))

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the template and the values."""
        return _again, (self.forms, self.values)


def quoted(text: str) -> Text:
    """Quote a text that is put into HTML."""
    return Text("{text:html}", text=text)


def _again(forms: tuple[str, ...], values: dict[str, Any]) -> Text:
    return Text(*forms, **values)


def filled(template: str, values: dict[str, Any]) -> str:
    """Fill values into a template; a string among them can be quoted for HTML."""
    for value in values.values():
        if type(value) not in _SHORT or (type(value) is not int and len(value) > _LONGEST_KEPT):
            return _filled(template, **values)
    return _kept(template, **values)


def _filled(template: str, /, **values: Any) -> str:
    return template.format(
        **{name: Words(value) if type(value) is str else value for name, value in values.items()}
    )


_kept = lru_cache(maxsize=4096, typed=True)(_filled)
"""The same: most texts of a page are made again with the same values at each step of a slider."""
_LONGEST_KEPT = 200
_SHORT = frozenset({str, int, Text})
"""Types that are equal only where their letters are: 0.0 is equal to -0.0."""
