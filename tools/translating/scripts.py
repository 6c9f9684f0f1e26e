"""Texts in scripts: prose in string literals, and in the HTML of template literals."""

import re
from collections.abc import Iterator
from pathlib import Path

from schuler_bench.languages.markup import CLOSE, OPEN, in_pieces
from tools.translating.python import Text

_PROSE = re.compile(
    r"[A-Za-z][A-Za-z'’-]+[,;:]? +(?:\{\d+\} *)*[A-Za-z(<\"'{]|\} [a-z]{3,}|[a-z]{3,}[:,]? \{"
)
_NAME = re.compile(r"[A-Z][a-z]+")
_CODE = re.compile(
    r"^[#.]?[\w-]+\s*\{[^0-9]|[a-z-]+:\s*[^;{}]*;|^--|\bvar\(|^[MmLl]\d|^/|^\w+(\.\w+)+$|\d+px\b|\}px\b"
    r"|^<?tr |^sb-|^pointer-|HTTP/|^Content-|-apple-system|^<|\\[a-z]+\{|^data-"
)
_SENTENCE = re.compile(r"(?:\b[A-Za-z]+[,:;]? ){5}")
"""Six words one after the other: no style or path has them."""
_NO_TEXTS = frozenset(
    "Enter|Escape|Slider|Select|Schuler Bench|Infinity|Library|Application Support|page command|page state|"
    "page painted|pair handle|<span>{0}</span>|Hz|skip|height|alpha|{0} next|{0} open {1}|{0} list|"
    "{0}px {1}".split("|")
)
"""Strings that look like prose and are none: keys, labels and arguments for scripts."""
_CITATION = re.compile(
    r"(?:Deng|Liu|Zhao|Sun|Zha|theory\.md|eq\.|eqs\.|figs?\.|"
    r"table|tables|and|to|et al\.|[0-9.,;:() +-]|\{\d+\})+"
)
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
            else _VALUE.sub(f"{OPEN}${CLOSE}", template)
        )
        for part in (text, *inner):
            for piece in in_pieces(part):
                key = "\n".join(" ".join(line.split()) for line in piece.replace("\\n", "\n").split("\n"))
                bare = re.sub(r"\{\d+\}", "", key)
                if re.search("[A-Za-z]{3,}", bare) and _SELECTOR.search(key) is None:
                    if "<" not in part and _WORD.fullmatch(key):
                        continue
                    yield Text(key, name, prose=is_prose(key) or "<" in part)


def is_prose(key: str) -> bool:
    """Whether a text is meant for a reader, as far as can be seen from it.

    Examples
    --------
    >>> [is_prose(text) for text in ("Undo", "largest tilt", "time_s", "color:red;", "Run {0}: {1} ms")]
    [True, True, False, False, True]
    >>> is_prose("Poles left of it die away: the farther left, the faster; steep ones swing.")
    True
    """
    bare = re.sub(r"<[^>]*>", "", key).strip()
    if _SENTENCE.search(bare):
        return True
    if _CODE.search(bare) or bare in _NO_TEXTS or _CITATION.fullmatch(bare):
        return False
    return _PROSE.search(bare) is not None or _NAME.fullmatch(bare.strip(" .:;,")) is not None
