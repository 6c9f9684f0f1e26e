"""Motions that several tests share."""

import math
from pathlib import Path

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.units import DEG
from navcore.motion import ProfileMotion, TrackMotion, WavesMotion

ZHAO = ProfileMotion.model_validate(
    {
        "shape": "half_sine",
        "point": [
            {"velocity_mps": [0.0, 0.0]},
            {"t_s": 43200.0, "velocity_mps": [300.0, 30.0]},
            {"t_s": 86400.0, "velocity_mps": [0.0, 0.0]},
        ],
    }
)
"""Zhao 2015, 5.1: V_E = 150 (1 - cos 2 pi t/24 h), V_N = 15 (1 - cos 2 pi t/24 h)."""

SUN = ProfileMotion.model_validate(
    {
        "shape": "triangle",
        "point": [
            {"speed_kn": 2.0, "course_deg": 45.0},
            {"t_s": 36000.0},
            {"t_s": 36240.0, "speed_kn": 10.0},
        ],
    }
)
"""Sun 2017, 5.1: 2 kn at 045 for 10 h, then 0 -> 4 -> 0 kn/min over 4 min."""

MANOEUVRES = ProfileMotion.model_validate(
    {
        "bow": "heading",
        "point": [
            {"speed_mps": 3.0, "course_deg": 10.0, "heading_deg": 5.0},
            {"t_s": 100.0, "pitch_deg": 5.0, "roll_deg": -3.0},
            {"t_s": 200.0, "speed_mps": 12.0, "course_deg": 200.0, "heading_deg": 220.0, "pitch_deg": -5.0},
            {"t_s": 203.0, "heading_deg": 230.0, "roll_deg": 5.0},
            {"t_s": 600.0, "speed_mps": 0.0},
        ],
    }
)
"""Speed, course, heading, pitch and roll all change, some at 5 deg/s."""

SEA = WavesMotion(speed_mps=6.0, heading_deg=0.0)
"""6 m/s in a sea of 2.5 m and 8 s, waves 60 deg on the bow."""


def circle_track(folder: Path) -> TrackMotion:
    """Circle of 500 m in 600 s about 32 N, recorded for 20 min at 1 Hz."""
    t = np.arange(1201.0)
    angle = 2.0 * math.pi * t / 600.0
    meridian, prime_vertical = WGS84.radii(32.0 * DEG)
    columns = {
        "t_s": t,
        "lat_deg": 32.0 + 500.0 * np.sin(angle) / meridian / DEG,
        "lon_deg": 118.0 + 500.0 * (1.0 - np.cos(angle)) / (prime_vertical * math.cos(32.0 * DEG)) / DEG,
        "heading_deg": np.mod(angle / DEG, 360.0),
    }
    path = folder / "circle.csv"
    np.savetxt(
        path,
        np.column_stack(list(columns.values())),
        fmt="%.12f",
        delimiter=",",
        header=",".join(columns),
        comments="",
    )
    return TrackMotion(file=str(path))
