"""Texts with named values: English where they are made, another language where somebody reads that."""

from __future__ import annotations

import threading
from typing import Any

_MOST_KEPT = 50_000
_origins: dict[str, Text] = {}
_keeping = threading.Lock()
"""Texts are made in many threads: the oldest cannot be looked for while another one is added."""


class Text(str):
    """A sentence with values in it, which is its English form and keeps what it is made of.

    A reader of another language is given the template's translation with the same values
    (`app.languages.wording`). The sentence may be put into HTML, JSON or a plotly figure, whole: `origin_of`
    returns the `Text` that a sentence was made as.

    Parameters
    ----------
    template : str
        English, values in braces with a format if need be: ``"{count} runs in {time:.3g} s"``.
    **values
        Values by name; one that is a `Text`, or a fixed text of the program, is translated too.

    Examples
    --------
    >>> text = Text("run {number}: {share:.0%}", number=3, share=0.25)
    >>> text, text.values["number"]
    ('run 3: 25%', 3)
    """

    forms: tuple[str, ...]
    values: dict[str, Any]

    def __new__(cls, template: str, /, *many: str, **values: Any) -> Text:
        """Fill the values in; ``many`` is given by `plural` alone."""
        one = not many or values["count"] == 1
        text = super().__new__(cls, (template if one else many[0]).format(**values))
        text.forms, text.values = (template, *many), values
        with _keeping:
            _origins[" ".join(text.split())] = text
            if len(_origins) > _MOST_KEPT:
                del _origins[next(iter(_origins))]
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

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the template and the values, so that the text is known where it arrives."""
        return _again, (self.forms, self.values)


def _again(forms: tuple[str, ...], values: dict[str, Any]) -> Text:
    return Text(*forms, **values)


def origin_of(sentence: str) -> Text | None:
    """Return the text that a sentence was made as; None for any other string."""
    return _origins.get(" ".join(sentence.split()))
