"""Only the paper's own words are a claim against it: every claim quotes them, and they stand in the paper."""

import os
import re
import unicodedata
from pathlib import Path

import pytest

from tools.papers.claim import quoted_parts
from tools.papers.write import papers

PAPERS = [paper for paper in papers() if paper.name != "Misprints"]
STATED = [
    pytest.param(paper.name, claim, id=f"{exhibit.name} {number}")
    for paper in PAPERS
    for exhibit in paper.exhibits
    for number, claim in enumerate(exhibit.claims, 1)
    if claim.kind != "own"
]
ROOT = Path(__file__).resolve().parents[2]
FOLDER = Path(os.environ.get("SCHULER_SHARED_PAPERS") or ROOT.parent / "shared" / "papers")
_DASHES = dict.fromkeys(map(ord, "‐‑‒–—−"), "-")


def plain(text: str) -> str:
    """Text without what recognition, typesetting and line ends change."""
    text = unicodedata.normalize("NFKC", text).translate(_DASHES)
    text = text.replace("\\times", "×").replace("\\text", "")
    for mark, other in {"’": "'", "‘": "'", "“": '"', "”": '"', "`": "'"}.items():
        text = text.replace(mark, other)
    return re.sub(r"[\s${}^\\]+", "", text).casefold()


def printed() -> dict[str, str]:
    """Text of each paper by its short name, as the README of the folder maps them."""
    rows = re.findall(r"\| `(\S+)` \| \*\*(.+?)\*\*", (FOLDER / "README.md").read_text("utf-8"))
    return {name: plain((FOLDER / file).read_text("utf-8")) for file, name in rows}


@pytest.fixture(scope="module")
def texts() -> dict[str, str]:
    if not (FOLDER / "README.md").is_file():
        pytest.skip("the papers are not here")
    return printed()


@pytest.mark.parametrize(("paper", "claim"), STATED)
def test_every_claim_quotes_the_paper(paper: str, claim) -> None:
    assert len(plain(claim.quote)) >= 6, f"{paper}: {claim.says}"


@pytest.mark.parametrize(("paper", "claim"), STATED)
def test_the_quotation_stands_in_the_paper(texts: dict[str, str], paper: str, claim) -> None:
    for part in quoted_parts(claim.quote):
        assert plain(part) in texts[paper], part


def test_our_own_claims_quote_nobody() -> None:
    own = [claim for paper in PAPERS for exhibit in paper.exhibits for claim in exhibit.claims]
    assert not [claim.says for claim in own if claim.kind == "own" and claim.quote]


def test_text_is_compared_without_spaces_case_and_marks() -> None:
    assert plain("the ship’s\n Figures 10–12") == plain("The ship's figures 10-12")
