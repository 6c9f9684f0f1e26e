"""The page and its files: viser's own page, unpacked, with ours added, kept in memory."""

from __future__ import annotations

import gzip
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from app.bridge.curves import CURVES_SCRIPT
from app.bridge.program import FILL_SCRIPT, SOCKET_SCRIPT, viser_program

_STATIC = Path(__file__).parent / "static"
FIRST_SCRIPTS = (SOCKET_SCRIPT, CURVES_SCRIPT, FILL_SCRIPT, _STATIC / "first.js", _STATIC / "plotly.js")
"""Ours that every page has; the last loads plotly.js."""
PLOTLY = _STATIC / "plotly-basic.min.js"
"""plotly.js with scatter, bar and pie alone (npm: plotly.js-basic-dist-min): a fifth of the whole to read."""
_START = _STATIC / "start.js"
_JAVASCRIPT = "text/javascript; charset=utf-8"
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
    files : dict of str to File
        Scripts and what else the page loads, by name; the name carries a hash of the content, so that a
        browser may keep it for ever.
    """

    html: File
    files: dict[str, File]


def build_page(scripts: Sequence[Path], later: Sequence[Path], title: str) -> Page:
    """Read and extend everything a browser loads.

    The scripts stand before viser's program, which start.js runs. Their addresses are relative, so that a
    reverse proxy may add a prefix.

    Parameters
    ----------
    scripts : sequence of pathlib.Path
        JavaScript files, sent as one and run in this order before viser's page.
    later : sequence of pathlib.Path
        Those that the page fetches and a script of `scripts` runs when they are needed.
    title : str
        Of the browser tab; plain text without markup.
    """
    viser = viser_program()
    before, found, after = viser.html.partition("<title>Viser</title>")
    if not found:
        raise ValueError("viser's page has changed: no title to replace")
    # One file: each would be a connection of its own.
    first = _file("bench.js", _JAVASCRIPT, b"\n".join(path.read_bytes() for path in scripts))
    others = _files(later)
    style = _file("viser.css", "text/css; charset=utf-8", viser.style)
    zstd = _file("zstd.wasm", "application/wasm", viser.zstd)
    program = _file("viser.js", _JAVASCRIPT, viser.program)
    start = _file("start.js", _JAVASCRIPT, _START.read_bytes())
    tags = [
        # Fetched side by side, the largest first.
        f'<link rel="modulepreload" data-program href="../../static/{_name(program)}">',
        f'<link rel="preload" as="fetch" crossorigin data-zstd href="../../static/{_name(zstd)}">',
        f'<script src="../../static/{_name(first)}"></script>',
        f'<link rel="stylesheet" href="../../static/{_name(style)}">',
        f'<script type="module" src="../../static/{_name(start)}"></script>',
        *(f'<link rel="preload" as="script" data-later href="../../static/{name}">' for name in others),
    ]
    html = f"{before}<title>{title}</title>{''.join(tags)}{after}"
    files = first | others | style | zstd | program | start
    return Page(html=File("text/html; charset=utf-8", html.encode()), files=files)


def _files(paths: Sequence[Path]) -> dict[str, File]:
    files: dict[str, File] = {}
    for path in paths:
        files |= _file(path.name, _JAVASCRIPT, path.read_bytes())
    return files


def _file(name: str, content_type: str, content: bytes) -> dict[str, File]:
    """One file under a name that carries a hash of its content."""
    stem, _, suffix = name.rpartition(".")
    return {f"{stem}.{hashlib.sha256(content).hexdigest()[:12]}.{suffix}": File(content_type, content)}


def _name(file: dict[str, File]) -> str:
    (name,) = file
    return name
