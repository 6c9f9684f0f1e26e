"""A misprint: where it stands, what is right, and both computed side by side."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from navcore.engine.simulation import simulate
from navcore.foundation.earth import SPHERE
from navcore.foundation.text import Text
from navcore.networks.base import LinearNetwork, linear_network
from navcore.scenario.model import Scenario

Form = Literal["printed", "corrected"]
OMEGA_S = SPHERE.schuler_frequency(0.0)
"""Schuler frequency of the textbook sphere, rad/s: that of the papers' formulas."""


@dataclass(frozen=True)
class Axis:
    """One axis of a comparison: what it shows, its SI unit ("" for a pure number), linear or logarithmic."""

    label: str
    unit: str = ""
    log: bool = False


TIME = Axis("time", "s")
TILT = Axis(Text("tilt / initial tilt"))
"""The axes that most comparisons share."""


@dataclass(frozen=True, eq=False)
class Curve:
    """One curve.

    Attributes
    ----------
    label : str
        What it is, in a few words.
    form : {"printed", "corrected"}
        Which of the two it belongs to.
    y : ndarray, shape (n,)
        Values in the unit of the y axis; NaN where there is none.
    """

    label: str
    form: Form
    y: np.ndarray


@dataclass(frozen=True)
class Number:
    """One number of a comparison, SI; None where it does not exist (a loop that never settles, say)."""

    name: str
    unit: str
    printed: float | None
    corrected: float | None


@dataclass(frozen=True, eq=False)
class Comparison:
    """Results of the printed and of the corrected form.

    Attributes
    ----------
    x_axis, y_axis : Axis
        Labels and units.
    x : ndarray, shape (n,)
        Common abscissa of all curves, SI.
    curves : tuple of Curve
        At least one of each form.
    numbers : tuple of Number
        One or two figures that say it.
    words : str
        The same in one plain sentence, with the numbers in readable units.
    """

    x_axis: Axis
    y_axis: Axis
    x: np.ndarray
    curves: tuple[Curve, ...]
    numbers: tuple[Number, ...]
    words: str


@dataclass(frozen=True)
class Misprint:
    """One error of a paper that changes a result (theory.md 8), or a remark on what it prints rightly.

    Attributes
    ----------
    id : str
        E.g. ``sun-18``.
    paper : str
        E.g. ``Sun 2017``.
    where : str
        Equation, figure or section.
    printed, right : str
        What the paper prints and what is right, as text.
    consequence : str
        What the printed form does.
    compute : callable
        Returns the `Comparison`; nothing is kept, every call computes anew.
    remark : bool
        What is printed is no error: the other form shows what it costs, or means elsewhere.
    """

    id: str
    paper: str
    where: str
    printed: str
    right: str
    consequence: str
    compute: Callable[[], Comparison]
    remark: bool = False


def growth_time(poles: np.ndarray) -> float | None:
    """Time in which the fastest growing mode grows e-fold, s; None when none grows.

    Parameters
    ----------
    poles : ndarray of complex
        Eigenvalues, rad/s.
    """
    largest = float(np.max(np.real(poles)))
    return 1.0 / largest if largest > 1e-9 * float(np.max(np.abs(poles))) else None


def as_network(num_p: np.ndarray | list[float], den_p: np.ndarray | list[float]) -> LinearNetwork:
    """Make a network of polynomials in p = s / omega_s that no catalogue entry would give."""
    return linear_network("custom", OMEGA_S, num_p, den_p)


def run_scenario(data: dict[str, Any], quantity: int) -> tuple[np.ndarray, list[np.ndarray]]:
    """Simulate a scenario; return the times (s) and each method's column of the recorder (SI).

    Parameters
    ----------
    data : dict
        The scenario as read from TOML.
    quantity : int
        Column of `navcore.mechanization.recorder`.
    """
    run = simulate(Scenario.parse(data))
    return run.t_s, [padded(method.rows[:, quantity], len(run.t_s)) for method in run.methods]


def padded(values: np.ndarray, count: int) -> np.ndarray:
    """Fill a curve that ended early with NaN up to ``count`` values."""
    out = np.full(count, np.nan)
    out[: len(values)] = values
    return out
