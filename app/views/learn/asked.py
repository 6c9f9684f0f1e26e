"""What a lesson asks: a question, a curve to predict, an open task; each is judged by a run."""

import math
import operator
import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from navcore.engine.run import Run
from navcore.foundation.notation import with_unit
from navcore.foundation.numbers import read_number, read_whole
from navcore.foundation.text import Text
from schuler_bench.views.learn.names import COLUMNS, in_unit, named

COLUMNS_OF_SKETCH = 49
"""Times at which a sketch has a height, from the begin of the run to its end."""
_LEAST_DRAWN = 0.8
_LARGEST_RATIO, _CROSSINGS, _NEAR_ZERO = 2.0, 0.2, 0.05
_COMPARISON = re.compile(r"([^<>]*)(<=|>=|<|>)(.*)")
_TERM = re.compile(r"(?:([0-9.eE+-]+)\s*\*\s*)?([a-z][a-z0-9_.]*)")
_SIGNS: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}


class Part(BaseModel):
    """Base of what a file of a lesson holds."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class Choice(Part):
    """One of the answers to choose from, and when it is right."""

    say: str
    when: str


class Question(Part):
    """A question, and how its answer follows from a run; see the module's text."""

    ask: str
    why: str
    answer: str = ""
    tolerance: float = Field(default=0.05, gt=0.0, le=0.5)
    choices: tuple[Choice, ...] = ()


class Sketch(Part):
    """A curve that the learner draws before the run shows it; see `schuler_bench.views.learn.lessons`."""

    ask: str
    curve: str
    why: str


class Task(Part):
    """An open task: conditions that the learner's own run is to meet."""

    ask: str
    conditions: tuple[Choice, ...] = Field(min_length=1)
    why: str


# ------------------------------------------------------------ answers


def holds(comparison: str, run: Run) -> bool:
    """Whether a comparison of names and numbers holds for a run.

    Raises
    ------
    KeyError
        It is no comparison, or a name is unknown.
    """
    match = _COMPARISON.fullmatch(comparison)
    if match is None:
        raise KeyError(comparison)
    left, sign, right = match.groups()
    return _SIGNS[sign](_term(left.strip(), run), _term(right.strip(), run))


def _term(text: str, run: Run) -> float:
    with suppress(ValueError):
        return float(text)
    match = _TERM.fullmatch(text)
    if match is None:
        raise KeyError(text)
    factor, name = match.groups()
    return float(factor or 1.0) * named(name, run).value


def right_choice(question: Question, run: Run) -> int:
    """Number of the choice that is right for a run.

    Raises
    ------
    KeyError
        Not exactly one is.
    """
    right = [i for i, choice in enumerate(question.choices) if holds(choice.when, run)]
    if len(right) != 1:
        raise KeyError(f"{question.ask}: {len(right)} choices are right")
    return right[0]


def is_right(question: Question, given: str, run: Run) -> bool:
    """Whether an answer is right for a run.

    Parameters
    ----------
    question : Question
        What was asked.
    given : str
        Number of the choice, or the number that was typed.
    run : Run
        Of the scenario that the question is about.

    Raises
    ------
    NotANumber
        ``given`` is no number.
    """
    if question.choices:
        return read_whole(given) == right_choice(question, run)
    value = named(question.answer, run).value
    return abs(read_number(given) - value) <= question.tolerance * abs(value)


# ------------------------------------------------------------ tasks


def met(task: Task, run: Run) -> tuple[bool, ...]:
    """Whether a run meets each condition of a task.

    Raises
    ------
    KeyError
        A condition is no comparison, or a name in it is unknown.
    """
    return tuple(holds(condition.when, run) for condition in task.conditions)


# ------------------------------------------------------------ sketches


@dataclass(frozen=True)
class Curve:
    """A curve of a run, as it is drawn under a sketch.

    Attributes
    ----------
    hours : ndarray, shape (n,)
        Times, h.
    values : ndarray, shape (n,)
        In ``unit``.
    unit : str
        Of the values.
    half : float
        Half of the height of the axis, in ``unit``: the axis runs from ``-half`` to ``half``.
    """

    hours: np.ndarray
    values: np.ndarray
    unit: str
    half: float

    @property
    def largest(self) -> float:
        """Largest magnitude, in ``unit``."""
        return float(np.max(np.abs(self.values)))


def curve_of(sketch: Sketch, run: Run) -> Curve:
    """Return the curve that a sketch is about.

    Raises
    ------
    KeyError
        The run has no such curve, or it is zero or no number throughout.
    """
    number, _, key = sketch.curve.partition(".")
    if not number.isdecimal() or int(number) >= len(run.methods) or key not in COLUMNS:
        raise KeyError(sketch.curve)
    plot = run.methods[int(number)].plot
    unit = in_unit(1.0, key)
    values = plot.values[:, COLUMNS[key]] * unit.value
    largest = float(np.max(np.abs(values), initial=0.0))
    if not (largest > 0.0 and math.isfinite(largest)):
        raise KeyError(sketch.curve)
    return Curve(plot.t_s / 3600.0, values, unit.unit, _axis_end(1.2 * largest))


def _axis_end(largest: float) -> float:
    """Smallest of 1, 2, 5 times a power of ten that is not below ``largest``."""
    power = 10.0 ** math.floor(math.log10(largest))
    return next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= largest)


def read_heights(text: str) -> tuple[float, ...]:
    """Read a sketch as the page sends it.

    Parameters
    ----------
    text : str
        `COLUMNS_OF_SKETCH` numbers from -1 to 1, with commas between them; empty where nothing was drawn.

    Returns
    -------
    tuple of float
        NaN where nothing was drawn.

    Raises
    ------
    ValueError
        It is no such list, or most of it is empty.
    """
    parts = text.split(",")
    heights = tuple(float(part) if part.strip() else math.nan for part in parts)
    if len(heights) != COLUMNS_OF_SKETCH or any(abs(h) > 1.0 for h in heights):
        raise ValueError(text[:80])
    drawn = sum(not math.isnan(height) for height in heights)
    if drawn < _LEAST_DRAWN * COLUMNS_OF_SKETCH:
        raise ValueError(drawn)
    return heights


def crossings(values: Sequence[float] | np.ndarray) -> int:
    """Count the changes of sign of what is not near zero, beside its largest, or no number."""
    sizes = np.asarray(values, float)
    least = _NEAR_ZERO * np.nanmax(np.abs(sizes))
    signs = np.sign(sizes[np.abs(sizes) > least])
    return int(np.count_nonzero(signs[1:] != signs[:-1]))


def compare(heights: Sequence[float], curve: Curve) -> tuple[str, bool]:
    """Say how a sketch compares with the curve, and whether both are alike.

    Alike are a largest value within a factor of two and a number of zero crossings within one, or a fifth.
    """
    own = float(np.nanmax(np.abs(heights))) * curve.half
    drawn, run = crossings(heights), crossings(curve.values)
    alike = curve.largest / _LARGEST_RATIO <= own <= curve.largest * _LARGEST_RATIO and abs(
        drawn - run
    ) <= max(1.0, _CROSSINGS * run)
    words = Text(
        "Your curve reaches {own} and crosses zero {drawn} times; the run reaches {largest} and crosses it "
        "{run} times.",
        own=with_unit(f"{own:.3g}", curve.unit),
        drawn=drawn,
        largest=with_unit(f"{curve.largest:.3g}", curve.unit),
        run=run,
    )
    return words, alike
