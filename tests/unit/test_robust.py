"""Designs over a study's spreads: what counts, what it costs, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest

from navcore.design.designs import designs
from navcore.design.tuned_designs import Spread
from navcore.foundation.errors import InputError, StoppedError
from navcore.scenario.file import load, to_toml
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
def test_what_is_tuned_for_the_spread_is_worst_no_worse_than_what_is_tuned_for_the_scenario() -> None:
    """Of each network both settings are judged; over the spread the better one is taken."""
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
