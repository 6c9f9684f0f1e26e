"""Whether the speeds of a recording agree: a water speed far from the speed over ground is told."""

from collections.abc import Mapping

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, KNOT
from navcore.io.series import Recording

LARGEST_CURRENT_MPS = 1.5
"""About 3 kn: a stream that is stronger is rare, and worth a word."""
LARGEST_SHARE = 0.3
"""... nor is a difference plain that is less than this share of the larger speed."""
_SHORTEST_LEG_S = 10.0
MOST_LEGS = 100_000
"""Of 10 s, 11 days; two fixes that lie years apart must not make millions."""
_STRONGEST_CURRENT_MPS = 5.0
"""About 10 kn: no larger difference is a stream."""
_KNOT_SLIP, _RADIAN_SLIP = 0.06, 0.4
KNOT_SLIPS = {KNOT: Text("m/s taken for knots"), 1.0 / KNOT: Text("knots taken for m/s")}
"""By the speed that is told over the true one."""
_RADIANS = {1.0 / DEG: Text("positions in radians")}
"""By the speed through the water over that of the track; a stream is in it."""


def speed_warnings(recording: Recording) -> list[str]:
    """Say that the speed through the water is plainly wrong, judged by the speed over ground.

    Parameters
    ----------
    recording : Recording
        With a water speed, and velocity, ground speed or positions that share its time; else nothing is said.
    """
    over_ground = _over_ground(recording)
    if recording.water is None or over_ground is None:
        return []
    time_s, speed = over_ground
    water = recording.water
    shared = water.valid & (water.time_s >= time_s[0]) & (water.time_s <= time_s[-1])
    if np.count_nonzero(shared) < 2:
        return []
    through = float(np.median(np.hypot(*water.values[shared].T)))
    ground = float(np.median(np.interp(water.time_s[shared], time_s, speed)))
    difference = abs(through - ground)
    if difference <= max(LARGEST_CURRENT_MPS, LARGEST_SHARE * max(through, ground)):
        return []
    ratio = through / ground if ground > 0.0 else np.inf
    slip = slip_of(ratio, KNOT_SLIPS, _KNOT_SLIP) or slip_of(ratio, _RADIANS, _RADIAN_SLIP)
    reason = (
        Text("the ratio {ratio:.2f} suggests {slip}", ratio=ratio, slip=slip)
        if slip
        else Text("a wrong unit or scale, or a log that fails")
    )
    if through == 0.0:
        return [
            Text(
                "the speed through the water ({source}) is 0 while the ship makes {ground:.1f} kn over "
                "ground: the log fails, or is not in the water",
                source=water.source,
                ground=ground / KNOT,
            )
        ]
    if difference > _STRONGEST_CURRENT_MPS:
        return [
            Text(
                "the speed through the water (median {through:.1f} kn, {source}) is far from "
                "the speed over ground ({ground:.1f} kn), farther than any stream: {reason}",
                through=through / KNOT,
                source=water.source,
                ground=ground / KNOT,
                reason=reason,
            )
        ]
    return [
        Text(
            "the speed through the water (median {through:.1f} kn, {source}) is far from "
            "the speed over ground ({ground:.1f} kn): a stream of {difference:.1f} kn, "
            "or {reason}",
            through=through / KNOT,
            source=water.source,
            ground=ground / KNOT,
            difference=difference / KNOT,
            reason=reason,
        )
    ]


def slip_of(ratio: float, slips: Mapping[float, str], within: float) -> str:
    """Slip whose ratio is nearest to one of two speeds; empty where none is within a share of it."""
    size = min(slips, key=lambda one: abs(np.log(max(ratio, 1e-30) / one)))
    return slips[size] if abs(ratio / size - 1.0) < within else ""


def _over_ground(recording: Recording) -> tuple[np.ndarray, np.ndarray] | None:
    """Times (s) and speeds over ground (m/s) of the best source: velocity, ground speed, positions."""
    for series in (recording.velocity, recording.ground):
        if series is not None and np.count_nonzero(series.valid) > 1:
            kept = series.valid
            return series.time_s[kept], np.hypot(*series.values[kept, :2].T)
    position = recording.position
    if position is None or position.time_s[-1] - position.time_s[0] < _SHORTEST_LEG_S:
        return None
    leg_s = max(_SHORTEST_LEG_S, float(np.ptp(position.time_s)) / MOST_LEGS)
    grid = np.arange(position.time_s[0], position.time_s[-1], leg_s)
    lat = np.interp(grid, position.time_s, position.values[:, 0])
    lon = np.interp(grid, position.time_s, np.unwrap(position.values[:, 1]))
    if grid.size < 3:
        return None
    meridian, prime_vertical = WGS84.radii(float(lat[0]))
    north, east = np.diff(lat) * meridian, np.diff(lon) * prime_vertical * np.cos(lat[:-1])
    return grid[:-1] + 0.5 * leg_s, np.hypot(east, north) / leg_s
