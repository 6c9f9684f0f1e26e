"""The table of the papers' items: no number without a row, no row without a place that exists."""

import re
from pathlib import Path

import pytest

from navcore.scenario.file import presets
from tools.papers.items import item_row, items, where_text
from tools.papers.write import papers

THEORY = Path("docs/theory.md").read_text("utf-8")
PAPERS = items()


def numbers(item: str) -> list[int]:
    """Numbers that the name of an item covers: "figs. 7 to 9", "eqs. 2, 3", "table 1"."""
    found = [int(number) for number in re.findall(r"\d+", item)]
    return list(range(found[0], found[1] + 1)) if " to " in item else found


@pytest.mark.parametrize("paper", PAPERS, ids=lambda paper: paper["name"])
@pytest.mark.parametrize(("word", "count"), [("eq", "equations"), ("fig", "figures"), ("table", "tables")])
def test_every_number_has_one_row(paper: dict, word: str, count: str) -> None:
    covered = [n for item, _, _ in paper["rows"] if item.startswith(word) for n in numbers(item)]
    assert sorted(covered) == list(range(1, paper[count] + 1))


@pytest.mark.parametrize(
    "row", [(p["name"], *row) for p in PAPERS for row in p["rows"]], ids=lambda r: f"{r[0]} {r[1]}"
)
def test_every_place_exists(row: tuple[str, str, str, str]) -> None:
    where = row[3]
    links = re.findall(r"\b([trp]):([\w-]+)", where)
    known = {
        "t": {name for name in re.findall(r'<a id="s-([\w-]+)"></a>', THEORY)},
        "r": {exhibit.name for paper in papers() for exhibit in paper.exhibits},
        "p": set(presets()),
    }
    assert all(name in known[kind] for kind, name in links), where
    assert links or "None: " in where or "`" in where, f"{row[1]}: no place and no reason"
    assert not re.search(r"\b[trp]:\w", where_text(where))


def test_the_report_has_the_table() -> None:
    report = Path("docs/papers.md").read_text("utf-8")
    for paper in PAPERS:
        for row in paper["rows"]:
            assert f"| {' | '.join(item_row(paper['name'], *row))} |" in report


@pytest.mark.parametrize("paper", PAPERS, ids=lambda paper: paper["name"])
def test_the_statements_of_the_text_have_rows_and_stand_in_a_section_that_exists(paper: dict) -> None:
    stated = [item.removeprefix("section ") for item, _, _ in paper["rows"] if item.startswith("section")]
    assert stated and set(stated) <= set(paper["sections"])
