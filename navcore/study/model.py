"""The study file: what is run (a scenario), over what (factors, seeds), and what is kept (output)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field, ValidationError

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.faults import faults_from
from navcore.foundation.parameters import Parameters, choice, quantity
from navcore.foundation.text import Text
from navcore.quantities import NAMES, QUANTITIES
from navcore.scenario.fields import SCHEMA

METRICS = tuple(key for key, row in QUANTITIES.items() if {"run", "loop"} & {*row.names})
"""Quantities that a single run has."""
OF_RUNS = tuple(key for key in METRICS if QUANTITIES[key].kind)
COLUMNS = ("run", "seed", "method", "status", "reason", "met")
"""Columns of every row, whose names no factor bears."""
LARGEST_HYPERCUBE = 10_000_000
if TYPE_CHECKING:
    Metric = Series = str
else:
    Metric, Series = Literal[METRICS], Literal[NAMES]


class Factor(Parameters):
    """One ``[[factor]]``: a field of the scenario, or several together, and the values that they take."""

    field: str | tuple[str, ...] = Field(
        description=Text("Dotted path of a field, as of --set, or a list of paths that are set together.")
    )
    name: str = Field(default="", max_length=80, description=Text("Column of the results; the first path."))
    values: tuple[Any, ...] = Field(
        default=(),
        max_length=100_000,
        description=Text("Values of a grid; of several fields each value is a list with one for each."),
    )
    labels: tuple[str, ...] = Field(default=(), description=Text("Names of the values in the results."))
    distribution: Literal["uniform", "log_uniform", "normal"] = choice(
        "uniform", help=Text("Of values that are drawn, in place of a grid.")
    )
    low: float | None = quantity(None, help=Text("Least value that is drawn; of normal it may be left out."))
    high: float | None = quantity(None, help=Text("Largest value that is drawn; as low."))
    mean: float | None = quantity(None, help=Text("Mean of normal, before values outside are cut off."))
    deviation: float | None = quantity(None, gt=0.0, help=Text("Standard deviation of normal, likewise."))

    @property
    def fields(self) -> tuple[str, ...]:
        """All paths."""
        return (self.field,) if isinstance(self.field, str) else self.field

    @property
    def drawn(self) -> bool:
        """Whether its values are drawn from a distribution."""
        return not self.values

    @property
    def column(self) -> str:
        """Name in the results."""
        return self.name or self.fields[0]

    @property
    def depth(self) -> int:
        """Parts of a run that it leaves as they are: 0 none, 2 the truth, 3 truth, sensors and log."""
        blocks = {field.partition(".")[0] for field in self.fields}
        if blocks <= {"method", "requirement"}:
            return 3
        return 2 if blocks <= {"method", "requirement", "imu", "reference", "initial_error"} else 0

    def faults(self, at: str) -> Iterator[Fault]:
        """Yield what is wrong beyond single fields; ``at`` names the block."""
        if not self.fields:
            yield Fault("", f"{at}.field", "[]", Text("must name at least one field"))
        figures = [name for name in ("low", "high", "mean", "deviation") if getattr(self, name) is not None]
        if self.values:
            if figures:
                yield Fault("", f"{at}.{figures[0]}", None, Text("is not for a grid: leave out values"))
            for k, value in enumerate(self.values):
                count = len(value) if isinstance(value, list | tuple) else 0
                if len(self.fields) > 1 and count != len(self.fields):
                    allowed = Text("must be a list of {count} values", count=len(self.fields))
                    yield Fault("", f"{at}.values.{k}", value, allowed)
            if self.labels and len({*self.labels}) != len(self.values):
                allowed = Text("must be {count} different texts, one a value", count=len(self.values))
                yield Fault("", f"{at}.labels", list(self.labels), allowed)
            return
        for name in ("mean", "deviation") if self.distribution == "normal" else ("low", "high"):
            if getattr(self, name) is None:
                yield Fault("", f"{at}.{name}", None, Text("is required where there are no values"))
        if self.low is not None and self.high is not None and self.low >= self.high:
            yield Fault("", f"{at}.low", self.low, Text("must be < high = {high:g}", high=self.high))
        if self.distribution == "log_uniform" and self.low is not None and self.low <= 0.0:
            yield Fault("", f"{at}.low", self.low, Text('must be > 0 for "log_uniform"'))


class Sample(Parameters):
    """Block ``sample``: how the factors with a distribution are drawn together."""

    method: Literal["random", "latin_hypercube", "sobol", "saltelli"] = choice(
        "sobol",
        help=Text(
            "random: independent; the others fill the space (scipy.stats.qmc, scrambled). saltelli: points x "
            "(factors + 2) draws, from which the summary gives Sobol indices."
        ),
    )
    points: int = Field(
        default=128, strict=True, ge=1, le=2**30, description=Text("Draws, each with every grid value.")
    )
    seed: int = Field(default=1, strict=True, ge=0, le=2**31 - 1, description=Text("Seed of the draws."))


class Output(Parameters):
    """Block ``output``: what is kept of a run, beside the requirements of the scenario."""

    metrics: tuple[Metric, ...] = Field(
        default=OF_RUNS, description=Text("Quantities, in the unit of their name, else that on the page.")
    )
    series: tuple[Series, ...] = Field(
        default=(), description=Text("Errors (SI) that are kept at the epochs, signed.")
    )
    epochs_h: tuple[float, ...] = Field(
        default=(), max_length=100, description=Text("Times, h; the nearest output row counts.")
    )


def series_column(name: str, hours: float) -> str:
    """Column of an error at an epoch in the results."""
    return f"{name}@{hours:g}h"


class Study(Parameters):
    """A study: the whole file."""

    schema_version: Literal[1] = Field(
        default=SCHEMA, alias="schema", description=Text("Version of this format.")
    )
    title: str = Field(default="", max_length=300, description=Text("What it asks, in one line."))
    scenario: str | dict[str, Any] = Field(
        description=Text("Preset, file (its path is relative to the study), or a table [scenario].")
    )
    set: tuple[str, ...] = Field(
        default=(), description=Text("Fields of the scenario to change, each KEY=VALUE as of --set.")
    )
    fidelity: Literal["channel", "error_model", "strapdown"] | None = Field(
        default=None, description=Text("In place of run.fidelity.")
    )
    seeds: int = Field(
        default=1,
        strict=True,
        ge=1,
        le=2**31,
        description=Text("Runs of every point: with run.seed and the seeds after it."),
    )
    constants: bool = Field(
        default=False,
        strict=True,
        description=Text("Each seed also draws biases and initial errors, as schuler design does."),
    )
    factor: tuple[Factor, ...] = Field(default=(), max_length=50, description=Text("What is varied."))
    sample: Sample = Sample()
    output: Output = Output()

    @classmethod
    def parse(cls, data: dict[str, Any], where: str = "") -> Study:
        """Validate a mapping as read from TOML.

        Raises
        ------
        InputError
            One fault per field that is wrong, each with value and allowed range.
        """
        try:
            study = cls.model_validate(data)
        except ValidationError as error:
            raise InputError(faults_from(error, cls, data, where)) from None
        faults = list(study.faults())
        if faults:
            raise InputError(faults).located(where)
        return study

    @property
    def draws(self) -> int:
        """Points that are drawn; 1 where no factor has a distribution."""
        drawn = sum(factor.drawn for factor in self.factor)
        rows = drawn + 2 if self.sample.method == "saltelli" else 1
        return self.sample.points * rows if drawn else 1

    def faults(self) -> Iterator[Fault]:
        """Yield the faults of the whole study."""
        taken = {*COLUMNS, *self.output.metrics}
        for i, factor in enumerate(self.factor):
            yield from factor.faults(f"factor.{i}")
            if factor.column in taken:
                allowed = Text("must differ from the other columns of the results")
                yield Fault("", f"factor.{i}.name", factor.column, allowed)
            taken.add(factor.column)
        if "sample" in self.model_fields_set and not any(factor.drawn for factor in self.factor):
            yield Fault("", "sample", None, Text("needs a [[factor]] with a distribution in place of values"))
        if self.sample.method == "latin_hypercube" and self.sample.points > LARGEST_HYPERCUBE:
            allowed = Text('must be <= {most} with "latin_hypercube"', most=LARGEST_HYPERCUBE)
            yield Fault("", "sample.points", self.sample.points, allowed)
        points = self.sample.points
        if self.sample.method == "saltelli" and (points < 2 or points & (points - 1)):
            near = max(2, 1 << points.bit_length())
            allowed = Text('must be a power of 2 with "saltelli": {near}', near=near)
            yield Fault("", "sample.points", points, allowed)
        if bool(self.output.series) != bool(self.output.epochs_h):
            missing = "epochs_h" if self.output.series else "series"
            yield Fault(
                "", f"output.{missing}", None, Text("is required: series and epochs_h belong together")
            )
