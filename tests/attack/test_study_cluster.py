"""A study on a Dask cluster of this machine: the rows of a local run; a worker or the scheduler is lost."""

import subprocess
import sys
import time
from pathlib import Path

import pyarrow.parquet as parquet
import pytest

from schuler_bench.bench.process import environment, free_port
from schuler_bench.cli import main
from tests.attack.conftest import eventually
from tests.attack.test_cluster import Machines

pytest.importorskip("distributed", reason="the extra schuler-bench[cluster] is not installed")
pytestmark = [pytest.mark.attack, pytest.mark.timeout(400)]

STUDY = """
schema = 1
title = "noise"
scenario = "sikuliaq-like"
set = ["run.duration_h=6"]
seeds = {seeds}
[[factor]]
field = "reference.noise_mps"
values = [0.05, 0.1, 0.2]
"""


def _study(folder: Path, seeds: int) -> str:
    path = folder / "study.toml"
    path.write_text(STUDY.format(seeds=seeds))
    return str(path)


def _rows(folder: Path) -> list[dict[str, object]]:
    return parquet.read_table(folder / "runs.parquet").to_pylist()


def _done(folder: Path) -> bool:
    return any(folder.glob("*/*.parquet")) or any(folder.glob("*.parquet"))


def test_a_worker_that_dies_leaves_the_rows_of_a_local_run(tmp_path: Path) -> None:
    study = _study(tmp_path, 40)
    assert main(["study", study, "--out", str(tmp_path / "here"), "--quiet"]) == 0
    machines = Machines(tmp_path)
    other = machines.start_worker()
    try:
        words = [sys.executable, "-m", "schuler_bench", "study", study, "--scheduler", machines.address]
        there = tmp_path / "there"
        with subprocess.Popen([*words, "--out", str(there), "--quiet"], env=environment()) as command:
            eventually(lambda: _done(there) or command.poll() is not None, 200.0)
            other.kill()
            assert command.wait(300.0) == 0
        assert _rows(there) == _rows(tmp_path / "here")
    finally:
        other.kill()
        other.wait()
        machines.end()


@pytest.mark.slow
def test_a_lost_scheduler_is_told_and_the_study_goes_on_here(tmp_path: Path) -> None:
    study, out = _study(tmp_path, 200), tmp_path / "out"
    machines = Machines(tmp_path)
    words = [sys.executable, "-m", "schuler_bench", "study", study, "--out", str(out), "--quiet"]
    try:
        with subprocess.Popen(
            [*words, "--scheduler", machines.address], env=environment(), stderr=subprocess.PIPE, text=True
        ) as command:
            eventually(lambda: _done(out) or command.poll() is not None, 200.0)
            machines.end()
            _, said = command.communicate(timeout=200.0)
        assert command.returncode == 2 and "--scheduler" in said
    finally:
        machines.end()
    assert main(["study", study, "--out", str(out), "--resume", "--quiet"]) == 0
    numbers = [(row["run"], row["method"]) for row in _rows(out)]
    assert len(numbers) == len(set(numbers)) == 600 * 3


@pytest.mark.slow
def test_no_scheduler_and_no_address_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    began = time.monotonic()
    address = f"tcp://127.0.0.1:{free_port()}"
    assert main(["study", _study(tmp_path, 1), "--scheduler", address, "--quiet"]) == 2
    said = capsys.readouterr().err
    assert f"--scheduler = '{address}'" in said and "cannot be reached" in said
    assert time.monotonic() - began < 60.0
    assert main(["study", _study(tmp_path, 1), "--scheduler", "somewhere", "--quiet"]) == 2
    assert "must be tcp://HOST:PORT" in capsys.readouterr().err
