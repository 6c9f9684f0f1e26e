"""Designs over a study's spreads: what counts, what it costs, and what is refused."""

import json
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from navcore.design.designs import designs
from navcore.design.shares import shares_of
from navcore.design.ship import Ship
from navcore.design.spread import Spread
from navcore.design.tuned_designs import INTERVALS, tuned_methods
from navcore.engine.ensemble import outcomes
from navcore.foundation.errors import InputError, StoppedError
from navcore.scenario.file import load, to_toml
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.study.model import Study
from navcore.study.robust import Robust, robust_designs
from schuler_bench.cli import main

LIMITS = [{"quantity": "velocity_rms_mps", "at_most": 0.4}, {"quantity": "tilt_rms_arcsec", "at_most": 40.0}]
STUDY = """
schema = 1
scenario = "sun-ship"
[[factor]]
field = "reference.noise_mps"
values = [0.05, 0.5, 2.0]
"""
DRAWN = '[[factor]]\nfield = "imu.gyro_arw_dpsh"\nlow = 0.0\nhigh = 0.1\n[sample]\npoints = 256\n'


def _scenario(*overrides: str) -> Scenario:
    data = load("sun-ship", ["run.duration_h=3", *overrides]).canonical()
    return Scenario.parse(data | {"requirement": LIMITS})


def _study(text: str = STUDY) -> Study:
    import tomllib

    return Study.parse(tomllib.loads(text), "study")


@pytest.fixture(scope="module")
def as_set() -> Robust:
    return robust_designs(_scenario(), _study(), 6, as_set=True)


def test_each_point_is_judged_as_design_judges_that_scenario(as_set: Robust) -> None:
    assert (as_set.points, as_set.seeds) == (3, 6)
    worst = as_set.methods[0]
    there = _scenario(f"reference.noise_mps={worst.where['reference.noise_mps']}")
    shares = {share.method.name: share for share in designs(there, 6, as_set=True).methods}
    for one in as_set.methods:
        if one.where == worst.where:
            assert one.worst.met == shares[one.method.name].met
    nominal = {share.method.name: share.met for share in designs(_scenario(), 6, as_set=True).methods}
    assert {one.method.name: one.nominal.met for one in as_set.methods} == nominal


def test_the_share_of_all_points_is_the_mean_and_the_quantile_names_one(as_set: Robust) -> None:
    for one in as_set.methods:
        assert one.worst.met == one.counted <= one.met
        assert one.low <= one.met <= one.high
    median = robust_designs(_scenario(), _study(), 6, quantile=0.5, as_set=True)
    counted = {one.method.name: one.counted for one in median.methods}
    assert all(counted[one.method.name] >= one.counted for one in as_set.methods)
    assert [one.order for one in as_set.methods] == sorted(one.order for one in as_set.methods)


def test_a_quantile_takes_a_value_that_is_there() -> None:
    shares, ratios = [0.2, 0.9, 0.4, 0.7], [3.0, 0.5, 2.0, 1.0]
    assert Spread(quantile=0.0).of_shares(shares) == 0.2 and Spread(quantile=0.0).of_ratios(ratios) == 3.0
    assert Spread(quantile=0.5).of_shares(shares) == 0.4 and Spread(quantile=0.5).of_ratios(ratios) == 2.0


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_what_is_tuned_for_the_spread_is_worst_no_worse_than_what_is_tuned_for_the_scenario() -> None:
    """Each network is searched by the share that counts."""
    found = robust_designs(_scenario(), _study(), 20)
    alone = designs(_scenario(), 4)
    tuned = _scenario().model_copy(update={"method": tuple(share.method for share in alone.methods[:12])})
    kept = robust_designs(tuned, _study(), 20, as_set=True)
    best, before = found.methods[0], kept.methods[0]
    assert best.counted >= before.counted - 0.1
    assert found.price >= 0.0
    assert np.isfinite(found.price)


def test_the_command_prints_a_table_and_a_document(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "study.toml"
    path.write_text(STUDY)
    (tmp_path / "ship.toml").write_text(to_toml(_scenario()))
    ship = str(tmp_path / "ship.toml")
    words = ["design", ship, "--over", str(path), "--as-set", "--seeds", "3", "--quiet"]
    assert main(words) == 0
    said = capsys.readouterr().out
    assert (
        "3 points, 3 seeds" in said
        and "worst point %" in said
        and "is worst with reference.noise_mps" in said
    )
    assert main([*words, "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document["points"] == 3 and {"counted", "nominal", "worst"} <= document["methods"][0].keys()
    assert "reference.noise_mps" in document["methods"][0]["worst"]["factors"]


@pytest.mark.parametrize(
    ("text", "options", "said"),
    [
        (STUDY.replace("reference.noise_mps", "method.0.network.zeta"), {}, "must not be a method"),
        (STUDY.replace("reference.noise_mps", "run.seed"), {}, "the seed"),
        (STUDY.partition("[[factor]]")[0], {}, "what may differ"),
        (STUDY, {"quantile": 1.0}, "must be >= 0 and < 1"),
        (STUDY, {"seeds": 0}, "must be >= 1"),
        (
            STUDY
            + '[[factor]]\nfield = "imu.gyro_arw_dpsh"\nlow = 0.0\nhigh = 0.1\n[sample]\npoints = 256\n',
            {},
            "are 768 points; at most 400",
        ),
    ],
    ids=["method", "seed", "no factor", "quantile", "seeds", "too many"],
)
def test_what_cannot_be_judged_is_refused(text: str, options: dict[str, float], said: str) -> None:
    with pytest.raises(InputError, match=said):
        robust_designs(_scenario(), _study(text), **options)


def test_a_stop_ends_without_a_half_judged_result() -> None:
    with pytest.raises(StoppedError):
        robust_designs(_scenario(), _study(), 6, as_set=True, cancelled=lambda: True)


SPREAD_SHIP = {
    "run": {"duration_h": 8.0, "step_s": 10.0, "output_step_s": 600.0},
    "site": {"lat_deg": 45.0},
    "method": [{"name": "free"}],
    "requirement": [
        {"quantity": "tilt_max_arcsec", "at_most": 32.0},
        {"quantity": "velocity_max_mps", "at_most": 1.3},
    ],
}
SENSORS = {
    "gyro_bias_std_dph": 0.006,
    "accel_bias_std_ug": 30.0,
    "gyro_arw_dpsh": 0.002,
    "accel_vrw_ugpshz": 10.0,
}
DRIFTING = {"kind": "log", "noise_mps": 0.1, "drift_mps": 0.1}


@pytest.mark.slow
@pytest.mark.timeout(300)
def test_over_a_spread_the_offer_is_within_three_points_of_a_grids_best() -> None:
    """The covariance as a guide offered a setting of unity2 four points below the grid's best."""
    base, *others = (
        Scenario.parse(SPREAD_SHIP | {"imu": SENSORS | imu, "reference": DRIFTING | log})
        for imu, log in (
            ({}, {}),
            ({}, {"drift_mps": 0.2}),
            ({"gyro_bias_std_dph": 0.009}, {}),
            ({"gyro_arw_dpsh": 0.006}, {}),
        )
    )
    tuned, _ = tuned_methods(base, lambda _: None, None, Spread(tuple(others)), ids=("unity2",))
    (offered,) = (one for one in tuned if one.name == "unity2")
    blocks = [
        {"id": "unity2", "zeta": zeta, "r": r, "zeta2": zeta2}
        for zeta, r, zeta2 in product((0.4, 0.7, 1.0, 1.5), (1.05, 1.3, 1.8), (0.8, 1.4))
    ]
    grid = [Method.model_validate({"damping": "external", "network": block}) for block in blocks]
    methods = [offered, *grid]
    shares = [
        [
            share.met
            for share in shares_of(
                Ship(one, True, INTERVALS, drawn=True), methods, outcomes(one, methods, range(200))
            )
        ]
        for one in (base, *others)
    ]
    counted = np.min(shares, axis=0)
    assert 0.1 < counted[1:].max() < 0.95, "the limits must tell settings apart"
    assert counted[0] >= counted[1:].max() - 0.03
