"""The verification matrix: every limit on every method, how it was judged, and what came of it."""

import csv
import io
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from navcore.engine.known_by import known_words
from navcore.engine.measures import SeedShare, finite, needs_seeds, verdict
from navcore.engine.run import Run
from navcore.engine.verdicts import Judgement, Verdict
from navcore.foundation.answers import number
from navcore.foundation.cells import safe_cell
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from navcore.scenario.requirement import Requirement

COLUMNS = (
    "clause", "test", "text", "quantity", "method", "how_judged", "result", "low", "high", "unit",
    "seeds", "share", "share_low", "share_high", "verdict", "more_seeds", "rests_on",
)  # fmt: skip
"""Columns of the matrix as CSV."""


@dataclass(frozen=True)
class MatrixRow:
    """One limit on one method.

    Attributes
    ----------
    test : str
        Of a set of clauses, what the clause prescribes; empty for the scenario itself.
    requirement : Requirement
        The limit.
    method : str
        Name.
    how : str
        How it was judged, in words.
    value : float or None
        In the unit of the quantity's name; None where there is none.
    verdict : {"met", "missed", "open"}
        What came of it.
    judgement : Judgement or None
        What seeds say; None where none was run.
    rests_on : str
        How the value is known to be right (`navcore.quantities.known`).
    """

    test: str
    requirement: Requirement
    method: str
    how: str
    value: float | None
    verdict: Verdict
    judgement: Judgement | None
    rests_on: str = ""

    @property
    def unit(self) -> str:
        """Unit of the value: that in the quantity's name."""
        return self.requirement.unit

    @property
    def interval(self) -> tuple[float | None, float | None]:
        """95 % interval of the value over seeds; none of a run."""
        if self.judgement is None or not QUANTITIES[self.requirement.quantity].over:
            return None, None
        return finite(self.judgement.value_low), finite(self.judgement.value_high)

    def as_dict(self) -> dict[str, Any]:
        """Return the row as a document, by `COLUMNS`."""
        one, said = self.requirement, self.judgement
        low, high = self.interval
        return {
            "clause": one.clause or "",
            "test": self.test,
            "text": one.text or one.words,
            "quantity": one.quantity,
            "method": self.method,
            "how_judged": self.how,
            "result": self.value,
            "low": low,
            "high": high,
            "unit": self.unit,
            "seeds": None if said is None else said.seeds,
            "share": None if said is None else said.met,
            "share_low": None if said is None else said.low,
            "share_high": None if said is None else said.high,
            "verdict": self.verdict,
            "more_seeds": None if said is None or self.verdict != "open" else said.more,
            "rests_on": self.rests_on,
        }

    def result_words(self) -> str:
        """Value with its interval and unit, and the share of seeds."""
        low, high = self.interval
        value = number(self.value)
        if low is not None or high is not None:
            words = {"value": value, "low": number(low), "high": number(high)}
            value = Text("{value} ({low} to {high})", **words)
        value = Text("{value} {unit}", value=value, unit=self.unit) if self.unit else value
        if self.judgement is None:
            return value
        met, *ends = (
            number(100.0 * x, 3) for x in (self.judgement.met, self.judgement.low, self.judgement.high)
        )
        share = {"met": met, "low": ends[0], "high": ends[1], "seeds": self.judgement.seeds}
        return Text("{value}; met by {met} % of {seeds} seeds ({low} to {high})", value=value, **share)


def matrix_rows(run: Run, shares: Sequence[SeedShare], test: str = "") -> Iterator[MatrixRow]:
    """Yield a row for each limit of a run's scenario and each method.

    Parameters
    ----------
    run : Run
        Of the scenario.
    shares : sequence of SeedShare
        One a method; empty where no seeds were run.
    test : str
        Of a set of clauses, what the clause prescribes.
    """
    for place, one in enumerate(run.scenario.requirement):
        for k, method in enumerate(run.methods):
            judgement = shares[k].limits[place] if shares else None
            value, word = verdict(one, method, judgement)
            how = how_judged(one, run, judgement)
            rests = known_words(one.quantity, method.method, run.scenario.run.fidelity)
            yield MatrixRow(test, one, method.method.name, how, value, word, judgement, rests)


def how_judged(one: Requirement, run: Run, judgement: Judgement | None) -> str:
    """Say of what a limit was judged."""
    if QUANTITIES[one.quantity].kind is None:
        return Text("analysis of the loop in force")
    if needs_seeds(one) and judgement is not None:
        if QUANTITIES[one.quantity].over and one.share is None:
            return Text("statistic of {seeds} seeds, 95 % interval", seeds=judgement.seeds)
        return Text("share of {seeds} seeds, Wilson interval of 95 %", seeds=judgement.seeds)
    settings = run.scenario.run
    return Text("run of seed {seed}, {fidelity}", seed=settings.seed, fidelity=settings.fidelity)


def matrix_csv(rows: Iterable[MatrixRow]) -> str:
    """Write the matrix as CSV, with a heading."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for row in rows:
        values = row.as_dict()
        writer.writerow([_cell(values[name]) for name in COLUMNS])
    return text.getvalue()


def _cell(value: Any) -> str:
    if value is None:
        return ""
    return safe_cell(str(value)) if isinstance(value, str) else repr(value)
