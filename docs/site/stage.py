"""Lays the pages out for Sphinx: the checkout's own Markdown, the lessons, the notebooks, the reference.

The staged tree has the checkout's folders, so that a link between two files holds on both. Explicit anchors
(``<a id="s-3-1"></a>``), which GitHub resolves, become targets of MyST.
"""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from docs.site import api, lessons

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
_ANCHOR = re.compile(r'^<a id="([^"]+)"></a>\n\n?', re.MULTILINE)
_LINK = re.compile(r"\[([^\]]*)\]\(([^)#\s:]+)(#[^)\s]+)?\)")
_ANCHORED_LINK = re.compile(r"\]\((?:[\w./-]+\.md)?#((?:s|eq)-[\w-]+)\)")

_GUIDE = [
    (
        "Start",
        [
            "docs/tutorial",
            "docs/tabs",
            "docs/scenario",
            "docs/import",
            "docs/networks",
            "docs/interface",
            "docs/extending",
            "docs/stable",
            "docs/scale",
            "docs/teaching",
        ],
    ),
    ("Theory", ["docs/theory", "docs/design", "docs/ledger", "docs/papers"]),
    ("Lessons", []),
    ("Examples", []),
    ("Project", ["docs/architecture", "CONTRIBUTING", "CHANGELOG"]),
    ("Reference", ["api/index"]),
]


def for_myst(text: str) -> str:
    """A page of the checkout with its explicit anchors as targets of MyST."""
    return _ANCHORED_LINK.sub(r"](#\1)", _ANCHOR.sub(r"(\1)=\n", text))


def stage(root: Path, target: Path, *, notebooks: bool = True) -> None:
    """Fill ``target`` anew with everything that Sphinx reads.

    Parameters
    ----------
    root : Path
        The checkout.
    target : Path
        Folder to make; one that is there is removed.
    notebooks : bool
        Whether to include the notebooks of ``examples``, which Sphinx executes.
    """
    shutil.rmtree(target, ignore_errors=True)
    for page in [*root.glob("docs/*.md"), *root.glob("*.md")]:
        if page.name != "README.md":
            _write(target / page.relative_to(root), _settled(root, target, page, page.read_text("utf-8")))
    for name, text in lessons.pages().items():
        _write(target / "lessons" / f"{name}.md", text)
    for name, text in api.pages(root).items():
        _write(target / "api" / name, text)
    books = sorted(root.glob("examples/*.ipynb")) if notebooks else []
    for book in books:
        _copy(root, target, book)
    shutil.copytree(HERE / "static", target / "_static")
    shutil.copy(HERE / "conf.py", target / "conf.py")
    _write(target / "index.md", _front_page(root, target, [f"examples/{book.stem}" for book in books]))


def _settled(root: Path, target: Path, page: Path, text: str) -> str:
    """A page for MyST, its pictures and other files beside it; a link to a folder becomes its text."""

    def settle(found: re.Match[str]) -> str:
        said, place, anchor = found.groups()
        linked = (page.parent / place).resolve()
        if linked == root / "README.md":
            return f"[{said}]({'../' if page.parent != root else ''}index.md{anchor or ''})"
        if linked.is_dir() or not linked.is_relative_to(root):
            return said
        if linked.is_file() and linked.suffix != ".md":
            _copy(root, target, linked)
        return found[0]

    return for_myst(_LINK.sub(settle, text))


def _front_page(root: Path, target: Path, books: list[str]) -> str:
    """The README up to the map of the code, and the tables of contents."""
    readme = root / "README.md"
    text = _settled(root, target, readme, readme.read_text("utf-8").split("\n## Speed and accuracy")[0])
    listed = {"Lessons": sorted(f"lessons/{p.stem}" for p in target.glob("lessons/*.md")), "Examples": books}
    others = sorted(str(p.relative_to(target).with_suffix("")) for p in target.glob("docs/*.md"))
    others += sorted(p.stem for p in target.glob("*.md"))
    placed = {page for _, pages in _GUIDE for page in pages}
    for caption, pages in _GUIDE:
        entries = listed.get(caption, pages)
        if caption == "Project":
            entries = [*entries, *(page for page in others if page not in placed)]
        if entries:
            body = "\n".join(entries)
            text += f"\n```{{toctree}}\n:hidden:\n:caption: {caption}\n:maxdepth: 1\n\n{body}\n```\n"
    return text


def _copy(root: Path, target: Path, source: Path) -> None:
    place = target / source.relative_to(root)
    place.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(source, place)


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
