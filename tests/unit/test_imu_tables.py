"""Tables of recorded IMUs: names, units and axes of their columns, and stamps that are even all the same."""

from pathlib import Path

import numpy as np
import pytest

from navcore.checks.imu import check_imu, recognises
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, STANDARD_GRAVITY
from navcore.sensors.even_stamps import interval_of
from navcore.sensors.imu_columns import RATES, imu_columns, is_imu_header
from navcore.sensors.recorded_imu import read_imu

TURN, FORCE = (1e-5, 2e-5, 5e-5), (0.01, -0.02, 9.81)


def table(path: Path, header: str, time_factor: float = 1.0, turn: float = 1.0, force: float = 1.0) -> Path:
    """Write 400 samples at 100 Hz; the factors are what one SI unit is in the table's units."""
    rows = [
        ",".join(
            [
                f"{time_factor * 0.01 * k:.9g}",
                *(f"{turn * value:.12g}" for value in TURN),
                *(f"{force * value:.12g}" for value in FORCE),
            ]
        )
        for k in range(400)
    ]
    path.write_text(header + "\n" + "\n".join(rows) + "\n")
    return path


def header(pattern: str, turn: str, force: str, gyro: str = "gyro", accel: str = "acc") -> str:
    names = [pattern.format(sensor=gyro, axis=axis, unit=turn) for axis in "xyz"]
    return ",".join([*names, *(pattern.format(sensor=accel, axis=axis, unit=force) for axis in "xyz")])


@pytest.mark.parametrize(
    ("head", "time", "turn", "force"),
    [
        ("t_s," + ",".join(RATES), 1.0, 1.0, 1.0),
        (
            "#timestamp [ns]," + header("{sensor}_RS_S_{axis} [{unit}]", "rad s^-1", "m s^-2", "w", "a"),
            1e9, 1.0, 1.0,
        ),
        (
            "Time (ms)," + header("{sensor} {axis} [{unit}]", "deg/s", "g", "GYRO", "ACC"),
            1e3, 1.0 / DEG, 1.0 / STANDARD_GRAVITY,
        ),
        ("t_us," + header("{sensor}{axis}_{unit}", "dps", "mg"), 1e6, 1.0 / DEG, 1e3 / STANDARD_GRAVITY),
        (
            "timestamp," + header("{sensor} {axis} ({unit})", "°/s", "m/s²", "Angular rate", "Acceleration"),
            1.0, 1.0 / DEG, 1.0,
        ),
    ],
    ids=["own", "data-set", "brackets", "suffix", "signs"],
)  # fmt: skip
def test_units_and_axes_are_read_from_the_header(tmp_path, head, time, turn, force) -> None:
    path = table(tmp_path / "imu.csv", head, time, turn, force)
    assert recognises(path, path.read_bytes()[:4096])
    record = read_imu(path)
    assert record.rate_hz == pytest.approx(100.0, rel=1e-6)
    mean = record.increments.mean(axis=0) * record.rate_hz
    assert mean == pytest.approx([*TURN, *FORCE], rel=1e-6)


def test_columns_in_another_order_and_others_between_them(tmp_path: Path) -> None:
    names = (
        "acc_z [m/s^2],temp [C],gyro_y [rad/s],mag_x [uT],t [s],gyro_x [rad/s],acc_x [m/s^2],"
        "gyro_z [rad/s],acc_y [m/s^2]"
    )
    rows = "\n".join(f"9.81,20,2e-5,1,{0.01 * k:.2f},1e-5,0.01,5e-5,-0.02" for k in range(100))
    (tmp_path / "imu.csv").write_text(f"# logged on board\n{names}\n{rows}\n")
    mean = read_imu(tmp_path / "imu.csv").increments.mean(axis=0) * 100.0
    assert mean == pytest.approx([*TURN, *FORCE], rel=1e-4)


@pytest.mark.parametrize(
    ("head", "told"),
    [
        ("t [s]," + header("{sensor}_{axis}", "", ""), "gyro_x, gyro_y, gyro_z, acc_x, acc_y, acc_z: a unit"),
        ("t [s]," + header("{sensor}_{axis} [{unit}]", "furlong", "m/s^2"), "gyro_x [furlong], gyro_y"),
        ("t [s]," + header("{sensor}_{axis} [{unit}]", "m/s^2", "m/s^2"), "gyro_x [m/s^2]"),
        ("n," + header("{sensor}_{axis} [{unit}]", "rad/s", "m/s^2"), "needs a header"),
    ],
)
def test_a_unit_that_is_missing_or_wrong_is_refused_by_the_columns_name(tmp_path, head, told) -> None:
    with pytest.raises(InputError) as caught:
        read_imu(table(tmp_path / "imu.csv", head))
    assert told in str(caught.value)


@pytest.mark.parametrize(
    "names",
    [
        "time_s,lat_deg,lon_deg,speed_kn,heading_deg",
        "t,wind_x,wind_y,wave_z",
        "t,acc_x,acc_y,acc_z,speed_mps",
    ],
)
def test_a_ships_log_is_no_imu(names: str) -> None:
    assert not is_imu_header(names.split(","))


def test_a_magnetometer_is_no_gyro() -> None:
    others = [f"mag_{axis} [rad/s]" for axis in "xyz"]
    names = ["t [s]", *others, *(f"acc_{axis} [m/s^2]" for axis in "xyz")]
    assert not is_imu_header(names)
    with pytest.raises(InputError, match="needs a header"):
        imu_columns(names, "x")


# ------------------------------------------------------------ stamps


def test_coarse_and_jittering_stamps_are_even_and_the_jitter_is_told(tmp_path: Path) -> None:
    stamps = np.repeat(np.arange(500) * 0.01, 2) + np.tile([0.008, 0.010], 500)
    interval, jitter = interval_of(stamps)
    assert interval == pytest.approx(0.005, rel=2e-3) and 1e-3 < jitter < 3e-3
    noisy = np.arange(2000) * 0.01 + np.random.default_rng(1).uniform(-0.004, 0.004, 2000)
    assert interval_of(np.sort(noisy))[0] == pytest.approx(0.01, rel=1e-3)
    rows = "\n".join(f"{t:.6f},1e-5,2e-5,5e-5,0.01,-0.02,9.81" for t in stamps)
    (tmp_path / "imu.csv").write_text("t_s," + ",".join(RATES) + "\n" + rows)
    report = check_imu(tmp_path / "imu.csv")
    assert any("off an even record" in text for text in report.warnings)
    assert report.details["rate_hz"] == pytest.approx(200.0, rel=2e-3)


@pytest.mark.parametrize("jitter", [0.0, 0.003])
@pytest.mark.parametrize("lost", [1, 2, 50])
def test_missing_samples_are_gaps_in_an_even_and_in_a_jittering_record(jitter: float, lost: int) -> None:
    stamps = np.arange(3000) * 0.01 + np.random.default_rng(2).uniform(-jitter, jitter, 3000)
    kept = np.delete(np.sort(stamps), slice(1200, 1200 + lost))
    with pytest.raises(ValueError, match=r"1 gaps, the first at t = 1[12]\.|1 gaps, the first at t = 11.9"):
        interval_of(kept)


def test_time_that_runs_backwards_or_stands_is_refused() -> None:
    stamps = np.arange(100) * 0.01
    for place, value in ((50, 0.2), (50, 10.0)):
        broken = stamps.copy()
        broken[place] = value
        with pytest.raises(ValueError, match="backwards"):
            interval_of(broken)
    with pytest.raises(ValueError, match="stands still"):
        interval_of(np.repeat(np.arange(10.0), 100))
