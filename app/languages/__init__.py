"""The page in other languages: English is written in the code, a gettext catalogue holds what others read.

A text of the page is a `navcore.foundation.text.Text`. ``make languages`` writes them into
``<language>/LC_MESSAGES/schuler.po`` and compiles that, and `schuler_bench.bridge.texts` translates what goes
to a page on its way there (`schuler_bench.languages.wording`).
"""

from pathlib import Path

_STATIC = Path(__file__).parent / "static"
LANGUAGE_SCRIPTS = (*sorted(_STATIC.glob("*-*.js")), _STATIC / "language.js")
"""Scripts of the page: the words of each language, then what uses them; before all that writes texts."""
