"""The page and its script files: viser's own page with ours added, kept in memory."""

from __future__ import annotations

import gzip
import hashlib
import importlib.util
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from app.bridge.server import page_html

_STATIC = Path(__file__).parent / "static"
FIRST_SCRIPTS = (_STATIC / "first.js", _STATIC / "plotly.js")
"""Ours that every page has; the second loads plotly.js when it is needed."""
_FAST = 5


@dataclass(frozen=True)
class File:
    """A file that the server sends to browsers.

    Attributes
    ----------
    content_type : str
        With charset.
    plain : bytes
        The content.
    """

    content_type: str
    plain: bytes

    @cached_property
    def zipped(self) -> bytes:
        """The content, compressed when first asked for: a quarter of a second for plotly.js."""
        return gzip.compress(self.plain, _FAST, mtime=0)


@dataclass(frozen=True)
class Page:
    """All that a browser loads.

    Attributes
    ----------
    html : File
        The page.
    scripts : dict of str to File
        By name; the name carries a hash of the content, so that a browser may keep it for ever.
    """

    html: File
    scripts: dict[str, File]


def plotly_script() -> Path:
    """Return the path of plotly.js, without the cost of importing plotly.

    Raises
    ------
    FileNotFoundError
        plotly is not installed.
    """
    found = importlib.util.find_spec("plotly")
    if found is None or found.origin is None:
        raise FileNotFoundError("plotly is not installed")
    return Path(found.origin).parent / "package_data" / "plotly.min.js"


def build_page(scripts: Sequence[Path], later: Sequence[Path], title: str) -> Page:
    """Read and extend everything a browser loads.

    The scripts stand before viser's own. Their addresses are relative, so that a reverse proxy may add a
    prefix.

    Parameters
    ----------
    scripts : sequence of pathlib.Path
        JavaScript files, run in this order before viser's page.
    later : sequence of pathlib.Path
        Those that the page fetches and a script of `scripts` runs when they are needed.
    title : str
        Of the browser tab; plain text without markup.
    """
    first, others = _files(scripts), _files(later)
    tags = "".join(f'<script src="../../static/{name}"></script>' for name in first)
    tags += "".join(
        f'<link rel="preload" as="script" data-later href="../../static/{name}">' for name in others
    )
    before, found, after = page_html().partition("<title>Viser</title>")
    if not found:
        raise ValueError("viser's page has changed: no title to replace")
    html = f"{before}<title>{title}</title>{tags}{after}"
    return Page(html=File("text/html; charset=utf-8", html.encode()), scripts=first | others)


def _files(paths: Sequence[Path]) -> dict[str, File]:
    files: dict[str, File] = {}
    for path in paths:
        content = path.read_bytes()
        name = f"{path.name.removesuffix('.js')}.{hashlib.sha256(content).hexdigest()[:12]}.js"
        files[name] = File("text/javascript; charset=utf-8", content)
    return files
