"""Papers with their claims -> the text of the report."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from navcore.foundation.markdown import markdown_table
from navcore.foundation.notation import in_symbols
from tools.papers.claim import KINDS, Claim, Exhibit, Kind, Paper, Table, Verdict, number
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

A paper is judged by what it prints, in its own setting where that is printed. What it does not print is
filled in, and other choices are *readings*. A claim is one row, and its readings stand in the row. Where the
claim does not agree in the exhibit's own setting but does in a reading, the verdict is *agrees, if* with the
reading's name. Only what a paper says in so many words is a claim of it: the words are quoted below each
table, and a test looks them up in the paper. What replaces a law of a paper here is judged apart, as our own.

Where a claim of a figure or table does not agree as it is, the settings that the paper does not print were
searched. *Search* names what is varied and every value of it; all combinations are tried, and each is judged
as a claim is, by the confidence interval over the stated seeds. It says which setting meets all claims of the
exhibit, or which claims no setting meets together, and on what a claim does not depend. A setting meets a
claim only when the whole interval lies in the range; *no setting meets* therefore includes settings in which
a claim is undecided.
"""


class Contradiction(Exception):
    """A claim differs without a reason, or agrees although a reason stands beside it."""


@dataclass(frozen=True)
class Checked:
    """A claim with our numbers and the verdict; ``condition``: the reading on which the verdict hangs."""

    claim: Claim
    linear: Estimate
    strapdown: Estimate | None
    verdict: Verdict
    why: str
    note: str
    readings: tuple["Checked", ...] = ()
    condition: str = ""


def check(claim: Claim, runs: Runs) -> Checked:
    """Compute our numbers of a claim.

    Raises
    ------
    Contradiction
        The verdict and ``claim.why`` contradict each other.
    """
    found = _measured(claim, runs)
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
    readings = tuple(_measured(other, runs) for other in others)
    verdict, condition = _decided(claim, found, readings)
    if verdict != "undecided" and (verdict == "differs") != bool(claim.why):
        ours = " / ".join(f"{one}" for one in (found.linear, found.strapdown) if one is not None)
        raise Contradiction(f"{claim.says}: {ours} {verdict} with {claim.agreed}, why = {claim.why!r}")
    facts = {name: _fact(fact(runs)) for name, fact in claim.facts.items()}
    return replace(
        found,
        verdict=verdict,
        condition=condition,
        why=claim.why.format_map(facts),
        note=claim.note.format_map(facts),
        readings=readings,
    )


def _decided(claim: Claim, found: Checked, readings: Sequence[Checked]) -> tuple[Verdict, str]:
    """Verdict of a claim with its readings, and the reading on which it hangs."""
    if found.verdict != "agrees":
        for reading, other in zip(claim.readings, readings, strict=True):
            if other.verdict == "agrees":
                return "agrees if", reading.name
    return found.verdict, ""


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


Judged = tuple[Kind, Verdict]
"""Kind of a claim and its verdict."""


def judged(checked: Iterable[Checked]) -> list[Judged]:
    """Kinds and verdicts of claims."""
    return [(one.claim.kind, one.verdict) for one in checked]


def summary(found: Iterable[tuple[Paper, Exhibit, Sequence[Judged]]]) -> Table:
    """One row an exhibit: how many claims of each kind agree, of how many; a last row with the sums."""
    head = (
        "paper",
        "figure or table",
        "preset",
        *(f"{kind}: agree" for kind in KINDS),
        "agree, if",
        "differ",
        "undecided",
    )
    rows, everything = [], []
    for paper, exhibit, claims in found:
        link = f"[{exhibit.title}](#{exhibit.name})"
        rows.append((paper.name, link, _presets(exhibit), *_counts(claims)))
        everything += claims
    rows.append(("all", "", "", *_counts(everything)))
    return Table("", head, tuple(rows))


def _counts(found: Sequence[Judged]) -> tuple[str, ...]:
    """For each kind "agreeing of all", empty where there is none; then the other three verdicts."""
    texts = []
    for kind in KINDS:
        of_kind = [verdict for kind_of, verdict in found if kind_of == kind]
        agree = of_kind.count("agrees")
        texts.append(f"{agree} of {len(of_kind)}" if of_kind else "")
    others = (sum(one == verdict for _, one in found) for verdict in ("agrees if", "differs", "undecided"))
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
        parts.append(_quotations(checked))
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
    plain = _cells(c, both)
    cells = [*plain[:-1], _verdict_text(c)]
    for reading, other in zip(c.claim.readings, c.readings, strict=True):
        for k, (first, text) in enumerate(zip(plain[:-1], _cells(other, both)[:-1], strict=True)):
            if text and text != first:
                cells[k] += f"; {reading.name}: {text}"
        if other.verdict != c.verdict and reading.name != c.condition:
            cells[-1] += f"; {reading.name}: {other.verdict}"
    return cells


def _verdict_text(c: Checked) -> str:
    """Text of a verdict; what is not plain agreement is bold."""
    if c.verdict == "agrees":
        return c.verdict
    return f"**agrees, if** {c.condition}" if c.verdict == "agrees if" else f"**{c.verdict}**"


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


def _quotations(checked: Sequence[Checked]) -> str:
    """The paper's words, each stated once for all claims that share them."""
    by_quote: dict[str, list[int]] = {}
    for i, c in enumerate(checked, 1):
        if c.claim.quote:
            by_quote.setdefault(c.claim.quote, []).append(i)
    lines = [f'- {_numbered(numbers)}, quoted: "{_plain(quote)}"' for quote, numbers in by_quote.items()]
    return "\n".join(lines) + "\n" if lines else ""


def _plain(quote: str) -> str:
    """A quotation on one line, without what Markdown would take for its own."""
    return " ".join(quote.split()).replace("\\", "\\\\").replace("|", "\\|").replace("*", "\\*")


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
