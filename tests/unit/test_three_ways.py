"""The planted voyage of ``examples`` and the three ways through it."""

import filecmp
import math
from pathlib import Path

import pytest

import navcore
from examples import three_ways
from examples.voyage import make

FOLDER = Path(make.__file__).parent


def test_the_recordings_are_those_that_the_script_makes(tmp_path: Path) -> None:
    make.main(tmp_path)
    for name in ("log.csv", "track.csv"):
        assert filecmp.cmp(tmp_path / name, FOLDER / name, shallow=False), name
    assert sum(path.stat().st_size for path in FOLDER.glob("*.csv")) < 250_000


def test_the_fit_of_the_voyage_holds_what_was_planted() -> None:
    found = navcore.fit(str(FOLDER / "log.csv"), track=[str(FOLDER / "track.csv")]).document()["log"]
    for name, value in make.PLANTED.items():
        many = isinstance(value, tuple)
        for one, truth in zip(
            found[name] if many else [found[name]], value if many else [value], strict=True
        ):
            middle, half = one["value"], 0.5 * (one["high"] - one["low"])
            assert math.isfinite(half) and abs(middle - truth) < 1.5 * half, (name, one, truth)


def test_the_three_ways_lead_to_an_answer() -> None:
    first = three_ways.engineer(seeds=8)
    assert any("late against the motion over ground" in text for text in first["warnings"])
    assert first["run"].run.status == "ok"
    # a number of one step is the number of the next
    document = first["fit"].document()["log"]
    fitted = first["fitted"].reference
    assert fitted.noise_mps == pytest.approx(document["noise_mps"]["value"], rel=0.05)
    assert fitted.delay_s == pytest.approx(0.0, abs=1.0)
    met = {share.method.label(): share.met for share in first["shares"].methods}
    assert met["unity2"] > met["free"]
    second = three_ways.researcher(first["fitted"])
    assert not second["budget"].floor_reason
    assert {"log_drift", "log_white"} <= second["budget"].methods[2].sources.keys()
    third = three_ways.systems_engineer(first["fitted"], seeds=4)
    assert third.needed and third.methods[0].met < 0.5
