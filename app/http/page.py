"""The page and its files: viser's own page, unpacked, with ours added, kept in memory."""

import gzip
import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import fontpkg_arimo

from schuler_bench.bridge.program import SCRIPTS, viser_program

_STATIC = Path(__file__).parent / "static"
FIRST_SCRIPTS = (*SCRIPTS, *(_STATIC / f"{name}.js" for name in ("first", "without3d", "plotly")))
"""Ours that every page has; the last loads plotly.js."""
PLOTLY = _STATIC / "plotly-basic.min.js"
"""plotly.js with scatter, bar and pie alone (npm: plotly.js-basic-dist-min): a fifth of the whole to read."""
_START = _STATIC / "start.js"
FONT = fontpkg_arimo.ROOT / "files" / "Arimo[wght].ttf"
"""The first of `schuler_bench.plots.style.FONT_FAMILY`; the licence is in its package."""
_FACE = "@font-face{{font-family:{family};font-weight:400 700;font-display:block;src:url({address})}}"
_JAVASCRIPT = "text/javascript; charset=utf-8"
_FAST = 5
_ROOT = '<div id="root"></div>'
_BLANK = (
    "<style>#sb-blank{visibility:hidden;animation:sb-blank 0s 8s forwards;max-width:36em;margin:2em auto;"
    "padding:0 1em;font:15px/1.5 sans-serif;color:#243b53}@keyframes sb-blank{to{visibility:visible}}"
    "#root:not(:empty)~#sb-blank{display:none}</style>"
    '<div id="sb-blank" role="note"><b>Schuler Bench has not started yet.</b> If this stays in a frame, the '
    "page around it shows it with <code>sandbox</code> and without <code>allow-same-origin</code>: then no "
    "program of this server may run in it. Add <code>allow-same-origin</code>, or open it "
    '<a href="" target="_blank" rel="noopener">in a window of its own</a>.</div>'
)
"""Seen where no script of ours may run, and so made of style alone: a frame would stay blank."""


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
    files: dict[str, File] = {}

    def address(name: str, content: bytes, content_type: str = _JAVASCRIPT) -> str:
        """Add a file under a name that carries a hash of its content."""
        stem, _, suffix = name.rpartition(".")
        hashed = f"{stem}.{hashlib.sha256(content).hexdigest()[:12]}.{suffix}"
        files[hashed] = File(content_type, content)
        return f"../../static/{hashed}"

    # One file: each would be a connection of its own.
    first = address("bench.js", b"\n".join(path.read_bytes() for path in scripts))
    others = [address(path.name, path.read_bytes()) for path in later]
    style = address("viser.css", viser.style, "text/css; charset=utf-8")
    font = address("arimo.ttf", FONT.read_bytes(), "font/ttf")
    tags = [
        f"<style>{_FACE.format(family=fontpkg_arimo.FAMILY, address=font)}</style>",
        # Fetched side by side, the largest first.
        f'<link rel="modulepreload" data-program href="{address("viser.js", viser.program)}">',
        '<link rel="preload" as="fetch" crossorigin data-zstd '
        f'href="{address("zstd.wasm", viser.zstd, "application/wasm")}">',
        f'<link rel="preload" as="font" type="font/ttf" crossorigin href="{font}">',
        f'<script src="{first}"></script>',
        f'<link rel="stylesheet" href="{style}">',
        f'<script type="module" src="{address("start.js", _START.read_bytes())}"></script>',
        *(f'<link rel="preload" as="script" data-later href="{other}">' for other in others),
    ]
    if after.count(_ROOT) != 1:
        raise ValueError("viser's page has changed: no root to say beside it what is wrong")
    after = after.replace(_ROOT, _ROOT + _BLANK)
    html = f"{before}<title>{title}</title>{''.join(tags)}{after}"
    return Page(html=File("text/html; charset=utf-8", html.encode()), files=files)
