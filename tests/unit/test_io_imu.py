"""Recorded IMUs as other programs write them: names, units, axes, headers and stamps."""

from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC, DEG
from navcore.io.imu_columns import imu_column
from navcore.io.times.even_stamps import evenness
from navcore.sensors.recorded_imu import Axes, ImuRecord, read_imu

SI = "t_s,gx_rad_s,gy_rad_s,gz_rad_s,fx_mps2,fy_mps2,fz_mps2"
ROW = (1e-4, 2e-4, 3e-4, 0.1, 0.2, 9.8)


def _read(
    folder: Path,
    header: str,
    row: tuple[float, ...] = ROW,
    times: list[str] | None = None,
    axes: Axes = "rfu",
) -> ImuRecord:
    path = folder / "imu.csv"
    stamps = times or [f"{k * 0.01:.2f}" for k in range(1, 51)]
    separator = next((s for s in ";\t" if s in header), ",")
    cells = separator.join(repr(value) for value in row)
    path.write_text("\n".join([header, *(f"{t}{separator}{cells}" for t in stamps)]) + "\n")
    return read_imu(path, axes)


@pytest.mark.parametrize(
    ("name", "kind", "axis", "unit"),
    [
        ("gx_rad_s", "rate", "x", "rad_s"), ("fz_mps2", "force", "z", "mps2"),
        ("dvx_mps", "velocity", "x", "mps"),
        ("ACC X [m/s^2]", "force", "x", "mps2"), ("GYRO Z [rad/s]", "rate", "z", "rad_s"),
        ("w_RS_S_y [rad s^-1]", "rate", "y", "rad_s"), ("a_RS_S_z [m s^-2]", "force", "z", "mps2"),
        ("Gyroscope y (°/s)", "rate", "y", "deg_s"), ("Acceleration x (m/s²)", "force", "x", "mps2"),
        ("AccelX", "force", "x", ""), ("wz", "rate", "z", ""), ("accel_y_g", "force", "y", "g"),
        ("gyro_x_dps", "rate", "x", "deg_s"), ("X Gyro (deg/h)", "rate", "x", "deg_h"),
        ("field.angular_velocity.x", "rate", "x", "rad_s"), ("linear_acceleration.y", "force", "y", "mps2"),
        ("Delta Angle Z (arcsec)", "angle", "z", "arcsec"), ("deltaV_x [m/s]", "velocity", "x", "mps"),
    ],
)  # fmt: skip
def test_a_name_gives_kind_axis_and_unit(name: str, kind: str, axis: str, unit: str) -> None:
    column = imu_column(0, name)
    assert column is not None and (column.kind, column.axis, column.unit) == (kind, axis, unit)


@pytest.mark.parametrize(
    "name",
    [
        "mag_x",
        "FreeAcc_X",
        "gyro_bias_x",
        "acc_x_std",
        "gravity_x",
        "heading_deg",
        "max",
        "t_s",
        "pos_x",
        "vx",
    ],
)
def test_other_columns_are_not_taken(name: str) -> None:
    assert imu_column(0, name) is None


@pytest.mark.parametrize(
    ("header", "rate", "force"),
    [
        ("Time (s),GYRO X [deg/s],GYRO Y [deg/s],GYRO Z [deg/s],ACC X [g],ACC Y [g],ACC Z [g]", DEG, 9.80665),
        ("t;wx (deg/h);wy (deg/h);wz (deg/h);ax (mg);ay (mg);az (mg)", DEG / 3600, 9.80665e-3),
        (f"# recorded at the quay\n#\n# {SI}", 1.0, 1.0),
        (f"A title\n\n{SI}", 1.0, 1.0),
        (f"% {SI}", 1.0, 1.0),
    ],
)
def test_rates_and_forces_have_the_units_of_their_names(
    tmp_path: Path, header: str, rate: float, force: float
) -> None:
    record = _read(tmp_path, header)
    assert record.rate_hz == pytest.approx(100.0) and not record.warnings
    assert record.increments[3, :3] == pytest.approx(np.array(ROW[:3]) * rate * 0.01)
    assert record.increments[3, 3:] == pytest.approx(np.array(ROW[3:]) * force * 0.01)


WORDS = ("dtheta", "arcsec"), ("dvel", "m/s")


def test_increments_are_not_multiplied_by_the_interval(tmp_path: Path) -> None:
    angles, velocities = (",".join(f"{n}_{a} ({u})" for a in "xyz") for n, u in WORDS)
    assert _read(tmp_path, f"Time [s],{angles},{velocities}").increments[0] == pytest.approx(
        np.array(ROW) * ([ARCSEC] * 3 + [1.0] * 3)
    )


def test_forces_without_a_unit_have_the_one_in_which_they_are_gravity(tmp_path: Path) -> None:
    header = "t_s,gyro_x_dps,gyro_y_dps,gyro_z_dps,acc_x,acc_y,acc_z"
    record = _read(tmp_path, header, (0.0, 0.0, 0.0, 0.0, 0.01, 1.001))
    assert record.increments[0, 5] == pytest.approx(9.80665e-2 * 1.001)
    assert "acc_x, acc_y, acc_z name no unit: taken as g" in record.warnings[0]
    with pytest.raises(InputError, match="acc_x.*names no unit"):
        _read(tmp_path, header, (0.0, 0.0, 0.0, 0.0, 0.0, 3.0))


@pytest.mark.parametrize(
    ("header", "wanted"),
    [
        ("t_s,gyro_x,gyro_y,gyro_z,acc_x_g,acc_y_g,acc_z_g", "gyro_x.*names no unit"),
        (SI.replace("gz_rad_s", "yaw_rate"), "columns found: t_s, gx_rad_s, .*yaw_rate"),
        (SI.replace("t_s", "n"), "needs a header with t_s"),
        ("t_s,GYRO X [rpm],GYRO Y [rpm],GYRO Z [rpm],acc_x_g,acc_y_g,acc_z_g", r"GYRO X \[rpm\].*rpm"),
    ],
)
def test_what_cannot_be_known_is_refused_by_name(tmp_path: Path, header: str, wanted: str) -> None:
    with pytest.raises(InputError, match=wanted):
        _read(tmp_path, header)


@pytest.mark.parametrize(
    ("name", "times"),
    [
        ("timestamp [ns]", [str(1700000000_123456789 + 5_000_000 * k) for k in range(60)]),
        ("timestamp", [str(1700000000_123456 + 5_000 * k) for k in range(60)]),
        ("Time (ms)", [str(5 * k) for k in range(60)]),
        ("utc", [f"2024-05-01T10:00:00.{5 * k:03d}Z" for k in range(60)]),
        ("t_s", [f"{k // 20}" for k in range(100)]),
    ],
)
def test_time_has_its_unit_and_coarse_stamps_are_spread(tmp_path: Path, name: str, times: list[str]) -> None:
    rate = 20.0 if name == "t_s" else 200.0
    assert _read(tmp_path, SI.replace("t_s", name), times=times).rate_hz == pytest.approx(rate, rel=1e-6)


def test_slow_steps_without_a_unit_are_asked_for(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="steps of 5: s, ms, us or ns"):
        _read(tmp_path, SI.replace("t_s", "time"), times=[str(5 * k) for k in range(60)])


@pytest.mark.parametrize("late", ["alternate", "burst", "random"])
def test_uneven_stamps_without_a_missing_sample_are_told(tmp_path: Path, late: str) -> None:
    rng = np.random.default_rng(4)
    time_s = 0.005 * np.arange(1, 801)
    if late == "alternate":
        time_s[::2] += 0.003
    elif late == "burst":
        time_s[300:308] = time_s[308] - 1e-4 * np.arange(8, 0, -1)
    else:
        time_s = np.sort(time_s + rng.uniform(0.0, 0.004, time_s.size))
    record = _read(tmp_path, SI, times=[f"{t:.6f}" for t in time_s])
    assert record.rate_hz == pytest.approx(200.0, rel=1e-4)
    assert "uneven" in record.warnings[0] and "gap" not in record.warnings[0]


@pytest.mark.parametrize("jitter", [0.0, 0.003])
def test_a_missing_sample_among_uneven_stamps_is_a_gap(jitter: float) -> None:
    time_s = 0.005 * np.arange(1, 801)
    time_s[::2] += jitter
    found = evenness(np.delete(time_s, [400, 401, 402, 650]))
    assert found.gaps.tolist() == [399, 646] and found.interval_s == pytest.approx(0.005, rel=1e-3)


@pytest.mark.parametrize(
    ("axes", "wanted"),
    [
        ("rfu", [1, 2, 3]),
        ("frd", [2, 1, -3]),
        ("flu", [-2, 1, 3]),
        ("bru", [2, -1, 3]),
        ("ufl", [-3, 2, 1]),
    ],
)
def test_axes_are_turned_to_right_forward_up(tmp_path: Path, axes: Axes, wanted: list[int]) -> None:
    record = _read(tmp_path, SI, (1.0, 2.0, 3.0, 1.0, 2.0, 3.0), axes=axes)
    assert record.increments[0] == pytest.approx(0.01 * np.array(wanted * 2))
