"""A verification is drawn apart from the run, and its difference is the one that the table tells."""

from __future__ import annotations

import numpy as np
import pytest

from app.jobs.verifier import Verified
from app.session.display import Display
from app.session.shown import Shown
from app.views.errors.verified import KEYS, verification_plots
from app.views.errors.view import error_curves
from navcore.engine.simulation import simulate
from navcore.engine.verification import Verification, verify
from navcore.scenario.file import load


@pytest.fixture(scope="module")
def verified() -> Verification:
    return verify(load("sikuliaq-like", ["run.duration_h=0.3"]))


def test_the_curves_of_the_run_stay_what_they_were(verified: Verification) -> None:
    made = simulate(load("sikuliaq-like", ["run.duration_h=0.3"]))
    before = error_curves(Shown(made, 1, Display()))
    after = error_curves(Shown(made, 1, Display(), verified=Verified(verified, old=False)))
    assert after.names == before.names
    for key, plot in before.plots.items():
        for old, new in zip(plot.data, after.plots[key].data, strict=True):
            np.testing.assert_array_equal(new, old)
        peak = max(method.errors[plot.quantity]["max_abs"] for method in made.methods)
        assert max(np.nanmax(np.abs(c)) for c in plot.data[1:]) * plot.unit.si == pytest.approx(peak)


def test_the_difference_that_is_drawn_is_the_one_in_the_table(verified: Verification) -> None:
    plots = verification_plots(verified)
    assert list(plots) == [f"{which}_{key}" for key in KEYS for which in ("both", "difference")]
    for key in KEYS:
        difference, both = plots[f"difference_{key}"], plots[f"both_{key}"]
        assert len(both.names) == 2 * len(difference.names)
        assert [bool(curve.dash) for curve in both.curves] == [False] * 3 + [True] * 3
        for place, told in enumerate(verified.differences):
            drawn = np.nanmax(np.abs(difference.data[1 + place])) * difference.unit.si
            assert drawn == pytest.approx(told[both.quantity].peak)
            assert drawn > 0.0
