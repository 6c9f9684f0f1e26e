"""The language of a page: what its script has chosen, else what the browser asks for."""

from __future__ import annotations

import re
from collections.abc import Iterable

from app.http.access import RequestHeaders, cookies
from app.languages.wording import NAMES

COOKIE = "schuler_language"
"""Written by language.js: ``?lang=``, the visitor's last choice, or the browser's first language we have."""
ENGLISH = "en"
_LONGEST = 500


def language_of(headers: RequestHeaders) -> str:
    """Language for a request: one of `app.languages.wording.NAMES`."""
    chosen = cookies(headers, COOKIE)
    if chosen:
        return _known(chosen[-1:])
    return _known(_accepted(headers.get_all("Accept-Language")))


def _known(wanted: Iterable[str]) -> str:
    """First of some languages that we have.

    Examples
    --------
    >>> _known(["fr-CH", "zh-TW", "en"]), _known(["de", "en-GB", "zh"]), _known(["xx"])
    ('zh-CN', 'en', 'en')
    """
    for name in wanted:
        first = name.strip().lower().partition("-")[0]
        for own in NAMES:
            if own.partition("-")[0] == first:
                return own
    return ENGLISH


def _accepted(lines: Iterable[str]) -> list[str]:
    """Languages of an Accept-Language header, the most wanted first; what cannot be read is left out.

    Examples
    --------
    >>> _accepted(["en;q=0.7, zh-CN, *;q=0.1, zh;q=0.9"])
    ['zh-CN', 'zh', 'en']
    """
    found: list[tuple[float, str]] = []
    for part in ",".join(lines)[:_LONGEST].split(","):
        one = re.fullmatch(
            r"\s*([A-Za-z]{1,8}(?:-[A-Za-z0-9]{1,8})*)\s*(?:;\s*q=([01](?:\.[0-9]{0,3})?))?\s*", part
        )
        if one is not None:
            found.append((-float(one[2] or 1.0), one[1]))
    return [name for _, name in sorted(found, key=lambda pair: pair[0])]
