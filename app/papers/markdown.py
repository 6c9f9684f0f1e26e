"""Papers with their claims -> the text of the report."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from app.papers.claim import Claim, Exhibit, Paper, Table, Verdict, number
from app.papers.runs import Runs

HEAD = """\
# What the papers say, and what comes out here

Written by `make papers` from the presets; nothing here is typed by hand. For each figure and table of the
papers: the claim, our number and whether they agree; where they differ, why. *Linear* is the error model (or
the single channel) of the preset, *strapdown* the full nonlinear mechanization on the same setting, where
both apply. Seeds and digits are fixed: the same code writes the same file.
"""


class Contradiction(Exception):
    """A claim differs without a reason, or agrees although a reason stands beside it."""


@dataclass(frozen=True)
class Checked:
    """A claim with our numbers and the verdict."""

    claim: Claim
    linear: float
    strapdown: float | None
    verdict: Verdict
    why: str
    note: str


def check(claim: Claim, runs: Runs) -> Checked:
    """Compute our numbers of a claim.

    Raises
    ------
    Contradiction
        The verdict and ``claim.why`` contradict each other.
    """
    linear = float(claim.ours(runs))
    strapdown = float(claim.ours(runs.in_strapdown())) if claim.strapdown else None
    verdict = claim.verdict(linear, *(() if strapdown is None else (strapdown,)))
    if (verdict == "differs") != bool(claim.why):
        found = f"{linear!r}" if strapdown is None else f"{linear!r} / {strapdown!r}"
        raise Contradiction(f"{claim.says}: {found} {verdict} with {claim.agreed}, why = {claim.why!r}")
    facts = {name: number(fact(runs)) for name, fact in claim.facts.items()}
    return Checked(
        claim, linear, strapdown, verdict, claim.why.format_map(facts), claim.note.format_map(facts)
    )


def report(papers: Iterable[tuple[Paper, Sequence[tuple[Exhibit, str]]]]) -> str:
    """Text of the whole report; each exhibit with its text from `exhibit_text`."""
    parts = [HEAD]
    for paper, exhibits in papers:
        parts.append(f"## {paper.name}\n\n{paper.reference}\n")
        parts.extend(text for _, text in exhibits)
    return "\n".join(parts)


def summary(checked: Iterable[tuple[Paper, Exhibit, Sequence[Checked]]]) -> Table:
    """One row an exhibit: how many claims agree and differ."""
    rows = []
    for paper, exhibit, found in checked:
        differ = sum(c.verdict == "differs" for c in found)
        link = f"[{exhibit.title}](#{exhibit.name})"
        rows.append((paper.name, link, _presets(exhibit), str(len(found) - differ), str(differ)))
    return Table("", ("paper", "figure or table", "preset", "agree", "differ"), tuple(rows))


def exhibit_text(exhibit: Exhibit, checked: Sequence[Checked], tables: Sequence[Table]) -> str:
    """Section of one figure or table."""
    parts = [
        f'<a id="{exhibit.name}"></a>\n\n### {exhibit.title}\n',
        f"Preset: {_presets(exhibit)}. {exhibit.setting}\n",
    ]
    if checked:
        parts.append(table_text(_claims(checked)))
        parts.append(_remarks(checked))
    parts.extend(table_text(table) for table in tables)
    if exhibit.draw is not None:
        parts.append(f"![{exhibit.title}](papers/{exhibit.name}.svg)\n")
    return "\n".join(part for part in parts if part)


def table_text(table: Table) -> str:
    """Markdown of a table."""
    lines = [f"{table.caption}\n"] if table.caption else []
    lines.append("| " + " | ".join(table.head) + " |")
    lines.append("|" + "---|" * len(table.head))
    lines.extend("| " + " | ".join(row) + " |" for row in table.rows)
    return "\n".join(lines) + "\n"


def _presets(exhibit: Exhibit) -> str:
    return ", ".join(f"`{name}`" for name in exhibit.presets) or "none"


def _claims(checked: Sequence[Checked]) -> Table:
    both = any(c.strapdown is not None for c in checked)
    head = ("", "the paper's claim", "paper", *(("linear", "strapdown") if both else ("ours",)), "")
    rows = []
    for i, c in enumerate(checked, 1):
        ours = [_value(c.claim, c.linear)]
        if both:
            ours.append("" if c.strapdown is None else _value(c.claim, c.strapdown))
        verdict = c.verdict if c.verdict == "agrees" else f"**{c.verdict}**"
        rows.append((str(i), c.claim.says, c.claim.printed, *ours, verdict))
    return Table("", head, tuple(rows))


def _value(claim: Claim, value: float) -> str:
    return f"{number(value, claim.digits)} {claim.unit}".strip()


def _remarks(checked: Sequence[Checked]) -> str:
    lines = []
    for i, c in enumerate(checked, 1):
        if c.why:
            lines.append(f"- **{i} differs:** {c.why}")
        if c.note:
            lines.append(f"- {i}: {c.note}")
    return "\n".join(lines) + "\n" if lines else ""
