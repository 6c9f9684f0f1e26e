"""Papers with their claims -> the text of the report."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from navcore.foundation.markdown import markdown_table
from navcore.foundation.notation import in_symbols
from tools.papers.claim import KINDS, Claim, Exhibit, Paper, Table, Verdict, number
from tools.papers.estimate import Estimate, estimate
from tools.papers.runs import Runs
from tools.papers.search import outcome, verdict

HEAD = """\
# What the papers claim, and what we find

`make papers` runs the presets and writes this page; every number of ours is computed. For each figure and
table of the papers it states the claim, our number, the range of numbers that counts as agreement, and the
verdict. Where the two differ, it gives the reason. *Linear* is the error model (or the single channel) of the
preset; *strapdown* is the full nonlinear mechanization on the same setting, where both apply. Seeds and
digits are fixed: the same code writes the same file.

Where noise decides, our number is the mean over the stated number of seeds with its 95 % confidence interval
(Student; an RMS over seeds has the interval of the mean of the squares, to first order; a skewed ratio is a
geometric mean with the interval of its logarithm), and the verdict goes by the interval: *agrees* when all of
it lies in the range, *differs* when none of it does, *undecided* when it reaches across an end of the range.
Where both fidelities are given, both must agree; if one of them differs, the verdict is *differs*. A number
without an interval is of one run.

The kind of a claim says what its agreement is worth. *Predicted*: our number follows from the settings that
the paper prints. *Fitted*: a setting that the paper does not print was chosen so that the number comes out.
*Direction only*: the paper states a relation without a number, or prints too little of its setting for more.
*Own*: the claim is ours, about what this project adds; it says nothing about a paper.

Where a claim of a figure or table differs, the settings that the paper does not print were searched within
the stated ranges for one that meets all its claims; *Search* says which one does, or which claims no setting
meets together. The settings are judged by their means over the stated seeds, linear unless said otherwise.

A claim is one row. Where a statement can be read in more than one way, every reading stands in its row;
the verdict and the counts go by the first one, which fits the whole table or figure, for the reason given
above it.
"""


class Contradiction(Exception):
    """A claim differs without a reason, or agrees although a reason stands beside it."""


@dataclass(frozen=True)
class Checked:
    """A claim with our numbers and the verdict."""

    claim: Claim
    linear: Estimate
    strapdown: Estimate | None
    verdict: Verdict
    why: str
    note: str
    readings: tuple["Checked", ...] = ()


def check(claim: Claim, runs: Runs) -> Checked:
    """Compute our numbers of a claim.

    Raises
    ------
    Contradiction
        The verdict and ``claim.why`` contradict each other.
    """
    found = _measured(claim, runs)
    if found.verdict != "undecided" and (found.verdict == "differs") != bool(claim.why):
        ours = " / ".join(f"{one}" for one in (found.linear, found.strapdown) if one is not None)
        raise Contradiction(f"{claim.says}: {ours} {found.verdict} with {claim.agreed}, why = {claim.why!r}")
    facts = {name: _fact(fact(runs)) for name, fact in claim.facts.items()}
    others = (
        replace(
            claim,
            printed=other.printed,
            agreed=other.agreed,
            ours=other.ours,
            strapdown=claim.strapdown and other.strapdown,
        )
        for other in claim.readings
    )
    return replace(
        found,
        why=claim.why.format_map(facts),
        note=claim.note.format_map(facts),
        readings=tuple(_measured(other, runs) for other in others),
    )


def _measured(claim: Claim, runs: Runs) -> Checked:
    """Our numbers of one reading and its verdict."""
    linear = estimate(claim.ours(runs))
    strapdown = estimate(claim.ours(runs.in_strapdown())) if claim.strapdown else None
    verdict = claim.verdict(linear, *(() if strapdown is None else (strapdown,)))
    return Checked(claim, linear, strapdown, verdict, "", "")


def _fact(value: float) -> str:
    """Text of a number that a reason names; a whole number is a count."""
    return str(value) if isinstance(value, int) else number(value)


def report(papers: Iterable[tuple[Paper, Sequence[tuple[Exhibit, str]]]]) -> str:
    """Text of the whole report; each exhibit with its text from `exhibit_text`."""
    parts = [HEAD]
    for paper, exhibits in papers:
        parts.append(f"## {paper.name}\n\n{paper.reference}\n")
        parts.extend(text for _, text in exhibits)
    return "\n".join(parts)


def summary(checked: Iterable[tuple[Paper, Exhibit, Sequence[Checked]]]) -> Table:
    """One row an exhibit: how many claims of each kind agree, of how many; a last row with the sums."""
    head = (
        "paper",
        "figure or table",
        "preset",
        *(f"{kind}: agree" for kind in KINDS),
        "differ",
        "undecided",
    )
    rows, everything = [], []
    for paper, exhibit, found in checked:
        link = f"[{exhibit.title}](#{exhibit.name})"
        rows.append((paper.name, link, _presets(exhibit), *_counts(found)))
        everything += found
    rows.append(("all", "", "", *_counts(everything)))
    return Table("", head, tuple(rows))


def _counts(found: Sequence[Checked]) -> tuple[str, ...]:
    """For each kind "agreeing of all", empty where there is none; then how many differ or are open."""
    texts = []
    for kind in KINDS:
        of_kind = [c for c in found if c.claim.kind == kind]
        agree = sum(c.verdict == "agrees" for c in of_kind)
        texts.append(f"{agree} of {len(of_kind)}" if of_kind else "")
    others = (sum(c.verdict == verdict for c in found) for verdict in ("differs", "undecided"))
    return (*texts, *(str(count) for count in others))


def exhibit_text(
    exhibit: Exhibit, checked: Sequence[Checked], tables: Sequence[Table], searched: str = ""
) -> str:
    """Section of one figure or table; ``searched``: what `search_text` says."""
    parts = [
        f'<a id="{exhibit.name}"></a>\n\n### {exhibit.title}\n',
        f"Preset: {_presets(exhibit)}. {exhibit.setting}\n",
    ]
    if checked:
        parts.append(table_text(_claims(checked)))
        parts.append(_notes(checked))
    parts.append(searched)
    parts.extend(table_text(table) for table in tables)
    if exhibit.draw is not None:
        parts.append(f"![{exhibit.title}](papers/{exhibit.name}.svg)\n")
    return in_symbols("\n".join(part for part in parts if part))


def search_text(exhibit: Exhibit, runs: Runs) -> str:
    """What is varied in an exhibit's search, and its verdict; empty without a search."""
    search = exhibit.search
    if search is None:
        return ""
    found = outcome(search, [exhibit.claims[number - 1].agreed for number in search.claims], runs)
    return f"**Search:** {search.varied} {verdict(found)}\n"


def table_text(table: Table) -> str:
    """Markdown of a table."""
    caption = f"{table.caption}\n\n" if table.caption else ""
    return f"{caption}{markdown_table(table.head, table.rows)}\n"


def _presets(exhibit: Exhibit) -> str:
    return ", ".join(f"`{name}`" for name in exhibit.presets) or "none"


def _claims(checked: Sequence[Checked]) -> Table:
    both = any(c.strapdown is not None for c in checked)
    ours_head = ("linear", "strapdown") if both else ("ours",)
    own = all(c.claim.kind == "own" for c in checked)
    stated = ("our claim", "expected") if own else ("the paper's claim", "paper")
    head = ("", *stated, *ours_head, "agrees within", "kind", "verdict")
    rows = []
    for i, c in enumerate(checked, 1):
        printed, *ours, allowed, verdict = _with_readings(c, both)
        rows.append((str(i), c.claim.says, printed, *ours, allowed, c.claim.kind, verdict))
    return Table("", head, tuple(rows))


def _with_readings(c: Checked, both: bool) -> list[str]:
    """Cells of a claim; another reading is named behind where it has another text."""
    cells = _cells(c, both)
    cells[-1] = cells[-1] if c.verdict == "agrees" else f"**{c.verdict}**"
    for reading, other in zip(c.claim.readings, c.readings, strict=True):
        for k, (first, text) in enumerate(zip(_cells(c, both), _cells(other, both), strict=True)):
            if text != first:
                cells[k] += f"; {reading.name}: {text}"
    return cells


def _cells(c: Checked, both: bool) -> list[str]:
    """The paper's number, ours (linear and, with ``both``, strapdown), the range and the verdict."""
    ours = [_value(c.claim, c.linear)]
    if both:
        ours.append("" if c.strapdown is None else _value(c.claim, c.strapdown))
    return [c.claim.printed, *ours, c.claim.allowed, c.verdict]


def _value(claim: Claim, found: Estimate) -> str:
    text = number(found.value, claim.digits)
    if found.ends is not None:
        low, high = (number(end, 2) for end in found.ends)
        return f"{text} {claim.unit}".strip() + f" ({low} to {high}, {found.seeds} seeds)"
    if found.seeds > 1:
        text += f" +- {number(found.half, 2)}"
    text = f"{text} {claim.unit}".strip()
    return f"{text} ({found.seeds} seeds)" if found.seeds > 1 else text


_VERBS = {"differs": ("differs", "differ"), "undecided": ("is undecided", "are undecided")}


def _notes(checked: Sequence[Checked]) -> str:
    """Reasons and notes, each stated once for all claims that share it."""
    lines: dict[str, None] = {}
    for i, c in enumerate(checked, 1):
        if c.why:
            alike = [
                k for k, other in enumerate(checked, 1) if (other.why, other.verdict) == (c.why, c.verdict)
            ]
            one, several = _VERBS.get(c.verdict, (c.verdict, c.verdict))
            verb = one if len(alike) == 1 else several
            lines[f"- **{_numbered(alike)} {verb}:** {c.why}"] = None
        if c.note:
            lines[f"- Note on claim {i}: {c.note}"] = None
    return "\n".join(lines) + "\n" if lines else ""


def _numbered(numbers: Sequence[int]) -> str:
    """Text "Claim 3" or "Claims 3, 5 and 7"."""
    if len(numbers) == 1:
        return f"Claim {numbers[0]}"
    *first, last = (str(number) for number in numbers)
    return f"Claims {', '.join(first)} and {last}"
