"""Several sources of one quantity: which is taken, and by how much the others differ from it."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np

from navcore.foundation.earth import WGS84
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, KNOT

Source = tuple[str, np.ndarray, np.ndarray]
"""Name, times in s, shape (n,), and values, shape (n, k)."""
_NEAR_S = 1.5
_FEWEST = 3


class _Measure(NamedTuple):
    """Name of a quantity, unit of its differences, and the largest one that is not warned of."""

    name: str
    unit: str
    size: float
    most: float
    share: float = 0.0


_MEASURES = {
    "position": _Measure(Text("position"), "m", 1.0, 100.0),
    "velocity": _Measure(Text("velocity over ground"), "kn", KNOT, 0.5, 0.1),
    "water": _Measure(Text("speed through the water"), "kn", KNOT, 0.3, 0.05),
    "ground": _Measure(Text("speed over ground along axes"), "kn", KNOT, 0.3, 0.05),
    "heading": _Measure(Text("heading"), "°", DEG, 2.0),
    "attitude": _Measure(Text("pitch and roll"), "°", DEG, 1.0),
    "height": _Measure(Text("height"), "m", 1.0, 30.0),
    "deviation_m": _Measure(Text("deviation of the position"), "m", 1.0, 100.0),
    "deviation_mps": _Measure(Text("deviation of the velocity"), "m/s", 1.0, 1.0),
    "deviation_rad": _Measure(Text("deviation of an angle"), "°", DEG, 1.0),
}


def choice_texts(found: Iterable[tuple[str, Sequence[Source]]]) -> tuple[list[str], list[str]]:
    """Say of each quantity with several sources which is taken, the first, and by how much the others differ.

    Returns
    -------
    told : list of str
        One text for each source that is not taken.
    differing : list of str
        Those of them that differ by more than instruments of one ship do.
    """
    told: list[str] = []
    differing: list[str] = []
    for quantity, sources in found:
        for other in sources[1:]:
            text, plainly = _compared(_MEASURES[quantity], quantity, sources[0], other)
            told.append(text)
            differing += [text] if plainly else []
    return told, differing


def _compared(measure: _Measure, quantity: str, taken: Source, other: Source) -> tuple[str, bool]:
    off = difference(quantity, taken, other)
    if off is None:
        by, plainly = Text("they share too little time to be compared"), False
    else:
        by = Text("they differ by {size:.3g} {unit} (median)", size=off / measure.size, unit=measure.unit)
        speed = float(np.median(np.abs(taken[2][:, :2]))) if measure.share else 0.0
        plainly = off > max(measure.most * measure.size, measure.share * speed)
    text = Text(
        "{quantity}: {taken} is taken ({count}), {other} ({others}) is not used: {by}",
        quantity=measure.name,
        taken=taken[0],
        count=taken[1].size,
        other=other[0],
        others=other[1].size,
        by=by,
    )
    return text, plainly


_OF_STEMS = {
    "lat": "position", "lon": "position", "height": "height", "heading": "heading", "cog": "heading",
    "pitch": "attitude", "roll": "attitude", "speed": "water", "speed_starboard": "water", "ground": "ground",
    "ground_starboard": "ground", "sog": "velocity", "ve": "velocity", "vn": "velocity",
    "north_sigma": "deviation_m", "east_sigma": "deviation_m", "ve_sigma": "deviation_mps",
    "vn_sigma": "deviation_mps", "heading_sigma": "deviation_rad", "pitch_sigma": "deviation_rad",
    "roll_sigma": "deviation_rad",
}  # fmt: skip


def column_choice(stem: str, taken: str, other: str, off: np.ndarray) -> tuple[str, bool]:
    """Say by how much a column differs from the one that is taken, and whether it is more than it should.

    Parameters
    ----------
    stem : str
        What both hold.
    taken, other : str
        Their names.
    off : ndarray, shape (n,)
        Difference, SI.
    """
    measure = _MEASURES[_OF_STEMS[stem]]
    if measure.unit == "°":
        off = (off + np.pi) % (2.0 * np.pi) - np.pi
    elif stem in ("lat", "lon"):
        off = off * WGS84.radii(0.0)[1]
    size = float(np.median(np.abs(off)))
    text = Text(
        "{quantity}: column {taken} is taken, {other} is not used: they differ by {size:.3g} {unit} (median)",
        quantity=measure.name,
        taken=taken,
        other=other,
        size=size / measure.size,
        unit=measure.unit,
    )
    return text, size > measure.most * measure.size


def difference(quantity: str, taken: Source, other: Source) -> float | None:
    """Median size of the difference of two sources, SI; None where they share too little time."""
    (_, time_s, values), (_, other_s, others) = taken, other
    if quantity in ("water", "ground") and values.shape[1] == others.shape[1] == 3:
        (time_s, values), (other_s, others) = (
            (t[v[:, 2] != 0.0], v[v[:, 2] != 0.0]) for t, v in ((time_s, values), (other_s, others))
        )
    if time_s.size < 1 or other_s.size < 1:
        return None
    order = np.argsort(time_s, kind="stable")
    time_s, values = time_s[order], values[order]
    near = np.clip(np.searchsorted(time_s, other_s), 1, max(time_s.size - 1, 1)).clip(max=time_s.size - 1)
    before = np.maximum(near - 1, 0)
    near = np.where(np.abs(other_s - time_s[before]) < np.abs(time_s[near] - other_s), before, near)
    close = np.abs(time_s[near] - other_s) <= _NEAR_S
    if np.count_nonzero(close) < _FEWEST:
        return None
    off = others[close, :2] - values[near[close], :2]
    if quantity in ("heading", "attitude"):
        off = (off + np.pi) % (2.0 * np.pi) - np.pi
    elif quantity == "position":
        lat = float(np.median(values[:, 0]))
        meridian, prime_vertical = WGS84.radii(lat)
        off[:, 1] = (off[:, 1] + np.pi) % (2.0 * np.pi) - np.pi
        off = off * np.array([meridian, prime_vertical * np.cos(lat)])
    return float(np.median(np.linalg.norm(off, axis=1)))
