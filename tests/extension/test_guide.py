"""Every example of CONTRIBUTING.md is put into one copy of the program, where the contract tests pass.

The guide's own text is taken: the block behind ``<!-- file: PATH -->`` is the file PATH; of the block behind
``<!-- line: PATH -->`` the first line stands in PATH already and the second one is written below it.
"""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.recipes import RUN, recipes

RECIPES = (
    "network",
    "kind of damping",
    "policy",
    "switching method",
    "motion",
    "sensor error",
    "question",
    "tab",
    "import format",
)
_LEFT_OUT = shutil.ignore_patterns(".git", ".venv", "__pycache__", "build", ".*_cache")
pytestmark = pytest.mark.timeout(1500)  # the kernels of the changed program are compiled


def follow(blocks: list[tuple[str, str, str]], folder: Path) -> None:
    """Do in a copy of the program what a recipe says."""
    for kind, name, text in blocks:
        path = folder / name
        if kind == "file":
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
            continue
        present, added = text.splitlines()
        registry = path.read_text(encoding="utf-8")
        assert registry.count(f"{present}\n") == 1, f"{name} has no line {present}"
        path.write_text(registry.replace(f"{present}\n", f"{present}\n{added}\n"), encoding="utf-8")


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory, repo_root: Path) -> Iterator[Path]:
    """Copy of the program with all examples of the guide in it."""
    folder = tmp_path_factory.mktemp("copy") / "program"
    shutil.copytree(repo_root, folder, symlinks=True, ignore=_LEFT_OUT)
    for blocks in recipes((folder / "CONTRIBUTING.md").read_text(encoding="utf-8")).values():
        follow(blocks, folder)
    yield folder
    shutil.rmtree(folder)


def python(program: Path, *arguments: str) -> str:
    """Run Python in the copy; return what it prints."""
    cache = str(program.parent / "cache")
    environment = os.environ | {"PYTHONPATH": str(program), "SCHULER_CACHE_DIR": cache}
    command = [sys.executable, *arguments]
    ended = subprocess.run(command, cwd=program, env=environment, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stdout[-10_000:] + ended.stderr[-10_000:]
    return ended.stdout


def test_the_guide_has_every_recipe(repo_root: Path) -> None:
    found = recipes((repo_root / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    assert tuple(found) == RECIPES
    for name, blocks in found.items():
        assert {kind for kind, _, _ in blocks} == {"file", "line"}, name
        assert sum(kind == "line" for kind, _, _ in blocks) == 1, f"{name}: one line of a registry"


@pytest.mark.slow
def test_the_contract_tests_pass_with_all_examples(program: Path) -> None:
    for module in (
        "scenario.guide",
        "scenario.schema_file",
        "analysis.network_table",
        "questions.page",
    ):  # make guide
        python(program, "-m", f"navcore.{module}")
    python(program, "-m", "ruff", "check", ".")
    python(program, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-m", "contract", "tests/unit")


def test_the_examples_run_in_both_fidelities(program: Path) -> None:
    """Policy and switching decide at their seconds; on the new motion both fidelities err alike."""
    runs = json.loads(python(program, "-c", RUN))
    for fidelity, run in runs.items():
        waiting, hard = run["law"]
        for k, (wanted, damped, _, measure) in enumerate(waiting):
            turn, second = divmod(k, 60)
            assert measure == turn and wanted == float(turn % 2 == 0), fidelity
            assert damped == float(turn % 2 == 0 and second >= 15), fidelity
        assert [row[1] for row in hard] == [float(k // 90 % 2 == 0) for k in range(len(hard))], fidelity
        assert (
            run["moored"][0] == run["moored"][1] and run["moored budget"][0] == run["moored budget"][1] > 0.0
        )
        assert run["source"] == pytest.approx(np.sqrt(np.mean(np.square(run["trend"]))), rel=1e-3), fidelity
        assert run["steady"] == ["imu.gyro_trend_dph: gyro trend is not in the budget"]
    assert np.array(runs["error_model"]["tilt"]).min() > 0.0
    for errors in ("tilt", "trend"):
        np.testing.assert_allclose(runs["strapdown"][errors], runs["error_model"][errors], rtol=1e-3)


def test_the_command_line_shows_the_network(program: Path) -> None:
    report = json.loads(
        python(program, "-m", "schuler_bench", "network", 'id = "lead", corner = 0.5', "--json")
    )
    assert report["id"] == "lead" and report["stable"]
    assert report["h0"] == pytest.approx(1.0)


def test_the_format_is_read_and_its_faults_name_the_line(program: Path, tmp_path: Path) -> None:
    lines = [json.dumps({"utc_s": 1.7e9 + i, "speed_mps": 5.0 + i}) for i in range(3)]
    good, bad = tmp_path / "good.jsonl", tmp_path / "bad.jsonl"
    good.write_text("\n".join(lines))
    bad.write_text("\n".join([*lines, '{"utc_s": 2}']))
    report = json.loads(python(program, "-m", "schuler_bench", "check", str(good), "--json"))
    assert report["kind"] == "JSON Lines log" and report["quantities"]["water"]["forward_mps"] == [5.0, 7.0]
    call = f"from navcore.io.recording import load\ntry: load({str(bad)!r})\nexcept ValueError as e: print(e)"
    assert 'line 4: expected "utc_s" and "speed_mps"' in python(program, "-c", call)


ASKED = """
import json
from schuler_bench.jobs import helper
from schuler_bench.jobs.searches import Searches
from schuler_bench.shell.view import View
from schuler_bench.editing import form
from schuler_bench.views import load
from navcore import exceed, load as scenario
from navcore.questions import QUESTIONS

if __name__ == "__main__":
    question = QUESTIONS["exceed"]
    (ship,) = (scenario("zha-fast", ["run.duration_h=1"]),)
    here = exceed(ship, limit_m=500.0).document()  # the kernels are compiled now
    helper.start()
    asker = Searches("test").asking["exceed"]
    asker.begin(question.ask({"scenario": ship, "limit_m": 500.0}))
    assert asker.wait_idle(900.0), "no answer"
    of_views = {id for kind in load() for id in kind.asks}
    spec, = form.fields(question, ("exceed",))
    print(json.dumps({
        "words": asker.words,
        "here": here,
        "helped": asker.result.document(),
        "html": asker.result.html(),
        "page": "exceed" not in of_views,
        "control": [spec.label, spec.slider.low, spec.slider.high],
    }))
    helper.stop()
"""


def test_the_question_is_asked_by_command_function_job_and_page(program: Path, tmp_path: Path) -> None:
    script = tmp_path / "asked.py"
    script.write_text(ASKED)
    found = json.loads(python(program, str(script)))
    command = ["exceed", "zha-fast", "--set", "run.duration_h=1", "--limit-m", "500", "--json"]
    document = json.loads(python(program, "-m", "schuler_bench", *command))
    assert found["words"] == []
    assert document == found["here"] == found["helped"] and set(document["first_h"]) >= {"free"}
    assert found["page"] and "<table" in found["html"]
    assert found["control"] == ["position error (m)", 100.0, 10000.0]
    python(program, "-m", "navcore.questions.page")
    page = (program / "docs" / "interface.md").read_text("utf-8")
    assert "### `schuler exceed SCENARIO`" in page and "| `--limit-m LIMIT_M` | `1852.0` |" in page


@pytest.mark.nightly
def test_the_whole_unit_stage_passes_with_all_examples(program: Path) -> None:
    python(program, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests/unit")
