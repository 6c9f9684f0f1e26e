"""Columns of an IMU's table: what a header calls them, in which unit, about which axis.

``gx_rad_s``, ``GYRO X [rad/s]``, ``w_RS_S_x [rad s^-1]``, ``AccZ (mg)``, ``#timestamp [ns]``.
"""

import re
from dataclasses import dataclass

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.written_units import UNITS, unit_of, written

RATES = ("gx_rad_s", "gy_rad_s", "gz_rad_s", "fx_mps2", "fy_mps2", "fz_mps2")
INCREMENTS = ("dax_rad", "day_rad", "daz_rad", "dvx_mps", "dvy_mps", "dvz_mps")
_DIMENSIONS = {"gyro": "turn", "accel": "force"}
_WORDS = {
    "gyro": frozenset("gyro gyr gyros gyroscope angular angvel angrate omega w rate rot g".split()),
    "accel": frozenset("acc accel accelerometer acceleration acl a f force specific sf".split()),
}
_OTHERS = frozenset("mag magnetometer wind wave gps bias temp temperature std var".split())
_JOINED = re.compile(r"(gyro|gyr|acc|accel|acl|omega|w|g|a|f)([xyz])")
_TIME = frozenset("t time timestamp sow tow stamp elapsed seconds".split())
_BRACKETS = re.compile(r"[\[({]([^\])}]*)[\])}]")
_SIGNS = re.compile(r"[^A-Za-z0-9]+")


@dataclass(frozen=True)
class ImuColumns:
    """Where the quantities of a table stand.

    Attributes
    ----------
    time, time_s : int, float
        Column of the time, and s over its unit.
    places : tuple of int
        Columns of the turn about x, y, z and of the specific force along x, y, z.
    factors : tuple of float
        SI over the unit of each.
    increments : bool
        They are angles (rad) and velocities (m/s) over an interval, not rates.
    """

    time: int
    time_s: float
    places: tuple[int, ...]
    factors: tuple[float, ...]
    increments: bool = False


def is_imu_header(names: list[str]) -> bool:
    """Whether a row of names is the header of an IMU's table: two of our own names, or all six axes."""
    bare = [name.strip() for name in names]
    if len({*RATES, *INCREMENTS} & set(bare)) >= 2:
        return True
    found = {what for name in bare if (what := _axis_of(name)[0])}
    return len(found) == len(RATES)


def imu_columns(names: list[str], source: str) -> ImuColumns:
    """Find the six quantities and the time in a header.

    Parameters
    ----------
    names : list of str
        Of the columns.
    source : str
        File, for faults.

    Raises
    ------
    InputError
        A quantity or the time is missing, or a column names no unit; says which.
    """
    bare = [name.strip() for name in names]
    for own, increments in ((RATES, False), (INCREMENTS, True)):
        if set(own) <= set(bare) and "t_s" in bare:
            places = tuple(bare.index(name) for name in own)
            return ImuColumns(bare.index("t_s"), 1.0, places, (1.0,) * 6, increments)
    axes: dict[str, tuple[int, str]] = {}
    for place, name in enumerate(bare):
        what, unit = _axis_of(name)
        if what:
            axes.setdefault(what, (place, unit))
    wanted = [f"{sensor} {axis}" for sensor in _DIMENSIONS for axis in "xyz"]
    clock = next((place for place, name in enumerate(bare) if _is_time(name)), None)
    if clock is None or any(what not in axes for what in wanted):
        allowed = Text(
            "needs a header with t_s and {rates} (or {increments}), or with a time, three angular rates and "
            "three accelerations by name, axis and unit, such as gyro_x [rad/s]",
            rates=", ".join(RATES),
            increments=", ".join(INCREMENTS),
        )
        raise InputError(Fault(source, "imu.file", ",".join(names), allowed))
    without = [bare[axes[what][0]] for what in wanted if not axes[what][1]]
    if without:
        allowed = Text(
            "{columns}: a unit is needed, such as [rad/s], [deg/s] for angular rates and [m/s^2], [g] for "
            "accelerations",
            columns=", ".join(without),
        )
        raise InputError(Fault(source, "imu.file", ",".join(names), allowed))
    factors = tuple(UNITS[_DIMENSIONS[what.split()[0]]][axes[what][1]] for what in wanted)
    return ImuColumns(clock, _clock_unit(bare[clock]), tuple(axes[what][0] for what in wanted), factors)


def _axis_of(name: str) -> tuple[str, str]:
    """Quantity such as "gyro x" and unit of a column; both empty where it is none of the six."""
    brackets, words = _BRACKETS.findall(name), _words(_BRACKETS.sub(" ", name))
    for length in range(min(3, len(words) - 1), 0, -1) if not brackets else ():
        unit = "_".join(words[-length:])
        if any(unit_of(unit, dimension) for dimension in _DIMENSIONS.values()):
            brackets, words = [unit], words[:-length]
            break
    joined = next((match for word in words if (match := _JOINED.fullmatch(word))), None)
    axis = joined[2] if joined else next((word for word in words if word in ("x", "y", "z")), "")
    named = {joined[1]} if joined else set(words)
    sensor = next((sensor for sensor, known in _WORDS.items() if known & named), "")
    if not axis or not sensor or _OTHERS & set(words):
        return "", ""
    dimension = _DIMENSIONS[sensor]
    told = written(brackets, dimension)
    if told.dimension != dimension or told.unknown:
        return f"{sensor} {axis}", ""
    return f"{sensor} {axis}", told.unit


def _words(text: str) -> list[str]:
    """Words of a name in small letters: ``AngVelX`` and ``ANG_VEL X`` alike."""
    apart = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)
    return [word.lower() for word in _SIGNS.split(apart) if word]


def _is_time(name: str) -> bool:
    return bool(_TIME & set(_words(_BRACKETS.sub(" ", name))))


def _clock_unit(name: str) -> float:
    """Seconds over the unit that the column of the time names; seconds where it names none."""
    brackets, words = _BRACKETS.findall(name), _words(_BRACKETS.sub(" ", name))
    unit = written(brackets or words[-1:], "time").unit
    return UNITS["time"][unit or "s"]
