"""Texts in HTML: which pieces a reader takes as one, so that each is translated as a whole.

A piece lies between two block elements. Inline elements (``<b>``, ``<code>``, ``<a>``) belong to it and
stand in its key without their attributes; formulas and the live numbers of a lesson count as a value.
Texts of plotly are read in the same way: they know a little HTML, and ``%{y:.3g}`` stands for a value there.
"""

import json
import re
from collections.abc import Callable
from html import escape, unescape
from string import Formatter

OPEN, CLOSE = "\ue000", "\ue001"
"""Around the number of a value while a text is looked up; no text has these letters."""
HIDDEN = re.compile(f"{OPEN}([^{CLOSE}]*){CLOSE}")
"""A value; a number or a name with a format."""


def _element(name: str, attributes: str = r"\b[^<>]*>") -> str:
    """Pattern of an element and all that it holds. It stops at its like: no text takes long to search."""
    return rf"<{name}{attributes}(?>(?:[^<]|<(?!{name}\b|/{name}>))*)</{name}>"


_MATH = _element("math")
_OPAQUE = re.compile(
    rf"{_MATH}|<span class=.sb-(?:live|formula)\b[^<>]*>(?:{_MATH}|[^<]*)</span>|"
    r"%\{[^{}]*\}|"
    r"<[a-z]++ (?>[^<>]*?translate=.no.)[^<>]*+>[^<]*</[a-z]+>"
)
_LIVE = re.compile(r"(<span class=.sb-live\b[^<>]*>)([^<]*)")
"""A number of a lesson; it may have a word for its unit, and a title."""
_HIDDEN = "|".join(
    (
        _element("pre"),
        _element("style"),
        _element("script"),
        _element("div", r" id=.sb-[a-z]+. hidden\b[^<>]*>"),
    )
)
_TOKEN = re.compile(rf"({_HIDDEN}|</?[a-zA-Z][^<>]*>|<!--(?>(?:[^-<]|-(?!->)|<(?!!--))*)-->)")
_INLINE = re.compile(r"<(/?)(b|i|em|strong|code|sub|sup|a|span|kbd|small|var)\b([^>]*)>")
_ATTRIBUTE = re.compile(r'(?<![\w-])(title|aria-label|aria-valuetext|alt|placeholder|data-told)="([^"]*)"')
_VALUE_IN_TAG = re.compile(f"{_ATTRIBUTE.pattern}|{OPEN}[^{CLOSE}]*{CLOSE}")
_TAG_WITH_VALUE = re.compile(f"<[a-zA-Z][^<>]*{OPEN}[^<>]*>")
_TAG = re.compile(r"</?[a-z]+>")
_PARTS = re.compile(r"(</?[a-z]+>)")
_AROUND = re.compile(r"<([a-z]+)>(.*)</\1>", re.DOTALL)
_BLANKS = re.compile(r"\s+")
LETTERS = re.compile(r"[A-Za-z]{2,}")
"""In a text to translate; a tag may hold words too, in its attributes."""
_BARE = re.compile(r"\{[^{}]*\}|<[^>]*>")

Say = Callable[[str], str]
"""``say(key)``: the translation of a plain text or of a piece."""


def has_markup(text: str) -> bool:
    """Whether a text must be read as HTML, or has values in the manner of plotly."""
    return "%{" in text or ("<" in text and _TOKEN.search(text) is not None)


def has_words(text: str) -> bool:
    """Whether a text has words beside its values and tags: anything to translate."""
    return LETTERS.search(_BARE.sub("", text)) is not None


def hidden(template: str) -> str:
    """Put each field of a template between `OPEN` and `CLOSE`, as markup takes a value for it."""
    return "".join(
        literal + ("" if name is None else f"{OPEN}{name}:{spec}{CLOSE}")
        for literal, name, spec, _ in Formatter().parse(template)
    )


def key_of(piece: str) -> tuple[str, list[str]]:
    """Key of a piece in the catalogue, and those of its values that have no name: they count as ``{0}``."""
    values: list[str] = []

    def field(match: re.Match[str]) -> str:
        if match[1][0].isalpha():
            return f"{{{match[1].rstrip(':')}}}"
        values.append(match[0])
        return f"{{{len(values) - 1}}}"

    return HIDDEN.sub(field, piece), values


def in_pieces(html: str) -> list[str]:
    """Keys of the texts in some HTML, with those in attributes.

    Examples
    --------
    >>> in_pieces('<p title="a hint">See <b class="x">this</b> &amp; that</p><p>42</p>')
    ['a hint', 'See <b>this</b> & that', '42']
    """
    keys: list[str] = []

    def keep(key: str) -> str:
        keys.append(key_of(key)[0])
        return f"{key} "  # another text: what is the same counts as unknown, and is looked up piece by piece

    translate(html, keep)
    return keys


def translate(html: str, say: Say) -> str:
    """Exchange the texts in some HTML; its elements stay.

    Parameters
    ----------
    html : str
        HTML, or a text of plotly.
    say : callable
        Translates a piece; its inline elements and values are to stand in the translation as well.
    """
    values: list[str] = []

    def hide(match: re.Match[str]) -> str:
        values.append(match[0])
        return f"{OPEN}{len(values) - 1}{CLOSE}"

    def live(found: re.Match[str]) -> str:
        return f"{_attributes(found[1], say)}{escape(say(unescape(found[2])), quote=False)}"

    out: list[str] = []
    piece: list[str] = []
    for token in _TOKEN.split(_OPAQUE.sub(hide, html)):
        if not token.startswith("<") or _INLINE.fullmatch(token):
            piece.append(token)
        elif _TOKEN.fullmatch(token):
            out += [_translate_piece("".join(piece), say), _attributes(token, say)]
            piece = []
        else:
            piece.append(token)
    out.append(_translate_piece("".join(piece), say))
    return re.sub(
        f"{OPEN}([0-9]+){CLOSE}", lambda match: _LIVE.sub(live, values[int(match[1])]), "".join(out)
    )


def for_scripts(html: str) -> str:
    """Put ``!`` before each value in a tag that is no text for a reader: a class, a command."""
    return _TAG_WITH_VALUE.sub(lambda tag: _VALUE_IN_TAG.sub(_marked, tag[0]), html)


def _marked(match: re.Match[str]) -> str:
    return match[0] if match[0][0] != OPEN else f"{OPEN}!{match[0][1:]}"


def _translate_piece(piece: str, say: Say) -> str:
    if not piece.strip():
        return piece
    tags: dict[str, list[str]] = {}
    key = ""
    for token in _TOKEN.split(piece):
        match = _INLINE.fullmatch(token)
        if match is None:
            key += unescape(token)
        else:
            short = f"<{match[1]}{match[2]}>"
            tags.setdefault(short, []).append(_attributes(token, say))
            key += short
    key = _BLANKS.sub(" ", key)
    lead, tail = key[: len(key) - len(key.lstrip())], key[len(key.rstrip()) :]
    said = say_inside(key.strip(), say) if tags else say(key.strip())
    if said == key.strip():
        return _with_attributes(piece, say)
    return lead + _with_tags(said, tags) + tail


def say_inside(key: str, say: Say) -> str:
    """Translate a piece with elements in it: without those around all of it, else part by part."""
    match = _AROUND.fullmatch(key)
    if match is not None and f"<{match[1]}>" not in match[2]:
        inner = match[2].strip()
        said = say_inside(inner, say) if _TAG.search(inner) else say(inner)
        return f"<{match[1]}>{match[2].replace(inner, said)}</{match[1]}>" if inner else key
    said = say(key)
    if said == key:
        said = "".join(part if _TAG.fullmatch(part) else _around(part, say) for part in _PARTS.split(key))
    return said


def _around(text: str, say: Say) -> str:
    """Translate a text between its blanks."""
    bare = text.strip()
    return text.replace(bare, say(bare)) if bare else text


def _with_tags(said: str, tags: dict[str, list[str]]) -> str:
    queues = {short: list(full) for short, full in tags.items()}
    parts = _PARTS.split(said)
    return "".join(queues[part].pop(0) if queues.get(part) else escape(part, quote=False) for part in parts)


def _with_attributes(piece: str, say: Say) -> str:
    return "".join(
        _attributes(token, say) if token.startswith("<") else token for token in _TOKEN.split(piece)
    )


def _attributes(tag: str, say: Say) -> str:
    if "=" not in tag or tag.startswith(("<style", "<script")):
        return tag

    def change(match: re.Match[str]) -> str:
        name, text = match[1], unescape(match[2])
        nested = name == "data-told" and text.startswith("[")  # a list of texts
        said = json.dumps(_walk(json.loads(text), say)) if nested else say(text)
        return match[0] if said == text else f'{name}="{escape(said)}"'

    return _ATTRIBUTE.sub(change, tag)


def _walk(value: object, say: Say) -> object:
    if isinstance(value, list):
        return [_walk(one, say) for one in value]
    return say(value) if isinstance(value, str) else value
