"""The box beside an INS: the output and the log in, what damping in its loop would have given out."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.exporting.form import Form
from navcore.exporting.outside_form import outside_form
from navcore.exporting.subject import subject_of
from navcore.scenario.model import Scenario
from schuler_bench.cli import main
from tests.exported import called, compiler, library
from tests.recordings import raw_folder
from tests.unit.test_export_laws import deviation

LEGS = [{"duration_s": 900.0, "speed_mps": 6.0}, {"turn_dps": 0.3, "duration_s": 300.0}]
METHODS: list[dict[str, Any]] = [
    {"damping": "external", "network": {"id": "unity2"}},
    {"damping": "external", "network": {"id": "compass"}, "policy": {"id": "threshold"}},
    {"damping": "external", "network": {"id": "unity2"}, "azimuth": {"id": "unity2"}},
]


def simulated(method: dict[str, Any], **log: Any) -> Form:
    """Box of a method beside a free INS of a short scenario."""
    data = {
        "run": {"duration_h": 1.0},
        "motion": {"kind": "legs", "leg": LEGS},
        "initial_error": {"attitude_arcmin": [1.0, -1.0, 4.0], "velocity_mps": [0.2, 0.3]},
        "reference": {"kind": "log", "noise_mps": 0.05, **log},
        "method": [method],
    }
    return outside_form(subject_of(Scenario.parse(data), hours=1.0))


@pytest.mark.skipif(not compiler(), reason="no C compiler")
def test_the_box_is_exported_as_it_runs(tmp_path: Path) -> None:
    outage = {"outage": [{"t_h": 0.3, "duration_s": 300.0}]}
    forms = [simulated(METHODS[0], **outage), *(simulated(one, frame="body") for one in METHODS[1:])]
    named = [(f"box{i}", form) for i, form in enumerate(forms)]
    laws = library(named, tmp_path)
    for prefix, form in named:
        assert deviation(form, called(laws, prefix, form, form.given)) <= 1e-12
        moved = form.expected[:, 0] - form.given[:, 0]
        assert np.max(np.abs(moved)) > 0.01


def test_an_ins_that_was_damped_has_its_own_correction_taken_off() -> None:
    """With the INS's own law for a new one nothing is left to move."""
    folder = recordings()
    data = {"damping": "external", "network": {"id": "classic2"}}
    north = folder / "north"
    scenario = on_north(north, data, 1.0)
    scenario["ins"]["damping"] = data
    form = outside_form(subject_of(Scenario.parse(scenario)))
    np.testing.assert_allclose(form.expected[:, 0], form.given[:, 0], atol=1e-6)


def recordings() -> Path:
    """Folder of the recordings of INSs; the test is left out where there are none."""
    folder = raw_folder()
    if folder is None or not (folder / "own_ins").is_dir():
        pytest.skip("no recordings")
    return folder / "own_ins"


def on_north(folder: Path, method: dict[str, Any], hours: float) -> dict[str, Any]:
    """Scenario on the recordings of a folder."""
    return {
        "ins": {"file": str(folder / "ins.csv")},
        "reference": {"kind": "file", "file": str(folder / "log.csv")},
        "run": {"duration_h": hours},
        "method": [method],
    }


@pytest.mark.slow
@pytest.mark.parametrize("case", ["north", "outage"])
def test_it_gives_what_damping_in_the_loop_would_have_given(case: str) -> None:
    """Recordings of nonlinear twins: within 1 % of the free INS's peaks at all epochs."""
    folder = recordings()
    expected = json.loads((folder / case / "expected.json").read_text())
    truth = np.genfromtxt(folder / case / "truth.csv", delimiter=",", names=True)
    peak = expected["methods"]["free"]["peak"]
    for name, method in expected["methods"].items():
        if name == "free":
            continue
        scenario = Scenario.parse(on_north(folder / case, method["damping"], expected["hours"]))
        form = outside_form(subject_of(scenario))
        out = dict(zip(form.outputs, form.expected.T, strict=True))
        for second, errors in method["t"].items():
            k, row = int(second), truth[np.searchsorted(truth["t_s"], float(second))]
            lat, turn = math.radians(row["lat_deg"]), math.radians(row["heading_deg"])
            found = {
                "dve_mps": out["v_e_out_mps"][k] - row["ve_mps"],
                "dvn_mps": out["v_n_out_mps"][k] - row["vn_mps"],
                "dlat_m": 6.37e6 * (out["lat_out_rad"][k] - lat),
                "phi_u_rad": math.remainder(out["yaw_out_rad"][k] - turn, math.tau),
            }
            for quantity, value in found.items():
                assert abs(value - errors[quantity]) < 0.01 * peak[quantity], (name, second, quantity)


def test_it_needs_a_law(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    words = ["export", "zha-external", "--method", "0", "--set", 'method.0.damping="kalman"', "--outside"]
    assert main([*words, "--quiet", "--out", str(tmp_path / "box")]) == 2
    assert "has no law that acts from outside" in capsys.readouterr().err
    assert not (tmp_path / "box").exists()
