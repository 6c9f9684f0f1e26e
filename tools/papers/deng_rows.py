"""Deng 2019: the rows of tables 1, 2 and 4 as claims, with the readings that matter to a row."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from navcore.mechanization.recorder import DV_N
from tools.papers.claim import Claim, Reading, Table, at_most, number, order_of
from tools.papers.deng_errors import DAMPED, ROWS, SEEDS, SLOW, WORDS, Printed, errors, of_seed, statistics
from tools.papers.deng_reasons import BIASED_20, NORTH_UP, effects, referenced, spread_with
from tools.papers.measure import hours, mean_and_interval, rms
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs, method

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def schuler_swing(runs: Runs, preset: str, name: str, seeds: range = SEEDS) -> np.ndarray:
    """Amplitude of the Schuler line in dV_N by least squares over the whole run, m/s, with each seed."""
    found = []
    for seed in seeds:
        run = of_seed(runs, preset, seed)
        each = method(run, name)
        phase = run.scenario.omega_s * each.t_s
        basis = np.column_stack([np.ones_like(phase), each.t_s, np.cos(phase), np.sin(phase)])
        fit = np.linalg.lstsq(basis, each.rows[:, DV_N], rcond=None)[0]
        found.append(float(np.hypot(fit[2], fit[3])))
    return np.array(found)


def side_by_side(preset: str, printed: Printed, caption: str) -> Callable[[Runs], Table]:
    """Table of the paper beside ours."""

    def make(runs: Runs) -> Table:
        columns = [statistics(runs, preset, name) for name in (DAMPED, SLOW, "free")]
        rows = []
        for i, name in enumerate(ROWS):
            mean, variance = printed[i]
            cells = [number(mean), number(variance), number(variance**0.5)]
            for found in columns:
                cells += [number(rms(found[:, i, 0]), 2), mean_and_interval(found[:, i, 1], 2)]
            rows.append((name, *cells))
        head = ["error", "paper: mean", "paper: variance", "its square root"]
        for name in ("sigma = 0.13", "sigma = 0.0088", "free"):
            head += [f"{name}: RMS of the means", "std"]
        return Table(f"{caption} (ours over {len(SEEDS)} seeds):", tuple(head), tuple(rows))

    return make


_DISAPPEARED = "it can be found that Schuler oscillation and Foucault oscillation disappeared"
_SUPPRESSED = "the system Schuler periodic oscillation error is effectively suppressed"


def no_oscillation(preset: str) -> Claim:
    """The claim that the Schuler oscillation has disappeared."""
    return Claim(
        "the Schuler oscillation has disappeared: amplitude of its line in V_N, damped over free",
        "none",
        at_most(0.01),
        lambda runs: schuler_swing(runs, preset, DAMPED) / schuler_swing(runs, preset, "free"),
        quote=_SUPPRESSED if preset == "deng-vehicle" else _DISAPPEARED,
    )


def draw_errors(preset: str, methods: tuple[str, ...]) -> Callable[[Runs, Figure], None]:
    """Picture of pitch, northern velocity and position of some methods."""

    def draw(runs: Runs, figure: Figure) -> None:
        axes = figure.subplots(1, 3)
        for i, name in enumerate(methods):
            values = errors(runs, preset, name)
            t = hours(method(of_seed(runs, preset, 1), name))
            behind = {"zorder": 1.5, "alpha": 0.6} if name == DAMPED else {}
            curve(axes[0], t, values[:, 0] * 60.0, name, i, **behind)
            curve(axes[1], t, values[:, 4], name, i, **behind)
            curve(axes[2], t, np.hypot(values[:, 6], values[:, 7]), name, i, **behind)
        panel(axes[0], "Pitch", "time, h", "error, arcmin", legend=False)
        panel(axes[1], "Northern velocity", "time, h", "error, m/s", legend=False)
        panel(axes[2], "Position", "time, h", "error, m", legend=False)
        axes[1].set_yscale("symlog", linthresh=0.02)
        axes[2].set_yscale("symlog", linthresh=1.0)
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=len(methods))

    return draw


def spreads(
    preset: str,
    printed: Printed,
    cells: tuple[str, ...],
    why: dict[str, str],
    notes: Mapping[str, str] = MappingProxyType({}),
) -> tuple[Claim, ...]:
    """Each row of a table; "variance" read as a standard deviation, and the other readings beside it."""

    def claim(row: int) -> Claim:
        name, unit = ROWS[row].split(", ")
        value = printed[row][1]

        def ours(runs: Runs) -> np.ndarray:
            return statistics(runs, preset, DAMPED)[:, row, 1]

        return Claim(
            f'"variance" of {name}, as a standard deviation',
            number(value),
            order_of(value, 2.0),
            ours,
            unit,
            kind="fitted" if row in (0, 1, 3, 4) else "direction only",
            why=why.get(name, ""),
            note=notes.get(name, ""),
            facts=_named(effects(preset, row), why.get(name, "") + notes.get(name, "")),
            readings=(
                Reading("read as a variance", number(value**0.5), order_of(value**0.5, 2.0), ours),
                *_fillings(preset, row, value),
            ),
            quote=f"{WORDS[row]} {cells[row]}",
        )

    return tuple(claim(row) for row in range(len(ROWS)))


def _named(facts: dict[str, Callable[[Runs], float]], text: str) -> dict[str, Callable[[Runs], float]]:
    """Those facts that a text names, so that no other is computed."""
    return {name: fact for name, fact in facts.items() if f"{{{name}}}" in text}


def _fillings(preset: str, row: int, value: float) -> tuple[Reading, ...]:
    """Other ways to fill in what is not printed, where they matter to a row."""
    name = ROWS[row].split(", ")[0]
    if name == "V_U" and preset != "deng-vehicle":
        root = value**0.5
        return (
            Reading(
                "read as a variance and the accelerometers' biases, printed as less than 50 ug, are 20 ug",
                number(root),
                order_of(root, 2.0),
                lambda runs: spread_with(runs, preset, row, BIASED_20),
            ),
        )
    if preset != "deng-vehicle":
        return ()
    if name in ("longitude", "latitude"):
        return (
            Reading(
                "the log measures in east and north",
                number(value),
                order_of(value, 2.0),
                lambda runs: spread_with(runs, preset, row, NORTH_UP),
            ),
        )
    if row < 3:
        return (
            Reading(
                "the error of the reference itself, 0.01 deg by table 3, is part of it",
                number(value),
                order_of(value, 2.0),
                lambda runs: referenced(runs, preset, row),
            ),
        )
    return ()
