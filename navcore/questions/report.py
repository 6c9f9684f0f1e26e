"""Report: the verification matrix of a scenario, with what its verdicts rest on, as one file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.drawing import drawn
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.out import PathLike, require_file, signed, write_file
from navcore.foundation.out_table import require_table, write_table
from navcore.foundation.parameters import quantity
from navcore.foundation.progress import part_of
from navcore.foundation.text import Text
from navcore.questions.base import Cancelled, Progress, Question, Writes, option, unless_stopped

if TYPE_CHECKING:
    from navcore.design.matrix import MatrixRow
    from navcore.design.result import Budget
    from navcore.design.worst.result import Worst
    from navcore.engine.measures import SeedShare
    from navcore.engine.run import Run
    from navcore.scenario.model import Scenario
    from navcore.scenario.requirement import Requirement

_HTML_COMMENT = "<!-- {} -->"
_JUDGED, _BUDGETED = 0.7, 0.9
"""Parts of the time after which matrix and budget are there."""


@dataclass(frozen=True)
class Case:
    """One scenario of a report: the one under test, or what a test of a set of clauses makes of it.

    Attributes
    ----------
    title, text : str
        Name of the test, and what it prescribes; empty for the scenario itself.
    run : Run
        Of all methods.
    shares : tuple of SeedShare
        One a method; none without limits.
    rows : tuple of MatrixRow
        Its part of the matrix.
    """

    title: str
    text: str
    run: Run
    shares: tuple[SeedShare, ...]
    rows: tuple[MatrixRow, ...]


@dataclass(frozen=True)
class Told:
    """All that a report's page tells.

    Attributes
    ----------
    scenario : Scenario
        Under test.
    clauses : str
        Title and source of the set of clauses; empty for none.
    seeds : int
        Of which shares and statistics are.
    cases : tuple of Case
        The scenario itself, and one a test.
    budget : Budget or None
        Along the run; None where there is none.
    worst : Worst or None
        What a log within a bound can do; None where there is none.
    left_out : tuple of (str, str)
        Parts that the page lacks, and why.
    """

    scenario: Scenario
    clauses: str
    seeds: int
    cases: tuple[Case, ...]
    budget: Budget | None
    worst: Worst | None
    left_out: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Report(Answer):
    """The verification matrix, and the page that holds it.

    Attributes
    ----------
    scenario_sha256, version : str
        Of the scenario, and of the program.
    seeds : int
        Of which shares and statistics are.
    matrix : tuple of MatrixRow
        A row for each limit and method.
    page : str
        HTML that loads nothing.
    assumed_zero : tuple of str
        Standard deviations that the scenario states in no way.
    """

    scenario_sha256: str
    version: str
    seeds: int
    matrix: tuple[MatrixRow, ...]
    page: str
    assumed_zero: tuple[str, ...] = ()

    def document(self) -> dict[str, Any]:
        """Return what ``--json`` prints."""
        return {
            "scenario_sha256": self.scenario_sha256,
            "version": self.version,
            "seeds": self.seeds,
            "matrix": [row.as_dict() for row in self.matrix],
            "assumed_zero": list(self.assumed_zero),
        }

    def rows(self) -> Iterator[Table | str]:
        """Give the matrix."""
        yield matrix_table(self.matrix)


def matrix_table(rows: Iterable[MatrixRow]) -> Table:
    """Make a table of rows of the matrix."""
    from navcore.questions.run import verdict_words

    heads = Text("clause"), Text("requirement"), Text("method"), Text("judged by"), Text("result")
    columns = tuple(Column(head, left=True) for head in (*heads, Text("verdict"), Text("rests on")))
    cells = (
        (
            row.requirement.clause or "-",
            _asked(row.requirement),
            row.method,
            row.how,
            row.result_words(),
            verdict_words(row.verdict, row.judgement),
            row.rests_on,
        )
        for row in rows
    )
    return Table(columns, tuple(cells))


def _asked(one: Requirement) -> str:
    """Words of the clause, and the limit."""
    if not one.text:
        return one.words
    return Text("{text} [{words}]", text=one.text, words=one.words)


class ReportQuestion(Question):
    """Which methods meet which clause, and how that is known."""

    title: ClassVar[str] = Text("Report")
    help: ClassVar[str] = Text(
        "Verification matrix of a scenario: every limit on every method, how it was judged, and the verdict; "
        "with --out as one HTML file that prints on A4."
    )
    keeps: ClassVar[bool] = False
    stopped: ClassVar[str] = Text("Stopped: no report.")
    writes: ClassVar[Writes] = "file"
    files: ClassVar = ("report.html",)
    written: ClassVar[str] = Text("the report: one HTML file that loads nothing, and prints on A4")
    example: ClassVar[str] = """\
>>> from navcore import load, report
>>> limit = ["requirement.0.quantity=position_cep50_m", "requirement.0.at_most=1 nmi"]
>>> found = report(load("zha-fast", ["run.duration_h=1", *limit]), seeds=8)
>>> [row.verdict for row in found.matrix]
['met', 'met', 'met']"""
    id: Literal["report"] = "report"
    seeds: int | None = quantity(
        None,
        ge=1,
        le=100_000,
        label=Text("seeds"),
        help=Text("Runs by which limits are judged; where none is given 200, fewer where runs are long."),
    )
    clauses: str | None = option(
        None,
        label=Text("set of clauses"),
        metavar="SET",
        help=Text(
            "Ready set of clauses (imo-a821, imo-a824, ins-1nmi-24h) or a file: its tests are run with the "
            "scenario's methods and sensors, each in the scenario that it prescribes."
        ),
    )
    log_max: float = quantity(
        1.0,
        unit="m/s",
        ge=1e-6,
        le=50.0,
        label=Text("log within"),
        help=Text("Bound of the log's error for the worst case, in m/s."),
    )
    matrix: str | None = option(
        None, label=Text("matrix"), metavar="FILE", help=Text("CSV file for the matrix alone.")
    )

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> Report:
        """Run and judge the scenario and the tests, and write the page."""
        from navcore.design.stated import assumed_zero
        from navcore.foundation.version import __version__
        from navcore.scenario.file import scenario_hash

        tests = self._tests()
        if not self.scenario.requirement and not tests:
            allowed = Text("is needed: [[requirement]] with quantity and at_most, or --clauses")
            raise InputError(Fault("", "requirement", None, allowed))
        scenarios = [("", "", self.scenario), *tests]
        cases: list[Case] = []
        seeds = 0
        for k, (title, text, scenario) in enumerate(scenarios):
            ends = (_JUDGED * place / len(scenarios) for place in (k, k + 1))
            case, count = self._judged(title, text, scenario, part_of(progress, *ends), cancelled)
            cases.append(case)
            seeds = max(seeds, count)
        left_out: list[tuple[str, str]] = []
        budget = self._budget(left_out, part_of(progress, _JUDGED, _BUDGETED), cancelled)
        worst = self._worst(left_out, part_of(progress, _BUDGETED, 1.0), cancelled)
        unless_stopped(cancelled)
        named = self._set
        clauses = Text("{title}. {source}", title=named.title, source=named.source) if named else ""
        told = Told(self.scenario, clauses, seeds, tuple(cases), budget, worst, tuple(left_out))
        rows = tuple(row for case in cases for row in case.rows)
        page = str(drawn("report_page", told))
        hashed = scenario_hash(self.scenario)
        return Report(hashed, __version__, seeds, rows, page, assumed_zero(self.scenario))

    @property
    def _set(self) -> Any:
        from navcore.scenario.clauses import load_clauses

        return None if self.clauses is None else load_clauses(self.clauses)

    def _tests(self) -> list[tuple[str, str, Scenario]]:
        named = self._set
        return [] if named is None else [(one.name, one.text, one.of(self.scenario)) for one in named.tests]

    def _judged(
        self,
        title: str,
        text: str,
        scenario: Scenario,
        progress: Progress | None,
        cancelled: Cancelled | None,
    ) -> tuple[Case, int]:
        """Run one scenario, and judge its limits by seeds."""
        from navcore.design.matrix import matrix_rows
        from navcore.design.run_shares import run_shares, seeds_for
        from navcore.engine.simulation import simulate

        run = simulate(scenario, part_of(progress, 0.0, 0.2), cancelled)
        unless_stopped(cancelled)
        seeds = self.seeds or seeds_for(scenario, wanted=True)
        shares: tuple[SeedShare, ...] = ()
        if scenario.requirement:
            shares = run_shares(scenario, seeds, part_of(progress, 0.2, 1.0), cancelled)
            unless_stopped(cancelled)
        return Case(title, text, run, shares, tuple(matrix_rows(run, shares, title))), seeds

    def _budget(
        self, left_out: list[tuple[str, str]], progress: Progress | None, cancelled: Cancelled | None
    ) -> Budget | None:
        from navcore.design.budget import budget

        try:
            return budget(self.scenario, progress=progress, cancelled=cancelled)
        except InputError as error:
            left_out.append((Text("budget"), str(error)))
            return None

    def _worst(
        self, left_out: list[tuple[str, str]], progress: Progress | None, cancelled: Cancelled | None
    ) -> Worst | None:
        from navcore.design.worst.bounded import worst

        try:
            return worst(self.scenario, self.log_max, None, progress, cancelled)
        except InputError as error:
            left_out.append((Text("worst case"), str(error)))
            return None

    def require_free(self, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False) -> None:
        """Refuse a place for the page or the matrix that must not be replaced."""
        kept = [*reads, *self.recordings()]
        require_file(out, self._command, kept, force=force)

    def write(
        self, answer: Answer, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False
    ) -> None:
        """Write the page."""
        kept = [*reads, *self.recordings()]
        assert isinstance(answer, Report)
        write_file(out, answer.page, self._command, kept, force=force, comment=_HTML_COMMENT)

    def require_beside(self, reads: Iterable[PathLike] = (), *, force: bool = False) -> None:
        """Refuse a place for the matrix that must not be replaced."""
        if self.matrix is not None:
            require_table(
                self.matrix, _heading(), [*reads, *self.recordings()], force=force, option="--matrix"
            )

    def write_beside(self, answer: Answer, reads: Iterable[PathLike] = (), *, force: bool = False) -> None:
        """Write the matrix."""
        from navcore.design.matrix import matrix_csv

        if self.matrix is None:
            return
        assert isinstance(answer, Report)
        kept, text = [*reads, *self.recordings()], matrix_csv(answer.matrix)
        write_table(self.matrix, text, _heading(), kept, force=force, option="--matrix")

    def texts(self, answer: Answer) -> dict[str, str]:
        """Return the page as `write` writes it."""
        return {"report.html": signed(vars(answer)["page"], self._command, _HTML_COMMENT)}


def _heading() -> str:
    from navcore.design.matrix import COLUMNS

    return ",".join(COLUMNS)
