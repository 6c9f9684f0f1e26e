"""Texts in Python files: the templates of `navcore.foundation.text.Text`, as pybabel extracts them."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from babel.messages.extract import extract

from schuler_bench.languages.markup import has_markup, has_words, hidden, in_pieces

KEYWORDS = {"Text": None, "plural": (1, 2)}
"""Functions whose first text is one of the page; `Text.plural` has two."""


@dataclass(frozen=True)
class Text:
    """A text that a page may show.

    Attributes
    ----------
    key : str
        English, values in braces.
    where : str
        File.
    many : str
        The form for several, where there are two.
    prose : bool
        It must have a translation; another word may have one.
    """

    key: str
    where: str
    many: str = ""
    prose: bool = True


def texts_in(path: Path, name: str) -> Iterator[Text]:
    """Texts in a Python file.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    name : str
        What it is called in `Text.where`.
    """
    with path.open("rb") as file:
        for _, message, _, _ in extract("python", file, KEYWORDS):
            one, *many = (message,) if isinstance(message, str) else message
            if has_markup(hidden(one)):
                yield from pieces(hidden(one), name)
            elif has_words(one):
                yield Text(" ".join(one.split()), name, " ".join("".join(many).split()))


def pieces(html: str, where: str, *, prose: bool = True) -> Iterator[Text]:
    """Texts in some HTML; ``prose`` as `Text.prose`."""
    for key in in_pieces(html):
        if has_words(key):
            yield Text(key, where, prose=prose)
