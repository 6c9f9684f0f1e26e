"""The recordings that come with the program: their IMU and licences, and the runs on them, in any clone."""

from pathlib import Path

import numpy as np
import pytest

from navcore.alignment.fine import coarse_alignment
from navcore.checks.file import check_file
from navcore.checks.imu import IMU_CHECKER
from navcore.engine.simulation import simulate
from navcore.foundation.earth import WGS84
from navcore.foundation.units import DEG, DEG_PER_HOUR
from navcore.mechanization.strapdown.attitude import angles_of
from navcore.scenario.file import load
from navcore.sensors.recorded_imu import check_rest, read_imu

SHARED_S = 714.0


@pytest.fixture(scope="module")
def recordings(repo_root: Path) -> Path:
    return repo_root / "assets" / "recordings"


def test_the_recordings_are_small_understood_and_licensed(recordings: Path) -> None:
    files = sorted(recordings.glob("*.csv"))
    assert [file.stem for file in files] == ["lasergyro-1s", "sikuliaq-log", "sikuliaq-track"]
    assert sum(file.stat().st_size for file in files) < 500_000
    assert all(check_file(file, [IMU_CHECKER]).ok for file in files)
    licences = (recordings / "LICENCES.md").read_text(encoding="utf-8")
    assert "David Pablo Cohn" in licences and "Gongmin Yan" in licences
    assert all(file.name in licences for file in files)


def test_the_example_runs_on_them(repo_root: Path) -> None:
    run = simulate(load(str(repo_root / "examples" / "sikuliaq.toml")))
    assert [m.method.name for m in run.methods] == ["free", "classic2", "complementary"]
    assert [m.status for m in run.methods] == ["ok"] * 3
    assert run.t_s[-1] == pytest.approx(SHARED_S, abs=1.0)
    assert any("of a Schuler period" in warning for warning in run.warnings)


def test_the_parked_imu_measures_gravity_the_earths_rate_and_its_heading(recordings: Path) -> None:
    record = read_imu(recordings / "lasergyro-1s.csv", "frd")
    lat, quiet = 34.246048 * DEG, record.increments[570:950]
    check_rest(record, WGS84.gravity(lat, 380.0), 570.0, 950.0)
    mean = quiet.mean(axis=0) * record.rate_hz
    assert np.linalg.norm(mean[3:]) == pytest.approx(9.7955, abs=1e-3)
    assert np.linalg.norm(mean[:3]) / DEG_PER_HOUR == pytest.approx(14.94, abs=0.1)
    pitch, roll, heading = np.array(angles_of(*coarse_alignment(quiet, record.rate_hz, lat))) / DEG
    # The file's own heading is -90.6 deg, counted counter-clockwise.
    assert heading == pytest.approx(90.6, abs=1.0)
    assert abs(pitch) < 2.0 and abs(roll) < 2.0
