"""The part of a run that its errors are measured over: all of it, after the settling, or some hours."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from app.session.display import Display
from app.session.requirements import loop_of
from navcore.engine.run import MethodRun, Run
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.mechanization.recorder import NAMES

_FEWEST_ROWS = 2


@dataclass(frozen=True)
class Window:
    """What the errors of a run are measured over.

    Attributes
    ----------
    run : Run
        The run, its `MethodRun.errors` measured over the window.
    from_s, to_s : float or None
        Ends of the window, s; None: the whole run.
    told : str
        The window in words; empty while the whole run is asked for.
    possible : bool
        False where the window that was asked for holds nothing, so that the whole run is measured.
    """

    run: Run
    from_s: float | None = None
    to_s: float | None = None
    told: str = ""
    possible: bool = True

    def of(self, other: Run) -> Run:
        """Measure another run over the same window."""
        if self.from_s is None or self.to_s is None:
            return other
        return _measured(other, self.from_s, self.to_s)


def window_of(run: Run, display: Display) -> Window:
    """Measure a run over what the display asks for.

    "After settling" begins where the slowest of the damped, stable methods has come down to 2 % of an initial
    tilt: one window for all methods, so that their numbers can be compared.
    """
    if display.window == "whole" or not len(run.t_s):
        return Window(run)
    begins, end = 0.0, float(run.t_s[-1])
    why = ""
    if display.window == "settled":
        settling = [s for method in run.methods if (s := loop_of(method).settling_s) is not None]
        if not settling:
            return Window(run, told="No method settles: the errors are of the whole run.", possible=False)
        begins, why = max(settling), " (the slowest damped method has settled)"
    else:
        begins = display.window_from_h * HOUR
        end = end if display.window_to_h is None else min(end, display.window_to_h * HOUR)
    rows = int(np.count_nonzero((run.t_s >= begins) & (run.t_s <= end)))
    if rows < _FEWEST_ROWS:
        told = Text(
            "The run of {t_s:.3g} h has nothing between {begins:.3g} h{why} and "
            "{end:.3g} h: the errors are of the whole run.",
            t_s=run.t_s[-1] / HOUR,
            begins=begins / HOUR,
            why=why,
            end=end / HOUR,
        )
        return Window(run, told=told, possible=False)
    told = Text(
        "Errors from {begins:.3g} h{why} to {end:.3g} h, on {rows} output rows.",
        begins=begins / HOUR,
        why=why,
        end=end / HOUR,
        rows=rows,
    )
    return Window(_measured(run, begins, end), begins, end, told)


def _measured(run: Run, from_s: float, to_s: float) -> Run:
    return replace(run, methods=tuple(_method(method, from_s, to_s) for method in run.methods))


def _method(method: MethodRun, from_s: float, to_s: float) -> MethodRun:
    """Statistics on the output rows; the largest magnitude on the curves too, which keep every extreme."""
    rows = method.rows[(method.t_s >= from_s) & (method.t_s <= to_s), : len(NAMES)]
    drawn = method.plot.values[(method.plot.t_s >= from_s) & (method.plot.t_s <= to_s)]
    if not len(rows):
        empty = dict.fromkeys(("mean", "std", "rms", "max_abs", "final"), float("nan"))
        return replace(method, errors=dict.fromkeys(NAMES, empty))
    largest = np.abs(np.concatenate([rows, drawn])).max(axis=0)
    return replace(
        method,
        errors={
            name: {
                "mean": float(rows[:, i].mean()),
                "std": float(rows[:, i].std()),
                "rms": float(np.sqrt(np.mean(rows[:, i] ** 2))),
                "max_abs": float(largest[i]),
                "final": float(rows[-1, i]),
            }
            for i, name in enumerate(NAMES)
        },
    )
