"""A whole law of the user's own, in Python or C, in place of the program's: the exported laws are the oracle.

What is exported from a method and registered again runs as the method does, to the last bit.
"""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from navcore.exporting.law_form import Given as ExportedGiven
from navcore.exporting.step import Commands as ExportedCommands
from navcore.law.hosted import Commands, Given

EXPORTED = """
import json, sys
import navcore
from navcore.law.hosted import UserLaw

sys.path.insert(0, {folder!r} + "/python")
import schuler_law

@navcore.register
class InPython(UserLaw):
    id = "in_python"

    def start(self, at):
        return schuler_law.SchulerLaw().step

if {compiler!r}:
    navcore.register(navcore.c_law({folder!r} + "/c/schuler_law.c", id="in_c"))
    navcore.register(navcore.fmu_law({folder!r} + "/fmu/schuler_law.fmu", id="in_unit"))
data = navcore.load("zha-fast").canonical()
kinds = ["in_python"] + ["in_c", "in_unit"] * bool({compiler!r})
methods = [data["method"][2]] + [{{"name": kind, "damping": kind}} for kind in kinds]
found = {{}}
for fidelity in ("error_model", "strapdown"):
    run = data["run"] | {{"fidelity": fidelity, "duration_h": 0.5}}
    done = navcore.simulate(navcore.Scenario.parse(data | {{"run": run, "method": methods}}))
    assert all(one.status == "ok" for one in done.methods)
    own = done.methods[0].rows[:, :7]
    found[fidelity] = [float(abs(one.rows[:, :7] - own).max()) for one in done.methods]
    found["moved"] = float(abs(own[:, :2]).max())
    found["said"] = [list(one.warnings) for one in done.methods]
print(json.dumps(found))
"""
FAULTY = """
import time
import navcore
from navcore.foundation.parameters import quantity
from navcore.law.hosted import UserLaw

SHARED = [0]

@navcore.register
class Bad(UserLaw):
    "Fails at its fourth call."

    id = "bad"
    limit_s = 0.3
    how: int = quantity(0, ge=0, le=9, label="how", help="What it does.")

    def start(self, at):
        calls = []

        def step(given):
            calls.append(given)
            SHARED[0] += 1
            if self.how == 5:
                return given.v_e_mps + 1e-6 * SHARED[0], given.v_n_mps
            if len(calls) > 3 and self.how == 0:
                raise ValueError("no more")
            if len(calls) > 3 and self.how == 1:
                return float("nan"), 0.0
            if len(calls) > 3 and self.how == 2:
                time.sleep(2.0)
            while len(calls) > 3 and self.how == 3:
                pass
            if len(calls) > 3 and self.how == 4:
                return 3
            return given.v_e_mps, given.v_n_mps

        return step

@navcore.register
class Unstarted(UserLaw):
    id = "unstarted"

    def start(self, at):
        raise KeyError("gain")

@navcore.register
class Empty(UserLaw):
    id = "empty"
"""
RUN = """
import json
import navcore
from navcore.extending.plugins import load_file

found = {{"faults": [str(fault) for fault in load_file({plugin!r})]}}
data = {{"run": {{"duration_h": 0.01}}, "reference": {{"kind": "log"}}}}
methods = [{{"name": "free"}}] + [{{"name": str(i), "damping": "bad", "bad": {{"how": i}}}} for i in range(6)]
for fidelity in ("error_model", "strapdown"):
    run = {{"duration_h": 0.01, "fidelity": fidelity, "rate_hz": 10.0}}
    done = navcore.simulate(navcore.Scenario.parse(data | {{"run": run, "method": methods}}))
    found[fidelity] = [[one.status, one.reason, list(one.warnings)] for one in done.methods]
try:
    navcore.simulate(navcore.Scenario.parse(data | {{"method": [{{"damping": "unstarted"}}]}}))
except navcore.InputError as error:
    found["unstarted"] = str(error)
print(json.dumps(found))
"""


def python(code: str) -> dict[str, object]:
    """Run Python in a process of its own; return the document that it prints."""
    environment = os.environ | {"PYTHONPATH": os.getcwd()}
    ended = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr[-5000:]
    return json.loads(ended.stdout)


def test_a_law_is_given_and_gives_what_an_exported_one_does() -> None:
    assert Given._fields == ExportedGiven._fields
    assert Commands._fields == ExportedCommands._fields[: len(Commands._fields)]


def test_an_exported_law_registered_again_runs_to_the_last_bit(tmp_path: Path) -> None:
    for target in ("python", "c", "fmu"):
        command = ["export", "zha-fast", "--method", "2", "--as", target, "--out", str(tmp_path / target)]
        subprocess.run([sys.executable, "-m", "schuler_bench", *command], check=True, capture_output=True)
    found = python(EXPORTED.format(folder=str(tmp_path), compiler=shutil.which("cc") or ""))
    for fidelity in ("error_model", "strapdown"):
        assert found[fidelity] == [0.0] * len(found["said"])  # pyright: ignore[reportArgumentType]
    assert found["moved"] > 1e-6  # pyright: ignore[reportOperatorIssue]
    assert found["said"][1] == ["the law runs in Python, which takes some microseconds a call"]  # pyright: ignore


@pytest.mark.parametrize("fidelity", ["error_model", "strapdown"])
def test_a_law_that_fails_ends_its_method_alone_and_is_named(
    fidelity: str, faulty: dict[str, list[list[str]]]
) -> None:
    free, raised, nan, slept, looped, wrong, shared = faulty[fidelity]
    assert free[0] == "ok" and shared[0] == "ok"
    for one in (raised, nan, slept, looped, wrong):
        assert one[0] == "stopped" and one[1].startswith('law "bad" (mine.py:9)') and "call 4" in one[1]
    assert "raises ValueError: no more (mine.py:26)" in raised[1]
    assert "gives v_star_e_mps = nan" in nan[1]
    assert "does not return within 0.3 s" in slept[1] and "does not return within 0.3 s" in looped[1]
    assert "gives int, not Commands" in wrong[1]
    assert any("keeps state between methods" in text for text in shared[2])


def test_a_law_that_cannot_be_started_or_lacks_a_part_is_refused(
    faulty: dict[str, list[list[str]]],
) -> None:
    assert faulty["faults"] == ["mine.py:46: Empty: must define start()"]
    assert "mine.py:39: unstarted: raises KeyError: 'gain' (mine.py:44)" in faulty["unstarted"]


@pytest.fixture(scope="module")
def faulty(tmp_path_factory: pytest.TempPathFactory) -> dict[str, object]:
    """What a file with faulty laws does."""
    plugin = tmp_path_factory.mktemp("laws") / "mine.py"
    plugin.write_text(FAULTY)
    return python(RUN.format(plugin=str(plugin)))


def test_c_that_is_no_law_or_does_not_compile_is_refused(tmp_path: Path) -> None:
    if shutil.which("cc") is None:
        pytest.skip("no C compiler")
    none, broken = tmp_path / "none.c", tmp_path / "broken.c"
    none.write_text("int x;\n")
    broken.write_text("void my_step(void) { return 1 +; }\n")
    code = "import json\nfrom navcore.extending.plugins import load_file\n"
    code += f"print(json.dumps([str(f) for n in ({str(none)!r}, {str(broken)!r}) for f in load_file(n)]))"
    first, second = python(code)
    assert first == "none.c: must define PREFIX_init and PREFIX_step, as an exported law does"
    assert second.startswith("broken.c: does not compile: ")
