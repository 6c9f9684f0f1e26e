"""A ``%`` begins a comment in many tables; only numbers below it make an IMU of a file."""

from pathlib import Path

import pytest

from navcore.checks.imu import recognises


@pytest.mark.parametrize(
    ("text", "imu"),
    [
        ("% track\n% UTC latitude(deg) longitude(deg)\n2023/01/09 10:00:00.0 44.0 8.0\n", False),
        ("% log\nutc,lat,lon\n2023-01-09T10:00:00Z,44,8\n", False),
        ("% a record\n\n 0.1 0.2 1e-3 0 0 -0.5 % attitude\n", True),
    ],
)
def test_numbers_below_decide(tmp_path: Path, text: str, imu: bool) -> None:
    assert recognises(tmp_path / "x", text.encode()) is imu
