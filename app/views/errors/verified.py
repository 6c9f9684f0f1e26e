"""The two models of a verification over time: both on one noise, and beside them what is between them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from app.plots import style
from app.plots.uplot import Curve, UplotFigure
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
    display = display or Display()
    both = error_plots(verification.linear, Overlay(verification.strapdown, old), display=display)
    plots: dict[str, UplotFigure] = {}
    for key in KEYS:
        plots[f"both_{key}"] = replace(both[key], key=f"both_{key}")
        plots[f"difference_{key}"] = _difference(verification, key, both[key], display)
    return plots


def _difference(verification: Verification, key: str, beside: UplotFigure, display: Display) -> UplotFigure:
    time_s, column = verification.linear.t_s, NAMES.index(beside.quantity)
    differences = np.full((len(verification.linear.methods), len(time_s)), np.nan)
    pairs = zip(verification.strapdown.methods, verification.linear.methods, strict=True)
    for values, (full, simple) in zip(differences, pairs, strict=True):
        rows = min(len(full.t_s), len(simple.t_s), len(time_s))
        values[:rows] = full.rows[:rows, column] - simple.rows[:rows, column]
    unit = quantity_unit(key, float(np.nanmax(np.abs(differences), initial=0.0)), display)
    names = [method.method.name for method in verification.strapdown.methods]
    return UplotFigure(
        key=f"difference_{key}",
        quantity=f"{beside.quantity} difference",
        title=f"{beside.title}: strapdown minus linear model",
        symbol=f"Δ {beside.symbol.strip('|')}",
        unit=unit,
        time_unit=beside.time_unit,
        time=np.ascontiguousarray(time_s / beside.time_unit.si),
        curves=tuple(
            Curve(name, style.method_color(i), values / unit.si, state=display.state_of(name))
            for i, (name, values) in enumerate(zip(names, differences, strict=True))
        ),
    )
