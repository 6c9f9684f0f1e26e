"""Recordings of a ship that turns, whose log or heading may be late, wrongly scaled or far away."""

from pathlib import Path
from typing import Any

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.units import DEG
from navcore.motion.track import TrackMotion
from navcore.scenario.model import Scenario

SECONDS = 3600
TIME = np.arange(SECONDS + 1.0)
HEADING = DEG * (50.0 * np.sin(TIME / 111.0) + 30.0 * np.sin((TIME / 1200.0) ** 3) + 0.03 * TIME)
TURN = np.gradient(HEADING, TIME)
SPEED = 5.0 + 2.0 * np.sin((TIME + 900.0) ** 1.5 / 2000.0)
START = 1714564800.0
COMPASS = {"id": "compass", "sigma": 0.01}


def table(path: Path, time_s: np.ndarray, **columns: np.ndarray) -> str:
    names = ",".join(("unix_time", *columns))
    rows = np.column_stack([START + time_s, *columns.values()])
    np.savetxt(path, rows, "%.9f", ",", header=names, comments="")
    return str(path)


def _integral(values: np.ndarray) -> np.ndarray:
    return np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]))])


def track(folder: Path, heading_late_s: float = 0.0) -> TrackMotion:
    east, north = SPEED * np.sin(HEADING), SPEED * np.cos(HEADING)
    meridian, normal = WGS84.radii(45.0 * DEG)
    lat = 45.0 + _integral(north) / meridian / DEG
    lon = -10.0 + _integral(east) / (normal * np.cos(lat * DEG)) / DEG
    positions = table(folder / "track.csv", TIME, lat_deg=lat, lon_deg=lon)
    heading = table(folder / "heading.csv", TIME + heading_late_s, heading_deg=HEADING / DEG % 360.0)
    return TrackMotion(file=(positions, heading))


def log(folder: Path, late_s: float = 0.0, factor: float = 1.0, arm: tuple[float, float] = (0, 0)) -> str:
    starboard, forward = arm
    return table(
        folder / "log.csv",
        TIME + late_s,
        speed_mps=(SPEED - TURN * starboard) * factor,
        speed_starboard_mps=TURN * forward * factor,
    )


def late_log(folder: Path, late_s: float) -> Scenario:
    """Scenario of a track and a log whose clock is late."""
    data: dict[str, Any] = {
        "schema": 1,
        "run": {"duration_h": 0.9},
        "motion": track(folder).model_dump(mode="json"),
        "reference": {"kind": "file", "file": log(folder, late_s=late_s), "frame": "body"},
        "method": [{"name": "damped", "damping": "external", "network": COMPASS}],
    }
    return Scenario.parse(data)
