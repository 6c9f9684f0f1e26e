"""The fit of a standing IMU gives back the noise that it was made with."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from navcore.fitting.imu import FittedImu, allan_deviation, fit_imu
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG_PER_HOUR, DEG_PER_SQRT_HOUR, MICRO_G
from navcore.scenario.file import load
from navcore.sensors.recorded_imu import ImuRecord
from schuler_bench.cli import main

RATE_HZ = 10.0
ARW, GYRO, GYRO_TAU_S = 0.003, 0.02, 200.0
VRW, ACCEL, ACCEL_TAU_S = 10.0, 20.0, 300.0


def standing(seed: int, hours: float = 3.0) -> ImuRecord:
    """An IMU at rest with white noise and a Gauss-Markov drift on each axis."""
    random = np.random.default_rng(seed)
    n = int(hours * 3600.0 * RATE_HZ)
    columns = []
    for white, drift, tau_s, mean in (
        *[(ARW * DEG_PER_SQRT_HOUR, GYRO * DEG_PER_HOUR, GYRO_TAU_S, 5e-5)] * 3,
        *[(VRW * MICRO_G, ACCEL * MICRO_G, ACCEL_TAU_S, 9.8)] * 3,
    ):
        rho = math.exp(-1.0 / (RATE_HZ * tau_s))
        steps = random.normal(0.0, drift * math.sqrt(1.0 - rho**2), n)
        steps[0] = random.normal(0.0, drift)
        slow = np.asarray(lfilter([1.0], [1.0, -rho], steps))
        columns.append(mean + slow + random.normal(0.0, white * math.sqrt(RATE_HZ), n))
    return ImuRecord(np.column_stack(columns) / RATE_HZ, RATE_HZ, "standing")


@pytest.fixture(scope="module")
def found() -> FittedImu:
    return fit_imu(standing(1))


def test_what_was_planted_comes_back_within_the_intervals(found: FittedImu) -> None:
    planted = {
        "gyro_arw_dpsh": ARW,
        "gyro_instability_dph": GYRO,
        "gyro_tau_s": GYRO_TAU_S,
        "accel_vrw_ugpshz": VRW,
        "accel_instability_ug": ACCEL,
        "accel_tau_s": ACCEL_TAU_S,
    }
    document = found.document()["imu"]
    held = [one["low"] <= truth <= one["high"] for name, truth in planted.items() for one in document[name]]
    assert sum(held) >= 16 and len(held) == 18
    for name in ("gyro_arw_dpsh", "accel_vrw_ugpshz"):
        assert [one["value"] for one in document[name]] == pytest.approx([planted[name]] * 3, rel=0.05)
    for name in ("gyro_instability_dph", "accel_instability_ug"):
        assert [one["value"] for one in document[name]] == pytest.approx([planted[name]] * 3, rel=0.3)
    assert not found.disturbed_s


def test_a_drift_that_levels_off_is_no_rate_walk_and_one_that_does_not_is(found: FittedImu) -> None:
    assert all(axis.walk.value == 0.0 for axis in found.gyro)
    random = np.random.default_rng(4)
    walk, white = 5e-8, ARW * DEG_PER_SQRT_HOUR
    n = 36_000
    rates = np.cumsum(random.normal(0.0, walk / math.sqrt(RATE_HZ), (n, 6)), axis=0)
    rates += random.normal(0.0, white * math.sqrt(RATE_HZ), (n, 6))
    fits = fit_imu(ImuRecord(rates / RATE_HZ, RATE_HZ, "walking"))
    axes = (*fits.gyro, *fits.accel)
    assert sum(axis.walk.value > 0.0 for axis in axes) >= 5
    assert np.median([axis.walk.value for axis in axes]) == pytest.approx(walk, rel=0.2)
    assert sum(axis.walk.low <= walk <= axis.walk.high for axis in axes) >= 5


def test_the_allan_deviation_of_white_noise_falls_by_the_root_of_the_time() -> None:
    rates = np.random.default_rng(2).normal(0.0, 1.0, 50_000)
    curve = allan_deviation(rates, 10.0)
    expected = 1.0 / np.sqrt(curve.tau_s * 10.0)
    assert np.mean((curve.low <= expected) & (expected <= curve.high)) >= 0.8
    np.testing.assert_allclose(curve.deviation[:6], expected[:6], rtol=0.05)


def test_the_block_holds_the_root_mean_square_of_the_axes(found: FittedImu) -> None:
    block = found.blocks()["imu"]
    values = [one["value"] for one in found.document()["imu"]["gyro_arw_dpsh"]]
    assert block["gyro_arw_dpsh"] == pytest.approx(np.sqrt(np.mean(np.square(values))), rel=1e-3)
    assert "gyro_rate_walk_dphph" not in block


def test_a_disturbance_is_named_by_its_time() -> None:
    record = standing(3, 0.5)
    shaken = record.increments.copy()
    shaken[6000:9000] += np.random.default_rng(1).normal(0.0, 0.01, (3000, 6)) / RATE_HZ
    found = fit_imu(ImuRecord(shaken, RATE_HZ, "shaken"))
    ((begin, end),) = found.disturbed_s
    assert begin <= 600.0 < 900.0 <= end and end - begin < 500.0
    assert any("disturbed from" in line for line in found.lines())


def test_a_record_of_a_minute_is_refused() -> None:
    with pytest.raises(InputError, match="lasts 36 s; a fit of its noise needs 120 s"):
        fit_imu(standing(1, 0.01))


def test_the_command_fits_an_imu_and_writes_its_block(
    repo_root: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, block = repo_root / "assets" / "recordings" / "lasergyro-1s.csv", tmp_path / "imu.toml"
    assert main(["fit", str(file), "--scenario", str(block), "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert len(document["imu"]["gyro_arw_dpsh"]) == 3
    assert len(document["allan"]["gyro_dph"]) == 3
    assert load(str(block)).imu.gyro_arw_dpsh > 0.0
    assert main(["fit", str(file), "--track", str(file)]) == 2
    assert "--track" in capsys.readouterr().err
