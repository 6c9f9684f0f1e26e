"""Tuning and Pareto fronts: the known optima from any start, requirements, ends of ranges, bad input."""

import json
from typing import Any

import numpy as np
import pytest

from navcore.design.budget import budget
from navcore.design.measures import (
    TUNING_INTERVALS,
    Setting,
    Ship,
    measure,
    read_objective,
    read_requirement,
)
from navcore.design.pareto import measured, pareto
from navcore.design.tune import tune
from navcore.design.vary import read_varied, tunable_fields
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC
from navcore.questions.tune import TuneQuestion
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.cli import main
from schuler_bench.editing import form
from schuler_bench.views.method.view import set_by_policy
from schuler_bench.views.tune.setting import left_out_html
from tests.acceptance.test_design_values import SET_A, set_a
from tools.tuning import CASES, Case, best_of_grid

SIGMA, XI = "method.0.network.sigma", "method.0.network.xi"
NIGHTLY = pytest.mark.nightly
COMPASS = [f"{SIGMA}=1e-4:0.1", f"{XI}=0.1:5"]


@pytest.mark.parametrize(
    "start",
    [(0.0088, 0.7), pytest.param((0.09, 4.9), marks=NIGHTLY), pytest.param((2e-4, 0.15), marks=NIGHTLY)],
)
def test_the_known_optimum_of_compass_from_any_start(start: tuple[float, float]) -> None:
    """theory.md 20: 4.850 arcsec at 0.002945, 2.790; the range of 5 % holds its value at both ends."""
    scenario = set_a({"id": "compass", "sigma": start[0], "xi": start[1]})
    found = tune(scenario, "tilt_rms", COMPASS)
    assert found.objective / ARCSEC == pytest.approx(4.850, rel=1e-3)
    assert found.best[SIGMA] == pytest.approx(0.002945, rel=5e-3)
    assert found.best[XI] == pytest.approx(2.790, rel=5e-3)
    assert found.floor is not None and found.floor / ARCSEC == pytest.approx(4.699, rel=5e-3)
    assert found.at_end_of_range == () and found.active == ()
    before = budget(scenario, steady=True).methods[0].total.rms.tilt_rad
    assert found.before == pytest.approx(before)
    low, high = found.flat[SIGMA]
    assert low < found.best[SIGMA] < high
    edge = budget(set_a({"id": "compass", "sigma": high, "xi": found.best[XI]}), steady=True)
    assert edge.methods[0].total.rms.tilt_rad == pytest.approx(1.05 * found.objective, rel=5e-3)
    assert found.scenario.method[0].network.model_dump()["sigma"] == found.best[SIGMA]


def test_it_is_the_best_of_a_fine_grid() -> None:
    """Within 0.1 % of 40 x 40 points, with a requirement."""
    scenario = set_a({"id": "complementary"})
    vary = ["method.0.network.zeta=0.1:2", "method.0.network.eta=0.1:2"]
    found = tune(scenario, "velocity_rms", vary, ["tilt_rms<=8arcsec"])
    best = np.inf
    grid = np.geomspace(0.1, 2.0, 40)
    networks = [{"id": "complementary", "zeta": z, "eta": e} for z in grid for e in grid]
    for k in range(0, len(networks), 10):
        for method in budget(set_a(*networks[k : k + 10]), steady=True).methods:
            rms = method.total.rms
            if rms.tilt_rad is not None and rms.tilt_rad <= 8.0 * ARCSEC:
                best = min(best, rms.velocity_mps or np.inf)
    assert found.objective <= best * 1.001


@pytest.mark.parametrize(
    ("network", "vary", "arcsec", "at_end"),
    [
        ({"id": "complementary"}, ("zeta=0.05:2", "eta=0.05:2"), 6.016, ("zeta", "eta")),
        pytest.param(
            {"id": "unity2"}, ("zeta=0.05:2", "r=1.02:3", "zeta2=0.3:2"), 4.882, ("zeta2",), marks=NIGHTLY
        ),
    ],
)
def test_an_optimum_at_the_end_of_a_range_is_told(
    network: dict[str, Any], vary: tuple[str, ...], arcsec: float, at_end: tuple[str, ...]
) -> None:
    """theory.md 20: the true optimum lies outside."""
    found = tune(set_a(network), "tilt_rms", [f"method.0.network.{text}" for text in vary])
    assert found.objective / ARCSEC == pytest.approx(arcsec, rel=1e-3)
    assert found.at_end_of_range == tuple(f"method.0.network.{name}" for name in at_end)


@pytest.mark.slow
def test_a_24_h_mode_that_grows_is_told_with_the_proposal() -> None:
    """The tilt of one channel does not see it; a requirement takes it, and the sentence, away."""
    ship, vary = set_a({"id": "optimal"}), ["method.0.network.q=0:5"]
    found = tune(ship, "tilt_rms", vary)
    (told,) = found.warnings
    assert "the 24 h mode grows, e-folding time" in told
    assert found.document()["warnings"] == [told]
    assert tune(ship, "tilt_rms", vary, ["earth_mode_growth_per_s<=0"]).warnings == ()


def test_a_recorded_log_is_told_to_count_with_its_fitted_error() -> None:
    """In the steady budget, whose floor rests on it, and with a proposal."""
    recorded = load("sikuliaq-recorded")
    index = next(k for k, method in enumerate(recorded.method) if method.network.id == "complementary")
    told = "reference.file: the recorded log counts with its fitted error"
    assert any(told in text for text in budget(recorded, steady=True).methods[index].warnings)
    found = tune(recorded, "settling_s", [f"method.{index}.network.zeta"])
    assert any(told in text for text in found.warnings)
    assert found.scenario.reference == recorded.reference


@pytest.mark.slow
def test_an_active_requirement_is_named_with_its_cost() -> None:
    """Less velocity error costs tilt; without the requirement the tilt is that of the free optimum."""
    found = tune(set_a({"id": "compass"}), "tilt_rms", COMPASS, ["log_tilt<=20arcsec", "settling_s<=48h"])
    assert found.active == ("log_tilt<=20arcsec",)
    assert found.objective / ARCSEC > 4.9
    assert found.cost["log_tilt<=20arcsec"] / ARCSEC == pytest.approx(4.850, rel=2e-3)


@pytest.mark.slow
def test_requirements_that_nothing_meets_say_what_each_costs() -> None:
    """Both are named, with what is in reach alone and the objective without each."""
    with pytest.raises(InputError) as caught:
        tune(set_a({"id": "compass"}), "tilt_rms", COMPASS, ["settling_s<=300", "log_tilt<=10arcsec"])
    lines = str(caught.value).splitlines()
    assert len(lines) == 2
    assert "settling_s<=300" in lines[0] and "nothing within these ranges meets all" in lines[0]
    assert "without it tilt_rms comes to" in lines[0]


@pytest.mark.slow
def test_a_weighted_sum_lies_between_its_parts() -> None:
    """Neither the best tilt nor the best velocity."""
    scenario = set_a({"id": "compass"})
    tilt = tune(scenario, "tilt_rms", COMPASS).best[SIGMA]
    both = tune(scenario, "tilt_rms + 20*velocity_rms", COMPASS)
    assert both.floor is None
    velocity = tune(scenario, "velocity_rms", COMPASS).best[SIGMA]
    assert sorted((tilt, velocity))[0] <= both.best[SIGMA] <= sorted((tilt, velocity))[1]


@pytest.mark.slow
def test_the_worst_of_two_scenarios_counts() -> None:
    """A noisier log asks for a slower loop: the compromise is the slower one's optimum or in between."""
    quiet = set_a({"id": "compass"})
    noisy = Scenario.parse(
        {
            **SET_A,
            "reference": {**SET_A["reference"], "drift_mps": 0.5},
            "method": [{"damping": "external", "network": {"id": "compass"}}],
        }
    )
    both = tune(quiet, "tilt_rms", COMPASS, worst_of=[noisy])
    alone = tune(noisy, "tilt_rms", COMPASS)
    assert both.objective == pytest.approx(alone.objective, rel=2e-3)


def test_over_the_run_with_progress_and_cancel() -> None:
    """Initial errors and biases count; a search that is stopped gives the best so far."""
    scenario = load("sikuliaq-like", ["run.duration_h=3"])
    told: list[float] = []
    found = tune(scenario, "position_rms", ["method.2.network.zeta=0.1:3"], along=True, progress=told.append)
    assert found.before is not None and found.objective <= found.before * (1.0 + 1e-9)
    assert found.floor is not None and found.objective > found.floor
    assert told and max(told) <= 1.0
    calls = iter(range(1000))
    stopped = tune(
        scenario, "position_rms", ["method.2.network.zeta=0.1:3"], cancelled=lambda: next(calls) > 4
    )
    assert stopped.stopped


@pytest.mark.parametrize(
    ("vary", "told"),
    [
        ("run.seed", "must not vary"),
        ("imu.gyro_arw_dpsh", "must not vary"),
        ("method.0.network.realisation", "must not vary: it is not a number"),
        ("method.0.network.speed", "is no field of this method"),
        ("method.7.network.sigma", "there is no method.7"),
        ("method.0.network.sigma=0.1:2", "must lie within"),
        ("method.0.network.sigma=0.1:0.01", "must be below"),
        ("method.0.network.sigma=fast", "must end in LOW:HIGH"),
    ],
)
def test_a_field_that_must_not_vary_is_named(vary: str, told: str) -> None:
    """One fault with the field."""
    with pytest.raises(InputError, match=told) as caught:
        read_varied(set_a({"id": "compass"}), [vary])
    assert vary.split("=")[0] in str(caught.value)


@pytest.mark.parametrize(
    ("preset", "method", "fields", "acting"),
    [
        ("sun-ship", 3, ("network.zeta",), ("r", "zeta2", "alpha")),
        ("zha-drive", 2, ("network.k2", "network.sigma"), ("realisation",)),
        ("own network", 3, ("policy.network.zeta", "network.zeta", "network.r"), ()),
    ],
)
def test_a_parameter_that_the_policy_sets_is_refused_with_that_reason(
    preset: str, method: int, fields: tuple[str, ...], acting: tuple[str, ...]
) -> None:
    """On the command line, in the page's offer and its sliders; no front replaces such a network."""
    own = 'method.3.policy={id="adaptive", network={id="unity2", zeta=0.5}}'
    scenario = load("sun-ship", [own]) if preset == "own network" else load(preset)
    policy = scenario.method[method].policy.id
    for field in fields:
        with pytest.raises(
            InputError, match=f'must not vary: policy "{policy}" sets .+ while it runs'
        ) as caught:
            read_varied(scenario, [f"method.{method}.{field}=0.1:1"])
        assert f"method.{method}.{field}" in str(caught.value)
    assert tunable_fields(scenario, method) == ((f"method.{method}.network.r",) if "r" in acting else ())
    with pytest.raises(InputError, match=f'has no fronts: policy "{policy}" sets'):
        pareto(scenario, method=method)
    assert measured(scenario, ("tilt_rms", "velocity_rms"), method) is None
    assert f"Not to be varied: policy &quot;{policy}&quot; sets" in left_out_html(scenario.method[method])
    assert left_out_html(scenario.method[1]) == ""
    for spec in form.fields(type(scenario.method[method].network), ("method", method, "network")):
        reason = set_by_policy(spec, scenario.method[method])
        assert reason.startswith("policy") is (spec.path[-1] not in acting)


def test_what_is_tuned_is_what_runs() -> None:
    """The adaptive policy sets zeta: its value changes no run; the loop that is judged is the run's own."""
    short = ["run.duration_h=2"]
    first, second = (
        simulate(load("sun-ship", [*short, f"method.3.network.zeta={zeta}"])).methods[3]
        for zeta in (0.5, 5.0)
    )
    assert np.array_equal(first.rows, second.rows)
    found = tune(load("sun-ship", short), "settling_s", ["method.3.network.r=1.1:2"])
    assert found.judged == "ensemble"
    assert found.before is not None and found.before == first.loop.settling_s
    assert found.objective == simulate(found.scenario).methods[3].loop.settling_s
    assert found.objective < 0.9 * found.before


def test_a_free_method_and_silent_sensors_cannot_be_tuned() -> None:
    """Said in plain words."""
    with pytest.raises(InputError, match=r'damping = "free" uses no network'):
        free = {**SET_A, "method": [{"network": {"id": "compass"}}]}
        tune(Scenario.parse(free), "tilt_rms", [SIGMA])
    silent = {**SET_A, "imu": {}, "reference": {"kind": "log"}}
    silent["method"] = [{"damping": "external", "network": {"id": "compass"}}]
    with pytest.raises(InputError, match="no random error"):
        tune(Scenario.parse(silent), "tilt_rms", [SIGMA])
    found = tune(Scenario.parse(silent), "settling_s", [f"{SIGMA}=1e-3:0.05"])
    assert found.objective < 700.0


def test_words_that_are_not_understood() -> None:
    """Objective, requirement, unit."""
    with pytest.raises(InputError, match="must be one of tilt_rms"):
        read_objective("speed")
    for text in ("settling_s=3600", "speed<=1", "settling_s<=1km", "settling_s<=x"):
        with pytest.raises(InputError, match="--require"):
            read_requirement(text)
    assert read_requirement("settling_s <= 1.5h").limit == 5400.0
    assert read_objective("tilt_rms + 0.5*velocity_rms").terms == (("tilt_rms", 1.0), ("velocity_rms", 0.5))


def test_pareto_fronts_cannot_be_beaten_by_the_known_optimum() -> None:
    """Points of a front trade one for the other; nothing is below the floor."""
    found = pareto(set_a({"id": "classic2"}), networks=["classic2", "compass", "optimal"], whole=True)
    assert list(found.fronts) == ["classic2", "compass", "optimal"]
    assert len(found.fronts["classic2"]) == 1
    for points in found.fronts.values():
        values = np.array([point.values for point in points])
        assert np.all(np.diff(values[:, 0]) > 0.0) and np.all(np.diff(values[:, 1]) < 0.0)
        assert np.all(values >= np.array([found.floor[0] or 0.0, found.floor[1] or 0.0]) * (1.0 - 1e-6))
    assert found.fronts["compass"][0].values[0] / ARCSEC == pytest.approx(4.850, rel=5e-3)
    assert found.fronts["compass"][0].network["xi"] == pytest.approx(2.79, rel=0.1)
    assert found.present is not None
    assert found.present[0] / ARCSEC == pytest.approx(5.36, rel=5e-3)
    with pytest.raises(InputError, match="must be one of"):
        pareto(set_a({"id": "classic2"}), ("tilt_rms", "speed"))


@pytest.mark.parametrize(
    ("q", "tilt", "velocity", "days"), [(0.0, 1.037, 3.385, 1.0 / 5.226), (1.0, 1.107, 1.407, -1.0 / 0.0207)]
)
def test_what_the_24_h_mode_of_optimal_costs(q: float, tilt: float, velocity: float, days: float) -> None:
    """docs/design.md: with q = 0 it grows within hours, with q = 1 it decays for a tenth of the tilt."""
    plain = set_a({"id": "optimal", "rho": 0.01, "q": q})
    scenario = plain.model_copy(update={"site": plain.site.model_copy(update={"lat_deg": 45.0})})
    found = budget(scenario, steady=True)
    times = found.times_floor(found.methods[0])
    assert times["tilt"] == pytest.approx(tilt, rel=1e-3)
    assert times["velocity"] == pytest.approx(velocity, rel=1e-3)
    growth = Setting(Ship(scenario, along_run=False), scenario.method[0]).whole.earth_growth
    assert 1.0 / growth == pytest.approx(days * 86400.0, rel=5e-3)
    requirement = read_requirement("earth_mode_growth_per_s<=0")
    setting = Setting(Ship(scenario, along_run=False), scenario.method[0])
    assert (requirement.excess(setting) > 0.0) is (q == 0.0)


def test_a_limit_of_the_scenario_counts_for_command_function_and_page(
    capsys: pytest.CaptureFixture[str],
) -> None:
    """`tune` kept limits on settling and growth alone; the page, all that a search can measure."""
    fields = ["method.2.network.zeta", "method.2.network.eta"]
    limit = ["requirement.0.quantity=velocity_rms_mps", "requirement.0.at_most=0.335"]
    limited = load("sikuliaq-like", ["run.duration_h=4", *limit])
    free = limited.model_copy(update={"requirement": ()})
    without = tune(free, "tilt_rms", fields, along=True)
    kept = TuneQuestion(
        scenario=limited, objective="tilt_rms", vary=tuple(fields), along=True, confirm=False
    ).answer()
    assert without.active == () and kept.active == ("velocity_rms<=0.335",)
    found = Setting(Ship(kept.scenario, True, TUNING_INTERVALS), kept.scenario.method[2])
    assert measure(found, "velocity_rms") == pytest.approx(0.335, rel=0.01)
    assert kept.objective > without.objective and kept.best["method.2.network.zeta"] < 1.1
    options = [option for one in ("run.duration_h=4", *limit) for option in ("--set", one)]
    vary = [option for field in fields for option in ("--vary", field)]
    call = ["tune", "sikuliaq-like", *options, "--objective", "tilt_rms", *vary, "--along", "--no-confirm"]
    assert main([*call, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["best"] == kept.best
    # one that is given takes its place; one that no search can measure is named
    again = tune(limited, "tilt_rms", fields, ["velocity_rms<=10"], along=True)
    assert again.best == without.best
    most = limited.requirement[0].model_copy(update={"quantity": "tilt_max_arcsec"})
    lines = tune(free.model_copy(update={"requirement": (most,)}), "tilt_rms", fields).lines()
    assert "judged by runs alone, not kept by the search: tilt_max_arcsec" in lines


@pytest.mark.parametrize(
    "case",
    [pytest.param(case, id=case.name, marks=NIGHTLY if k else ()) for k, case in enumerate(CASES)],
)
def test_any_start_comes_to_the_best_of_a_grid(case: Case) -> None:
    """Corners of the ranges; `make tuning` takes more starts and a finer grid."""
    least = best_of_grid(case, points=12)
    ends = [
        tune(case.scenario(start), "tilt_rms", case.vary, default_limits=False).objective
        for start in case.starts[1:3]
    ]
    assert max(ends) <= 1.001 * min(ends)
    assert max(ends) <= 1.001 * least
