"""What is asked of a run on a ship's own INS goes by the recording; what rests on its sensors is refused."""

from pathlib import Path

import numpy as np
import pytest

from navcore.design.bands import covariance_bands
from navcore.design.budget import budget
from navcore.design.designs import designs
from navcore.design.tune import tune
from navcore.engine.measures import metrics
from navcore.engine.simulation import simulate
from navcore.engine.verification import verify
from navcore.foundation.errors import InputError
from navcore.quantities import COMPONENTS
from navcore.questions.run import RunQuestion
from navcore.scenario.file import to_toml
from navcore.scenario.model import Scenario
from navcore.study.model import Study
from navcore.study.plan import Plan
from navcore.study.running import run_points
from navcore.study.sweep import sweeps
from schuler_bench.cli.check_scenario import check_scenario
from tests.own_ins import on_ins
from tests.unit.test_own_ins_faults import METHOD, recorded

HOURS = 6.0
FREE = [{"name": "free", "damping": "free"}]
LIMIT = [{"quantity": "velocity_rms_mps", "at_most": 0.7, "from_h": 2.0}]
UNITY = {"name": "unity2", "damping": "external", "network": {"id": "unity2", "zeta": 0.15}}


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    return recorded(tmp_path_factory.mktemp("ins"))


def velocity_rms(scenario: Scenario) -> float:
    errors = simulate(scenario).methods[0].errors
    return float(np.sqrt(0.5 * (errors["dve_mps"]["rms"] ** 2 + errors["dvn_mps"]["rms"] ** 2)))


def test_tuning_goes_by_the_recording(files: dict[str, str]) -> None:
    scenario = on_ins(files, [UNITY], run={"duration_h": 3.0, "step_s": 5.0})
    vary = ["method.0.network.zeta=0.1:0.8"]
    found = tune(scenario, "velocity_rms", vary, default_limits=False, confirm=True)
    assert found.before == pytest.approx(velocity_rms(scenario), rel=1e-6)
    assert found.objective == pytest.approx(velocity_rms(found.scenario), rel=1e-6)
    assert found.before is not None and found.objective < found.before
    assert found.confirmed is None and found.floor is None


@pytest.mark.parametrize(("objective", "truth"), [("tilt_rms", True), ("velocity_rms", False)])
def test_what_no_reference_tells_is_not_tuned_for(files: dict[str, str], objective: str, truth: bool) -> None:
    with pytest.raises(InputError, match=rf"--objective = '{objective}': is not known on this recording"):
        tune(on_ins(files, [UNITY], truth=truth), objective, ["method.0.network.zeta=0.1:0.8"])


def test_designs_as_they_stand_are_judged_by_the_recording(files: dict[str, str]) -> None:
    scenario = on_ins(files, [*FREE, *METHOD], requirement=LIMIT)
    found = designs(scenario, as_set=True)
    assert found.seeds == 1
    assert [(one.method.name, one.met) for one in found.methods] == [
        ("classic2 (external)", 1.0),
        ("free", 0.0),
    ]
    verdicts = [one["requirements"][0]["verdict"] for one in metrics(simulate(scenario))["methods"]]
    assert verdicts == ["missed", "missed", "met"]
    with pytest.raises(InputError, match="--as-set"):
        designs(scenario)


def test_what_rests_on_the_sensors_is_refused(files: dict[str, str]) -> None:
    scenario = on_ins(files, METHOD, run={"duration_h": 1.0})
    for ask in (budget, lambda of: budget(of, steady=True), covariance_bands):
        with pytest.raises(InputError, match=r"ins\.file.*does not tell the errors of its sensors"):
            ask(scenario)
    with pytest.raises(InputError, match="stay inside"):
        verify(scenario)
    with pytest.raises(InputError, match=r"requirement\.0\.quantity.*many seeds"):
        on_ins(files, METHOD, requirement=[LIMIT[0] | {"share": 0.9}])


def test_nothing_is_swept_that_the_recording_fixes(files: dict[str, str]) -> None:
    found = sweeps(
        on_ins(files, METHOD, run={"duration_h": 1.0}), ("latitude", "log_bias", "grade", "sea")
    ).found
    assert all(one.metrics is None and one.words for one in found.values())


def test_a_study_runs_on_the_recording(files: dict[str, str]) -> None:
    scenario = on_ins(files, [UNITY], run={"duration_h": 2.0})
    data = scenario.canonical()
    factor = {"name": "zeta", "field": "method.0.network.zeta", "values": [0.15, 0.5]}
    plan = Plan(Study.model_validate({"scenario": data, "factor": [factor]}))
    rows = [row for _, found in run_points(plan, range(plan.runs), lambda: False) for row in found]
    errors = simulate(scenario).methods[0].errors
    expected = np.hypot(errors["dve_mps"]["rms"], errors["dvn_mps"]["rms"]) / np.sqrt(2.0)
    assert rows[0]["velocity_rms_mps"] == pytest.approx(expected, rel=1e-6)
    assert rows[1]["velocity_rms_mps"] != pytest.approx(expected, rel=1e-2)


def test_the_table_of_a_run_names_the_ins_and_its_place(files: dict[str, str], tmp_path: Path) -> None:
    scenario = on_ins(files, METHOD, run={"duration_h": 1.0})
    lines = "\n".join(RunQuestion(scenario=scenario).answer().lines())
    assert "as recorded" in lines and "54 N" in lines and "361 epochs of the reference" in lines
    path = tmp_path / "scenario.toml"
    path.write_text(to_toml(scenario))
    report = check_scenario(path)
    assert any("the tilt is not known" in text for text in report.warnings)


def test_a_reference_at_a_high_rate_keeps_every_extreme(files: dict[str, str], tmp_path: Path) -> None:
    held = recorded(tmp_path, truth=lambda columns: columns.update(pitch_deg=0.0 * columns["t_s"]))
    scenario = on_ins(held | {"truth": files["ins"]}, METHOD)
    plot = simulate(scenario).methods[0].plot
    curve = plot.values[:, COMPONENTS.index("dve_mps")]
    assert len(plot.t_s) <= 2002 and np.all(np.diff(plot.t_s) >= 0.0)
    peak = simulate(scenario).methods[0].errors["dve_mps"]["max_abs"]
    assert np.max(np.abs(curve)) == pytest.approx(peak, abs=1e-12)
