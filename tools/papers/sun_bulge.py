"""Sun 2017, section 5.1: the "bulge" of external damping when the error of the log changes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from navcore.foundation.earth import SEMI_MAJOR_AXIS
from navcore.foundation.units import ARCMIN, HOUR
from navcore.mechanization.recorder import DV_E, DV_N, POSITION
from tools.papers.claim import Claim, Exhibit, Table, at_least
from tools.papers.measure import attitude_error, hours, mean_and_interval
from tools.papers.picture import curve, panel
from tools.papers.runs import Runs, method

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from navcore.engine.run import Run

PRESET = "sun-bulge"
SEEDS = range(1, 21)
STEADY = "reference.event=[]"
DAMPED, FREE = "external, horizontal", "undamped"
CHANGE_S = 10.0 * HOUR
QUANTITIES = ("attitude, arcmin", "velocity, m/s", "position, m")
CHANGE_MPS = 1.0
LARGE = 0.25
"""A fluctuation that is called large, in the natural size of the Schuler loop."""


def _errors(run: Run, name: str) -> np.ndarray:
    """Roll (arcmin), velocity (m/s) and position (m) error after the change, shape (m, 3)."""
    found = method(run, name)
    after = found.t_s >= CHANGE_S
    velocity = np.hypot(found.rows[:, DV_E], found.rows[:, DV_N])
    errors = np.column_stack([attitude_error(run, found)[:, 1] / ARCMIN, velocity, found.rows[:, POSITION]])
    return errors[after]


def bulge(runs: Runs, name: str) -> np.ndarray:
    """Largest effect of the change, and the spread of the error without it, shape (seeds, 2, 3)."""

    def one(seed: int) -> np.ndarray:
        given = f"run.seed={seed}"
        changed, steady = _errors(runs(PRESET, given), name), _errors(runs(PRESET, given, STEADY), name)
        return np.array([np.max(np.abs(changed - steady), axis=0), np.std(steady, axis=0)])

    return runs.keep(("sun bulge", name), lambda: np.array([one(seed) for seed in SEEDS]))


def over_natural(runs: Runs, quantity: int) -> np.ndarray:
    """Largest effect of the change over the natural size of the Schuler loop, with each of the seeds.

    That is dV/(R omega_s) of the attitude, dV of the velocity, dV/omega_s of the position.
    """
    omega_s = runs(PRESET).scenario.omega_s
    natural = (CHANGE_MPS / (SEMI_MAJOR_AXIS * omega_s) / ARCMIN, CHANGE_MPS, CHANGE_MPS / omega_s)
    return bulge(runs, DAMPED)[:, 0, quantity] / natural[quantity]


def _table(runs: Runs) -> Table:
    rows = tuple(
        (name, *(mean_and_interval(bulge(runs, name)[:, part, k]) for k in range(3) for part in (0, 1)))
        for name in (FREE, DAMPED)
    )
    head = [
        f"{text}: {what}" for text in QUANTITIES for what in ("effect of the change", "spread without it")
    ]
    return Table(f"From 10 h on, mean over {len(SEEDS)} seeds +- 95 %:", ("method", *head), rows)


def _draw(runs: Runs, figure: Figure) -> None:
    axes = figure.subplots(1, 3)
    run = runs(PRESET)
    for i, name in enumerate((FREE, DAMPED)):
        found = method(run, name)
        t = hours(found)
        curve(axes[0], t, attitude_error(run, found)[:, 1] / ARCMIN, name, i)
        curve(axes[1], t, found.rows[:, DV_E], name, i)
        curve(axes[2], t, found.rows[:, POSITION], name, i)
    for axis, title, unit in zip(
        axes, ("Roll", "East velocity", "Position"), ("arcmin", "m/s", "m"), strict=True
    ):
        panel(axis, title, "time, h", unit, legend=title == "Roll")


BULGE = Exhibit(
    name="sun-bulge",
    title="Section 5.1: the bulge of external damping",
    presets=(PRESET,),
    setting="The log's error changes by 1 m/s at 10 h and back at 12 h; the paper prints no change and no "
    "number. A "
    f"fluctuation of {LARGE:g} of the natural size of the Schuler loop (dV of 1 m/s, dV/(R omega_s), "
    f"dV/omega_s) counts as large.",
    claims=tuple(
        Claim(
            f"when the log's error changes, external damping has a large fluctuation: "
            f"{text.split(',')[0]}, largest "
            "effect over the natural size",
            "large",
            at_least(LARGE),
            lambda runs, quantity=quantity: over_natural(runs, quantity),
            quote="when the external velocity error has larger changes in the single working mode of the "
            "external horizontal damping, the attitude error, velocity error and position error have large "
            'fluctuations, resulting in the so-called "bulge" phenomenon',
        )
        for quantity, text in enumerate(QUANTITIES)
    ),
    tables=(_table,),
    draw=_draw,
)
