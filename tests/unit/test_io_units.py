"""Units and qualifiers in the headers of tables: understood, or refused by name."""

from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.io.recording import read_recording
from navcore.io.series import Recording


def _read(folder: Path, header: str, *rows: str) -> Recording:
    path = folder / "table.csv"
    path.write_text("\n".join([header, *rows]) + "\n")
    return read_recording(path)


@pytest.mark.parametrize(
    ("unit", "mps"),
    [
        ("(m s-1)", 1.0), ("[m s^-1]", 1.0), ("(m·s⁻¹)", 1.0), ("(m/s)", 1.0), ("[metres per second]", 1.0),
        ("(knot)", KNOT), ("[kn]", KNOT), ("(km h-1)", 1 / 3.6), ("[mph]", 0.44704), ("(ft/s)", 0.3048),
        ("[mm/s]", 1e-3),
    ],
)  # fmt: skip
def test_a_speed_has_the_unit_in_its_brackets(tmp_path: Path, unit: str, mps: float) -> None:
    read = _read(tmp_path, f"t_s,STW {unit}", "0,6.5", "1,6.5")
    assert read.water is not None
    assert read.water.values[:, 1] == pytest.approx(6.5 * mps)
    assert not read.warnings


@pytest.mark.parametrize(
    ("unit", "rad"),
    [
        ("(degree)", DEG),
        ("[°]", DEG),
        ("(deg T)", DEG),
        ("(° true)", DEG),
        ("[radians]", 1),
        ("(mrad)", 1e-3),
    ],
)
def test_an_angle_has_the_unit_in_its_brackets(tmp_path: Path, unit: str, rad: float) -> None:
    read = _read(tmp_path, f"t_s,Heading {unit}", "0,0.5", "1,0.5")
    assert read.heading is not None
    assert read.heading.values[:, 0] == pytest.approx(0.5 * rad)


@pytest.mark.parametrize(
    "name",
    [
        "STW (furlong/fortnight)",
        "Heading (magnetic)",
        "Heading [deg] (mag)",
        "time (local)",
        "lat (ddmm.mmm)",
    ],
)
def test_brackets_that_are_not_understood_are_refused_by_name(tmp_path: Path, name: str) -> None:
    names = ["t_s", name, "lon"] if name.startswith("lat") else ["t_s", name]
    names = [name, "heading"] if name.startswith("time") else names
    with pytest.raises(InputError) as caught:
        _read(tmp_path, ",".join(names), *(",".join("5" * len(names)) for _ in range(2)))
    assert name in str(caught.value)
    assert "not understood" in str(caught.value)


def test_a_column_that_is_understood_is_taken_before_one_that_is_not(tmp_path: Path) -> None:
    read = _read(tmp_path, "t_s,heading (counts),gyro [deg]", "0,9,30", "1,9,30")
    assert read.heading is not None
    assert read.heading.values[:, 0] == pytest.approx(30 * DEG)


@pytest.mark.parametrize("unit", ["nm", "nmi", "km", "nautical miles"])
def test_a_distance_log_is_no_speed(tmp_path: Path, unit: str) -> None:
    read = _read(tmp_path, f"t_s,heading_deg,Log ({unit})", "0,30,812.5", "1,30,812.6")
    assert read.water is None
    assert any(f"Log ({unit}) left out" in warning for warning in read.warnings)


@pytest.mark.parametrize(
    ("name", "step"),
    [
        ("time (ms)", 250),
        ("t_ms", 250),
        ("time [us]", 250_000),
        ("elapsed (min)", 0.25 / 60),
        ("t [s]", 0.25),
    ],
)
def test_a_time_has_the_unit_of_its_name(tmp_path: Path, name: str, step: float) -> None:
    read = _read(tmp_path, f"{name},heading_deg", *(f"{k * step:.9f},30" for k in range(5)))
    assert read.heading is not None
    assert not read.heading.dated
    assert np.diff(read.heading.time_s) == pytest.approx(0.25, abs=1e-6)


def test_unix_time_in_nanoseconds_is_dated(tmp_path: Path) -> None:
    rows = (f"{1_600_000_000_000_000_000 + k * 500_000_000},30" for k in range(4))
    read = _read(tmp_path, "timestamp [ns],heading_deg", *rows)
    assert read.heading is not None
    assert read.heading.dated
    assert read.heading.time_s[0] == pytest.approx(1.6e9)
