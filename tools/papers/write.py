"""Write the report: run every exhibit, draw its picture, put the text together."""

import sys
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from tools.papers.claim import Exhibit, Paper
from tools.papers.items import items_text
from tools.papers.markdown import (
    HEAD,
    Checked,
    Contradiction,
    check,
    exhibit_text,
    search_text,
    summary,
    table_text,
)
from tools.papers.picture import save
from tools.papers.runs import Runs


def papers() -> tuple[Paper, ...]:
    """All papers, in the order in which they are read."""
    from tools.papers import deng, liu, misprints, sun, zha, zhao

    return tuple(paper.PAPER for paper in (deng, liu, zhao, sun, zha, misprints))


def write_report(found: Sequence[Paper], out: Path, only: str = "") -> list[str]:
    """Write ``papers.md`` and ``papers/*.svg`` into a folder.

    Parameters
    ----------
    found : sequence of Paper
        What to report on.
    out : Path
        Folder, made when missing.
    only : str
        Only exhibits whose name holds this; the text is printed in place of being written.

    Returns
    -------
    list of str
        Claims whose verdict contradicts the reason beside it; the report is not written then.
    """
    pictures = out / "papers"
    pictures.mkdir(parents=True, exist_ok=True)
    faults: list[str] = []
    rows: list[tuple[Paper, Exhibit, list[Checked]]] = []
    texts: list[str] = []
    for paper in found:
        chosen = [exhibit for exhibit in paper.exhibits if only in exhibit.name]
        if chosen:
            texts.append(f"## {paper.name}\n\n{paper.reference}\n")
        runs = Runs()  # a paper's runs are let go before the next paper's
        for exhibit in chosen:
            print(exhibit.name, file=sys.stderr, flush=True)
            checked = _checked(exhibit, runs, faults)
            rows.append((paper, exhibit, checked))
            tables = [make(runs) for make in exhibit.tables]
            texts.append(exhibit_text(exhibit, checked, tables, search_text(exhibit, runs)))
            if exhibit.draw is not None:
                save(pictures / f"{exhibit.name}.svg", exhibit.height, partial(exhibit.draw, runs))
    text = "\n".join([HEAD, table_text(summary(rows)), *texts, *([] if only else [items_text()])])
    if only:
        print(text)
    elif not faults:
        (out / "papers.md").write_text(text, "utf-8")
        _remove_old(pictures, {exhibit.name for _, exhibit, _ in rows})
    return faults


def _checked(exhibit: Exhibit, runs: Runs, faults: list[str]) -> list[Checked]:
    done = []
    for claim in exhibit.claims:
        try:
            done.append(check(claim, runs))
        except Contradiction as fault:
            faults.append(f"{exhibit.name}: {fault}")
    return done


def _remove_old(pictures: Path, kept: set[str]) -> None:
    for path in pictures.glob("*.svg"):
        if path.stem not in kept:
            path.unlink()
