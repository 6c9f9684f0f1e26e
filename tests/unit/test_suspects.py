"""What `check` finds suspicious in recordings, and that it says nothing of good ones."""

from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.checks.imu import IMU_CHECKER

RNG = np.random.default_rng(7)
SPEED = 5.0 + 0.3 * np.sin(np.arange(1200) / 60.0) + 0.05 * RNG.normal(size=1200)
IMU = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,fx_mps2,fy_mps2,fz_mps2"
AT_REST = np.array([0.0, 5.2e-5, 5.1e-5, 0.0, 0.0, 9.8]) + 1e-7 * RNG.normal(size=(500, 6))


def _log(folder: Path, speed: np.ndarray) -> tuple[str, ...]:
    path = folder / "log.csv"
    path.write_text("t_s,stw_mps\n" + "".join(f"{k},{v:.3f}\n" for k, v in enumerate(speed)))
    return check_file(path, [IMU_CHECKER]).warnings


def _imu(folder: Path, values: np.ndarray) -> tuple[str, ...]:
    path = folder / "imu.csv"
    rows = (",".join(f"{v:.9g}" for v in row) for row in values)
    path.write_text(IMU + "\n" + "".join(f"{k * 0.01:.2f},{row}\n" for k, row in enumerate(rows)))
    return check_file(path, [IMU_CHECKER]).warnings


def test_good_recordings_are_not_suspicious(tmp_path: Path) -> None:
    assert _log(tmp_path, SPEED) == ()
    assert _log(tmp_path, np.round(SPEED, 1)) == ()
    assert _imu(tmp_path, AT_REST) == ()


@pytest.mark.parametrize("run", [1, 6])
def test_spikes_are_named_not_their_good_neighbours(tmp_path: Path, run: int) -> None:
    speed = SPEED.copy()
    speed[700 : 700 + run] = 40.0
    when = "at 700 s is" if run == 1 else "from 700 s to 705 s are"
    assert [w for w in _log(tmp_path, speed) if when in w and f"{run} sample" in w]


def test_a_ship_that_turns_to_another_speed_has_no_spike(tmp_path: Path) -> None:
    speed = SPEED.copy()
    speed[600:] += 4.0
    assert not any("neighbours" in w for w in _log(tmp_path, speed))


def test_a_stuck_value_is_told(tmp_path: Path) -> None:
    speed = SPEED.copy()
    speed[300:750] = speed[300]
    assert any("very same value from 300 s to 749 s" in w for w in _log(tmp_path, speed))


@pytest.mark.parametrize(
    ("factors", "wanted"),
    [
        ((1, 1 / 9.80665), "in g it is gravity"),
        ((1, 1e3 / 9.80665), "in mg it is gravity"),
        ((180 / np.pi, 1), "the Earth's in deg/s where rad/s was taken"),
        ((3600 * 180 / np.pi, 1), "the Earth's in deg/h where rad/s was taken"),
        ((np.pi / 180, 1), "the Earth's in rad/s where deg/s was taken"),
    ],
)
def test_the_unit_that_explains_an_imu_is_named(
    tmp_path: Path, factors: tuple[float, float], wanted: str
) -> None:
    assert any(wanted in w for w in _imu(tmp_path, AT_REST * np.repeat(factors, 3)))


def test_a_stuck_sensor_and_an_outlier_are_told(tmp_path: Path) -> None:
    stuck, far = AT_REST.copy(), AT_REST.copy()
    stuck[:, 1] = 5.2e-5
    far[200, 4] = 30.0
    assert any("gyro y: the very same reading" in w for w in _imu(tmp_path, stuck))
    assert any("1 sample is far from all others, at 2 s" in w for w in _imu(tmp_path, far))


def test_the_axes_of_another_mounting_are_proposed(tmp_path: Path) -> None:
    assert any('imu.axes = "u' in w for w in _imu(tmp_path, AT_REST[:, [2, 0, 1, 5, 3, 4]]))
