"""Every section, equation, figure and table of a paper that is cited anywhere exists in that paper."""

import re
from pathlib import Path

import pytest

from tests.unit.test_citations import cited_from
from tools.papers.items import items

ROOT = Path(__file__).resolve().parents[2]
PAPERS = {paper["name"].split()[0]: paper for paper in items()}
_GAP = r"[\s#*\"']*"
_NUMBER = r"[1-9]\d*(?:\.\d+)*"
_LIST = rf"{_NUMBER}(?:(?:, | to | and ){_NUMBER})*"
_CITED = re.compile(
    rf"\b({'|'.join(PAPERS)})(?: 20\d\d)?(?:'s)?[,:]?{_GAP}"
    rf"(sections?|eqs?\.|equations?|figs?\.|figures?|[Tt]ables?)?{_GAP}({_LIST})(?![\d.]*\s*(?:%|m/s|deg|kn|h\b))"
)
_KINDS = {"s": "sections", "e": "equations", "f": "figures", "t": "tables"}


def wrong(text: str) -> list[str]:
    """Citations of what the papers do not have."""
    found = []
    for name, kind, numbers in _CITED.findall(text):
        paper = PAPERS[name]
        for number in re.findall(_NUMBER, numbers):
            if number.startswith("20") and len(number) == 4:
                continue
            if "." in number or kind.startswith("section"):
                exists = number in paper["sections"]
            elif kind:
                exists = 1 <= int(number) <= paper[_KINDS[kind[0].lower()]]
            else:  # "Liu 5" is equation 5; "Sun 1" may be the section
                exists = 1 <= int(number) <= paper["equations"] or number in paper["sections"]
            if not exists:
                found.append(f"{name} {kind} {number}".replace("  ", " "))
    return found


@pytest.mark.parametrize(
    ("text", "faults"),
    [
        ("Deng 2019, section 5; theory.md 3.8", ["Deng section 5"]),
        ("the azimuth loop (Deng 5)", ["Deng 5"]),
        ("(Deng 2019, 4.1: three-axis swing)", ["Deng 4.1"]),
        ("Sun 2017, eq. 12 to 23", ["Sun eq. 23"]),
        ("Liu 2021, 3.2; Sun 2017, 1 and eq. 8 to 18; Zha 2019, 4.2", []),
        ("Zhao 2015, fig. 13", ["Zhao fig. 13"]),
        ("Deng 2019, table 4, fig. 17 to 22", []),
    ],
)
def test_what_a_paper_does_not_have_is_found(text: str, faults: list[str]) -> None:
    assert wrong(text) == faults


def test_every_citation_of_a_paper_exists() -> None:
    found = {
        f"{path.relative_to(ROOT)}: {fault}"
        for path in cited_from()
        if path != Path(__file__)
        for fault in wrong(path.read_text("utf-8"))
    }
    assert not found
