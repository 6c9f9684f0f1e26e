"""A package outside the repository adds one of each kind, and they run on page, command, study and jobs.

Its classes are those of the recipes in CONTRIBUTING.md, in modules of its own. Nothing of the program is
changed or compiled anew.
"""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.recipes import RUN, recipes

TAKEN = (
    "network",
    "kind of damping",
    "policy",
    "switching method",
    "motion",
    "sensor error",
    "import format",
)
REGISTERED = """
import navcore
from own_methods import json_lines
from own_methods.eight import EightMotion
from own_methods.lead import LeadNetwork
from own_methods.moored import Moored
from own_methods.trend import Trend
from own_methods.turns import Turns
from own_methods.waiting import Waiting

for thing in (LeadNetwork, Moored, Turns, Waiting, EightMotion, Trend, json_lines):
    navcore.register(thing)
"""
SCENARIO = """
[run]
duration_h = 0.1
[motion]
kind = "eight"
[imu]
gyro_trend_dph = 0.24
[reference]
kind = "log"
[[method]]
damping = "external"
network = { id = "lead" }
policy = { id = "turns" }
switching = { id = "waiting" }
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory, repo_root: Path) -> Iterator[Path]:
    """Folder of an installed package with the classes of the recipes, and an entry point."""
    folder = tmp_path_factory.mktemp("site")
    package, info = folder / "own_methods", folder / "own_methods-1.0.dist-info"
    package.mkdir()
    info.mkdir()
    found = recipes((repo_root / "CONTRIBUTING.md").read_text("utf-8"))
    for name in TAKEN:
        ((path, text),) = [(path, text) for kind, path, text in found[name] if kind == "file"]
        (package / Path(path).name).write_text(text, "utf-8")
    (package / "__init__.py").write_text("")
    (package / "methods.py").write_text(REGISTERED)
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: own-methods\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[schuler_bench.methods]\nours = own_methods.methods\n")
    (folder / "case.toml").write_text(SCENARIO)
    yield folder


def python(folder: Path, *arguments: str, code: int = 0) -> str:
    """Run Python where the package is installed; return what it prints."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(folder), os.getcwd()])}
    command = [sys.executable, *arguments]
    ended = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert ended.returncode == code, ended.stdout[-5000:] + ended.stderr[-5000:]
    return ended.stdout


def test_all_of_it_runs_in_both_fidelities(installed: Path) -> None:
    runs = json.loads(python(installed, "-c", RUN))
    for fidelity, run in runs.items():
        waiting, hard = run["law"]
        for k, (wanted, damped, _, measure) in enumerate(waiting):
            turn, second = divmod(k, 60)
            assert measure == turn and wanted == float(turn % 2 == 0), fidelity
            assert damped == float(turn % 2 == 0 and second >= 15), fidelity
        assert [row[1] for row in hard] == [float(k // 90 % 2 == 0) for k in range(len(hard))], fidelity
        assert run["moored"][0] == run["moored"][1]
        assert run["source"] == pytest.approx(np.sqrt(np.mean(np.square(run["trend"]))), rel=1e-3), fidelity
    np.testing.assert_allclose(runs["strapdown"]["tilt"], runs["error_model"]["tilt"], rtol=1e-3)


COMPILED = """
from navcore.foundation.compiled import COMPILATION
from navcore import load, simulate
simulate(load({case!r}))
print(COMPILATION.count, COMPILATION.seconds)
"""


def test_an_added_class_is_compiled_once_and_no_kernel_anew(installed: Path) -> None:
    code = COMPILED.format(case=str(installed / "case.toml"))
    python(installed, "-c", code)
    count, _ = python(installed, "-c", code).split()
    assert count == "0"


def test_the_command_runs_it_and_reads_its_format(installed: Path, tmp_path: Path) -> None:
    case = str(installed / "case.toml")
    document = json.loads(python(installed, "-m", "schuler_bench", "run", case, "--json"))
    assert document["methods"][0]["status"] == "ok"
    export = ["export", case, "--as", "c", "--out", str(tmp_path / "law")]
    assert python(installed, "-m", "schuler_bench", *export, code=2) == ""
    log = tmp_path / "log.jsonl"
    log.write_text("\n".join(json.dumps({"utc_s": 1.7e9 + i, "speed_mps": 5.0 + i}) for i in range(3)))
    report = json.loads(python(installed, "-m", "schuler_bench", "check", str(log), "--json"))
    assert report["kind"] == "JSON Lines log"


STUDY = """
scenario = "case.toml"
seeds = 2
[[factor]]
field = "method.0.network.ratio"
values = [5.0, 10.0]
"""


def test_a_study_varies_a_field_of_it(installed: Path) -> None:
    (installed / "study.toml").write_text(STUDY)
    document = json.loads(
        python(installed, "-m", "schuler_bench", "study", str(installed / "study.toml"), "--json")
    )
    assert "lead" in json.dumps(document)


JOB = """
import json
from navcore import load
from navcore.questions import QUESTIONS
from schuler_bench.jobs import helper
from schuler_bench.jobs.searches import Searches

if __name__ == "__main__":
    helper.start()
    asker = Searches("test").asking["budget"]
    asker.begin(QUESTIONS["budget"].ask({{"scenario": load({case!r})}}))
    assert asker.wait_idle(120.0), "no answer"
    print(json.dumps(asker.result.document()))
    helper.stop()
"""


def test_a_process_of_the_server_is_given_what_a_file_registered(installed: Path, tmp_path: Path) -> None:
    """A file that is named to the server alone: the helper gets its text with the job."""
    plugin, script = tmp_path / "mine.py", tmp_path / "job.py"
    plugin.write_text(REGISTERED)
    script.write_text(
        f"from navcore.extending.plugins import load_file\nassert not load_file({str(plugin)!r})\n"
        + JOB.format(case=str(installed / "case.toml"))
    )
    (installed / "own_methods-1.0.dist-info").rename(installed / "away")
    try:
        document = json.loads(python(installed, str(script)))
    finally:
        (installed / "away").rename(installed / "own_methods-1.0.dist-info")
    assert any('policy "turns" looks at the data' in text for text in document["methods"][0]["warnings"])


OFFERED = """
import json
from navcore.scenario.method import Method
from navcore.sensors.imu import Imu
from navcore import load
from schuler_bench.editing import edits, form
from schuler_bench.views.method.view import _catalogue

case = load({case!r})
offered = {{part: _catalogue(part, ("method", 0)).choices for part in ("network", "policy", "switching")}}
offered["damping"] = next(s for s in form.fields(Method, ("method", 0)) if s.path[-1] == "damping").choices
offered["imu"] = [spec.path[-1] for spec in form.fields(Imu, ("imu",))]
edited = edits.with_choice(case, ("method", 0, "policy", "id"), "constant")
edited = edits.with_value(edited, ("method", 0, "damping"), "internal")
print(json.dumps([offered, edited.method[0].damping]))
"""


def test_the_page_offers_it(installed: Path) -> None:
    code = OFFERED.format(case=str(installed / "case.toml"))
    offered, damping = json.loads(python(installed, "-c", code))
    assert damping == "internal"
    assert "lead" in offered["network"] and "turns" in offered["policy"] and "waiting" in offered["switching"]
    assert "moored" in offered["damping"] and "gyro_trend_dph" in offered["imu"]


FAULTY = """
from typing import Literal
import navcore
from navcore.law.policy.base import PolicyParameters
from navcore.networks.base import NetworkParameters, linear_network

@navcore.register
class Idle(PolicyParameters):
    id: Literal["idle"] = "idle"

@navcore.register
class Unity(NetworkParameters):
    id: Literal["unity2"] = "unity2"

    def transfer(self, omega_s):
        return linear_network("unity2", omega_s, [1.0], [1.0])

@navcore.register
class Nothing(NetworkParameters):
    id: Literal["nothing"] = "nothing"

@navcore.register
class Stranger:
    pass

@navcore.register
class Plain(NetworkParameters):
    id: Literal["plain"] = "plain"

    def transfer(self, omega_s):
        return linear_network("plain", omega_s, [10.0, 7.0], [1.0, 7.0])

raise RuntimeError("at the end")
"""


def test_faults_name_class_and_line_and_stop_nothing_else(tmp_path: Path) -> None:
    plugin = tmp_path / "faulty.py"
    plugin.write_text(FAULTY)
    command = [sys.executable, "-m", "schuler_bench", "network", "plain", "--plugin", str(plugin), "--json"]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    assert json.loads(ended.stdout)["h0"] == 1.0
    lines = ended.stderr.splitlines()
    assert lines[0].startswith("faulty.py:7: Idle: must have decide")
    assert lines[1] == 'faulty.py:11: Unity: id "unity2" is used twice'
    assert lines[2] == "faulty.py:18: Nothing: must define transfer()"
    assert lines[3].startswith("faulty.py:22: Stranger: must be derived from one of NetworkParameters")
    assert lines[4:] == ["faulty.py:33: RuntimeError: at the end"]


def test_a_plugin_that_is_not_there_is_refused(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "schuler_bench", "presets", f"--plugin={tmp_path / 'none.py'}"]
    ended = subprocess.run(command, capture_output=True, text=True, check=False)
    assert ended.returncode == 2 and "must be a file that registers methods" in ended.stderr
