"""The two models of a verification over time: both on one noise, and beside them what is between them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.plots import style
from app.plots.uplot import UplotFigure
from app.session.display import Display
from app.views.errors.figure import Overlay, error_plots, quantity_unit
from navcore.engine.verification import Verification
from navcore.mechanization.recorder import NAMES

KEYS = ("phi_e", "dve", "position")
"""Quantities that are drawn, top to bottom."""


def verification_plots(
    verification: Verification, *, old: bool = False, display: Display | None = None
) -> dict[str, UplotFigure]:
    """Plots of both models and of their difference, in pairs: left, right.

    Parameters
    ----------
    verification : Verification
        Result.
    old : bool
        It is of an earlier scenario: drawn faintly.
    display : Display, optional
        Units and scale.

    Returns
    -------
    dict
        Key -> plot. A difference is strapdown minus linear model at the common output rows, as
        `Verification.differences` measures it.
    """
    shown = display or Display()
    overlay = Overlay(verification.strapdown, old)
    both = error_plots(verification.linear, overlay, display=shown)
    plots: dict[str, UplotFigure] = {}
    for key in KEYS:
        plots[f"both_{key}"] = replace(both[key], key=f"both_{key}")
        plots[f"difference_{key}"] = _difference(verification, key, both[key], shown)
    return plots


def _difference(verification: Verification, key: str, beside: UplotFigure, display: Display) -> UplotFigure:
    pairs = list(zip(verification.strapdown.methods, verification.linear.methods, strict=True))
    time_s, column = verification.linear.t_s, NAMES.index(beside.quantity)
    curves = []
    for full, simple in pairs:
        rows = min(len(full.t_s), len(simple.t_s), len(time_s))
        values = np.full(len(time_s), np.nan)
        values[:rows] = full.rows[:rows, column] - simple.rows[:rows, column]
        curves.append(values)
    peak = max((float(np.nanmax(np.abs(values), initial=0.0)) for values in curves), default=0.0)
    unit = quantity_unit(key, peak, display)
    return UplotFigure(
        key=f"difference_{key}",
        quantity=f"{beside.quantity} difference",
        title=f"{beside.title}: strapdown minus linear model",
        symbol=f"Δ {beside.symbol.strip('|')}",
        unit=unit,
        time_unit=beside.time_unit,
        names=tuple(method.method.name for method, _ in pairs),
        colors=tuple(style.method_color(i) for i in range(len(pairs))),
        states=tuple(display.state_of(method.method.name) for method, _ in pairs),
        data=(np.ascontiguousarray(time_s / beside.time_unit.si), *(values / unit.si for values in curves)),
    )
