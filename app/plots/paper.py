"""A page to keep, send and print: it loads nothing, and its styles are its own."""

import base64
import hashlib
from html import escape
from pathlib import Path
from string import Template

from navcore.foundation.text import Text
from schuler_bench.plots import table
from schuler_bench.plots.style import FONT_FAMILY

_HERE = Path(__file__).parent
_PAGE = Template((_HERE / "paper.html").read_text(encoding="utf-8"))
_FONT = f":root{{--sb-font:{FONT_FAMILY}}}"
_CSS = _FONT + table.CSS + (_HERE / "paper.css").read_text(encoding="utf-8")


def paper(language: str, title: str, body: str, script: str = "") -> str:
    """HTML of a page.

    Parameters
    ----------
    language : str
        As a browser tells it.
    title, body : str
        HTML.
    script : str
        The only script that may run, with WebAssembly; "": none may.
    """
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    return _PAGE.substitute(
        language=escape(language),
        title=title,
        style=_CSS,
        body=body,
        allowed=f"; script-src 'sha256-{digest}' 'wasm-unsafe-eval'" if script else "",
        script=f"<script>{script}</script>" if script else "",
    )


def section(title: str, *content: str) -> str:
    """Section with a heading."""
    return Text("<section><h2>{title}</h2>{content}</section>", title=title, content=Text.joined("", content))
