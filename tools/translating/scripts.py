"""Texts in scripts: prose in string literals, and in the HTML of template literals."""

import re
from collections.abc import Iterator
from pathlib import Path

from app.languages.markup import CLOSE, OPEN, in_pieces
from tools.translating.python import Text, is_prose, numbered

_COMMENT = re.compile(r"^\s*//.*$|(?<=[;{},]) //.*$", re.MULTILINE)
_LITERAL = re.compile(r'((?:"(?:[^"\\\n]|\\.)*"\s*\+\s*)*"(?:[^"\\\n]|\\.)*")|`((?:[^`\\]|\\.)*)`')
_VALUE = re.compile(r"\$\{(?:[^{}`]|`[^`]*`|\{[^{}]*\})*\}")
_SELECTOR = re.compile(r"[\[\]#=]|^\.|::|^\(")
_WORD = re.compile(r"[a-z-]+")


def texts_in(path: Path, name: str) -> Iterator[Text]:
    """Texts in a script; values as ``{0}``."""
    source = _COMMENT.sub("", path.read_text(encoding="utf-8"))
    for found in _LITERAL.finditer(source):
        plain, template = found.groups()
        inner = [
            piece[1] for piece in re.finditer(r"`((?:[^`$\\]|\\.)*)`", template or "") if "<" in piece[1]
        ]
        text = (
            "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', plain))
            if plain
            else _VALUE.sub(OPEN + CLOSE, template)
        )
        for part in (text, *inner):
            for piece in in_pieces(part):
                key = numbered(piece.replace("\\n", "\n"))
                bare = re.sub(r"\{\d+\}", "", key)
                if re.search("[A-Za-z]{3,}", bare) and _SELECTOR.search(key) is None:
                    if "<" not in part and _WORD.fullmatch(key):
                        continue
                    yield Text(key, name, is_prose(key) or "<" in part)
