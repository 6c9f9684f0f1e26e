"""A study that is killed twenty times at random, and stopped once, ends as one that was left alone."""

import json
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

from navcore.study.plan import plan_of
from navcore.study.results import Folder
from schuler_bench.cli import main
from tests.studies import LATITUDE, NOISE, SHIP, stored, write

KILLS, RUNS = 20, 2 * 8 * 100


def command(study: str, folder: Path) -> subprocess.Popen[bytes]:
    """The command in a process of its own."""
    arguments = [sys.executable, "-m", "schuler_bench", "study", study, "--out", str(folder), "--resume"]
    return subprocess.Popen([*arguments, "--workers", "2"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def interrupted(
    process: subprocess.Popen[bytes], folder: Path, after_s: float, number: signal.Signals
) -> None:
    """Send a signal so long after another part has come; the command must not have ended before."""
    there = {*folder.glob("parts/[0-9]*.parquet")}
    until = time.monotonic() + 60.0
    while {*folder.glob("parts/[0-9]*.parquet")} <= there and process.poll() is None:
        assert time.monotonic() < until
        time.sleep(0.005)
    time.sleep(after_s)
    process.send_signal(number)


def test_killed_twenty_times_it_ends_as_if_left_alone(tmp_path, monkeypatch):
    scenario = {**SHIP, "run": {"duration_h": 24.0, "seed": 7}}
    blocks = {"factor": [LATITUDE, NOISE], "sample": {"points": 8}, "seeds": 100}
    study = write(tmp_path / "study.toml", scenario=scenario, **blocks)
    folder = tmp_path / "killed"
    chance = random.Random(26)
    kept: list[tuple[int, int]] = []
    told = b""
    for kill in range(KILLS + 1):
        process = command(study, folder)
        stopped = kill == KILLS
        wait_s = chance.uniform(0.0, 0.3)
        interrupted(process, folder, wait_s, signal.SIGINT if stopped else signal.SIGKILL)
        _, told = process.communicate(timeout=60)
        assert process.returncode == (3 if stopped else -signal.SIGKILL), told.decode()
        done = Folder(folder, plan_of(study)).done()
        # a part that is there stays as it is, and no run is in two
        assert {*kept} < {*done} and all(
            end <= after for (_, end), (after, _) in zip(done, done[1:], strict=False)
        )
        kept = done
    assert "--resume goes on" in told.decode()
    assert json.loads((folder / "summary.json").read_text())["status"] == "stopped"
    process = command(study, folder)
    _, told = process.communicate(timeout=120)
    assert process.returncode == 0, told.decode()
    assert main(["study", study, "--out", str(tmp_path / "alone"), "--quiet"]) == 0
    rows = stored(folder)
    assert [(row["run"], row["method"]) for row in rows[::2]] == [(run, "free") for run in range(RUNS)]
    assert rows == stored(tmp_path / "alone")
    assert (folder / "summary.json").read_text() == (tmp_path / "alone" / "summary.json").read_text()
