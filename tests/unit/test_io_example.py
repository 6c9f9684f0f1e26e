"""The example scenario for a user's own recordings runs on any ship's files."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.scenario.file import load
from tests.nmea import ship_files


@pytest.fixture
def example(tmp_path: Path, repo_root: Path) -> Path:
    """The example beside recordings of the names it asks for."""
    files = ship_files(tmp_path, seconds=720)
    files["log"].rename(tmp_path / "speedlog.txt")
    return Path(shutil.copy(repo_root / "examples" / "ship_log.toml", tmp_path))


def test_the_example_runs_on_the_files_beside_it(example):
    run = simulate(load(str(example)))
    assert [method.status for method in run.methods] == ["ok", "ok", "ok"]
    assert ["of a Schuler period" in warning for warning in run.warnings] == [True]
    assert run.t_s[-1] == pytest.approx(713.0, abs=1.0)
    # A level ship at 10 kn with a perfect log: the velocity stays near its initial error.
    for method in run.methods[1:]:
        assert np.abs(method.rows[:, 3:5]).max() < 0.5


def test_a_longer_run_than_the_recordings_is_refused(example):
    with pytest.raises(InputError, match=r"motion\.file = .*lasts 720\.0 s = 0\.2000 h"):
        simulate(load(str(example), ["run.duration_h=0.3"]))


def test_missing_recordings_are_named(example):
    (example.parent / "gyro.txt").unlink()
    with pytest.raises(InputError, match=r"motion\.file = '.*gyro\.txt': no such file"):
        simulate(load(str(example)))


def test_a_track_without_heading_is_refused(example):
    gnss = example.parent / "gnss.txt"
    with pytest.raises(InputError, match=r"motion\.file = .*: holds no heading"):
        simulate(load(str(example), [f'motion.file="{gnss}"']))
