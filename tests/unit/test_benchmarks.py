"""``python -m tools.benchmarks``: both do the same work; how fast they are is not tested."""

import importlib.util
import json
import sys

import numpy as np
import pytest

import tools.benchmarks.__main__ as command
from navcore.networks.undamped import UndampedNetwork
from schuler_bench.bench.strapdown import StaticRecord
from tools.benchmarks.python_ins import PythonIns

RATIOS = {
    "kernel_to_free": 9.0,
    "kernel_to_damped": 8.0,
    "public_call_to_free": 50.0,
    "public_call_to_damped": 45.0,
}


def test_without_python_ins_one_line_says_what_to_do(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyins", None)
    monkeypatch.setattr(command, "StaticRecord", lambda seconds: StaticRecord(1))
    assert command.main([]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("benchmarks: pyins") and line.endswith("run `make benchmarks`")


@pytest.mark.parametrize(("slow", "code"), [(1.0, 0), (0.5, 1)])
def test_a_missed_goal_is_told_by_the_exit_code(capsys, monkeypatch, slow: float, code: int):
    numbers = {key: slow * value for key, value in RATIOS.items()}
    monkeypatch.setattr(command, "beside_python_ins", lambda rounds: numbers)
    monkeypatch.setattr(command, "measure_strapdown", lambda rounds: {"strapdown_free_ns_per_sample": 43.0})
    assert command.main(["--json"]) == code
    assert json.loads(capsys.readouterr().out) == {**numbers, "strapdown_free_ns_per_sample": 43.0}
    assert command.main([]) == code
    (line,) = (row for row in capsys.readouterr().out.splitlines() if row.startswith("kernel_to_free"))
    assert line.endswith("(>= 7)")


@pytest.mark.slow
@pytest.mark.timeout(600)  # its kernel is compiled anew each time
@pytest.mark.skipif(
    importlib.util.find_spec("pyins") is None, reason="python-ins is installed by make benchmarks"
)
def test_both_stay_where_they_are():
    record = StaticRecord(20)
    other = PythonIns(record)
    assert other.kernel()() > 0.0 and other.public_call()() > 0.0
    assert record.run("free", UndampedNetwork(), record.second)() > 0.0


def test_the_record_is_at_rest():
    record = StaticRecord(2)
    assert record.increments.shape == (400, 6)
    # The Earth turns the gyros; the accelerometers feel gravity upwards.
    assert np.linalg.norm(record.increments[0, :3]) * 200.0 == pytest.approx(7.292115e-5)
    assert record.increments[0, 5] * 200.0 == pytest.approx(9.795, abs=0.01)
