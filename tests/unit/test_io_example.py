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
    assert ["of a Schuler period" in warning for warning in run.warnings] == [False, True]
    assert run.t_s[-1] == pytest.approx(713.0, abs=1.0)
    # A level ship at 10 kn with a perfect log: the velocity stays near its initial error.
    for method in run.methods[1:]:
        assert np.abs(method.rows[:, 3:5]).max() < 0.5


@pytest.mark.parametrize(
    ("missing", "override", "said"),
    [
        ("", "run.duration_h=0.3", r"lasts 720\.0 s = 0\.2000 h"),
        ("gyro.txt", "run.seed=1", r"'.*gyro\.txt': no such file"),
        ("", 'motion.file="{folder}/gnss.txt"', r".*: holds no heading"),
    ],
    ids=["too long", "missing", "no heading"],
)
def test_recordings_that_do_not_serve_are_refused(example, missing, override, said):
    if missing:
        (example.parent / missing).unlink()
    with pytest.raises(InputError, match=r"motion\.file = .*" + said):
        simulate(load(str(example), [override.format(folder=example.parent)]))
