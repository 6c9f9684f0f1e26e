"""Errors over a part of the run: the numbers of its rows, one window for all methods, and what cannot be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from pydantic import ValidationError

from app.session.display import Display
from app.session.requirements import Requirements, verdicts
from app.session.window import window_of
from navcore.mechanization.recorder import NAMES
from tests.unit.figures_runs import THREE, diverging, run_of, static_run


def test_the_whole_run_keeps_the_statistics_of_every_step() -> None:
    window = window_of(static_run(), Display())
    assert window.run is static_run() and not window.told


def test_after_settling_leaves_the_transient_of_the_slowest_method_out() -> None:
    run = static_run()
    slowest = max(method.loop.settling_s or 0.0 for method in run.methods)
    assert 0.0 < slowest < 6.0 * 3600.0
    window = window_of(run, Display(window="settled"))
    assert window.from_s == slowest and f"{slowest / 3600.0:.3g} h" in window.told
    for method, whole in zip(window.run.methods, run.methods, strict=True):
        rows = whole.rows[whole.t_s >= slowest]
        for i, name in enumerate(NAMES):
            assert method.errors[name]["rms"] == pytest.approx(np.sqrt(np.mean(rows[:, i] ** 2)))
            assert method.errors[name]["final"] == pytest.approx(whole.errors[name]["final"])
            assert method.errors[name]["max_abs"] >= np.abs(rows[:, i]).max()
            assert method.errors[name]["max_abs"] <= whole.errors[name]["max_abs"] * (1.0 + 1e-12)
    # the transient was the larger part of it
    damped = 1
    assert (
        window.run.methods[damped].errors["phi_e_rad"]["rms"] < run.methods[damped].errors["phi_e_rad"]["rms"]
    )


def test_chosen_hours_that_span_the_run_give_its_numbers() -> None:
    run = static_run()
    window = window_of(run, Display(window="hours", window_from_h=0.0, window_to_h=99.0))
    for method, whole in zip(window.run.methods, run.methods, strict=True):
        for name in ("dve_mps", "position_m"):
            assert method.errors[name]["rms"] == pytest.approx(whole.errors[name]["rms"], rel=0.02)
            assert method.errors[name]["max_abs"] == pytest.approx(whole.errors[name]["max_abs"])


@pytest.mark.parametrize(
    "display",
    [
        Display(window="hours", window_from_h=7.0),
        Display(window="hours", window_from_h=3.0, window_to_h=2.0),
    ],
)
def test_a_window_without_rows_measures_the_whole_run_and_says_so(display: Display) -> None:
    window = window_of(static_run(), display)
    assert window.run is static_run() and not window.possible and "whole run" in window.told


def test_without_a_method_that_settles_there_is_nothing_after_it() -> None:
    window = window_of(run_of(method=[THREE[0]]), Display(window="settled"))
    assert not window.possible and "No method settles" in window.told


def test_a_method_that_ended_before_the_window_has_no_numbers() -> None:
    run = diverging(static_run(), 0, 50)
    window = window_of(run, Display(window="hours", window_from_h=5.0))
    assert math.isnan(window.run.methods[0].errors["dve_mps"]["rms"])
    assert math.isfinite(window.run.methods[1].errors["dve_mps"]["rms"])


def test_a_baseline_is_measured_over_the_same_window() -> None:
    run = static_run()
    window = window_of(run, Display(window="settled"))
    assert window.of(run).methods[0].errors == window.run.methods[0].errors


def test_velocity_requirement_is_of_both_components_over_the_window() -> None:
    for display in (Display(), Display(window="settled")):
        run = window_of(static_run(), display).run
        wanted = [math.hypot(m.errors["dve_mps"]["rms"], m.errors["dvn_mps"]["rms"]) for m in run.methods]
        (found,) = [v for v in verdicts(run, Requirements(velocity_rms_mps=wanted[1]))
                    if v.name == "velocity_rms_mps"]  # fmt: skip
        assert found.measured == pytest.approx(wanted)
        assert found.passed[1] and found.passed[0] == (wanted[0] <= wanted[1])


def test_hours_are_checked() -> None:
    with pytest.raises(ValidationError):
        Display(window="hours", window_from_h=-1.0)
