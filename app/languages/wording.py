"""One language: what its catalogue says for a text, with values in it or not, and for several in one.

A text of the catalogue may have values in it, ``Run {0}: {1} methods``. What a page is sent has them
filled in, so that the text is recognised by what stands between them; the values themselves are translated
too. A text that is made of several, such as a help text and the range after it, is taken apart at its
punctuation.
"""

import gettext
import re
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path

from app.languages import markup
from app.languages.names import NAME, NONE, Names
from navcore.foundation.text import Text, origin_of

FOLDER = Path(__file__).parent
DOMAIN = "schuler"
NAMES = {"en": "English", "zh-CN": "中文（简体）"}
"""Languages of the page, each by its own name."""
_VALUE = re.compile(r"\{[0-9]+\}")
_NAMED = re.compile(r"%\{\{[^{}]*\}\}|\{[a-z][^{}]*\}")
_TAGS = re.compile(r"</?([a-z]+)>")
_WORD = re.compile(r"[^\W\d_]{2,}")
_LETTERS = re.compile(r"[A-Za-z]{2,}")
_SEPARATORS = tuple(
    re.compile(separator)
    for separator in (
        r"(\n+)",
        r"(?<=[.!?])(?<!eq\.)(?<!eqs\.)(?<!fig\.)(?<!figs\.)( )(?=[A-Z0-9(])",
        r"(; )",
        r"(: )",
        r"(, (?:and |or )?)",
        rf"(^{NAME} )(?=\()",
        r"( \(|\))",
        r"( / |/(?=[a-z]{3})| -> | → )",
    )
)
_WITHIN = _SEPARATORS[2:]
"""Separators within a sentence."""
_JOINTS = {"; ": "；", ": ": "：", ", ": "，", ", and ": "和", ", or ": "或"}
_LONGEST = 6000
_DEEPEST = 12
_MOST_PARTS = 15
_WEAK = 11
_LONGEST_VALUE = 40
_ENDS = {".": "。", ":": "："}
_WITH_UNIT = re.compile(r"(.+?) (\([^()]*\))((?:, [a-z]+)?)")
_NUMBERED = re.compile(r"\d+ [a-z]{3,}")
_FIELD = re.compile(r"[\w-]+\.[\w.-]+(?: = [^:]*)?: ")
"""The file or field in which something is wrong, and its value, before what is said of it."""
_UNENDED = re.compile(r"[A-Za-z%)]\Z")
_PROSE = re.compile(r"(?<![a-z])[a-z]{3,} [a-z]{2,} [a-z]{2,}")
"""Several words of a sentence: where they have no translation, nothing around them is translated."""
_TWO_WORDS = re.compile(r"(?<![A-Za-z])[A-Za-z]+,? [A-Za-z]+,? ")
_MANY = re.compile(r"(?<![A-Za-z])[A-Za-z]{2,},? [A-Za-z]{2}")
_ENDED = re.compile(r"[.;:] ")
_MOST_KEPT = 20_000
_LONGEST_KEPT = 50_000
"""Letters of a text with markup: a longer one, a whole page to be saved, is not kept with its translation."""


@dataclass(frozen=True)
class _Pattern:
    """A text of the catalogue with values in it, and its translation with the values as ``{0}``."""

    pattern: re.Pattern[str]
    said: str
    weight: int  # letters of the text itself: of two texts that match, the one that says more is meant
    labels: bool  # a colon stands in the text itself

    @cached_property
    def greedy(self) -> re.Pattern[str]:
        """Matches it with its values as long as can be; few texts need it."""
        return re.compile(self.pattern.pattern.replace(">.*?)", ">.*)"), re.DOTALL)

    def values(self, text: str) -> tuple[str, ...] | None:
        """Values in a text, the shortest that fit, else the longest; None when it is another one."""
        found = self.pattern.fullmatch(text)
        if found is None:
            return None
        values = self._fit(found.groups(default=""), text)
        longest = self.greedy.fullmatch(text) if values is None else None
        return values if longest is None else self._fit(longest.groups(default=""), text)

    def _fit(self, values: tuple[str, ...], text: str) -> tuple[str, ...] | None:
        """Values that a text can mean, None when they cannot be meant."""
        if values and values[-1].endswith(".") and text.endswith(values[-1]):  # the sentence's own
            return None
        if "\n" not in self.said and any("\n" in value.strip() for value in values):  # a line is a text
            return None
        # "A: tilt from log error" is a label and a text: the label is not part of the text's first value.
        if self.pattern.pattern.startswith("(?P") and not self.labels and ": " in values[0]:
            return None
        by_chance = self.weight < _WEAK and _TAGS.search(text) is not None
        return None if by_chance else values


class Wording:
    """Texts of a language.

    Parameters
    ----------
    texts : dict of str to str
        English and its translation; values as ``{0}``, literal braces nowhere.
    name : str
        Of the language, as a browser tells it.
    """

    def __init__(self, texts: dict[str, str], name: str = "") -> None:
        self.name = name
        self._templates = texts
        texts = dict(positional(key, said) for key, said in texts.items())
        self._exact = {key: said for key, said in texts.items() if _VALUE.search(key) is None}
        self._by_word: dict[str, list[_Pattern]] = {}
        patterns = {key: said for key, said in texts.items() if key not in self._exact}
        often: dict[str, int] = {}
        for key in patterns:
            for word in words_of(key):
                often[word] = often.get(word, 0) + 1
        for key, said in patterns.items():
            rarest = min(words_of(key), key=lambda word: often[word], default=None)
            if rarest is not None:
                self._by_word.setdefault(rarest, []).append(_pattern(key, said))
        self.say = lru_cache(maxsize=_MOST_KEPT)(self._say)
        self.markup = lru_cache(maxsize=_MOST_KEPT // 8)(self._markup)

    def _markup(self, html: str) -> str:
        if "<br>" in html:  # a long text of a figure, broken into lines
            lines = html.split("<br>")
            whole = " ".join(" ".join(lines).split())
            said = None if _TAGS.search(whole) or len(whole) < _WEAK * len(lines) else self._whole(whole, 0)
            if said is not None:
                width = -(-len(said) // len(lines))
                return "<br>".join(said[at : at + width] for at in range(0, len(said), width))
        return markup.translate(html, self.say)

    def text(self, text: str, names: Names = NONE) -> str:
        """Translate a text of the page, HTML or not; what has no translation stays as it is.

        Parameters
        ----------
        text : str
            In English.
        names : Names
            What users have called something: it stays as they wrote it.
        """
        if len(text) < 2 or _LETTERS.search(text) is None:
            return text
        if (origin := origin_of(text)) is not None:
            return self._rendered(origin, names)
        if not names.within(text):
            if not markup.has_markup(text):
                return self.say(text)
            return self.markup(text) if len(text) <= _LONGEST_KEPT else self._markup(text)
        if not markup.has_markup(names.hidden(text)[0]) and not text.lstrip().startswith("<"):
            return self._around_names(text, names)
        return markup.translate(text, lambda piece: self._around_names(piece, names))

    def _rendered(self, text: Text, names: Names) -> str:
        """Fill the values, each in this language, into the translation; without one all stays English."""
        said = self._templates.get(text.forms[0])
        if said is None:
            return str(text)
        values = {
            name: self.text(str(value), names) if isinstance(value, str) else value
            for name, value in text.values.items()
        }
        return said.format(**values)

    def _around_names(self, text: str, names: Names) -> str:
        """Translate a text without markup in which there may be names.

        A name may also be a word of the text itself, such as "log". Of the readings, the name as a name,
        as a word, as a label, and the text before and after it apart, the first that leaves least in English
        is meant.
        """
        if names.are(text):
            return text
        if (origin := origin_of(text)) is not None:
            return self._rendered(origin, names)
        around, found = names.hidden(text)
        if not found or " ".join(text.split()) in self._exact:  # the page's own text, all of it
            return self.say(text)
        said = [self.say(around), names.hidden(self.say(text))[0]]
        if _TAGS.search(text) is None:  # else `markup` takes it apart
            label, _, rest = around.partition(": ")
            said += [f"{label}：{self.say(rest)}"] if re.fullmatch(NAME, label) else []
            said.append("".join(self.say(part) for part in re.split(f"({NAME})", around)))
        return names.shown(min(said, key=lambda one: len(_LETTERS.findall(one))), found)

    def _say(self, text: str) -> str:
        found = self._look_up(text)
        return text if found is None else found

    def _look_up(self, text: str, depth: int = 0) -> str | None:
        """Return the translation, None when not even a part of it is known."""
        bare = text.strip()
        if depth > _DEEPEST or not bare or len(bare) > _LONGEST or _LETTERS.search(bare) is None:
            return None
        key = " ".join(bare.split()) if "\n" not in bare else bare
        said = self._whole(key, depth)
        if said is None and _TAGS.search(key) is None:  # with elements in it, `markup` takes it apart
            said = self._take_apart(key, depth)
        if said is None:
            return None
        lead, tail = text[: len(text) - len(text.lstrip())], text[len(text.rstrip()) :]
        return f"{lead}{said}{tail}"

    def _whole(self, key: str, depth: int) -> str | None:
        """Return the translation of one text of the catalogue, with or without values."""
        if (origin := origin_of(key)) is not None:
            return self._rendered(origin, NONE)
        for text, end in ((key, ""), (key[:-1], _ENDS.get(key[-1:], ""))):
            if text is not key and not end:
                break
            for form in dict.fromkeys((text, text[:1].lower() + text[1:])):  # a label may begin a sentence
                said = self._exact.get(form) or self._match(form, depth)
                if said is not None:
                    return said + end
        if _UNENDED.search(key) and _TWO_WORDS.search(key):  # its stop is another text's
            said = self._exact.get(f"{key}.") or self._match(f"{key}.", depth)
            if said is not None:
                return said.rstrip("。.")
        label = _WITH_UNIT.fullmatch(key)
        said = None if label is None else self._exact.get(label[1])
        if label is None or said is None:
            return None
        return f"{said} {label[2]}{self._value(label[3], depth)}"

    def _match(self, text: str, depth: int) -> str | None:
        words = dict.fromkeys(_WORD.findall(text))
        near = [pattern for word in words for pattern in self._by_word.get(word, ())]
        for one in sorted(near, key=lambda one: -one.weight):
            found = one.values(text)
            if found is None:
                continue
            weak = one.weight < _WEAK
            said = [self._value_of_weak(v, depth) if weak else self._value(v, depth) for v in found]
            if all(value is not None for value in said):
                return _filled(one.said, [value or "" for value in said])
        return None

    def _value(self, value: str, depth: int) -> str:
        if _TAGS.search(value) is not None and depth <= _DEEPEST:
            return markup.say_inside(value, lambda text: self._look_up(text, depth + 1) or text)
        found = self._look_up(value, depth + 1)
        return value if found is None else found

    def _value_of_weak(self, value: str, depth: int) -> str | None:
        """Translate a value of a text that fits much by chance, having few letters; None when it is no value.

        It is a word, or several that are known, and a sentence only when it is one of the catalogue.
        """
        sentence = len(value) > _LONGEST_VALUE or _ENDED.search(value) is not None
        found = self._whole(value, depth + 1) if sentence else self._look_up(value, depth + 1)
        is_word = not sentence and _MANY.search(value) is None and _NUMBERED.match(value) is None
        return value if found is None and is_word else found

    def _take_apart(self, text: str, depth: int) -> str | None:
        at = 0
        while (field := _FIELD.match(text, at)) is not None:
            at = field.end()
        told = self._whole(text[at:], depth + 1) if 0 < at < len(text) else None
        if told is not None:
            return text[:at] + told
        head, _, part = text.partition(" ")
        if head in self._exact and part in self._exact and " / " in part:  # "bias E / starboard"
            return f"{self._exact[head]} {self._exact[part]}"
        for separator in _SEPARATORS:
            parts = separator.split(text)
            if len(parts) > 1:
                said = self._part_by_part(parts, depth, separator in _WITHIN)
                if said is not None:
                    return said
        return self._begin(text, depth)

    def _begin(self, text: str, depth: int) -> str | None:
        """Translate a label before the name of an axis: "gyro bias x"."""
        words = text.split(" ")
        for count in range(len(words) - 1, max(0, len(words) - 4), -1):
            label = " ".join(words[:count])
            said = self._exact.get(label)
            if said is not None:
                number = [word for word in words[count : count + 1] if word.isdigit()]  # "event 2 begins"
                rest = " ".join(words[count + len(number) :])
                return " ".join([said, *number, *([self._value(rest, depth)] if rest else [])])
        return None

    def _part_by_part(self, parts: list[str], depth: int, within: bool) -> str | None:
        """Translate parts and the separators between them: as many parts at once as are one text.

        ``within`` a sentence all of it is translated or nothing.
        """
        said: list[str] = []
        place, known = 0, False
        while place < len(parts):
            ends = range(min(len(parts), place + _MOST_PARTS), place, -2) if len(parts) > place + 2 else ()
            for end in ends:
                found = (
                    self._whole("".join(parts[place:end]), depth + 1) if end - place < len(parts) else None
                )
                if found is not None:
                    break
            else:
                end, found = place + 1, self._look_up(parts[place], depth + 1)
            if found is None and within and _PROSE.search(parts[place]):
                return None
            known = known or found is not None
            said += ["".join(parts[place:end]) if found is None else found, *parts[end : end + 1]]
            place = end + 1
        return _joined(said) if known else None


def positional(key: str, said: str) -> tuple[str, str]:
    """Number the values of a template, by which a text that was joined with others is recognised."""
    for number, mark in enumerate(dict.fromkeys(_NAMED.findall(key))):
        key, said = key.replace(mark, f"{{{number}}}"), said.replace(mark, f"{{{number}}}")
    return key, said


def _filled(said: str, values: list[str]) -> str:
    return _VALUE.sub(lambda at: values[int(at[0][1:-1])], said)


def _joined(parts: list[str]) -> str:
    out = parts[0]
    for joint, part in zip(parts[1::2], parts[2::2], strict=True):
        chinese = _is_wide(out[-1:]) or _is_wide(part[:1])
        if joint == " " and _is_wide(out[-1:]):
            joint = ""
        elif chinese:
            joint = _JOINTS.get(joint, joint)
        out += joint + part
    return out


def _is_wide(letter: str) -> bool:
    return letter >= "\u3000" and not "\ue000" <= letter <= "\uf8ff"


def words_of(text: str) -> list[str]:
    """Words that stand whole in a text of the catalogue, none of them touching a value.

    Examples
    --------
    >>> words_of("Run {0}: {1} method{2}")
    ['Run']
    """
    bare = _VALUE.sub("\0", text)
    return [
        found[0]
        for found in _WORD.finditer(bare)
        if "\0" not in bare[max(found.start() - 1, 0) : found.end() + 1]
    ]


def _pattern(key: str, said: str) -> _Pattern:
    parts = _VALUE.split(key)
    order = [int(found[0][1:-1]) for found in _VALUE.finditer(key)]
    pattern = re.escape(parts[0])
    for number, part in zip(order, parts[1:], strict=True):
        again = f"(?P=v{number})" if f"(?P<v{number}>" in pattern else f"(?P<v{number}>.*?)"
        pattern += again + re.escape(part)
    return _Pattern(re.compile(pattern, re.DOTALL), said, sum(map(len, parts)), ":" in key)


def read_texts(language: str) -> dict[str, str]:
    """All texts of a language's catalogue with their translations; FileNotFoundError where there is none."""
    found = gettext.translation(DOMAIN, FOLDER, [language.replace("-", "_")])
    texts: dict[str, str] = getattr(found, "_catalog")  # noqa: B009 - the standard library lists them nowhere else
    return {key[0] if isinstance(key, tuple) else key: said for key, said in texts.items() if key and said}


@lru_cache(maxsize=8)
def wording(language: str) -> Wording | None:
    """Return the texts of a language; None for English and for a language without a catalogue."""
    return Wording(read_texts(language), language) if language in NAMES and language != "en" else None
