"""``schuler bench``: that it measures what it says. How fast this machine is, is not tested."""

import json
import os
import subprocess
import sys

import pytest

from schuler_bench.bench import reading
from schuler_bench.bench.dashboard import DESIGN, slider_to_frame_ms
from schuler_bench.bench.process import Server
from schuler_bench.bench.rounds import median_ratio, timed_rounds
from schuler_bench.bench.runs import KALMAN, day, strapdown_day
from schuler_bench.bench.strapdown import YARDSTICK, measure_strapdown
from schuler_bench.cli import main
from schuler_bench.cli.bench_text import bench_text

NUMBERS = {
    "error_model_24h_ms_per_method": 12.34567,
    "error_model_24h_cold_ms": 60.0,
    "run_24h_memory_mb": 59.0,
    "strapdown_free_ns_per_sample": 60.0,
    "strapdown_damped_ns_per_sample": 62.0,
    "strapdown_imu_rate_ns_per_sample": 110.0,
    "strapdown_batch_ns_per_sample_run": 14.0,
    "strapdown_seeds_ns_per_sample_run": 33.0,
    "imu_simulation_ns_per_sample": 75.0,
    "strapdown_24h_100hz_s": 1.7,
    "strapdown_24h_100hz_mb": 230.0,
    "strapdown_24h_100hz_kalman_s": 4.0,
    "nmea_us_per_sentence": 7.0,
    "imu_csv_ns_per_row": 900.0,
    "imu_parquet_ns_per_row": 150.0,
    "slider_to_frame_ms_p50": 55.0,
    "slider_to_frame_ms_p95": 69.0,
    "slider_design_ms_p50": 60.0,
    "slider_design_ms_p95": 75.0,
    "startup_s": 0.9,
    "rss_mb": 250.0,
}


def assert_told_in_words(numbers) -> None:
    assert not [key for key in numbers if any(key in line for line in bench_text(numbers))]


def test_numbers_are_one_document_or_lines_with_units_and_goals(capsys, monkeypatch):
    monkeypatch.setattr("schuler_bench.bench.bench", lambda tell: NUMBERS)
    assert main(["bench", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == NUMBERS | {"error_model_24h_ms_per_method": 12.3457}
    assert main(["bench"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 1 + len(NUMBERS)
    (start,) = (line for line in lines if "process start to page served" in line)
    assert "0.9" in start and "<= 1.5" in start
    assert_told_in_words(NUMBERS)


def test_recordings_are_read(monkeypatch):
    monkeypatch.setattr(reading, "SECONDS", 20)
    monkeypatch.setattr(reading, "SAMPLES", 200)
    numbers = reading.measure_reading()
    assert len(numbers) == 3 and all(value > 0.0 for value in numbers.values())
    assert_told_in_words(numbers)


def test_a_dashboard_that_does_not_answer_is_one_line(capsys, monkeypatch):
    def fails(tell):
        raise TimeoutError("the dashboard served no page within 30 s")

    monkeypatch.setattr("schuler_bench.bench.bench", fails)
    assert main(["bench"]) == 3
    assert capsys.readouterr().err == "bench: stopped: the dashboard served no page within 30 s\n"


@pytest.mark.parametrize(
    ("scenario", "methods", "motion", "step"),
    [
        (day(seed=1), ["external"] * 3, "legs", 1.0),
        (strapdown_day(seed=1), ["external"] * 2, "swing", 0.01),
        (strapdown_day(seed=1, methods=KALMAN), ["kalman"], "swing", 0.01),
    ],
    ids=["error model", "strapdown", "filter"],
)
def test_the_day_is_damped_noisy_and_moving(scenario, methods, motion, step):
    assert [method.damping for method in scenario.method] == methods
    assert min(scenario.imu.gyro_arw_dpsh, scenario.imu.accel_vrw_ugpshz, scenario.reference.noise_mps) > 0.0
    run = scenario.run
    assert (scenario.motion.kind, run.duration_h) == (motion, 24.0)
    assert (1.0 / run.rate_hz if scenario.strapdown else run.step_s) == step


def test_strapdown_gives_its_keys_and_with_a_yardstick_the_ratios(tmp_path, monkeypatch):
    monkeypatch.delenv(YARDSTICK, raising=False)
    plain = measure_strapdown(rounds=1, seconds=2)
    assert set(plain) == {key for key in NUMBERS if key.endswith(("_per_sample", "_per_sample_run"))}
    assert min(plain.values()) > 0.0
    file = tmp_path / "yardstick.py"
    file.write_text("def quick(samples, repeats):\n    return 50.0 if repeats == 1 else None\n")
    monkeypatch.setenv(YARDSTICK, str(file))
    numbers = measure_strapdown(rounds=1, seconds=2)
    assert_told_in_words(numbers)
    ratios = {f"{key.split('_ns_')[0]}_to_yardstick": numbers[key] / 50.0 for key in plain}
    times = {key: numbers[key] for key in plain}
    assert numbers == pytest.approx({**times, **ratios, "yardstick_ns_per_sample": 50.0})
    monkeypatch.setenv(YARDSTICK, str(tmp_path / "missing.py"))
    with pytest.raises(FileNotFoundError, match=r"no Python file: .*missing\.py"):
        measure_strapdown(rounds=1, seconds=2)


def test_rounds_do_every_work_in_turn_and_leave_out_the_first():
    seen = iter([9.0, 9.5, 2.0, 1.0, 6.0, 2.0])
    times = timed_rounds({"a": lambda: next(seen), "b": lambda: next(seen)}, 2)
    assert times == {"a": [2.0, 6.0], "b": [1.0, 2.0]}
    assert median_ratio(times["a"], times["b"]) == 2.5


@pytest.mark.slow
def test_a_slider_is_answered_by_figures_of_a_running_server():
    with Server() as server:
        assert server.startup_s > 0.0
        answers = [slider_to_frame_ms(server.port, steps=3), slider_to_frame_ms(server.port, DESIGN, steps=3)]
        assert server.rss_mb() > 50.0
    # A run of 24 h and its figures cannot be there sooner than in 1 ms.
    assert [sum(answer > 1.0 for answer in part) for part in answers] == [3, 3]


def test_a_compiled_yardstick_is_found_again_in_the_cache(tmp_path):
    file = tmp_path / "compiled_yardstick.py"
    file.write_text(
        "from numba import njit\n@njit(cache=True)\ndef half(x): return 0.5 * x\n"
        "def quick(samples, repeats): return half(100.0)\n"
    )
    program = (
        "from schuler_bench.bench.strapdown import _yardstick; from numba import config;"
        f"config.CACHE_DIR = {str(tmp_path / 'cache')!r}; print(_yardstick(10)())"
    )
    for _ in range(2):
        ended = subprocess.run(
            [sys.executable, "-c", program],
            env=os.environ | {YARDSTICK: str(file)},
            capture_output=True,
            text=True,
        )
        assert (ended.returncode, ended.stdout) == (0, "5e-07\n"), ended.stderr
