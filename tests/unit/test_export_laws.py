"""Exported laws are the program's own: compiled without a warning, and equal to it call by call."""

import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.engine.drivers.common import law_of, network_of, seen_by
from navcore.engine.environment import environment
from navcore.exporting.form import Form
from navcore.exporting.law_form import law_form
from navcore.exporting.replay import INPUTS
from navcore.exporting.step import NO_SAMPLE, NOT_YET, SAMPLE
from navcore.exporting.subject import Subject, subject_of
from navcore.exporting.vectors import inputs_along
from navcore.foundation.errors import InputError
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.mechanization.error_model import ErrorModelRun
from navcore.mechanization.recorder import make_recorder
from navcore.networks.catalogue import NETWORKS
from navcore.scenario.model import Scenario
from tests.exported import busy_inputs, called, compiler, library

needs_compiler = pytest.mark.skipif(not compiler(), reason="no C compiler")
BATCH = 20
"""Laws compiled at a time."""
EXTERNAL = {"damping": "external", "network": {"id": "unity2"}}
FEW: list[dict[str, Any]] = [
    {"damping": "free"},
    EXTERNAL,
    {"damping": "internal", "network": {"id": "classic3"}},
    {"damping": "external", "network": {"id": "compass"}},
    {"damping": "external", "network": {"id": "compass"}, "policy": {"id": "schedule"}},
    {"damping": "external", "network": {"id": "optimal", "realisation": "feedback"}},
    {
        **EXTERNAL,
        "network": {"id": "complementary"},
        "policy": {"id": "threshold"},
        "switching": {"id": "ramp"},
    },
    {**EXTERNAL, "policy": {"id": "yaw_rate"}, "switching": {"id": "keep"}},
    {**EXTERNAL, "policy": {"id": "acceleration"}, "switching": {"id": "step"}},
    {**EXTERNAL, "policy": {"id": "variation"}, "switching": {"id": "bumpless"}},
    {**EXTERNAL, "policy": {"id": "variation"}, "switching": {"id": "bridge", "output": "corrected"}},
    {**EXTERNAL, "policy": {"id": "adaptive"}},
    {**EXTERNAL, "azimuth": {"id": "unity2"}},
    {"damping": "internal", "network": {"id": "unity2"}, "azimuth": {"id": "complementary"}},
    {**EXTERNAL, "gyrocompass": {}, "policy": {"id": "threshold"}},
    {"damping": "external", "network": {"id": "compass"}, "policy": {"id": "mobility"}},
    {**EXTERNAL, "azimuth": {"id": "unity2"}, "policy": {"id": "states"}, "switching": {"id": "step"}},
]
"""One law for each part of the law."""


def subject(method: dict[str, Any], **blocks: Any) -> Subject:
    """A method of a short scenario."""
    data = {"reference": {"kind": "log"}, "run": {"duration_h": 1.0}, "method": [method], **blocks}
    return Subject(Scenario.parse(data), 0, 1.0)


def every_law() -> list[dict[str, Any]]:
    """Every network, policy, switching method and kind of damping that go together."""
    found = []
    for damping in ("internal", "external"):
        for network in NETWORKS:
            for policy in POLICIES:
                for switching in SWITCHINGS:
                    parts = {"network": network, "policy": policy, "switching": switching}
                    method = {"damping": damping, **{name: {"id": id} for name, id in parts.items()}}
                    found += [method, {**method, "azimuth": {"id": "unity2"}}, {**method, "gyrocompass": {}}]
    return found


def deviations(subjects: list[Subject], inputs: np.ndarray, folder: Path) -> list[float]:
    """Largest deviation of each exported law from the program's own, of the peak of each output."""
    forms = [(f"law{i}", law_form(one, inputs)) for i, one in enumerate(subjects)]
    laws = library(forms, folder)
    return [deviation(form, called(laws, prefix, form, inputs)) for prefix, form in forms]


def deviation(form: Form, found: np.ndarray) -> float:
    """Largest deviation, of the peak of each output."""
    peak = np.max(np.abs(form.expected), axis=0)
    off = np.max(np.abs(found - form.expected), axis=0)
    return float(np.max(off / np.where(peak > 0.0, peak, 1.0)))


@needs_compiler
def test_each_part_of_the_law_is_exported_as_it_runs(tmp_path: Path) -> None:
    inputs = busy_inputs()
    for method, off in zip(FEW, deviations([subject(one) for one in FEW], inputs, tmp_path), strict=True):
        assert off <= 1e-12, method


@needs_compiler
@pytest.mark.slow
@pytest.mark.timeout(900)
def test_every_law_of_the_catalogue_is_exported_as_it_runs(tmp_path: Path) -> None:
    inputs, subjects = busy_inputs(), []
    for method in every_law():
        try:
            subjects.append(subject(method))
        except InputError:
            continue  # parts that do not go together
    assert len(subjects) > 900
    for at in range(0, len(subjects), BATCH):
        batch = subjects[at : at + BATCH]
        for one, off in zip(batch, deviations(batch, inputs, tmp_path / str(at)), strict=True):
            assert off <= 1e-12, one.method


@needs_compiler
@pytest.mark.parametrize("rate_hz", [0.25, 8.0])
def test_another_rate_is_another_law(tmp_path: Path, rate_hz: float) -> None:
    one = subject_of(subject(FEW[9]).scenario, "", rate_hz, hours=0.1)
    assert one.step_s == 1.0 / rate_hz
    assert deviations([one], busy_inputs(2000, one.step_s), tmp_path)[0] <= 1e-12


def corrections(one: Subject) -> np.ndarray:
    """Corrections c of the run itself, shape (calls, 2), m/s: the error model, step by step."""
    scenario, method = one.scenario, one.method
    env, step_s = environment(scenario), one.step_s
    law = law_of(method, network_of(scenario, method), step_s)
    recorder = make_recorder(env.steps, step_s, step_s)
    run = ErrorModelRun(
        step_s, env.steps, env.coefficients, env.sensors, seen_by(method, env.reference), law,
        np.array(scenario.initial_error.state()), recorder,
    )  # fmt: skip
    found = []
    for _ in range(env.steps + 1):
        run.advance(1)
        found.append(np.array(law.s["correction"][:2]))
    return np.array(found)


LOGS: list[dict[str, Any]] = [
    {"kind": "log", "noise_mps": 0.1, "outage": [{"t_h": 0.05, "duration_s": 90.0}]},
    {"kind": "log", "noise_mps": 0.1, "rate_hz": 0.3, "outage": [{"t_h": 0.05, "duration_s": 90.0}]},
    {"kind": "log", "noise_mps": 0.05, "frame": "body", "rate_hz": 4.0},
]


@pytest.mark.parametrize("log", LOGS)
@pytest.mark.parametrize("method", [FEW[1], FEW[9]])
def test_vectors_are_the_run(method: dict[str, Any], log: dict[str, Any]) -> None:
    """From outside the law gives the corrections of the run itself: hold, outage, axes of the log."""
    motion = {
        "kind": "legs",
        "leg": [{"duration_s": 300.0, "speed_mps": 6.0}, {"turn_dps": 0.5, "duration_s": 60}],
    }
    errors = {"attitude_arcmin": [1.0, 1.0, 5.0], "velocity_mps": [0.3, 0.2]}
    scenario = subject(
        method, reference=log, motion=motion, initial_error=errors, run={"duration_h": 0.15}
    ).scenario
    one = Subject(
        scenario.model_copy(update={"run": scenario.run.model_copy(update={"output_step_s": 1.0})}), 0, 1.0
    )
    form, run = law_form(one), corrections(one)
    computed = form.given[:, [INPUTS.index("v_e_mps"), INPUTS.index("v_n_mps")]]
    peak = np.max(np.abs(run))
    assert peak > 1e-3
    np.testing.assert_allclose(form.expected[:, :2] - computed, run, rtol=0.0, atol=1e-10 * peak)


def test_a_caller_may_leave_the_last_sample_standing() -> None:
    """A log at 0.2 Hz: the sample again, none, or the word for none yet are all the same."""
    one = subject(FEW[1], reference={"kind": "log", "rate_hz": 0.2})
    inputs = busy_inputs(600)
    word, log = INPUTS.index("log_valid"), [INPUTS.index("log_e_mps"), INPUTS.index("log_n_mps")]
    between = np.arange(600) % 5 != 0
    inputs[:, word] = np.where(between, NOT_YET, SAMPLE)
    expected = law_form(one, inputs).expected
    assert np.any(expected[:, 0] != inputs[:, 0])
    none = inputs.copy()
    none[between, word] = NO_SAMPLE
    standing = inputs.copy()
    standing[:, word] = SAMPLE
    standing[:, log] = np.repeat(inputs[::5][:, log], 5, axis=0)
    for other in (none, standing):
        np.testing.assert_array_equal(law_form(one, other).expected, expected)


def test_without_a_sample_the_last_one_counts_for_the_time_of_the_run() -> None:
    one = subject(FEW[1])
    inputs = busy_inputs(300)
    inputs[:, INPUTS.index("log_valid")] = np.where(np.arange(300) < 100, SAMPLE, NOT_YET)
    damped = law_form(one, inputs).expected[:, 5]
    assert np.flatnonzero(damped == 0.0)[0] == 99 + 1 + 5  # held for 5 s


@needs_compiler
@pytest.mark.parametrize("method", [FEW[10], FEW[13]])
def test_sanitizers_find_nothing(tmp_path: Path, method: dict[str, Any]) -> None:
    """Addresses and undefined behaviour, over the vectors."""
    from navcore.exporting.target_c import double_bounds, files

    form = law_form(subject(method), busy_inputs(2000))
    for name, text in files(form, "law", False, double_bounds(form)).items():
        (tmp_path / name).write_text(text)
    command = f"{compiler()} -std=c99 -Wall -Wextra -Werror -Wconversion -g -fsanitize=address,undefined"
    subprocess.run([*command.split(), "law.c", "test.c", "-lm", "-o", "t"], cwd=tmp_path, check=True)
    done = subprocess.run(["./t", "vectors.csv"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


def test_inputs_have_the_run_in_them() -> None:
    """One row a call, from t = 0 on, with the log's words."""
    inputs = inputs_along(subject_of(subject(FEW[1]).scenario, hours=0.1))
    assert inputs.shape == (361, len(INPUTS))
    assert set(inputs[:, INPUTS.index("log_valid")]) == {SAMPLE}
