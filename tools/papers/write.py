"""Write the report: run every exhibit, draw its picture, put the text together."""

import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from tools.papers.claim import Exhibit, Paper
from tools.papers.items import items_text
from tools.papers.markdown import (
    HEAD,
    Checked,
    Contradiction,
    Judged,
    check,
    exhibit_text,
    judged,
    search_text,
    summary,
    table_text,
)
from tools.papers.picture import save
from tools.papers.runs import Runs
from tools.papers.search import IdleAxis


def papers() -> tuple[Paper, ...]:
    """All papers, in the order in which they are read."""
    from tools.papers import deng, liu, misprints, sun, zha, zhao

    return tuple(paper.PAPER for paper in (deng, liu, zhao, sun, zha, misprints))


@dataclass
class Written:
    """What became of one paper: its text, the verdicts of each exhibit, and contradictions."""

    texts: list[str] = field(default_factory=list)
    verdicts: list[tuple[str, list[Judged]]] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)


def write_paper(paper: Paper, pictures: Path, only: str = "") -> Written:
    """Run the exhibits of a paper and draw their pictures."""
    done = Written()
    chosen = [exhibit for exhibit in paper.exhibits if only in exhibit.name]
    if chosen:
        done.texts.append(f"## {paper.name}\n\n{paper.reference}\n")
    runs = Runs()  # a paper's runs are let go before the next paper's
    for exhibit in chosen:
        print(exhibit.name, file=sys.stderr, flush=True)
        checked = _checked(exhibit, runs, done.faults)
        done.verdicts.append((exhibit.name, judged(checked)))
        tables = [make(runs) for make in exhibit.tables]
        searched = _searched(exhibit, runs, done.faults)
        done.texts.append(exhibit_text(exhibit, checked, tables, searched))
        if exhibit.draw is not None:
            save(pictures / f"{exhibit.name}.svg", exhibit.height, partial(exhibit.draw, runs))
    return done


def _of_number(number: int, pictures: Path, only: str) -> Written:
    """`write_paper` in a process of its own: a paper holds functions, which cannot be sent there."""
    return write_paper(papers()[number], pictures, only)


def write_report(found: Sequence[Paper], out: Path, only: str = "", jobs: int = 1) -> list[str]:
    """Write ``papers.md`` and ``papers/*.svg`` into a folder.

    Parameters
    ----------
    found : sequence of Paper
        What to report on.
    out : Path
        Folder, made when missing.
    only : str
        Only exhibits whose name holds this; the text is printed in place of being written.
    jobs : int
        Processes; with more than one, ``found`` must be `papers`.

    Returns
    -------
    list of str
        Claims whose verdict contradicts the reason beside it; the report is not written then.
    """
    pictures = out / "papers"
    pictures.mkdir(parents=True, exist_ok=True)
    if jobs > 1:
        with ProcessPoolExecutor(jobs) as pool:
            numbers = range(len(found))
            written = list(pool.map(partial(_of_number, pictures=pictures, only=only), numbers))
    else:
        written = [write_paper(paper, pictures, only) for paper in found]
    faults = [fault for one in written for fault in one.faults]
    rows = [
        (paper, exhibit, verdicts)
        for paper, one in zip(found, written, strict=True)
        for name, verdicts in one.verdicts
        for exhibit in paper.exhibits
        if exhibit.name == name
    ]
    texts = [text for one in written for text in one.texts]
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


def _searched(exhibit: Exhibit, runs: Runs, faults: list[str]) -> str:
    try:
        return search_text(exhibit, runs)
    except IdleAxis as fault:
        faults.append(f"{exhibit.name}: {fault}")
        return ""


def _remove_old(pictures: Path, kept: set[str]) -> None:
    for path in pictures.glob("*.svg"):
        if path.stem not in kept:
            path.unlink()
