"""What a study's metrics depend on: against functions whose indices are known."""

import json
import math

import numpy as np
import pytest

from navcore.study.sensitivity import Sensitivity
from schuler_bench.__main__ import main
from tests.studies import LATITUDE, NOISE, plan, write

_FACTORS = [{"field": f"imu.{name}", "low": 0.0, "high": 2.0 * math.pi} for name in ("gyro_arw_dpsh",
            "gyro_instability_dph", "accel_vrw_ugpshz")]  # fmt: skip


def _ishigami(x: np.ndarray) -> np.ndarray:
    """Function of three angles from -pi to pi, shape (n, 3), whose indices Saltelli et al. give."""
    return np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


def test_the_indices_of_a_known_function(tmp_path):
    made = plan(tmp_path, factor=_FACTORS, sample={"method": "saltelli", "points": 1024})
    assert made.runs == 1024 * 5
    numbers = np.arange(made.runs)
    columns = [factor.column for factor in made.random]
    draws = np.array([[made.values(made.at(number)[0])[c] for c in columns] for number in numbers])
    sensitivity = Sensitivity(made, numbers, dict(zip(columns, draws.T, strict=True)))
    found = sensitivity.sobol(_ishigami(draws - math.pi), np.ones(len(numbers), bool))
    assert [one["factor"] for one in found] == columns
    for one, first, total in zip(found, (0.3139, 0.4424, 0.0), (0.5576, 0.4424, 0.2437), strict=True):
        assert one["first"]["value"] == pytest.approx(first, abs=0.05)
        assert one["total"]["value"] == pytest.approx(total, abs=0.05)
        assert one["total"]["low"] < one["total"]["value"] < one["total"]["high"]
    again = sensitivity.sobol(_ishigami(draws - math.pi), np.ones(len(numbers), bool))
    assert again == found, "the intervals come from random draws without a seed"


def test_a_run_without_a_value_takes_the_indices_away(tmp_path):
    made = plan(tmp_path, factor=_FACTORS, sample={"method": "saltelli", "points": 4})
    numbers, values = np.arange(made.runs), np.random.default_rng(1).random(made.runs)
    sensitivity = Sensitivity(made, numbers, {})
    assert len(sensitivity.sobol(values, np.ones(made.runs, bool))) == 3
    assert sensitivity.sobol(np.where(numbers == 7, np.inf, values), np.ones(made.runs, bool)) == []
    assert sensitivity.sobol(values, numbers != 3) == []
    assert sensitivity.sobol(np.ones(made.runs), np.ones(made.runs, bool)) == []


def test_the_tornado_names_where_the_median_is_least_and_largest(tmp_path):
    made = plan(tmp_path, factor=[LATITUDE, NOISE], sample={"points": 100})
    numbers = np.arange(made.runs)
    rows = [made.values(made.at(number)[0]) for number in numbers]
    latitude = np.array([row["site.lat_deg"] for row in rows])
    noise = np.array([row["imu.gyro_arw_dpsh"] for row in rows])
    sensitivity = Sensitivity(made, numbers, {"imu.gyro_arw_dpsh": noise})
    found = sensitivity.tornado(10.0 - 1000.0 * noise + 0.01 * latitude, np.ones(made.runs, bool))
    assert [one["factor"] for one in found] == ["imu.gyro_arw_dpsh", "site.lat_deg"]
    # the middles of the outer fifths of 0.001 to 0.01
    assert found[0]["at_least"] == pytest.approx(0.0091, abs=2e-4)
    assert found[0]["at_largest"] == pytest.approx(0.0019, abs=2e-4)
    assert found[1]["at_least"] == 10.0 and found[1]["at_largest"] == 45.0
    assert found[1]["largest"] - found[1]["least"] == pytest.approx(0.35, abs=0.1)


def test_the_command_gives_both_and_people_read_them(tmp_path, capsys):
    study = tmp_path / "study.toml"
    made = plan(
        tmp_path,
        factor=[NOISE, {"field": "reference.noise_mps", "low": 0.05, "high": 0.1}],
        sample={"method": "saltelli", "points": 8},
    )
    assert made.runs == 32
    assert main(["study", str(study), "--json", "--quiet"]) == 0
    damped = json.loads(capsys.readouterr().out)["methods"][1]
    assert [one["factor"] for one in damped["sobol"]["tilt_rms_arcsec"]] == [f.column for f in made.random]
    assert damped["tornado"]["tilt_rms_arcsec"][0]["factor"] == "imu.gyro_arw_dpsh"
    assert main(["study", str(study), "--quiet"]) == 0
    out = capsys.readouterr().out
    assert "least and largest median by factor" in out and "Sobol indices with their 95 % intervals" in out


def test_points_that_are_no_power_of_two_are_refused(tmp_path, capsys):
    study = write(tmp_path / "study.toml", factor=[NOISE], sample={"method": "saltelli", "points": 100})
    assert main(["study", study]) == 2
    assert "sample.points = 100: must be a power of 2" in capsys.readouterr().err
