"""``schuler bench``: that it measures what it says. How fast this machine is, is not tested."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import pytest

from app.bench.dashboard import DESIGN, slider_to_frame_ms
from app.bench.error_model import day
from app.bench.process import Server
from app.bench.rounds import median_ratio, timed_rounds
from app.bench.strapdown import YARDSTICK, measure_strapdown
from app.bench.strapdown_day import KALMAN, strapdown_day
from app.cli import main
from app.cli.bench_text import bench_text

NUMBERS = {
    "error_model_24h_ms_per_method": 12.34567,
    "error_model_24h_cold_ms": 60.0,
    "run_24h_memory_mb": 59.0,
    "strapdown_free_ns_per_sample": 60.0,
    "strapdown_damped_ns_per_sample": 62.0,
    "strapdown_imu_rate_ns_per_sample": 110.0,
    "strapdown_batch_ns_per_sample_run": 14.0,
    "strapdown_batch_noise_ns_per_sample_run": 33.0,
    "imu_simulation_ns_per_sample": 75.0,
    "strapdown_24h_100hz_s": 1.7,
    "strapdown_24h_100hz_mb": 230.0,
    "strapdown_24h_100hz_kalman_s": 4.0,
    "slider_to_frame_ms_p50": 55.0,
    "slider_to_frame_ms_p95": 69.0,
    "slider_design_ms_p50": 60.0,
    "slider_design_ms_p95": 75.0,
    "startup_s": 0.9,
    "rss_mb": 250.0,
}


def test_json_is_one_document_of_numbers(capsys, monkeypatch):
    monkeypatch.setattr("app.bench.bench", lambda tell: NUMBERS)
    assert main(["bench", "--json"]) == 0
    document = json.loads(capsys.readouterr().out)
    assert document == {**NUMBERS, "error_model_24h_ms_per_method": 12.3457}


def test_people_get_units_and_goals(capsys, monkeypatch):
    monkeypatch.setattr("app.bench.bench", lambda tell: NUMBERS)
    assert main(["bench"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 1 + len(NUMBERS)
    (start,) = (line for line in lines if "process start to page served" in line)
    assert "0.9" in start and "<= 1.5" in start


def test_every_number_has_its_words():
    assert not [key for key in NUMBERS if any(key in line for line in bench_text(NUMBERS))]


def test_a_dashboard_that_does_not_answer_is_one_line(capsys, monkeypatch):
    def fails(tell):
        raise TimeoutError("the dashboard served no page within 30 s")

    monkeypatch.setattr("app.bench.bench", fails)
    assert main(["bench"]) == 3
    assert capsys.readouterr().err == "bench: stopped: the dashboard served no page within 30 s\n"


def test_the_day_is_damped_noisy_and_moving():
    scenario = day(seed=1)
    assert (scenario.run.duration_h, scenario.run.step_s, len(scenario.method)) == (24.0, 1.0, 3)
    assert {method.damping for method in scenario.method} == {"external"}
    assert min(scenario.imu.gyro_arw_dpsh, scenario.imu.accel_vrw_ugpshz, scenario.reference.noise_mps) > 0.0
    assert scenario.motion.kind == "legs"


def test_the_strapdown_day_is_damped_noisy_and_moving():
    scenario = strapdown_day(seed=1)
    assert scenario.strapdown and len(scenario.method) == 2
    assert (scenario.run.duration_h, scenario.run.rate_hz) == (24.0, 100.0)
    assert min(scenario.imu.gyro_arw_dpsh, scenario.imu.accel_vrw_ugpshz, scenario.reference.noise_mps) > 0.0
    assert scenario.motion.kind == "swing"
    filtered = strapdown_day(seed=1, methods=KALMAN)
    assert [method.damping for method in filtered.method] == ["kalman"]
    assert filtered.imu == scenario.imu and filtered.reference == scenario.reference


def test_strapdown_gives_its_keys_and_with_a_yardstick_the_ratios(tmp_path, monkeypatch):
    monkeypatch.delenv(YARDSTICK, raising=False)
    plain = measure_strapdown(rounds=1, seconds=2)
    assert set(plain) == {key for key in NUMBERS if key.endswith(("_per_sample", "_per_sample_run"))}
    assert min(plain.values()) > 0.0
    assert not [key for key in plain if any(key in line for line in bench_text(plain))]
    file = tmp_path / "yardstick.py"
    file.write_text("def quick(samples, repeats):\n    return 50.0 if repeats == 1 else None\n")
    monkeypatch.setenv(YARDSTICK, str(file))
    with_ratios = measure_strapdown(rounds=1, seconds=2)
    assert with_ratios["yardstick_ns_per_sample"] == pytest.approx(50.0)
    for key in plain:
        ratio = with_ratios[key.split("_ns_")[0] + "_to_yardstick"]
        assert ratio == pytest.approx(with_ratios[key] / 50.0)
    assert not [key for key in with_ratios if any(key in line for line in bench_text(with_ratios))]
    monkeypatch.setenv(YARDSTICK, str(tmp_path / "missing.py"))
    with pytest.raises(FileNotFoundError, match=r"no Python file: .*missing\.py"):
        measure_strapdown(rounds=1, seconds=2)


def test_rounds_do_every_work_in_turn_and_leave_out_the_first():
    seen: list[str] = []

    def work(name: str, seconds: list[float]):
        def once() -> float:
            seen.append(name)
            return seconds.pop(0)

        return once

    times = timed_rounds({"a": work("a", [9.0, 2.0, 6.0]), "b": work("b", [9.0, 1.0, 2.0])}, 2)
    assert seen == ["a", "b"] * 3
    assert times == {"a": [2.0, 6.0], "b": [1.0, 2.0]}
    assert median_ratio(times["a"], times["b"]) == 2.5


@pytest.mark.slow
def test_a_slider_is_answered_by_figures_of_a_running_server():
    with Server() as server:
        assert server.startup_s > 0.0
        answers = slider_to_frame_ms(server.port, steps=3)
        design = slider_to_frame_ms(server.port, DESIGN, steps=3)
        assert server.rss_mb() > 50.0
    assert len(answers) == len(design) == 3
    assert min(answers + design) > 1.0  # a run of 24 h and its figures cannot be there sooner


def test_a_compiled_yardstick_is_found_again_in_the_cache(tmp_path):
    file = tmp_path / "compiled_yardstick.py"
    file.write_text(
        "from numba import njit\n@njit(cache=True)\ndef half(x): return 0.5 * x\n"
        "def quick(samples, repeats): return half(100.0)\n"
    )
    program = (
        "from app.bench.strapdown import _yardstick; from numba import config;"
        f"config.CACHE_DIR = {str(tmp_path / 'cache')!r}; print(_yardstick(10)())"
    )
    environment = os.environ | {YARDSTICK: str(file)}
    for _ in range(2):
        ended = subprocess.run(
            [sys.executable, "-c", program], env=environment, capture_output=True, text=True
        )
        assert (ended.returncode, ended.stdout) == (0, "5e-07\n"), ended.stderr
