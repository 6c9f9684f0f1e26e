"""Other targets than C: Python, MATLAB (by Octave), the table, the FMU; and single precision."""

import json
import math
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu

from navcore.analysis import analyse
from navcore.exporting import target_c, target_fmu, target_matlab, target_python, target_table
from navcore.exporting.exported import exported
from navcore.exporting.forms import form_of
from navcore.exporting.law_form import law_form
from navcore.exporting.rounding import rounding_of
from navcore.exporting.subject import subject_of
from navcore.exporting.vectors import corrections_of
from navcore.networks import parse_network
from navcore.scenario.file import load
from tests.exported import busy_inputs, compiler
from tests.unit.test_export_laws import FEW, subject

PARTS = range(len(FEW))
OTHER = {
    "kalman": ['method.0.damping="kalman"'],
    "kalman of the water": [
        'method.0.damping="kalman"',
        "method.0.kalman={current_std_mps=0.3, scale_std_ppm=5000.0}",
        'reference.frame="body"',
    ],
    "averaging": ['method.0.damping="averaging"', 'motion={kind="static"}'],
}


def written(folder: Path, files: dict[str, str | bytes]) -> Path:
    """Write the files of an export."""
    for name, content in files.items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder


@pytest.mark.parametrize("part", PARTS)
def test_the_class_in_python_is_the_law(
    tmp_path: Path, part: int, capsys: pytest.CaptureFixture[str]
) -> None:
    """It needs nothing of ours, and meets its bounds over the vectors; beyond them it says so."""
    form = law_form(subject(FEW[part]), busy_inputs(1500))
    files = target_python.files(form, "law", False, target_c.double_bounds(form))
    assert "navcore" not in files["law.py"]
    written(tmp_path, files)
    names: dict[str, object] = {"__name__": "law"}
    exec(compile(files["law.py"], "law.py", "exec"), names)
    replay = names["replay"]
    assert callable(replay)
    assert replay(tmp_path / "vectors.csv")
    lines = (tmp_path / "vectors.csv").read_text().splitlines()
    cells = lines[700].split(",")
    cells[9] = repr(float(cells[9]) + 1e-6)
    (tmp_path / "vectors.csv").write_text("\n".join([*lines[:700], ",".join(cells), *lines[701:]]))
    assert not replay(tmp_path / "vectors.csv")
    assert "not within the bounds" in capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("octave-cli"), reason="no Octave")
@pytest.mark.parametrize("part", PARTS)
def test_octave_runs_the_function(tmp_path: Path, part: int) -> None:
    form = law_form(subject(FEW[part]), busy_inputs(1500))
    written(tmp_path, target_matlab.files(form, "law", False, target_c.double_bounds(form)))
    command = ["octave-cli", "--no-init-file", "--eval", "replay"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "1500 steps: within the bounds" in done.stdout, done.stderr


@pytest.mark.nightly
@pytest.mark.timeout(3000)
@pytest.mark.skipif(not shutil.which("octave-cli"), reason="no Octave")
@pytest.mark.parametrize("method", ["1", "2"])
def test_octave_runs_a_day_of_vectors(tmp_path: Path, method: str) -> None:
    """24 h of a preset, a call a second, within 1e-12 of the peak of each output."""
    form = form_of(subject_of(load("zha-fast"), method, hours=24.0))
    bounds = target_c.double_bounds(form)
    assert max(bounds) <= 1e-12 and len(form.given) == 86401
    written(tmp_path, target_matlab.files(form, "law", False, bounds))
    command = ["octave-cli", "--no-init-file", "--eval", "replay"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "86401 steps: within the bounds" in done.stdout, done.stderr


@pytest.mark.parametrize("kind", OTHER)
def test_filter_and_averaging_are_exported_as_they_run(tmp_path: Path, kind: str) -> None:
    """In C where there is a compiler, and in Python."""
    form = form_of(subject_of(load("zha-external", OTHER[kind]), "0", hours=0.2))
    bounds = target_c.double_bounds(form)
    written(tmp_path, target_python.files(form, "law", False, bounds))
    subprocess.run([sys.executable, "law.py"], cwd=tmp_path, check=True, capture_output=True)
    if compiler():
        written(tmp_path, target_c.files(form, "law", False, bounds))
        flags = "-std=c99 -Wall -Wextra -Werror -Wconversion law.c test.c -lm -o t".split()
        subprocess.run([compiler(), *flags], cwd=tmp_path, check=True)
        subprocess.run(["./t", "vectors.csv"], cwd=tmp_path, check=True, capture_output=True)


@pytest.mark.parametrize("log", [[], ["reference.rate_hz=0.3", 'reference.frame="body"']])
def test_an_exported_filter_corrects_what_the_run_corrects(log: list[str]) -> None:
    """It moves along the computed motion in place of the true one: the same to first order."""
    one = subject_of(load("zha-external", ['method.0.damping="kalman"', *log]), "0", hours=0.5)
    run, found = corrections_of(one), form_of(one).expected[:, 6:13]
    peak = np.max(np.abs(run), axis=0)
    assert np.all(peak > 0.0)
    assert np.all(np.max(np.abs(found - run), axis=0) < 0.01 * peak)


def test_the_table_holds_the_network_to_the_last_digit(tmp_path: Path) -> None:
    form = law_form(subject(FEW[1]), busy_inputs(100))
    files = target_table.files(form, "law", False, target_c.double_bounds(form))
    document = tomllib.loads(files["law.toml"])
    network, own = form.subject.network, document["network"]
    assert own["num"] == network.num.tolist()
    assert own["den"] == network.den.tolist()
    assert own["settling_s"] == analyse(network).settling_s
    space = own["state_space"]
    row = np.linalg.solve(-np.array(space["dA"]), np.array(space["B"]))
    assert math.isclose(np.dot(space["C"], row) + space["D"], 1.0 - network.h0, abs_tol=1e-9)
    z = np.exp(1j * 0.01)
    ratio = np.polyval(own["difference_equation"]["num"], z) / np.polyval(
        own["difference_equation"]["den"], z
    )
    states = np.linalg.solve((z - 1.0) * np.eye(2) - np.array(space["dA"]), np.array(space["B"]))
    assert abs(ratio - (np.dot(space["C"], states) + space["D"])) < 1e-6
    assert "<h2>network</h2>" in files["law.html"]


def test_the_unit_has_its_sources_and_names_each_variable(tmp_path: Path) -> None:
    form = law_form(subject(FEW[9]), busy_inputs(100))
    unit = target_fmu.files(form, "law", False, target_c.double_bounds(form))["law.fmu"]
    (tmp_path / "law.fmu").write_bytes(unit if isinstance(unit, bytes) else b"")
    with zipfile.ZipFile(tmp_path / "law.fmu") as archive:
        names = set(archive.namelist())
        model = ElementTree.fromstring(archive.read("modelDescription.xml"))
    assert {"sources/law.c", "sources/law.h", "sources/fmi3.c", "sources/buildDescription.xml"} <= names
    assert model.attrib["fmiVersion"] == "3.0"
    variables = [one.attrib["name"] for one in model.find("ModelVariables") or ()]
    assert variables == ["time", *form.inputs, *form.outputs]


@pytest.mark.skipif(not compiler(), reason="no C compiler")
def test_fmpy_replays_the_unit(tmp_path: Path) -> None:
    """Valid by the standard's schema; outputs are those of the vectors, a step later."""
    form = law_form(subject(FEW[9]), busy_inputs(600))
    written(tmp_path, target_fmu.files(form, "law", False, target_c.double_bounds(form)))
    path = str(tmp_path / "law.fmu")
    assert validate_fmu(path) == []
    kinds = [("time", "f8"), *((name, "i4" if name == "log_valid" else "f8") for name in form.inputs)]
    given = np.zeros(len(form.given), dtype=kinds)
    given["time"] = np.arange(len(given))
    for name, column in zip(form.inputs, form.given.T, strict=True):
        given[name] = column
    found = fmpy.simulate_fmu(
        path, stop_time=500.0, step_size=1.0, output_interval=1.0, input=given, output=list(form.outputs)
    )
    for name, column in zip(form.outputs, form.expected.T, strict=True):
        np.testing.assert_allclose(found[name][1:501], column[:500], rtol=0.0, atol=1e-12)


@pytest.mark.skipif(not compiler(), reason="no C compiler")
def test_single_precision_is_measured_and_its_form_stands_it(tmp_path: Path) -> None:
    """The files meet the bounds that were measured; the difference equation would not."""
    form = law_form(subject(FEW[1]), busy_inputs(3000))
    rounding = rounding_of(form)
    assert 0.0 < rounding.tilt_rad < 1e-7
    assert rounding.pole_shift < 1e-6
    assert rounding.other_decisions == 0
    written(tmp_path, target_c.files(form, "law", True, rounding.bounds))
    flags = "-std=c99 -Wall -Wextra -Werror -Wconversion -Wdouble-promotion law.c test.c -lm -o t".split()
    subprocess.run([compiler(), *flags], cwd=tmp_path, check=True)
    done = subprocess.run(["./t", "vectors.csv"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
    assert "double " not in (tmp_path / "law.c").read_text()
    four_poles = {"damping": "external", "network": {"id": "complementary"}}
    other = rounding_of(law_form(subject(four_poles), busy_inputs(200)))
    assert other.direct_radius > 1.0
    assert "would be unstable in single precision" in " ".join(other.sentences())


def test_the_answer_says_what_single_precision_does() -> None:
    found = exported(load("zha-external"), "1", single=True)
    assert found.document()["single"]["tilt_rad"] < 1e-8
    assert any("single precision: rounding makes at most" in str(row) for row in found.rows())
    assert json.dumps(found.document())
    assert max(found.bounds) < 1e-4
    assert parse_network("classic2").transfer(1.24e-3).order == 2
