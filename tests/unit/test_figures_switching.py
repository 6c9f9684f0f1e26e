"""The switching view holds the law's own numbers: measure, thresholds, wish, state and xi."""

import re
from functools import lru_cache
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from navcore.engine.run import Run
from navcore.law.policy import POLICIES
from schuler_bench.plots import style
from schuler_bench.session.display import Display
from schuler_bench.session.shown import Shown
from schuler_bench.views.appearance.document import _numbers
from schuler_bench.views.switching.figure import (
    MARGIN,
    STATE,
    XI,
    switched_methods,
    switching_legend,
    switching_plots,
    thin,
)
from schuler_bench.views.switching.view import SwitchingView
from tests.unit.figures_runs import THREE, run_of, static_run

EVENT = {"t_h": 0.3, "duration_s": 1.0, "accel_mps2": [0.8, 0.0]}
LOG = {"kind": "log", "noise_mps": 0.02, "event": [EVENT]}
NETWORK = {"id": "unity2", "zeta": 0.5}


def method(name: str, policy: dict, network: dict | None = None, damping: str = "external") -> dict:
    return {"name": name, "damping": damping, "network": network or NETWORK, "policy": policy}


@lru_cache(maxsize=1)
def switching_run() -> Run:
    """A step of the log after 18 min: a threshold, two variations and a yaw rate beside constant methods."""
    return run_of(
        reference=LOG,
        method=[
            THREE[0],
            method("limit", {"id": "threshold", "limit_mps": 0.5}),
            method("varied", {"id": "variation"}),
            THREE[1],
            method("alike", {"id": "variation", "a": 0.2}),
            method("yaw", {"id": "yaw_rate", "limit_deg": 3.0}),
        ],
    )


def test_nothing_is_drawn_while_every_method_is_constant() -> None:
    assert switching_plots(static_run()) == ()
    assert switched_methods(static_run()) == ()


def test_a_free_method_switches_nothing_whatever_its_policy() -> None:
    run = run_of(reference=LOG, method=[method("x", {"id": "threshold"}, damping="free")])
    assert switched_methods(run) == ()


def test_one_plot_for_each_measure_then_states_and_xi() -> None:
    plots = switching_plots(switching_run())
    assert [plot.key for plot in plots] == ["measure0", "measure1", "measure2", STATE, XI, MARGIN]
    assert [plot.unit.name for plot in plots[:3]] == ["m/s", "m/s", "°"]
    assert plots[1].names == ("varied", "alike", "a", "b", "c", "a")
    colors = tuple(curve.color for curve in plots[1].curves)
    assert colors[:2] == (style.method_color(2), style.method_color(4))
    # a differs, b and c are those of both
    assert colors[2:] == (style.method_color(2), style.INK, style.INK, style.method_color(4))


def test_measures_and_thresholds_are_in_the_labelled_unit() -> None:
    run = switching_run()
    limit, variation, yaw, *_ = switching_plots(run)
    np.testing.assert_array_equal(limit.data[1], run.methods[1].law_series[:, 3])
    assert set(limit.data[2]) == {0.5}
    assert [float(line[0]) for line in variation.data[3:]] == [0.25, 0.35, 0.45, 0.2]
    assert set(yaw.data[2]) == {3.0}
    assert np.max(limit.data[1]) > 0.5
    np.testing.assert_allclose(np.deg2rad(yaw.data[1]), run.methods[5].law_series[:, 3])


def test_states_stand_in_lanes_the_first_method_on_top() -> None:
    run = switching_run()
    plot = next(plot for plot in switching_plots(run) if plot.key == STATE)
    lanes = zip(plot.data[1:5], plot.data[5:9], switched_methods(run), (4.2, 2.8, 1.4, 0.0), strict=True)
    for actual, wanted, switched, low in lanes:
        drawn = np.column_stack([wanted, actual]) - low
        np.testing.assert_allclose(drawn, switched.run.law_series[:, :2], atol=1e-12)
    # the variation leaves the damping for a while, and comes back
    state = run.methods[2].law_series[:, 1]
    assert state[0] == state[-1] == 1.0
    assert 0.0 in state


def test_margin_is_zero_while_undamped_and_the_networks_own_while_damped() -> None:
    run = switching_run()
    plot = next(plot for plot in switching_plots(run) if plot.key == MARGIN)
    varied = run.methods[2]
    damped = varied.law_series[:, 1] > 0.5
    assert 0 < np.count_nonzero(damped) < len(damped)
    np.testing.assert_array_equal(plot.data[2][~damped], 0.0)
    np.testing.assert_allclose(plot.data[2][damped], varied.loop.damping_ratio, rtol=1e-9)
    assert plot.curves[1].color == style.method_color(2)


def test_margin_of_an_adaptive_law_follows_its_coefficient() -> None:
    """unity2's main pair has exactly the damping ratio zeta that the table gives, up to 0.7."""
    run = run_of(reference=LOG, method=[method("adaptive", {"id": "adaptive"})])
    xi = run.methods[0].law_series[:, 2]
    plot = next(plot for plot in switching_plots(run) if plot.key == MARGIN)
    assert np.ptp(xi) > 0.05
    np.testing.assert_allclose(plot.data[1], xi, rtol=1e-3)


def test_margin_of_a_schedule_passes_from_one_set_of_gains_to_the_other() -> None:
    policy = {
        "id": "schedule",
        "from": [0.0264, 156.063, 0.904],
        "to": [7.68e-3, 6.68, 7.68e-3],
        "duration_s": 1800.0,
    }
    compass = {"id": "compass", "sigma": 0.0088, "xi": 0.7}
    run = run_of(reference=LOG, method=[method("zha", policy, compass)])
    plot = next(plot for plot in switching_plots(run) if plot.key == MARGIN)
    for place, gains in ((1, policy["from"]), (-1, policy["to"])):
        k1, k2, k3 = gains
        roots = np.roots([1.0, k1, run.scenario.omega_s**2 * (1.0 + k2), run.scenario.omega_s**2 * k3])
        least = np.min(-roots.real / np.abs(roots))
        assert plot.data[1][place] == pytest.approx(least, rel=5e-3)


def test_legend_names_thresholds_and_the_wish_and_leaves_the_methods_to_the_strip() -> None:
    run = switching_run()
    names = re.findall("</span>([^<]+)</span>", switching_legend(run))
    assert not {m.method.name for m in run.methods} & set(names)
    limits = {"threshold = 0.5 m/s", "a = 0.25 m/s", "c = 0.45 m/s", "heading limit = 3°"}
    assert limits | {"wanted state"} <= set(names)


def test_every_policy_can_be_drawn() -> None:
    compass = {"id": "compass", "sigma": 0.0088, "xi": 0.7}
    networks = {"adaptive": NETWORK, "schedule": compass, "mobility": compass}
    for id in set(POLICIES) - {"constant"}:
        run = run_of(reference=LOG, method=[method(id, {"id": id}, networks.get(id))])
        plots = switching_plots(run)
        assert [plot.key for plot in plots][-3:] == [STATE, XI, MARGIN], id
        for plot in plots:
            assert len({len(values) for values in plot.data}) == 1
            assert len(plot.series) == len(plot.data)
            assert plot.data[0][-1] == pytest.approx(60.0)


def test_thinning_keeps_every_extreme_in_its_order() -> None:
    time = np.arange(86401.0)
    values = np.zeros((86401, 2))
    values[40_000, 0], values[70_001, 1] = 5.0, -3.0
    thin_time, thinned = thin(time, values)
    assert len(thin_time) <= 2002
    assert thinned[:, 0].max() == 5.0 and thinned[:, 1].min() == -3.0
    assert np.all(np.diff(thin_time) > 0.0)
    assert (thin_time[0], thin_time[-1]) == (0.0, 86400.0)
    rising = thin(time, np.arange(86401.0)[:, None])[1][:, 0]
    assert np.all(np.diff(rising) > 0.0)
    short = np.arange(10.0)
    assert thin(short, values[:10])[0] is short


def test_where_nothing_switches_no_other_plot_is_saved_under_that_title() -> None:
    view = SwitchingView(cast(Any, SimpleNamespace(session=None)))
    with pytest.raises(LookupError, match="No method of this scenario switches"):
        view.figures(Shown(static_run(), 1, Display()), "Switching")
    now = Shown(switching_run(), 1, Display())
    saved = _numbers(view.figures(now, "Switching"), now, "Switching")
    assert b"damped" in saved.lower() and b"\xcf\x86E" not in saved
