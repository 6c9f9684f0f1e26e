"""Recordings of a ship's own INS, made by the strapdown engine: its output, the log and the truth."""

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.engine.strapdown_environment import strapdown_environment
from navcore.foundation.units import DEG
from navcore.mechanization.strapdown.records import NAVIGATION
from navcore.motion.truth import HEADING, LAT, LON, PITCH, ROLL, VE, VN
from navcore.scenario.model import Scenario
from navcore.sensors.true_state import horizontal_state, to_ship

HOURS = 6.0
LEGS: dict[str, Any] = {
    "kind": "legs",
    "heading_deg": 40.0,
    "leg": [
        {"duration_s": 5400.0, "speed_mps": 6.0},
        {"duration_s": 5400.0, "heading_deg": 130.0, "turn_dps": 0.5},
        {"duration_s": 7200.0, "heading_deg": 250.0, "turn_dps": 0.5, "speed_mps": 8.0},
        {"duration_s": 7200.0, "heading_deg": 310.0, "turn_dps": -0.5},
    ],
}
IMU = {"gyro_bias_dph": [0.004, -0.003, 0.003], "accel_bias_ug": [20.0, -15.0, 0.0], "gyro_arw_dpsh": 0.0005}
START = {
    "attitude_arcmin": [0.1, -0.15, 1.5],
    "velocity_mps": [0.1, -0.08],
    "position_arcsec": [3.0, -2.0],
}
LOG = {"kind": "log", "rate_hz": 1.0, "bias_mps": [0.06, -0.04], "noise_mps": 0.05}


def damped(network: Any, **more: Any) -> dict[str, Any]:
    """Method of external damping."""
    return {"damping": "external", "network": network, **more}


def in_the_loop(methods: list[dict[str, Any]], **blocks: Any) -> Run:
    """Strapdown run of a free INS and of methods with the damping in the loop, on the same IMU and log."""
    run = {"fidelity": "strapdown", "duration_h": HOURS, "rate_hz": 10.0, "output_step_s": 1.0}
    data: dict[str, Any] = {
        "run": run,
        "site": {"lat_deg": 54.0, "lon_deg": 7.0},
        "motion": LEGS,
        "imu": IMU,
        "initial_error": START,
        "reference": LOG,
        "method": [{"name": "ins", "damping": "free"}, *methods],
    }
    return simulate(Scenario.parse(data | blocks))


def recordings(run: Run, folder: Path, method: int = 0, every_s: float = 1.0) -> dict[str, str]:
    """Write the output of a method, the log and the truth as CSV; return the blocks' files."""
    log = strapdown_environment(run.scenario)
    truth, errors = log.truth, log.reference
    navigation = run.methods[method].navigation
    assert navigation is not None
    of = {name: navigation[:, place] for place, name in enumerate(NAVIGATION)}
    chosen = slice(None, None, round(every_s))
    table(
        folder / "ins.csv",
        t_s=run.t_s[chosen],
        lat_deg=of["lat_rad"][chosen] / DEG,
        lon_deg=of["lon_rad"][chosen] / DEG,
        ve_mps=of["ve_mps"][chosen],
        vn_mps=of["vn_mps"][chosen],
        heading_deg=of["heading_rad"][chosen] / DEG,
        pitch_deg=of["pitch_rad"][chosen] / DEG,
        roll_deg=of["roll_rad"][chosen] / DEG,
    )
    velocity, heading = horizontal_state(truth, errors.time_s)
    reading, valid = velocity + errors.error, errors.valid
    if errors.body_frame:
        starboard, forward = to_ship(reading, heading).T
        speeds = {"speed_mps": forward[valid], "speed_starboard_mps": starboard[valid]}
    else:
        speeds = {"ve_mps": reading[valid, 0], "vn_mps": reading[valid, 1]}
    table(folder / "log.csv", t_s=errors.time_s[valid], **speeds)
    true = run.truth[::10]
    table(
        folder / "truth.csv",
        t_s=run.t_s[::10],
        lat_deg=true[:, LAT] / DEG,
        lon_deg=true[:, LON] / DEG,
        ve_mps=true[:, VE],
        vn_mps=true[:, VN],
        heading_deg=np.mod(true[:, HEADING], math.tau) / DEG,
        pitch_deg=true[:, PITCH] / DEG,
        roll_deg=true[:, ROLL] / DEG,
    )
    return {name: str(folder / f"{name}.csv") for name in ("ins", "log", "truth")}


def table(path: Path, **columns: np.ndarray) -> None:
    """Write columns as CSV."""
    with path.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(columns)
        writer.writerows(zip(*(np.asarray(one).tolist() for one in columns.values()), strict=True))


def on_ins(
    files: dict[str, str], methods: list[dict[str, Any]], truth: bool = True, **blocks: Any
) -> Scenario:
    """Scenario on such recordings."""
    data: dict[str, Any] = {
        "run": {"duration_h": HOURS},
        "ins": {"file": files["ins"]},
        "reference": {"kind": "file", "file": files["log"]},
        "method": methods,
    }
    if truth:
        data["truth"] = {"file": files["truth"]}
    for name, block in blocks.items():
        data[name] = data.get(name, {}) | block if isinstance(block, dict) else block
    return Scenario.parse(data)
