"""What a run on a ship's own INS shows: the INS as recorded before the methods, and velocity minus log."""

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from navcore.engine.measures import metrics
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.engine.to_log import lines_to_log, to_log
from navcore.motion.truth import VE, VN
from navcore.quantities import COMPONENTS
from navcore.questions.run import Ran
from navcore.scenario.model import Scenario
from schuler_bench.jobs.rows import few_rows
from schuler_bench.session.display import Display
from schuler_bench.session.shown import Shown, window_of
from schuler_bench.shell.opening import as_json
from schuler_bench.views.errors.figure import error_plots
from schuler_bench.views.errors.view import legend_html
from schuler_bench.views.metrics.table import metrics_html
from schuler_bench.views.scene.graticule import needed
from schuler_bench.views.scene.moment import pendulum, pendulum_svg
from schuler_bench.views.scene.track import track
from schuler_bench.views.spectrum.figure import spectrum
from schuler_bench.views.strip.view import strip_html
from tests.own_ins import on_ins
from tests.unit.test_own_ins_faults import recorded

METHODS = [
    {"name": "unity2", "damping": "external", "network": "unity2"},
    {"name": "compass", "damping": "external", "network": {"id": "compass", "sigma": 0.0025, "xi": 0.7}},
]
NAMES = ["as recorded", "unity2", "compass"]


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    return recorded(tmp_path_factory.mktemp("ins"))


@pytest.fixture(scope="module")
def run(files: dict[str, str]) -> Run:
    return simulate(on_ins(files, METHODS))


def told(value: float | None) -> float:
    assert value is not None
    return value


def columns(path: str) -> dict[str, np.ndarray]:
    with Path(path).open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def test_the_ins_as_recorded_stands_first_in_every_picture(run: Run) -> None:
    plot = error_plots(run)["dve"]
    assert list(plot.names) == NAMES
    assert len(set(curve.color for curve in plot.curves)) == 3
    worst = np.nanmax(np.abs(plot.curves[0].values)) * plot.unit.si
    assert worst == pytest.approx(run.lines[0].errors["dve_mps"]["max_abs"])
    assert [trace["name"] for trace in spectrum(run, "dve")["data"]] == NAMES
    strip = strip_html(Shown(run, 1, Display()), 0)
    assert strip.index("as recorded") < strip.index("unity2") and strip.count("sb-result") == 3
    assert strip.count("edit-method") == 2
    assert "as recorded" in legend_html(run)
    assert metrics_html(run.with_recorded).index("as recorded") < metrics_html(run.with_recorded).index(
        "unity2"
    )


def test_what_no_reference_tells_is_left_out_of_the_3d_view(run: Run) -> None:
    assert run.against is not None and "phi_e_rad" in run.against.not_known
    assert pendulum(run, 3600.0).bobs == ()
    assert "nan" not in pendulum_svg(pendulum(run, 3600.0))
    for one in track(run).methods:
        assert np.isfinite(one.points).all() and len(one.points) > 100
    line = np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 0.0, 0.0], [np.nan, 0.0, 0.0]])
    assert needed(line, 0.1).tolist() == [0, 1, 2]


def test_a_window_and_a_pin_measure_the_ins_as_recorded_too(run: Run) -> None:
    window = window_of(run, Display(window="hours", window_from_h=1.0, window_to_h=2.0))
    whole, part = run.lines[0], window.run.lines[0]
    inside = (whole.t_s >= 3600.0) & (whole.t_s <= 7200.0)
    column = whole.rows[inside, COMPONENTS.index("dve_mps")]
    assert part.errors["dve_mps"]["rms"] == pytest.approx(np.sqrt(np.mean(column**2)))
    kept = few_rows(run, 50)
    assert all(
        len(one.rows) == len(one.output) == len(kept.t_s) for one in kept.lines if one.output is not None
    )
    assert len(kept.against.to_log) == len(kept.t_s) <= 52


def test_velocity_minus_log_is_that_of_the_files(run: Run, files: dict[str, str]) -> None:
    ins, log = columns(files["ins"]), columns(files["log"])
    epochs = log["t_s"]
    heading = np.radians(np.interp(epochs, ins["t_s"], ins["heading_deg"]))
    east = log["speed_mps"] * np.sin(heading)
    near = 0.5 * (run.t_s[1] - run.t_s[0])
    read = np.array([np.mean(east[np.abs(epochs - t_s) <= near]) for t_s in run.t_s])
    found = to_log(run)[:, 0]
    # of the end rows the mean lies to one side, of a ship that turns
    assert np.max(np.abs(found - (run.truth[:, VE] - read))[1:-1]) < 0.02
    rows = run.methods[1].rows[:, COMPONENTS.index("dve_mps")]
    recorded = run.lines[0].rows[:, COMPONENTS.index("dve_mps")]
    assert np.max(np.abs(to_log(run, run.methods[1])[:, 0] - (rows - recorded + found))) < 1e-3


def test_damping_takes_the_84_minute_line_out_of_velocity_minus_log(run: Run) -> None:
    lines = lines_to_log(run)
    assert list(lines) == NAMES
    for axis in ("ve", "vn"):
        before, after = (lines[name][axis] for name in ("as recorded", "compass"))
        assert told(after["schuler_mps"]) < 0.3 * told(before["schuler_mps"])
        assert before["earth_mps"] is None and told(before["rms_mps"]) > told(after["rms_mps"])
    document = metrics(run)
    assert document["velocity_minus_log"] == lines
    assert "as recorded" in json.loads(as_json(document))["velocity_minus_log"]
    text = "\n".join(Ran(run).lines())
    assert "velocity minus log" in text and "east: 84 min" in text


def test_a_line_of_known_amplitude_is_given_as_it_is(run: Run) -> None:
    t_s = run.t_s
    omega = run.scenario.omega_s
    wave = np.column_stack([0.8 * np.sin(omega * t_s), 0.2 + 0.3 * np.cos(omega * t_s)])
    wave[len(t_s) // 2 : len(t_s) // 2 + 5] = np.nan
    found = lines_to_log(replace(run, against=replace(run.against, to_log=wave)))["as recorded"]
    assert found["ve"]["schuler_mps"] == pytest.approx(0.8, rel=0.05)
    assert found["vn"]["schuler_mps"] == pytest.approx(0.3, rel=0.05)


def test_the_spectrum_shows_velocity_minus_log_before_and_after(run: Run) -> None:
    figure = spectrum(run, "ve_log")
    assert [trace["name"] for trace in figure["data"]] == NAMES
    heights = {trace["name"]: float(np.max(trace["y"].full)) for trace in figure["data"]}
    assert heights["compass"] < 0.3 * heights["as recorded"]


def test_velocity_minus_log_needs_no_reference(files: dict[str, str]) -> None:
    run = simulate(on_ins(files, METHODS, truth=False))
    assert [trace["name"] for trace in spectrum(run, "vn_log")["data"]] == NAMES
    assert to_log(run).shape == (len(run.t_s), 2)
    moved = run.methods[0].rows[:, COMPONENTS.index("dvn_mps")]
    assert np.allclose(to_log(run, run.methods[0])[:, 1] - to_log(run)[:, 1], moved, atol=1e-9)
    assert run.truth[:, VN].any()


def test_a_run_on_no_ins_shows_its_error_in_the_place_of_velocity_minus_log() -> None:
    plain = simulate(Scenario.parse({"run": {"duration_h": 0.5}, "method": [{"name": "free"}]}))
    assert spectrum(plain, "ve_log")["layout"] == spectrum(plain, "dve")["layout"]
    assert "velocity_minus_log" not in metrics(plain)
