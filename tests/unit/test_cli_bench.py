"""``schuler bench``: that it measures what it says. How fast this machine is, is not tested."""

from __future__ import annotations

import json

import pytest

from app.bench.dashboard import slider_to_frame_ms
from app.bench.error_model import day
from app.bench.process import Server
from app.bench.text import bench_text
from app.cli import main

NUMBERS = {
    "error_model_24h_ms_per_method": 12.34567,
    "error_model_24h_cold_ms": 60.0,
    "run_24h_memory_mb": 59.0,
    "slider_to_frame_ms_p50": 55.0,
    "slider_to_frame_ms_p95": 69.0,
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


@pytest.mark.slow
def test_a_slider_is_answered_by_figures_of_a_running_server():
    with Server() as server:
        assert server.startup_s > 0.0
        answers = slider_to_frame_ms(server.port, steps=3)
        assert server.rss_mb() > 50.0
    assert len(answers) == 3
    assert min(answers) > 1.0  # a run of 24 h and its figures cannot be there sooner
