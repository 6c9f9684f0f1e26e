"""The verification report: its matrix is what the command judges, and its page loads nothing."""

import base64
import csv
import hashlib
import io
import json
import re
from pathlib import Path
from typing import Any

import pytest

from navcore.foundation.errors import InputError
from navcore.questions.report import ReportQuestion
from navcore.scenario.clauses import clause_sets, load_clauses
from navcore.scenario.file import load, scenario_hash, to_toml
from navcore.scenario.model import Scenario
from schuler_bench.cli import main

SHIP: dict[str, Any] = {
    "title": "A <ship> under review",
    "run": {"duration_h": 3.0, "step_s": 5.0, "output_step_s": 60.0, "seed": 4},
    "imu": {"gyro_bias_std_dph": 0.01, "accel_bias_std_ug": 50.0, "gyro_arw_dpsh": 0.002},
    "reference": {"kind": "log", "noise_mps": 0.1},
    "method": [
        {"name": "damped", "damping": "external", "network": {"id": "classic2"}},
        {"name": "free", "damping": "free"},
    ],
    "requirement": [
        {"clause": "3.1", "quantity": "position_cep50_m", "at_most": "1 nmi", "at_h": 2.0},
        {
            "clause": "3.2",
            "text": "=tilt, that is",
            "quantity": "tilt_max_arcsec",
            "at_most": 20.0,
            "share": 0.9,
        },
        {"clause": "3.3", "quantity": "settling_s", "at_most": "2 h"},
    ],
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with the ship, its report and its matrix."""
    folder = tmp_path_factory.mktemp("report")
    (folder / "ship.toml").write_text(to_toml(Scenario.parse(SHIP)))
    arguments = ["report", str(folder / "ship.toml"), "--out", str(folder / "report.html"), "--seeds", "40"]
    assert main([*arguments, "--matrix", str(folder / "matrix.csv"), "--quiet"]) == 0
    return folder


def test_the_matrix_has_a_row_for_each_limit_and_method(folder: Path) -> None:
    """With clause, text, quantity, how it was judged, result with interval, and verdict."""
    rows = list(csv.DictReader(io.StringIO((folder / "matrix.csv").read_text("utf-8"))))
    assert [(row["clause"], row["method"]) for row in rows] == [
        (clause, method) for clause in ("3.1", "3.2", "3.3") for method in ("damped", "free")
    ]
    cep, _, tilt, _, settling, never = rows
    assert float(cep["low"]) <= float(cep["result"]) <= float(cep["high"]) and cep["seeds"] == "40"
    assert "40 seeds" in cep["how_judged"] and cep["unit"] == "m"
    assert tilt["text"] == "'=tilt, that is" and tilt["quantity"] == "tilt_max_arcsec"
    assert float(tilt["share_low"]) <= float(tilt["share"]) <= float(tilt["share_high"])
    assert (settling["verdict"], never["verdict"], never["result"]) == ("met", "missed", "")
    assert "loop" in settling["how_judged"]


def test_the_verdicts_are_those_of_the_run(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Where the same seeds judge; the document of the report says what its matrix says."""
    assert main(["report", str(folder / "ship.toml"), "--seeds", "200", "--json", "--quiet"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert main(["run", str(folder / "ship.toml"), "--json", "--quiet"]) == 0
    methods = json.loads(capsys.readouterr().out)["methods"]
    assert report["scenario_sha256"] == scenario_hash(load(str(folder / "ship.toml")))
    judged = {(row["clause"], row["method"]): row for row in report["matrix"]}
    for method in methods:
        for row in method["requirements"]:
            own = judged[row["clause"], method["name"]]
            assert (own["verdict"], own["result"]) == (row["verdict"], row["value"])


def test_the_page_loads_nothing_and_tells_all(folder: Path) -> None:
    page = (folder / "report.html").read_text("utf-8")
    for address in re.findall(r'(?:src|href|url)\s*[=(]\s*"?([^")\s>]+)', page):
        assert address.startswith(("data:", "#")), address
    assert "@import" not in page
    (script,) = re.findall(r"<script>(.*?)</script>", page, re.DOTALL)  # the sliders', by its digest alone
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{digest}' 'wasm-unsafe-eval'\"" in page
    assert re.search(r"fetch|XMLHttp|import\(|https?:|WebSocket|eval\(", script) is None
    assert len(page.encode()) < 1_500_000
    ship = load(str(folder / "ship.toml"))
    for words in (
        scenario_hash(ship), "Schuler Bench", "A &lt;ship&gt; under review", "@page { size: A4",
        "Verification matrix", "Error budget by source", "Worst case of the log", "What was assumed",
        "gyro_white", "from 4 to 43",
    ):  # fmt: skip
        assert words in page, words
    assert page.count('class="sb-d"') == 2 and page.count("<polyline") >= 8
    assert re.search(r"3\.1</td>.*?(met|missed|open)</td>", page, re.DOTALL)


def test_a_file_of_something_else_is_not_replaced(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Nor is the scenario; the report's own files are."""
    other = folder / "other.csv"
    other.write_text("a,b\n1,2\n")
    ship = str(folder / "ship.toml")
    assert main(["report", ship, "--matrix", str(other), "--seeds", "4", "--quiet"]) == 2
    assert "--matrix" in capsys.readouterr().err and other.read_text() == "a,b\n1,2\n"
    assert main(["report", ship, "--out", ship, "--seeds", "4", "--quiet"]) == 2
    again = ["--out", str(folder / "report.html"), "--matrix", str(folder / "matrix.csv")]
    assert main(["report", ship, *again, "--seeds", "40", "--quiet"]) == 0


def test_command_and_button_make_the_same_file(folder: Path) -> None:
    """The button asks the same question, and saves what it is written as."""
    asked = ReportQuestion.ask({"scenario": load(str(folder / "ship.toml")), "seeds": 40})
    assert asked.texts(asked.answer())["report.html"] == (folder / "report.html").read_text("utf-8")


def test_without_limits_and_clauses_there_is_nothing_to_report(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["report", "zha-fast", "--quiet"]) == 2
    assert "requirement" in capsys.readouterr().err
    assert main(["report", "zha-fast", "--clauses", "imo", "--quiet"]) == 2
    assert "imo-a821" in capsys.readouterr().err


# ---------------------------------------------------------------- sets of clauses


@pytest.mark.parametrize("name", ["imo-a821", "imo-a824", "ins-1nmi-24h"])
def test_a_set_of_clauses_prescribes_scenarios_that_can_be_run(name: str) -> None:
    """Each clause once, with its words; methods and sensors are those of the scenario under test."""
    assert name in clause_sets()
    ship = load("sea-gyrocompass")
    found = load_clauses(name)
    assert found.title and found.source and found.tests
    clauses = []
    for test in found.tests:
        scenario = test.of(ship)
        assert scenario.method == ship.method and scenario.imu == ship.imu
        assert scenario.requirement and all(one.clause and one.text for one in scenario.requirement)
        clauses += [one.clause for one in scenario.requirement]
    assert len({*clauses}) == len(clauses)
    assert name != "imo-a821" or len(clauses) == 10


def test_a_set_of_clauses_of_ones_own(tmp_path: Path) -> None:
    """Its faults name field and test."""
    path = tmp_path / "own.toml"
    path.write_text('title = "Own"\n[[test]]\nname = "one"\nscenario = { method = [] }\nlimits = 3\n')
    with pytest.raises(InputError) as refused:
        load_clauses(str(path))
    told = str(refused.value)
    assert "test.0.limits" in told and "test.0.scenario.method" in told and "test.0.requirement" in told
    path.write_text(
        'title = "Own"\n[[test]]\nname = "one"\n[test.scenario.run]\nduration_h = 0.5\n'
        '[[test.requirement]]\nclause = "1"\nquantity = "settling_s"\nat_most = "1 h"\n'
    )
    report = ReportQuestion.ask(
        {"scenario": Scenario.parse({**SHIP, "requirement": []}), "clauses": str(path)}
    )
    rows = report.model_copy(update={"seeds": 2}).answer().matrix
    assert [(row.test, row.method, row.verdict) for row in rows] == [
        ("one", "damped", "met"), ("one", "free", "missed"),
    ]  # fmt: skip
