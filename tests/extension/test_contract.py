"""The contract of the program as a plugin of pytest: a user holds a class of his own against it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.recipes import recipes

FAULTY = '''
from typing import Literal
import navcore
from navcore.foundation.parameters import quantity
from navcore.law.hosted import UserLaw
from navcore.networks.base import NetworkParameters, linear_network

@navcore.register
class Lag(NetworkParameters):
    """A network without a source, with a field that nothing tells of."""

    title = "Lag"
    id: Literal["lag"] = "lag"
    corner: float = 2.0

    def transfer(self, omega_s):
        return linear_network("lag", omega_s, [1.0, 2.0], [1.0, 2.0])

CALLS = [0]

@navcore.register
class Forgetful(UserLaw):
    """Its state outlives the run."""

    id = "forgetful"

    def start(self, at):
        def step(given):
            CALLS[0] += 1
            return given.v_e_mps + 1e-6 * CALLS[0], given.v_n_mps

        return step
'''


def held(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run pytest with the plugin in an empty folder."""
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-p",
        "schuler_bench.contract.plugin",
        "-p",
        "no:cacheprovider",
    ]
    environment = os.environ | {"PYTHONPATH": os.getcwd()}
    command += ["-q", "-rA", "--rootdir", str(folder), *arguments]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def test_classes_of_the_guide_hold_the_contract(tmp_path: Path, repo_root: Path) -> None:
    """Those of CONTRIBUTING.md as they stand there, each registered by a file."""
    found = recipes((repo_root / "CONTRIBUTING.md").read_text("utf-8"))
    names = "network", "policy", "switching method", "motion", "kind of damping", "sensor error"
    for name in names:
        ((path, text),) = [(path, text) for kind, path, text in found[name] if kind == "file"]
        (tmp_path / Path(path).name).write_text(text, "utf-8")
    plugin = tmp_path / "mine.py"
    plugin.write_text(
        "import sys\nfrom pathlib import Path\n"
        "sys.path.insert(0, str(Path(__file__).parent))\nimport navcore\n"
        "from lead import LeadNetwork\nfrom turns import Turns\nfrom waiting import Waiting\n"
        "from eight import EightMotion\nfrom moored import Moored\nfrom trend import Trend\n"
        "for one in (LeadNetwork, Turns, Waiting, EightMotion, Moored, Trend):\n    navcore.register(one)\n"
    )
    ended = held(tmp_path, "--schuler-plugin", str(plugin))
    assert ended.returncode == 0, ended.stdout[-6000:] + ended.stderr[-2000:]
    for name in ("network lead: it runs: strapdown", "motion eight: its truth is consistent"):
        assert f"PASSED schuler::{name}" in ended.stdout or name in ended.stdout


def test_what_does_not_hold_it_is_named_and_the_rest_is_judged(tmp_path: Path) -> None:
    plugin = tmp_path / "faulty.py"
    plugin.write_text(FAULTY)
    ended = held(tmp_path, "--schuler-plugin", str(plugin))
    assert ended.returncode == 1, ended.stderr
    assert "Lag.corner has no help" in ended.stdout
    assert "Lag has no source" in ended.stdout
    assert "keeps state" in ended.stdout
    assert "network lag: it runs: error_model" in ended.stdout


def test_a_file_that_registers_nothing_is_a_usage_error(tmp_path: Path) -> None:
    plugin = tmp_path / "empty.py"
    plugin.write_text("x = 1\n")
    ended = held(tmp_path, "--schuler-plugin", str(plugin))
    assert ended.returncode == 4
    assert "registers nothing" in ended.stderr


def test_without_the_option_pytest_is_as_it_was(tmp_path: Path) -> None:
    assert held(tmp_path).returncode == pytest.ExitCode.NO_TESTS_COLLECTED
