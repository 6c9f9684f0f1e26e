"""The moving report: its C program is the engine's error model, at every slider; its binary is as built."""

import ctypes
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.quantities import COMPONENTS
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits
from schuler_bench.views.requirements.moving import Moving, moving_of
from tests.eight import product
from tests.exported import compiler
from tools import wasm

SHIP: dict[str, Any] = {
    "run": {"duration_h": 4.0, "step_s": 5.0, "output_step_s": 60.0, "seed": 3},
    "imu": {"gyro_bias_dph": [0.01, -0.02, 0.03], "accel_bias_ug": [20.0, 10.0, 0.0], "gyro_arw_dpsh": 0.002},
    "initial_error": {"attitude_arcmin": [1.0, -0.5, 3.0]},
    "motion": {
        "kind": "legs",
        "leg": [
            {"duration_s": 3000.0, "speed_mps": 6.0, "accel_mps2": 0.005},
            {"duration_s": 600.0, "turn_dps": 0.2},
            {"duration_s": 10800.0},
        ],
    },
    "reference": {
        "kind": "log",
        "frame": "body",
        "rate_hz": 0.1,
        "noise_mps": 0.05,
        "bias_mps": [0.1, 0.05],
        "outage": [{"t_h": 1.0, "duration_s": 1800.0}],
    },
    "method": [
        {"name": "free", "damping": "free"},
        {"name": "gains", "damping": "external", "network": {"id": "compass", "sigma": 0.002}},
        {"name": "printed", "damping": "external", "network": {"id": "compass", "realisation": "as_printed"}},
        {
            "name": "two outputs",
            "damping": "external",
            "network": {"id": "optimal", "realisation": "feedback"},
        },
        {
            "name": "threshold",
            "damping": "external",
            "network": {"id": "complementary"},
            "policy": {"id": "threshold", "limit_mps": 0.3},
        },
        {"name": "own", "damping": "internal", "network": {"id": "unity2"}},
        {"name": "eight states", "damping": "external", "network": product()},
        {"name": "bridged", "damping": "external", "switching": {"id": "bridge"}},
    ],
}


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The program of the report, compiled for this machine."""
    if not compiler():
        pytest.skip("no C compiler")
    made = tmp_path_factory.mktemp("moving") / "error_model.so"
    flags = "-std=c99 -Wall -Wextra -Werror -Wconversion -O2 -shared -fPIC".split()
    subprocess.run([compiler(), *flags, str(wasm.SOURCE), "-o", str(made)], check=True)
    return ctypes.CDLL(str(made)).run


def rows_of(program: Any, moving: Moving, place: int, law: int = -1, **moved: float) -> np.ndarray:
    """Rows of a method with the law at a position of its slider, and other sliders moved to values."""
    header = moving.header

    def array(where: tuple[int, int]) -> np.ndarray:
        return moving.numbers[where[0] : where[0] + where[1]].copy()

    method = header["methods"][place]
    sensors, start, log = (array(one) for one in (header["sensors"], header["start"], method["log"]))
    log = log.reshape(-1, 4)
    for slider in header["sliders"]:
        by = moved.get(slider["field"].replace(".", "__"), slider["present"]) - slider["present"]
        for key, into in (("sensors", sensors), ("start", start)):
            if key in slider:
                into += by * array(slider[key])
        if "log" in slider:
            log[:, 1:3] += by * array(slider["log"]).reshape(-1, 2)
    given = [array(header[key]) for key in ("coefficients", "motion")]
    given += [
        sensors,
        np.ascontiguousarray(log),
        start,
        array(method["laws"][law if law >= 0 else method["present"]]),
    ]
    rows = np.zeros((header["steps"] // header["every"] + 1, len(COMPONENTS)))
    pointers = [one.ctypes.data_as(ctypes.POINTER(ctypes.c_double)) for one in (*given, rows)]
    written = program(
        header["steps"],
        ctypes.c_double(header["step_s"]),
        header["every"],
        pointers[0],
        header["along"],
        *pointers[1:],
    )
    return rows[:written]


def require_same(found: np.ndarray, run: Any, place: int) -> None:
    expected = run.methods[place].rows[:, : len(COMPONENTS)]
    assert found.shape == expected.shape
    peaks = np.max(np.abs(expected), axis=0)
    assert np.all(np.max(np.abs(found - expected), axis=0) <= 1e-9 * peaks)


@pytest.fixture(scope="module")
def moving() -> Moving:
    return moving_of(Scenario.parse(SHIP))


def test_it_is_the_engines_model_for_every_method(program: Any, moving: Moving) -> None:
    """On a moving ship with noise, an outage and a log in the ship's axes; what does not move is named."""
    run = simulate(moving.scenario)
    assert [one.method.name for one in run.methods] == [one["name"] for one in moving.header["methods"]]
    assert all(one.status == "ok" for one in run.methods)
    for place in range(len(run.methods)):
        require_same(rows_of(program, moving, place), run, place)
    place, length = moving.header["methods"][4]["laws"][moving.header["methods"][4]["present"]]
    always = replace(moving, numbers=moving.numbers.copy())
    assert moving.numbers[place + 2] == 0.3 and length > 9
    always.numbers[place + 2] = -1.0  # the threshold has acted
    assert np.any(rows_of(program, always, 4) != rows_of(program, moving, 4))
    assert [name for name, _ in moving.left_out] == ["bridged"] and "bridge" in moving.left_out[0][1]


@pytest.mark.parametrize("preset", ["zha-external", "liu-networks", "zha-fast"])
def test_it_is_the_engines_model_of_presets(program: Any, preset: str) -> None:
    found = moving_of(load(preset))
    run = simulate(found.scenario)
    for place in range(len(run.methods)):
        require_same(rows_of(program, found, place), run, place)


def test_every_slider_gives_what_the_server_gives(program: Any, moving: Moving) -> None:
    """The network at both ends of its slider, and each constant error at another value."""
    scenario = moving.scenario
    fields = [one["field"] for one in moving.header["sliders"]]
    assert {"imu.gyro_bias_dph.2", "reference.bias_mps.0", "initial_error.attitude_arcmin.2"} <= {*fields}
    for slider in moving.header["sliders"]:
        value = 0.3 * slider["low"] + 0.7 * slider["high"]
        path = tuple(int(part) if part.isdecimal() else part for part in slider["field"].split("."))
        run = simulate(edits.with_value(scenario, path, value))
        require_same(rows_of(program, moving, 1, **{slider["field"].replace(".", "__"): value}), run, 1)
    for place, method in enumerate(moving.header["methods"]):
        for position in (0, len(method["values"]) - 1) if method["values"] else ():
            path = tuple(int(part) if part.isdecimal() else part for part in method["field"].split("."))
            run = simulate(edits.with_value(scenario, path, method["values"][position]))
            require_same(rows_of(program, moving, place, position), run, place)


def test_it_is_small_and_says_what_cannot_move(moving: Moving) -> None:
    assert len(moving.packed()) < 700_000 and moving.packed() == moving.packed()
    with pytest.raises(InputError, match="has no method that moves"):
        moving_of(Scenario.parse({**SHIP, "method": SHIP["method"][-1:]}))


def test_the_binary_is_that_of_the_source(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A changed source is noticed."""
    assert wasm.faults() == []
    changed = tmp_path / wasm.SOURCE.name
    changed.write_bytes(wasm.SOURCE.read_bytes() + b" ")
    monkeypatch.setattr(wasm, "SOURCE", changed)
    assert wasm.faults() == ["error_model.c is not the one that was built: run python -m tools.wasm"]
