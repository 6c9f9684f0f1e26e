"""Names that users gave: a method, a pin, a file. They are found in a text, and stay as they are written."""

import re
from collections.abc import Iterable
from functools import lru_cache
from html import escape

_FIRST, _MOST_IN_A_TEXT = 0xE100, 200
"""A letter of nobody's alphabet stands for each name while the text around it is looked up."""
NAME = "[\ue100-\ue1ff]"
"""Pattern of such a letter."""
_SHORTEST = 2


class Names:
    """Names that users have given.

    Parameters
    ----------
    names : iterable of str
        As they wrote it; what has less than two letters is left out.
    """

    def __init__(self, names: Iterable[str]) -> None:
        given = {name for name in map(str.strip, names) if len(name) >= _SHORTEST}
        # As plotly and HTML hold them, too; the longer one first, for a name may begin another one.
        forms = {form for name in given for form in (name, escape(name), escape(name, quote=False))}
        either = "|".join(map(re.escape, sorted(forms, key=lambda form: (-len(form), form))))
        self._pattern = re.compile(rf"(?<!\w)(?:{either})(?!\w)") if forms else None

    def within(self, text: str) -> bool:
        """Whether a name stands in a text, HTML or not."""
        return self._pattern is not None and self._pattern.search(text) is not None

    def are(self, text: str) -> bool:
        """Whether a text is a name and nothing else."""
        bare = text.strip()
        return self._pattern is not None and self._pattern.fullmatch(bare) is not None

    def hidden(self, text: str) -> tuple[str, list[str]]:
        """Exchange each name for a letter that no text has; return the names in these letters' order."""
        found: list[str] = []

        def hide(name: re.Match[str]) -> str:
            if name[0] not in found:
                if len(found) >= _MOST_IN_A_TEXT:
                    return name[0]
                found.append(name[0])
            return chr(_FIRST + found.index(name[0]))

        return (text, found) if self._pattern is None else (self._pattern.sub(hide, text), found)

    def shown(self, text: str, found: list[str]) -> str:
        """Put the names back that `hidden` has found."""
        letters = {_FIRST + place: name for place, name in enumerate(found)}
        return text.translate(letters)


NONE = Names(())


@lru_cache(maxsize=64)
def names_of(names: frozenset[str]) -> Names:
    """Make `Names`, once for the same ones."""
    return Names(names)
