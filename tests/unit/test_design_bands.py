"""Bands by covariance: those of the budget, the Kalman filter's own, none where the law looks at the data."""

import numpy as np
import pytest

from navcore.design.bands import Bands, covariance_bands
from navcore.design.budget import budget
from navcore.engine.results import timeseries
from navcore.engine.simulation import simulate
from navcore.mechanization.recorder import NAMES, PHI_E, POSITION
from navcore.scenario.model import Scenario
from schuler_bench.jobs.envelopes import Envelopes
from schuler_bench.plots.envelope import covariance_envelope
from schuler_bench.views.errors.figure import error_plots
from schuler_bench.views.errors.view import legend_html
from tools.filter_consistency import SHIP, final_error

_SHORT = SHIP["run"] | {"duration_h": 1.0}
_METHODS = [
    {"name": "free", "damping": "free"},
    {"name": "classic2", "damping": "external", "network": {"id": "classic2"}},
    {"name": "turns", "damping": "external", "network": {"id": "classic2"}, "policy": {"id": "yaw_rate"}},
    {"name": "filter", "damping": "kalman"},
]


@pytest.fixture(scope="module")
def ship() -> Scenario:
    return Scenario.parse(SHIP | {"run": _SHORT, "method": _METHODS})


@pytest.fixture(scope="module")
def found(ship: Scenario) -> Bands:
    bands = covariance_bands(ship)
    assert bands is not None
    return bands


def test_a_band_is_the_square_root_of_the_budgets_variance(ship: Scenario, found: Bands) -> None:
    known = budget(ship.model_copy(update={"method": ship.method[:2]}))
    for band, method in zip(found.methods[:2], known.methods, strict=True):
        assert method.series is not None and band.kind == "covariance" and band.sigma is not None
        np.testing.assert_allclose(band.sigma, np.sqrt(method.series.total), rtol=1e-12)
    assert found.methods[2].sigma is None and "looks at the data" in found.methods[2].reason


def test_the_filters_band_is_what_the_running_filter_says_of_itself(found: Bands) -> None:
    _, P = final_error(Scenario.parse(SHIP | {"run": _SHORT}))
    own = np.sqrt(np.diag(P))[[4, 5, 6, 0, 1]]
    assert found.methods[3].kind == "filter" and found.methods[3].sigma is not None
    np.testing.assert_allclose(found.methods[3].sigma[-1, :5], own, rtol=0.02)


def test_the_run_gives_what_the_filter_says_of_itself_at_every_output_row(
    ship: Scenario, found: Bands
) -> None:
    """Equal to the band between two samples of the log, to the covariance itself at the end."""
    run = simulate(ship)
    assert [method.sigma is None for method in run.methods] == [True, True, True, False]
    filtered, band = run.methods[3], found.methods[3].sigma
    assert filtered.sigma is not None and band is not None
    assert filtered.sigma.shape == (len(filtered.t_s), 7)
    later = filtered.t_s > 300.0
    for column in range(7):
        expected = np.interp(filtered.t_s[later], found.t_s, band[:, column])
        np.testing.assert_allclose(filtered.sigma[later, column], expected, rtol=0.05)
    _, P = final_error(Scenario.parse(SHIP | {"run": _SHORT}))
    np.testing.assert_allclose(filtered.sigma[-1, :5], np.sqrt(np.diag(P))[[4, 5, 6, 0, 1]], rtol=1e-12)


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_the_time_series_holds_it_and_nothing_for_the_other_methods(fidelity: str) -> None:
    run_block = _SHORT | {"duration_h": 0.25, "fidelity": fidelity, "rate_hz": 10.0}
    run = simulate(Scenario.parse(SHIP | {"run": run_block, "method": _METHODS}))
    table = timeseries(run)
    filtered = run.methods[3].sigma
    assert filtered is not None and np.all(filtered > 0.0)
    rows = np.array(table["method"].to_pylist()) == "filter"
    for index, name in enumerate(NAMES[:POSITION]):
        column = np.array(table[f"sigma_{name}"].to_pylist(), dtype=float)
        np.testing.assert_array_equal(column[rows], filtered[:, index])
        assert np.all(np.isnan(column[~rows]))
    alone = simulate(Scenario.parse(SHIP | {"run": run_block, "method": _METHODS[:1]}))
    assert not any(name.startswith("sigma") for name in timeseries(alone).column_names)


def test_both_fidelities_give_the_filter_the_same_deviations() -> None:
    found = [
        simulate(Scenario.parse(SHIP | {"run": _SHORT | {"fidelity": f, "rate_hz": 10.0}})).methods[0]
        for f in ("error_model", "strapdown")
    ]
    linear, full = (method.sigma for method in found)
    assert linear is not None and full is not None
    # not at the start and the end, where the one is taken before and the other after a sample of the log
    np.testing.assert_allclose(full[1:-1], linear[1:-1], rtol=0.03)


def test_what_is_cancelled_gives_no_bands(ship: Scenario) -> None:
    assert covariance_bands(ship, cancelled=lambda: True) is None


def test_the_legend_says_what_the_band_is_and_which_method_has_none(ship: Scenario, found: Bands) -> None:
    made, run = covariance_envelope(ship, found), simulate(ship)
    plots = error_plots(run, envelope=made)
    assert [len(plot.bands) for plot in plots.values()] == [3] * len(plots)
    upper, lower, _ = plots["phi_e"].bands[1]
    np.testing.assert_array_equal(plots["phi_e"].data[1 + upper], -plots["phi_e"].data[1 + lower])
    assert made.high[1] is not None and made.low[1] is not None and found.methods[1].sigma is not None
    np.testing.assert_array_equal(made.high[1][:, PHI_E], found.methods[1].sigma[:, 0])
    assert np.all(made.low[1][:, POSITION] == 0.0) and np.all(made.high[1][:, POSITION] >= 0.0)
    html = legend_html(run, envelope=made)
    assert "±1σ by covariance; no covariance: turns" in html
    assert "turns: no band, policy &quot;yaw_rate&quot; looks at the data" in html
    assert "Kalman filter computes for itself" in html


def test_the_job_makes_them_in_the_background(ship: Scenario) -> None:
    told: list[str] = []
    jobs = Envelopes(
        lambda *_: pytest.fail("runs nothing"),
        lambda: told.append("further"),
        lambda: told.append("ended"),
        0.0,
    )
    try:
        jobs.follow(ship, "covariance")
        assert jobs.wait_idle(60.0) and told[-1] == "ended" and told.count("further") == len(_METHODS)
        band = jobs.beside(ship, "covariance")
        assert band is not None and not band.old and jobs.fraction is None
    finally:
        jobs.stop()
