"""Time a run on a ship's own INS, 36 h at 1 Hz and four methods: ``python -m tools.own_ins_speed``.

Printed are the first reading of the files by a process that has read nothing, and the answer (median of five)
after a parameter of one method has changed, both without the start of the process.
"""

import argparse
import statistics
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from navcore.engine.simulation import simulate
from navcore.foundation.units import DEG, HOUR
from navcore.io.recording import load
from navcore.scenario.model import Scenario

METHODS: tuple[dict[str, Any], ...] = (
    {"name": "unity2", "damping": "external", "network": {"id": "unity2", "zeta": 0.5}},
    {"name": "complementary", "damping": "external", "network": {"id": "complementary"}},
    {
        "name": "whole",
        "damping": "external",
        "network": {"id": "unity2", "zeta": 0.5},
        "azimuth": {"id": "unity2", "zeta": 0.5},
    },
    {"name": "compass", "damping": "external", "network": {"id": "compass", "sigma": 0.0025, "xi": 0.7}},
)
_RADIUS_M, _SCHULER_S, _SPEED_MPS = 6.37e6, 5064.0, 7.0
_COLUMNS = {"ins": "t_s,lat_deg,lon_deg,ve_mps,vn_mps,heading_deg", "log": "t_s,speed_mps"}


def written(folder: Path, hours: float) -> dict[str, str]:
    """Write the output of an INS that swings about a ship on slow courses, and its log; return the paths."""
    t = np.arange(hours * HOUR + 1.0)
    heading = 40.0 + 60.0 * np.sin(2.0 * np.pi * t / (7.0 * HOUR))
    phase = 2.0 * np.pi * t / _SCHULER_S
    east = _SPEED_MPS * np.sin(heading * DEG) + 0.6 * np.sin(phase)
    north = _SPEED_MPS * np.cos(heading * DEG) + 0.6 * np.cos(phase)
    lat = 40.0 + np.cumsum(north) / _RADIUS_M / DEG
    lon = 7.0 + np.cumsum(east) / _RADIUS_M / np.cos(lat * DEG) / DEG
    noise = np.random.default_rng(1).normal(0.0, 0.05, t.size)
    tables = {"ins": [t, lat, lon, east, north, heading], "log": [t, _SPEED_MPS + noise]}
    for name, columns in tables.items():
        np.savetxt(
            folder / f"{name}.csv",
            np.column_stack(columns),
            fmt=["%.0f", *(["%.9f"] * 2 + ["%.4f"] * 3 if name == "ins" else ["%.3f"])],
            delimiter=",",
            header=_COLUMNS[name],
            comments="",
        )
    return {name: str(folder / f"{name}.csv") for name in tables}


def main() -> None:
    """Write the files, time, and print."""
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("--hours", type=float, default=36.0)
    hours = arguments.parse_args().hours
    with tempfile.TemporaryDirectory() as made:
        files = written(Path(made), hours)
        began = time.perf_counter()
        for path in files.values():
            load(path)
        print(f"first reading: {time.perf_counter() - began:.2f} s")
        data: dict[str, Any] = {
            "run": {"duration_h": hours, "output_step_s": 30.0},
            "ins": {"file": files["ins"]},
            "reference": {"kind": "file", "file": files["log"]},
            "method": [dict(one) for one in METHODS],
        }
        began = time.perf_counter()
        simulate(Scenario.parse(data))
        print(f"first answer: {time.perf_counter() - began:.2f} s")
        times = []
        for k in range(5):
            data["method"][0]["network"]["zeta"] = 0.5 + 0.01 * (k + 1)
            scenario = Scenario.parse(data)
            began = time.perf_counter()
            simulate(scenario)
            times.append(time.perf_counter() - began)
        print(
            f"answer, median of five: {statistics.median(times):.2f} s ({min(times):.2f} to {max(times):.2f})"
        )


if __name__ == "__main__":
    main()
