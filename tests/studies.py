"""A small study, and what its tests share."""

from pathlib import Path
from typing import Any

import pyarrow.parquet as pq
import tomlkit

from navcore.study.plan import Plan, plan_of

SHIP: dict[str, Any] = {
    "run": {"duration_h": 0.5, "seed": 7},
    "imu": {"gyro_arw_dpsh": 0.003, "gyro_bias_dph": [0.01, 0.02, 0.0]},
    "reference": {"kind": "log", "noise_mps": 0.1},
    "method": [
        {"name": "free", "damping": "free"},
        {"damping": "external", "network": {"id": "unity2"}, "policy": {"id": "adaptive"}},
    ],
    "requirement": [{"quantity": "tilt_max_arcsec", "at_most": 30.0, "from_h": 0.1}],
}
LATITUDE: dict[str, Any] = {"field": "site.lat_deg", "values": [10.0, 45.0]}
NOISE: dict[str, Any] = {"field": "imu.gyro_arw_dpsh", "low": 0.001, "high": 0.01}


def write(path: Path, **blocks: Any) -> str:
    """Write a study file; its name."""
    path.write_text(tomlkit.dumps({"schema": 1, **blocks, "scenario": blocks.get("scenario", SHIP)}))
    return str(path)


def plan(tmp_path: Path, **blocks: Any) -> Plan:
    """Plan of a study."""
    return plan_of(write(tmp_path / "study.toml", **blocks))


def stored(folder: Path) -> list[dict[str, Any]]:
    """Rows of a folder."""
    return pq.read_table(folder / "runs.parquet").to_pylist()
