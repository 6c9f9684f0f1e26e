"""The page and its script files: viser's own page with ours added, kept in memory."""

from __future__ import annotations

import gzip
import hashlib
import importlib.util
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from app.http.viser_insides import page_html

FIRST_SCRIPT = Path(__file__).parent / "static" / "first.js"
_FAST = 5


@dataclass(frozen=True)
class File:
    """Something to serve.

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


def build_page(scripts: Sequence[Path], title: str) -> Page:
    """Read and extend everything a browser loads.

    The scripts stand before viser's own: its first plot may be drawn as soon as it runs, and needs plotly by
    then. Their addresses are relative, so that a reverse proxy may add a prefix.

    Parameters
    ----------
    scripts : sequence of pathlib.Path
        JavaScript files, run in this order before viser's page.
    title : str
        Of the browser tab; plain text without markup.
    """
    files: dict[str, File] = {}
    for path in scripts:
        content = path.read_bytes()
        name = f"{path.name.removesuffix('.js')}.{hashlib.sha256(content).hexdigest()[:12]}.js"
        files[name] = File("text/javascript; charset=utf-8", content)
    tags = "".join(f'<script src="../../static/{name}"></script>' for name in files)
    before, found, after = page_html().partition("<title>Viser</title>")
    if not found:
        raise ValueError("viser's page has changed: no title to replace")
    html = f"{before}<title>{title}</title>{tags}{after}"
    return Page(html=File("text/html; charset=utf-8", html.encode()), scripts=files)
