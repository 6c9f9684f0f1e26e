"""A study that is killed twenty times at random, and stopped once, ends as one that was left alone."""

import itertools
import json
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from navcore.study.plan import plan_of
from navcore.study.results import Folder
from schuler_bench.cli import main
from tests.studies import LATITUDE, NOISE, SHIP, stored, write

KILLS, SEEDS = 20, 180
RUNS = 2 * 8 * SEEDS
"""More work than one and twenty commands do that keep a part each, on a machine twice as fast."""


def command(study: str, folder: Path, workers: str = "1") -> subprocess.Popen[bytes]:
    """The command in a process of its own."""
    arguments = [sys.executable, "-m", "schuler_bench", "study", study, "--out", str(folder), "--resume"]
    return subprocess.Popen(
        [*arguments, "--workers", workers], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )


def parts(folder: Path) -> set[Path]:
    """Parts that are complete."""
    return {*folder.glob("parts/[0-9]*.parquet")}


def further(process: subprocess.Popen[bytes], folder: Path, within_s: float) -> bool:
    """Wait until the command has kept another part; False when it has not within that time."""
    there, until = parts(folder), time.monotonic() + within_s
    while parts(folder) <= there and process.poll() is None:
        if time.monotonic() > until:
            return False
        time.sleep(0.005)
    return True


@pytest.mark.slow
@pytest.mark.timeout(400)
def test_killed_twenty_times_it_ends_as_if_left_alone(tmp_path):
    scenario = {**SHIP, "run": {"duration_h": 24.0, "seed": 7}}
    blocks = {"factor": [LATITUDE, NOISE], "sample": {"points": 8}, "seeds": SEEDS}
    study = write(tmp_path / "study.toml", scenario=scenario, **blocks)
    folder = tmp_path / "killed"
    chance = random.Random(26)
    kept: list[tuple[int, int]] = []
    told = b""
    for number in [signal.SIGKILL] * KILLS + [signal.SIGINT]:
        process = command(study, folder)
        # while it works, or at any time before: a part or two each, so no machine is done too early
        working = number == signal.SIGINT or chance.random() < 0.4
        if working:
            assert further(process, folder, 100.0)
            time.sleep(chance.uniform(0.0, 0.1))
        else:
            further(process, folder, chance.uniform(0.0, 1.5))
        process.send_signal(number)
        _, told = process.communicate()
        assert process.returncode == (3 if number == signal.SIGINT else -number), told.decode()
        done = Folder(folder, plan_of(study)).done()
        # a part that is there stays as it is, and no run is in two
        assert {*kept} <= {*done} and len({*kept}) + working <= len(done)
        assert all(end <= after for (_, end), (after, _) in itertools.pairwise(done))
        kept = done
    assert "--resume goes on" in told.decode()
    assert json.loads((folder / "summary.json").read_text())["status"] == "stopped"
    _, told = (process := command(study, folder, "2")).communicate()
    assert process.returncode == 0, told.decode()
    assert {*folder.iterdir()} == {folder / name for name in ("runs.parquet", "study.toml", "summary.json")}
    assert main(["study", study, "--out", str(tmp_path / "alone"), "--quiet"]) == 0
    rows = stored(folder)
    assert [(row["run"], row["method"]) for row in rows[::2]] == [(run, "free") for run in range(RUNS)]
    assert rows == stored(tmp_path / "alone")
    assert (folder / "summary.json").read_text() == (tmp_path / "alone" / "summary.json").read_text()
