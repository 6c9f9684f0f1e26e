"""Suspicions about a recorded IMU: units that would explain it, stuck sensors, which way is up."""

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import DEG, STANDARD_GRAVITY
from navcore.sensors.recorded_imu import ImuRecord

EARTH_DPH = 15.041
_NEAR = 0.03
_FORCE_SLIPS = {
    1.0 / STANDARD_GRAVITY: "g", 1e3 / STANDARD_GRAVITY: "mg", 100.0: "cm/s²", 1.0 / 0.3048: "ft/s²",
}  # fmt: skip
"""Units by the size of gravity in them over that in m/s^2; the numbers were taken as m/s^2."""
_TURN_SLIPS = {1.0 / DEG: ("deg/s", "rad/s"), 3600.0: ("deg/h", "deg/s"), 3600.0 / DEG: ("deg/h", "rad/s")}
"""True unit and the one that was taken, by the measured rate over the Earth's."""
_SENSORS = (Text("gyro x"), Text("gyro y"), Text("gyro z"), Text("accel x"), Text("accel y"), Text("accel z"))
_UPWARD = {"+x": "urf", "-x": "dfr", "+y": "fur", "-y": "rdf"}


def force_reason(size: float) -> str:
    """Unit in which a mean force (given as m/s^2) would be gravity, with the remedy; empty where none is."""
    unit = next(
        (u for ratio, u in _FORCE_SLIPS.items() if abs(size / (STANDARD_GRAVITY * ratio) - 1.0) < _NEAR), ""
    )
    return Text("; in {unit} it is gravity: name this unit in the header or a map", unit=unit) if unit else ""


def turn_warnings(size_dph: float) -> list[str]:
    """Say that a mean turn, deg/h, is the Earth's in another unit."""
    for ratio, (true, taken) in _TURN_SLIPS.items():
        for factor, unit, wrong in ((ratio, true, taken), (1.0 / ratio, taken, true)):
            if abs(size_dph / (EARTH_DPH * factor) - 1.0) < _NEAR:
                return [
                    Text(
                        "the mean turn is {size:.4g} °/h, the Earth's in {unit} where {wrong} was taken: "
                        "name the unit in the header or a map",
                        size=size_dph,
                        unit=unit,
                        wrong=wrong,
                    )
                ]
    return []


def still_warnings(record: ImuRecord) -> list[str]:
    """Name the sensors whose readings never change while their neighbours' do."""
    still = np.ptp(record.increments, axis=0) == 0.0
    words: list[str] = []
    for first in (0, 3):
        if still[first : first + 3].any() and not still[first : first + 3].all():
            names = Text.joined(", ", [_SENSORS[first + i] for i in np.flatnonzero(still[first : first + 3])])
            words.append(
                Text("{names}: the very same reading throughout: stuck, or a wrong column?", names=names)
            )
    return words


def outlier_warnings(record: ImuRecord) -> list[str]:
    """Count the samples in which a reading is far from all others, and say when the first one is."""
    values = record.increments
    middle = np.median(values, axis=0)
    spread = np.median(np.abs(values - middle), axis=0)
    far = ((np.abs(values - middle) > _FAR * spread) & (spread > 0.0)).any(axis=1)
    count = int(np.count_nonzero(far))
    if not 0 < count <= max(_MOST_FAR * len(values), 1.0):
        return []
    return [
        Text.plural(
            "{count} sample is far from all others, at {first:.6g} s: a run takes it as is",
            "{count} samples are far from all others, the first at {first:.6g} s: a run takes them as is",
            count=count,
            first=float(np.argmax(far)) / record.rate_hz,
        )
    ]


def rocking_warnings(record: ImuRecord) -> list[str]:
    """Say which gyro turns otherwise than the specific force does, of a vehicle that rocks: sign or unit.

    The direction u of the force obeys du/dt = -w x u while accelerations are small. A factor of each gyro is
    fitted; a lever arm or sway changes it by less than wrong units do.
    """
    block = max(1, round(_ROCKING_S * record.rate_hz))
    blocks = len(record.increments) // block
    if blocks < _FEWEST_BLOCKS:
        return []
    force = record.increments[: blocks * block, 3:]
    size = np.linalg.norm(force, axis=1, keepdims=True)
    if not size.all():
        return []
    up = force / size
    turns = record.increments[: blocks * block, :3]
    parts = [turns[:, i, None] * np.cross(up, axis) for i, axis in enumerate(np.eye(3))]
    means = up.reshape(blocks, block, 3).mean(axis=1)
    half = block // 2
    # Means of neighbouring blocks lie a block apart: the turns between their middles moved them.
    moved = (means[1:] - means[:-1]).ravel()
    design = np.column_stack(
        [part[half : half + (blocks - 1) * block].reshape(-1, block, 3).sum(axis=1).ravel() for part in parts]
    )
    weight = np.linalg.norm(design, axis=0)
    if not weight.all() or np.linalg.cond(design / weight) > _WORST_CONDITION:
        return []
    factors, _, _, _ = np.linalg.lstsq(design, moved, rcond=None)
    left = moved - design @ factors
    if left @ left > _LEFT * (moved @ moved):
        return []
    spread = np.sqrt(float(np.mean(left**2)) * np.diag(np.linalg.inv(design.T @ design)))
    low, high = _FITTING
    return [
        Text(
            "{name} agrees with the turn of the specific force when it is multiplied by {factor:.3g}: a "
            "wrong sign or unit of the gyro, of the forces across it or of the time?",
            name=_SENSORS[i],
            factor=float(factors[i]),
        )
        for i in range(3)
        if not low < factors[i] < high
        and abs(factors[i] - np.clip(factors[i], low, high)) > _SURE * spread[i]
    ]


_ROCKING_S = 0.5
_FEWEST_BLOCKS = 60
_WORST_CONDITION = 1e3
_LEFT = 0.3
"""Share of the turn of the force that may be left over; more is acceleration or noise."""
_FITTING = 0.35, 2.5
_SURE = 4.0
_FAR = 1000.0
"""Median deviations."""
_MOST_FAR = 0.001
"""More are motion, not outliers."""


def upward_remedy(up: str) -> str:
    """Axes to give for an axis that looks like up; the two level ones are to be seen from the mounting."""
    return _UPWARD.get(up, "")
