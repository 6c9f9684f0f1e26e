"""From limits to designs in the page: shares of seeds in the background, the table, and taking a design."""

import re
from typing import Any

import pytest

from navcore.design.designs import designs
from navcore.design.judged import Designs
from navcore.design.run_shares import run_shares
from navcore.design.stated import assumed_zero
from navcore.engine.measures import metrics
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.questions.design import DesignQuestion
from navcore.questions.tune import TuneQuestion
from navcore.scenario.file import load
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.study.crossed import crossed
from navcore.study.robust import robust_designs
from schuler_bench.editing.edits import with_design, with_value
from schuler_bench.editing.limits import with_limit
from schuler_bench.jobs import odds
from schuler_bench.jobs.asking import Asker
from schuler_bench.jobs.odds import Judge, Odds
from schuler_bench.plots.units import number
from schuler_bench.session.requirements import asked
from schuler_bench.views.design.limits import designs_html
from schuler_bench.views.design.view import designs_beside
from schuler_bench.views.requirements.table import requirements_html
from schuler_bench.views.tune.proposal import sentences_about


@pytest.fixture(scope="module")
def ship() -> Scenario:
    """Two hours under way, with a limit that some seeds meet."""
    scenario = load("sikuliaq-like", ["run.duration_h=2", "initial_error.level_std_arcmin=0.1"])
    return with_limit(with_limit(scenario, "tilt_max_arcsec", "12"), "settling_s", "200")


@pytest.fixture
def judging(monkeypatch: pytest.MonkeyPatch) -> Any:
    monkeypatch.setattr(odds, "FEW", 4)
    monkeypatch.setattr(odds, "SEEDS", 12)
    told: list[int] = []
    one = Judge(lambda: told.append(1), still_s=0.0)
    yield one
    one.stop()


def shares(found: Designs) -> list[tuple[str, float]]:
    return sorted((share.method.label(), share.met) for share in found.methods)


def test_shares_are_those_of_the_command_and_a_method_that_stays_is_not_run_again(
    judging: Judge, ship: Scenario
) -> None:
    judging.judge(ship)
    assert judging.wait_idle(120.0)
    odds = [judging.odds(ship, method) for method in ship.method]
    wanted = designs(ship, 12, as_set=True)
    found = sorted((one.share.method.label(), one.share.met) for one in odds if one is not None)
    assert found == shares(wanted) and {one.seeds for one in odds if one is not None} == {12}
    # the metrics that the page saves hold them as those of a run do
    saved = metrics(simulate(ship), judging.shares(ship))["methods"]
    of_run = metrics(simulate(ship), run_shares(ship, 12))["methods"]
    assert [one["requirements"] for one in saved] == [one["requirements"] for one in of_run]
    assert "seeds" in saved[0]["requirements"][0] or "share" in saved[0]["requirements"][0]
    changed = with_value(ship, ("method", 2, "network", "zeta"), 0.6)
    assert judging.odds(changed, changed.method[2]) is None and judging.shares(changed) == ()
    judging.judge(changed)
    assert judging.wait_idle(120.0)
    assert judging.asked is not None and [m.name for m in judging.asked.scenario.method] == ["complementary"]
    assert judging.odds(changed, changed.method[1]) is odds[1]
    # other limits, other shares
    stricter = with_limit(changed, "tilt_max_arcsec", "1")
    assert judging.odds(stricter, stricter.method[1]) is None


def test_what_one_seed_meets_and_another_misses_has_its_share_beside_the_tick(judging: Judge) -> None:
    """Seeds 1, 5 and 6 meet this limit, 2, 3 and 4 miss it: the share hardly depends on which is on show."""

    def of_seed(seed: int) -> Scenario:
        return Scenario.parse(
            {
                "run": {"duration_h": 2.0, "seed": seed},
                "imu": {"gyro_arw_dpsh": 0.003, "gyro_instability_dph": 0.003},
                "reference": {"kind": "log", "noise_mps": 0.1, "drift_mps": 0.05},
                "method": [{"damping": "external", "network": {"id": "complementary"}}],
                "requirement": [{"quantity": "velocity_rms_mps", "at_most": 0.3}],
            }
        )

    runs = {seed: simulate(of_seed(seed)) for seed in range(1, 7)}
    ticks = {seed: asked(run, run.scenario.requirement)[0].passed[0] for seed, run in runs.items()}
    assert [seed for seed, met in ticks.items() if met] == [1, 5, 6]
    shown = {}
    for seed in (1, 2):
        scenario = runs[seed].scenario
        judging.judge(scenario)
        assert judging.wait_idle(120.0)
        odds = judging.odds(scenario, scenario.method[0])
        assert odds is not None and odds.seeds == 12
        html = requirements_html(runs[seed], odds=[odds])
        assert ("✓ met" if ticks[seed] else "✗ missed") in html
        said = re.findall(r"class=\"sb-share\"[^>]*>([\d.]+) % \((\d+) to (\d+)\)", html)
        assert len(said) == 2 and len(set(said)) == 1  # beside the limit's tick, and below, all together
        share, low, high = (float(text) for text in said[0])
        assert 0.0 < low < share < high < 100.0 and high - low > 20.0
        shown[seed] = share
    # eleven of their twelve seeds are the same
    assert abs(shown[1] - shown[2]) < 100.0 / 12.0 + 0.1


def test_without_a_limit_nothing_is_judged_and_a_wrong_one_is_refused_in_words(
    judging: Judge, ship: Scenario
) -> None:
    judging.judge(ship.model_copy(update={"requirement": ()}))
    assert judging.wait_idle(10.0) and judging.asked is None and judging.under_way is None
    late = ship.requirement[0].model_copy(update={"from_h": 5.0})
    judging.judge(ship.model_copy(update={"requirement": (late,)}))
    assert judging.wait_idle(60.0)
    assert "requirement.0.from_h = 5.0: must be <= 2 (h), the end of the run" in judging.words


def test_the_table_has_a_row_a_method_with_share_limit_and_this_run(ship: Scenario) -> None:
    run = simulate(ship)
    found = designs(ship, 6, as_set=True)
    by_name = {share.method.name: Odds(share, found.seeds) for share in found.methods}
    html = designs_html(run, lambda method: by_name.get(method.name), found)
    rows = re.findall(r'<tr data-design="(.*?)" data-met="(.*?)">(.*?)</tr>', html)
    assert [name for name, _, _ in rows[:3]] == [method.name for method in ship.method]
    assert [float(met) for _, met, _ in rows[:3]] == [by_name[m.name].share.met for m in ship.method]
    assert "largest tilt: median " in rows[0][2] and ", limit ≤\xa012\xa0arcsec" in rows[0][2]
    assert "✗ misses largest tilt, settling" in rows[0][2]
    assert "ζ = 0.5, η = 0.5" in rows[2][2]
    grows = [(method.growth_per_s or 0.0) > 0.0 for method in run.methods]
    assert any(grows) and ["↗ grows by e in" in row[2] for row in rows[:3]] == grows
    by_place = {name: "↗ grows by e in" in text for name, _, text in rows[3:]}
    assert [by_place[method.name] for method in ship.method] == grows
    assert [f"take-design {k}" in rows[3 + k][2] for k in range(3)] == [True] * 3
    assert "Limits: largest tilt ≤ 12 arcsec, settling ≤ 200 min." in html
    assert "The worst that a log within 1 m/s can do to the tilt of one channel, ″: " in html
    # the answer to a slider, before a seed is run
    bare = designs_html(run, lambda _: None, None)
    assert bare.count("runs are under way") == 3 and "✗ misses" in bare


def test_the_page_says_what_counts_as_0() -> None:
    """The command did; with 0.1 m/s of log bias a share falls from 59 to 38 %."""
    limit = ["requirement.0.quantity=velocity_rms_mps", "requirement.0.at_most=0.5"]
    silent = load("zha-fast", ["run.duration_h=0.2", *limit])
    fields = ", ".join(assumed_zero(silent))
    found = DesignQuestion(scenario=silent, seeds=2, as_set=True).answer()
    for answer in (None, found):
        html = designs_html(simulate(silent), lambda _: None, answer)
        assert fields and f"note: 0 is assumed for {fields}" in html
    asked = TuneQuestion(
        scenario=load("liu-networks"), objective="tilt_rms", vary=("method.2.network.zeta",), confirm=False
    )
    told = sentences_about(asked, tuned := asked.answer())
    assert tuned.assumed_zero and "note: 0 is assumed for " + ", ".join(tuned.assumed_zero) in told


def test_over_a_study_the_table_shows_the_worst_point_and_what_it_costs(ship: Scenario) -> None:
    run = simulate(ship)
    study = crossed(ship, ["log_bias"], 3)
    found = robust_designs(ship, study, 3, as_set=True)
    html = designs_html(run, lambda _: None, found)
    rows = re.findall(r'<tr data-design="([^"]*)" data-met="([^"]*)">(.*?)</tr>', html)
    assert [name for name, _, _ in rows] == [one.method.label() for one in found.methods]
    assert [float(met) for _, met, _ in rows] == [one.worst.met for one in found.methods]
    for place, (one, (_, _, text)) in enumerate(zip(found.methods, rows, strict=True)):
        assert f"take-design {place}" in text
        assert f"this scenario {number(100.0 * one.nominal.met, 3)} %, all points " in text
    assert f"the worst of {found.points} points" in html
    assert f"Cost: {number(100.0 * found.price, 3)} %" in html


def test_a_design_takes_the_place_of_the_edited_method_or_stands_behind_a_free_one(ship: Scenario) -> None:
    kalman = Method(name="kalman", damping="kalman")
    changed, at = with_design(ship, 2, kalman)
    assert at == 2 and [m.name for m in changed.method] == ["free", "classic2", "kalman"]
    changed, at = with_design(ship, 0, ship.method[1])
    assert at == 1
    assert [m.name for m in changed.method] == ["free", "classic2 2", "classic2", "complementary"]
    with pytest.raises(InputError):
        with_design(ship.model_copy(update={"method": ship.method[:1] * 8}), 0, kalman)


def test_designs_are_of_one_ship_and_its_limits(ship: Scenario) -> None:
    limits = Asker(lambda: None, DesignQuestion)
    try:
        limits.result, limits.asked = Designs(1, (), ()), DesignQuestion(scenario=ship)
        changed = with_value(ship, ("method", 2, "network", "zeta"), 0.6)
        assert designs_beside(limits, changed) is limits.result
        assert designs_beside(limits, with_limit(ship, "tilt_max_arcsec", "1")) is None
    finally:
        limits.stop()
