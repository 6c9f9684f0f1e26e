"""Studies of a session: what they are of, what is refused, stopped and gone on with; their pictures."""

import io
import threading
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest

from navcore.engine.measures import measure
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.quantities import limit_unit
from navcore.questions.study import StudyQuestion
from navcore.scenario.file import load
from navcore.study.crossed import crossed
from navcore.study.plan import Plan
from navcore.study.results import RUNS_FILE, Folder
from navcore.study.studied import Studied
from navcore.study.study import carry_out
from schuler_bench.jobs.asking import Asker
from schuler_bench.session.document import restore, to_document
from schuler_bench.session.session import Session
from schuler_bench.session.studying import (
    MOST_RUNS,
    NOTHING,
    chosen_task,
    is_study,
    left_of,
    run_scenario,
    uploaded_study,
)
from schuler_bench.views.study.figure import MET, series_figure, study_figure
from schuler_bench.views.study.table import metrics_of, study_html

_SHORT = ["run.duration_h=0.2", "reference.noise_mps=0.1", "imu.gyro_arw_dpsh=0.01"]
_LIMIT = "requirement=[{quantity='tilt_rms_arcsec', at_most=4.0}]"
_FILE = """
schema = 1
title = "Two latitudes"
scenario = "zha-fast"
set = ["run.duration_h=0.1"]
seeds = 2
[[factor]]
field = "site.lat_deg"
values = [10, 60]
"""


@pytest.fixture(scope="module")
def ship() -> Any:
    """A ship on legs, with a limit."""
    return load("sikuliaq-like", [*_SHORT, _LIMIT])


@pytest.fixture
def session(ship: Any, tmp_path: Path) -> Any:
    """One visitor's session."""
    made = Session("of-studies", ship, "test", tmp_path / "files")
    yield made
    made.close()


def done(task: StudyQuestion, path: Path) -> Studied:
    """Result of a study, all of whose runs are carried out."""
    plan = Plan(task.study, task.where)
    folder = Folder(path, plan)
    with folder.opened(resume=False):
        document = carry_out(plan, folder, 2)
    return Studied(document, (path / RUNS_FILE).read_bytes())


def test_the_scenario_is_crossed_over_two_quantities(ship, session, tmp_path):
    session.show(None, study_x="latitude", study_y="method.2.network.zeta", study_seeds=2)
    task = chosen_task(session)
    grid = [factor.column for factor in task.study.factor]
    assert grid == ["latitude", "method.2.network.zeta"] and task.scenario is ship
    present = ship.method[2].network.zeta
    assert present in task.study.factor[1].values
    document = done(task, tmp_path / "out").summary
    cells = {(*cell["factors"].values(),): cell["methods"] for cell in document["cells"]}
    assert len(cells) == len(task.study.factor[0].values) * len(task.study.factor[1].values)
    runs = [simulate(Plan(task.study).seeded(ship, seed)) for seed in (0, 1)]
    for place, method in enumerate(ship.method):
        want = np.median([measure(run.methods[place], "tilt_rms_arcsec", 0.0) for run in runs])
        found = next(v for key, v in cells.items() if key == (repr(ship.site.lat_deg), present))[place]
        assert found["name"] == method.name
        got = found["metrics"]["tilt_rms_arcsec"]["median"] * limit_unit("tilt_rms_arcsec")
        assert got == pytest.approx(want, rel=1e-9)


def test_what_cannot_be_varied_is_refused_with_its_reason(session):
    session.show(None, study_x="latitude", study_y="latitude")
    with pytest.raises(InputError, match="twice"):
        chosen_task(session)
    session.show(None, study_x="method.0.network.xi", study_y=NOTHING)
    with pytest.raises(InputError):
        chosen_task(session)
    session.show(None, study="../../etc/passwd")
    with pytest.raises(InputError, match="must be one of"):
        chosen_task(session)


def test_a_study_that_is_too_large_for_a_page_says_how_long_it_takes(session):
    session.study_file = "large.toml", _FILE.replace("seeds = 2", f"seeds = {MOST_RUNS}")
    session.show(None, study="uploaded")
    with pytest.raises(InputError, match=r"is 40000 runs, about .* min; on the page at most 20000 runs"):
        chosen_task(session)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('scenario = "/etc/hostname"', "must be the name of a preset"),
        ('scenario = "zha-fast"\nset = ["reference.file=/etc/hostname"]', "reads no recordings"),
        ('scenario = "zha-fast"\nset = ["imu={file=\'/etc/hostname\'}"]', "reads no recordings"),
        (
            'scenario = "zha-fast"\n[[factor]]\nfield = "reference.file"\nvalues = ["/etc/hostname"]',
            "reads no recordings",
        ),
        (
            'scenario = "zha-fast"\n[[factor]]\nfield = "reference"\nvalues = [{file = "/etc/hostname"}]',
            "reads no recordings",
        ),
        ('seeds = 2\n[scenario.motion]\nkind = "track"\nfile = "/etc/hostname"', "reads no recordings"),
        (
            f'scenario = "zha-fast"\n[[factor]]\nfield = "site.lat_deg"\nvalues = {[*range(301)]}',
            "at most 300",
        ),
        (
            'scenario = "zha-fast"\n[[factor]]\nfield = "site.lat_deg"\nvalues = [95.0]',
            r"factor\.0\.values\.0",
        ),
        ('scenario = "zha-fast"\nseeds = -1', "seeds"),
    ],
)
def test_an_uploaded_study_reads_no_file_of_the_server(text, words):
    assert is_study(text)
    with pytest.raises(InputError, match=words):
        uploaded_study("mine.toml", text)


def test_an_uploaded_study_outlives_the_server_and_a_scenario_is_none(session, ship, tmp_path):
    assert (
        is_study(_FILE) and not is_study('title = "a scenario"\n[run]\nduration_h = 1') and not is_study("[")
    )
    session.study_file = "mine.toml", _FILE
    session.show(None, study="uploaded")
    other = Session("another", ship, "test", tmp_path / "other")
    restore(other, to_document(session))
    task = chosen_task(other)
    assert task.where == "mine.toml" and task.scenario is None
    assert run_scenario(task, 3).site.lat_deg == 60 and run_scenario(task, 0).site.lat_deg == 10
    assert run_scenario(task, 1).run.seed == run_scenario(task, 0).run.seed + 1
    with pytest.raises(InputError, match="must be >= 0 and < 4"):
        run_scenario(task, 4)
    other.close()


def test_what_was_stopped_is_gone_on_with_and_nothing_runs_twice(ship, tmp_path, monkeypatch):
    import navcore.study.study

    task = StudyQuestion(study=crossed(ship, ["latitude", "log_bias"], 2), scenario=ship)
    whole = done(task, tmp_path / "whole")
    ran: list[int] = []
    halted = threading.Event()
    real = navcore.study.study.run_points

    def counted(plan: Plan, numbers: Any, stopped: Any) -> Any:
        for number, rows in real(plan, numbers, stopped):
            ran.append(number)
            yield number, rows
            if len(ran) == 9 and not halted.is_set():
                halted.set()
                studier.halt()

    monkeypatch.setattr(navcore.study.study, "run_points", counted)
    studier = Asker(lambda: None, StudyQuestion)
    try:
        studier.begin(task)
        assert halted.wait(60.0) and studier.wait_idle(60.0)
        assert studier.result is not None and not studier.result.complete
        part, left = studier.result.summary["runs"], left_of(studier)
        assert 9 <= part < whole.summary["runs"] and left is not None
        studier.begin(left)
        assert studier.wait_idle(60.0)
        assert studier.result.complete and left_of(studier) is None
    finally:
        studier.stop()
    assert sorted(ran) == [*range(whole.summary["runs"])]
    assert studier.result.summary["methods"] == whole.summary["methods"]
    assert pq.read_table(io.BytesIO(studier.result.runs)) == pq.read_table(io.BytesIO(whole.runs))


def test_the_worst_runs_are_those_of_the_rows_and_can_be_run_again(ship, tmp_path):
    task = StudyQuestion(study=crossed(ship, ["latitude"], 4), scenario=ship)
    found = done(task, tmp_path / "out")
    table = pq.read_table(io.BytesIO(found.runs)).to_pylist()
    for method in found.summary["methods"]:
        own = [row for row in table if row["method"] == method["name"]]
        want = sorted(own, key=lambda row: -row["tilt_max_arcsec"])[:5]
        worst = method["worst"]["tilt_max_arcsec"]
        assert [one["run"] for one in worst] == [row["run"] for row in want]
        assert [one["value"] for one in worst] == [row["tilt_max_arcsec"] for row in want]
        assert [one["factors"]["latitude"] for one in worst] == [row["latitude"] for row in want]
    place, method = 1, found.summary["methods"][1]
    one = method["worst"]["tilt_max_arcsec"][0]
    again = simulate(run_scenario(task, one["run"])).methods[place]
    assert measure(again, "tilt_max_arcsec", 0.0) / limit_unit("tilt_max_arcsec") == one["value"]
    html = study_html(found.summary, "tilt_max_arcsec", method["name"])
    assert html.count("data-command") == 5 and f"open-study-run {one['run']}" in html
    assert "data-command" not in study_html(found.summary, "tilt_max_arcsec", method["name"], buttons=False)


def test_runs_that_diverge_come_first_among_the_worst(tmp_path):
    # a log that speaks every 500 s makes the fast network's loop unstable
    text = _FILE.replace("0.1", "24.0").replace("site.lat_deg", "reference.rate_hz")
    study = uploaded_study("mine.toml", text.replace("[10, 60]", "[1.0, 0.002]"))
    found = done(StudyQuestion(study=study), tmp_path / "out").summary
    free, fast = found["methods"][0], found["methods"][2]
    assert fast["diverged"] == 2 and free["diverged"] == 0
    worst = fast["worst"]["tilt_rms_arcsec"]
    assert [(one["status"], one["value"] is None) for one in worst] == [
        ("diverged", True),
        ("diverged", True),
        ("ok", False),
        ("ok", False),
    ]
    assert [one["factors"]["reference.rate_hz"] for one in worst] == [0.002, 0.002, 1.0, 1.0]
    html = study_html(found, "tilt_rms_arcsec", fast["name"])
    assert html.count("diverged") == 3 and "none" in html


def test_map_curves_factors_and_tables_show_the_summary(ship, tmp_path):
    task = StudyQuestion(study=crossed(ship, ["latitude", "log_bias"], 2), scenario=ship)
    document = done(task, tmp_path / "two").summary
    name, keys = document["methods"][1]["name"], metrics_of(document)
    assert keys[-1] == MET
    drawn = study_figure(document, "tilt_rms_arcsec", name, 0.4)
    texts = {note["text"] for note in drawn["layout"]["annotations"]}
    assert len(drawn["layout"]["shapes"]) == len(document["cells"])
    cell = document["cells"][7]["methods"][1]["metrics"]["tilt_rms_arcsec"]["median"]
    assert f"{cell:.3g}" in texts
    (bars,) = [trace for trace in drawn["data"] if trace["type"] == "bar"]
    tornado = document["methods"][1]["tornado"]["tilt_rms_arcsec"]
    assert bars["base"] == [one["least"] for one in tornado][::-1]
    met = study_figure(document, MET, name, 0.4)
    assert not [trace for trace in met["data"] if trace["type"] == "bar"]
    one = done(StudyQuestion(study=crossed(ship, ["latitude"], 3), scenario=ship), tmp_path / "one").summary
    curves = study_figure(one, "tilt_rms_arcsec", name, 0.4)["data"]
    assert [curve["name"] for curve in curves[:3]] == [method["name"] for method in one["methods"]]
    medians = [cell["methods"][1]["metrics"]["tilt_rms_arcsec"]["median"] for cell in one["cells"]]
    assert curves[1]["y"] == medians
    assert "alone the best" in study_html(one, "tilt_rms_arcsec", name)


def test_a_study_without_a_grid_and_one_with_series_are_drawn(ship, tmp_path):
    seeds = crossed(ship, [], 6)
    found = done(StudyQuestion(study=seeds), tmp_path / "seeds").summary
    points = study_figure(found, "tilt_rms_arcsec", found["methods"][0]["name"], 0.4)["data"]
    assert [len(one["y"]) for one in points] == [1] * len(found["methods"])
    output = seeds.output.model_copy(update={"series": ("phi_e_rad",), "epochs_h": (0.05, 0.1, 0.2)})
    timed = done(StudyQuestion(study=seeds.model_copy(update={"output": output})), tmp_path / "series")
    rows = pq.read_table(io.BytesIO(timed.runs)).to_pylist()
    method = timed.summary["methods"][2]
    own = [row["phi_e_rad@0.1h"] for row in rows if row["method"] == method["name"]]
    assert method["series"]["phi_e_rad"]["median"][1] == pytest.approx(float(np.median(own)), rel=1e-12)
    assert timed.summary["epochs_h"] == [0.05, 0.1, 0.2]
    assert len(series_figure(timed.summary, "phi_e_rad", 0.4)["data"]) == 3 * len(found["methods"])
