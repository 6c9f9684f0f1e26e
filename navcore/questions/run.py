"""Run: every method of a scenario on the same truth, sensors and log, as a table."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from navcore.foundation.answers import Answer, Column, Table, number
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.out import PathLike
from navcore.foundation.progress import part_of
from navcore.foundation.text import Text
from navcore.quantities import ERRORS, POSITION, components
from navcore.questions.base import Cancelled, Progress, Question, Writes, option

if TYPE_CHECKING:
    from navcore.engine.measures import SeedShare
    from navcore.engine.run import LawInForce, MethodRun, Run
    from navcore.engine.verdicts import Judgement, Verdict

_RUN = 0.2
"""Of the time, for the run itself where seeds judge its limits too."""
_SHOWN = tuple(error for error in ERRORS if error.name not in components(POSITION))
_STATISTICS = {"rms": Text("RMS"), "max_abs": Text("largest"), "final": Text("at the end")}
_LOOP = (
    Column(Text("loop")),
    Column(Text("damping"), Text("ratio")),
    Column("H(0)"),
    Column(Text("settling"), "min"),
    Column(Text("24 h mode"), Text("e-folding")),
    Column(Text("damped"), "%"),
    Column(Text("\u03b6 in"), Text("force")),
    Column(Text("status")),
)
_EARTHS = {"wgs84": "WGS-84", "sphere": Text("sphere")}


@dataclass(frozen=True)
class Ran(Answer):
    """A run, and what seeds say of its limits.

    Attributes
    ----------
    run : Run
        Of all methods.
    shares : tuple of SeedShare
        One a method; none where a run draws all that there is to draw.
    without_shares : tuple of Fault
        Why there is no share of seeds.
    """

    run: Run
    shares: tuple[SeedShare, ...] = ()
    without_shares: tuple[Fault, ...] = ()

    @property
    def failed(self) -> bool:
        """Whether a method diverged or was stopped."""
        return self.run.status != "ok"

    def complaints(self) -> Iterator[str]:
        """Give why a method did not go through, and why there is no share of seeds."""
        for fault in self.without_shares:
            yield Text("no share of seeds: {fault}", fault=str(fault))
        for one in self.run.methods:
            if one.reason:
                name, reason = one.method.name, one.reason
                yield Text("{name}: {status}: {reason}", name=name, status=one.status, reason=reason)

    def document(self) -> dict[str, Any]:
        """Return ``metrics.json``."""
        from navcore.engine.measures import metrics

        return metrics(self.run, self.shares)

    def rows(self) -> Iterator[Table | str]:
        """Give what was run, the loops, RMS, largest and last errors of every method, verdicts, warnings."""
        from navcore.scenario.provenance import source_of

        run, settings = self.run, self.run.scenario.run
        on_ins = self.run.scenario.on_ins and len(run.truth)
        lat_deg = math.degrees(float(run.truth[0, 0])) if on_ins else run.scenario.site.lat_deg
        if head := ", ".join(part for part in (run.scenario.title, source_of(run.scenario)) if part):
            yield head
        yield Text(
            "{fidelity}, {hours:g} h, {earth}, {lat:g} {side}, seed {seed}; statistics over {steps}",
            fidelity=settings.fidelity,
            hours=settings.duration_h,
            earth=_EARTHS[settings.earth],
            lat=abs(lat_deg),
            side="N" if lat_deg >= 0 else "S",
            seed=settings.seed,
            steps=run.computed_on,
        )
        yield from (one.line for one in run.scenario.refused)
        yield Table(_LOOP, tuple(map(_loop_row, run.lines)))
        for key, title in _STATISTICS.items():
            heads = (Column(title), *(Column(error.symbol, error.kind.unit) for error in _SHOWN))
            rows = (
                (one.method.name, *(one.errors[error.name][key] / error.kind.size for error in _SHOWN))
                for one in run.lines
            )
            yield Table(heads, tuple(rows))
        yield from self._to_log()
        yield from self._verdicts()
        warnings: list[str] = [Text("warning: {text}", text=text) for text in run.warnings]
        for one in run.lines:
            name = one.method.name
            warnings += (Text("warning: {name}: {text}", name=name, text=text) for text in one.warnings)
        yield from ("", *warnings) if warnings else ()

    def _to_log(self) -> Iterator[Table | str]:
        """Give the natural lines in velocity minus log, before and after; nothing without ``[ins]``."""
        from navcore.engine.to_log import lines_to_log

        if self.run.against is None:
            return
        heads = (
            Column(Text("velocity minus log")),
            *(
                Column(Text("{axis}: {line}", axis=axis, line=line), "m/s")
                for axis in (Text("east"), Text("north"))
                for line in (Text("84 min"), Text("24 h"), "RMS")
            ),
        )
        keys = "schuler_mps", "earth_mps", "rms_mps"
        rows = (
            (name, *(of_axis[key] for of_axis in axes.values() for key in keys))
            for name, axes in lines_to_log(self.run).items()
        )
        yield Table(heads, tuple(rows))

    def _verdicts(self) -> Iterator[Table | str]:
        """Give a row for each method and limit, and what the run draws as 0; nothing without limits."""
        from navcore.design.stated import assumed_zero
        from navcore.engine.measures import verdict
        from navcore.scenario.stochastic import drawn_as_zero

        run, shares, limits = self.run, self.shares, self.run.scenario.requirement
        if not limits:
            return
        heads = Text("requirement"), Text("method"), Text("value"), Text("verdict")
        rows: list[tuple[str, ...]] = []
        for place, one in enumerate(limits):
            limit = Text("{clause}: {words}", clause=one.clause, words=one.words) if one.clause else one.words
            for k, method in enumerate(run.lines):
                judgement = shares[k].limits[place] if shares else None
                value, word = verdict(one, method, judgement)
                said = [] if judgement is None else [_share(judgement)]
                rows.append((limit, method.method.name, number(value), verdict_words(word, judgement), *said))
        if shares and len(limits) > 1:
            every = Text("all limits")
            rows += [(every, one.method.name, "", "", _share(shares[k])) for k, one in enumerate(run.methods)]
        if shares:
            heads = (*heads, Text("seeds that meet it"))
        yield Table(tuple(map(Column, heads)), tuple(rows))
        if zero := drawn_as_zero(run.scenario):
            yield Text(
                "drawn as 0 in this run, though a standard deviation is given: {zero}", zero=", ".join(zero)
            )
        if assumed := assumed_zero(run.scenario):
            yield Text(
                "assumed 0, with neither number nor standard deviation given: {assumed}",
                assumed=", ".join(assumed),
            )


class RunQuestion(Question):
    """A run of every method."""

    title: ClassVar[str] = Text("Run")
    help: ClassVar[str] = Text("Run a scenario: every method on the same truth, sensors and log.")
    writes: ClassVar[Writes] = "folder"
    written: ClassVar[str] = Text(
        "scenario.toml, metrics.json and the time series: made if need be; other files in it stay"
    )
    example: ClassVar[str] = """\
>>> from navcore import load, run
>>> found = run(load("zha-fast", ["run.duration_h=0.1"]))
>>> found.run.status, found.failed
('ok', False)"""
    apart: ClassVar[bool] = True
    id: Literal["run"] = "run"
    format: Literal["parquet", "csv"] = option("parquet", help=Text("Of the time series."))

    def answer(self, progress: Progress | None = None, cancelled: Cancelled | None = None) -> Ran:
        """Run, and judge by seeds where a run does not draw all."""
        from navcore.design.run_shares import draws_more_than_a_run, run_shares
        from navcore.engine.simulation import simulate

        judging = draws_more_than_a_run(self.scenario)
        run = simulate(self.scenario, part_of(progress, 0.0, _RUN if judging else 1.0), cancelled)
        if not judging or run.status == "stopped":
            return Ran(run)
        try:
            partly = part_of(progress, _RUN, 1.0)
            return Ran(run, run_shares(self.scenario, progress=partly, cancelled=cancelled))
        except InputError as error:
            return Ran(run, without_shares=error.faults)

    def require_free(self, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False) -> None:
        """Refuse a folder in which a file of the run's own names cannot be replaced."""
        from navcore.engine.results import require_results

        require_results(self.scenario, out, self.format, reads)

    def write(
        self, answer: Answer, out: Path, reads: Iterable[PathLike] = (), *, force: bool = False
    ) -> None:
        """Write the scenario, the metrics and the time series."""
        from navcore.engine.results import write_results

        assert isinstance(answer, Ran)
        write_results(answer.run, out, self.format, reads, answer.shares)


def verdict_words(verdict: Verdict, judgement: Judgement | None) -> str:
    """Verdict in words, of an open one with the number of seeds that would decide."""
    from navcore.engine.verdicts import WORDS

    if verdict != "open" or judgement is None:
        return WORDS[verdict]
    if judgement.more is None:
        return Text("open: no number of seeds decides")
    return Text("open: {more} more seeds decide", more=judgement.more)


def _share(share: SeedShare | Judgement) -> str:
    one = share.as_dict()
    met, low, high = (number(100.0 * one[key], 3) for key in ("met", "low", "high"))
    return Text("{met} % of {seeds} ({low} to {high})", met=met, seeds=share.seeds, low=low, high=high)


def _loop_row(one: MethodRun) -> tuple[str | float | None, ...]:
    loop, law = one.loop, one.law_in_force
    settling = number(loop.settling_s / 60.0) if loop.settling_s is not None else Text("never")
    h0 = number(loop.h0) if math.isfinite(loop.h0) else Text("infinite")
    damped = 100.0 * law.damped_share
    name = one.method.name
    return name, loop.damping_ratio, h0, settling, _earth_mode(one), damped, _coefficient(law), one.status


def _coefficient(law: LawInForce) -> str:
    """Damping ratio in force: one value, or the range."""
    if law.xi_min is None or law.xi_max is None:
        return "-"
    low, high = number(law.xi_min, 3), number(law.xi_max, 3)
    return low if low == high else Text("{low} to {high}", low=low, high=high)


def _earth_mode(one: MethodRun) -> str:
    """How the 24 h mode of the whole system behaves: which way, and the e-folding time."""
    from navcore.analysis.whole_system import duration

    growth = one.whole.earth_growth
    if growth == 0.0:
        return Text("stands")
    every = duration(1.0 / growth)
    return Text("grows, {every}", every=every) if growth > 0.0 else Text("decays, {every}", every=every)
