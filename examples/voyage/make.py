"""Make the recordings of a voyage whose truth is known: ``python examples/voyage/make.py [FOLDER]``.

A ship sails four hours and changes course and speed each ten to twenty minutes. Its log errs as `PLANTED`
says, its receiver by a metre. `schuler fit log.csv --track track.csv` finds the planted values.
"""

import sys
from pathlib import Path
from typing import Any

import numpy as np

PLANTED: dict[str, Any] = {
    "bias_mps": (0.03, 0.06),
    "noise_mps": 0.03,
    "drift_mps": 0.05,
    "drift_tau_s": 300.0,
    "scale_ppm": 10_000.0,
    "delay_s": 20.0,
    "current_mps": (0.25, -0.15),
}
"""Starboard and forward bias, noise of a sample, drift, scale, delay, and the current, east and north."""
START, HOURS, STEP_S = 1_750_000_000, 4.0, 5.0
LAT_DEG, LON_DEG = 47.0, -6.0
_RADIUS = 6.371e6
_FIX_M = 1.0


def voyage(seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Rows of the log (time, forward, starboard) and of the track (time, latitude, longitude, heading)."""
    random = np.random.default_rng(seed)
    t = np.arange(-60.0, HOURS * 3600.0 + 1.0)
    speed, heading, at = np.full(t.size, 5.0), np.full(t.size, 0.9), 0.0
    while at < t[-1]:
        at += random.uniform(600.0, 1200.0)
        heading[t > at] += random.uniform(-1.6, 1.6)
        speed[t > at] = random.uniform(2.5, 7.5)
    speed, heading = (
        np.convolve(np.pad(each, 30, "edge"), np.ones(61) / 61.0, "valid") for each in (speed, heading)
    )
    sine, cosine = np.sin(heading), np.cos(heading)
    east, north = speed * sine, speed * cosine
    through = np.column_stack([east, north]) - PLANTED["current_mps"]
    starboard = through[:, 0] * cosine - through[:, 1] * sine
    forward = through[:, 0] * sine + through[:, 1] * cosine
    rho = np.exp(-1.0 / PLANTED["drift_tau_s"])
    drift = random.normal(0.0, PLANTED["drift_mps"], (t.size, 2))
    for k in range(1, t.size):
        drift[k] = rho * drift[k - 1] + np.sqrt(1.0 - rho**2) * drift[k]
    kept = np.flatnonzero((t >= 0.0) & (t % STEP_S == 0.0))
    late = kept - int(PLANTED["delay_s"])
    true = np.column_stack([starboard, forward])[late]
    read = (1.0 + 1e-6 * PLANTED["scale_ppm"]) * true + PLANTED["bias_mps"] + drift[kept]
    read += random.normal(0.0, PLANTED["noise_mps"], read.shape)
    lat = LAT_DEG + np.degrees((_way(north)[kept] + random.normal(0.0, _FIX_M, kept.size)) / _RADIUS)
    metres = _way(east)[kept] + random.normal(0.0, _FIX_M, kept.size)
    lon = LON_DEG + np.degrees(metres / (_RADIUS * np.cos(np.radians(LAT_DEG))))
    utc = START + t[kept]
    return (
        np.column_stack([utc, read[:, 1], read[:, 0]]),
        np.column_stack([utc, lat, lon, np.degrees(heading[kept]) % 360.0]),
    )


def _way(speed: np.ndarray) -> np.ndarray:
    """Way of a speed that is given each second, m."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]))])


def main(folder: Path) -> None:
    """Write ``log.csv`` and ``track.csv``."""
    log, track = voyage()
    plain: dict[str, Any] = {"delimiter": ",", "comments": "", "encoding": "utf-8"}
    header = "unix_time,speed_mps,speed_starboard_mps"
    np.savetxt(folder / "log.csv", log, ("%d", "%.3f", "%.3f"), header=header, **plain)
    header = "unix_time,lat_deg,lon_deg,heading_deg"
    np.savetxt(folder / "track.csv", track, ("%d", "%.6f", "%.6f", "%.2f"), header=header, **plain)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
