"""Columns of a recorded IMU by their names: ``gx_rad_s``, ``GYRO X [deg/s]``, ``w_RS_S_x [rad s^-1]``.

A name gives a kind (rate, force, or the increment of either), an axis, and a unit. Words of frames and
instruments between them (``imu``, ``RS_S``, ``body``) are not heeded.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

from navcore.io.column_names import plain_name
from navcore.io.dialects import meant
from navcore.io.written_units import UNITS, unit_of, without_brackets, written

RATE, FORCE, ANGLE, VELOCITY = "rate", "force", "angle", "velocity"
"""Kinds: angular rate, specific force, and the increments of angle and velocity of one sample."""
DIMENSIONS = {RATE: "rate", FORCE: "force", ANGLE: "angle", VELOCITY: "speed"}
"""Key of `UNITS` by kind."""
PAIRS = ((RATE, FORCE), (ANGLE, VELOCITY))
"""Kinds that together are an IMU."""
AXES = "xyz"
_WORDS = {
    RATE: "gyro gyr gyros gyroscope omega angular_velocity angular_rate ang_vel ang_rate turn_rate "
    "rotation_rate angvel angrate",
    FORCE: "acc accel accelerometer accelerometers acceleration linear_acceleration lin_acc specific_force "
    "force",
    ANGLE: "delta_theta delta_angle dtheta dang dangle delta_ang d_theta d_angle",
    VELOCITY: "delta_velocity delta_vel delta_v dvel dvelocity d_v d_vel",
}
_SHORT = {RATE: "g w", FORCE: "a f", ANGLE: "da", VELOCITY: "dv"}
"""First words that serve where the axis stands behind them: ``gx``, ``w_RS_S_x``."""
_KINDS = {word: kind for kind, words in _WORDS.items() for word in words.split()}
_FIRST = {word: kind for kind, words in _SHORT.items() for word in words.split()}
_OTHERS = frozenset(
    "mag magnetometer magnetic free gravity grav user bias std sigma cov covariance var variance temp "
    "temperature err error scale offset east north up lat lon quat orientation status".split()
)
"""Words of columns that are no reading of an IMU."""
_TOGETHER = re.compile(r"(da|dv|[gwaf]|gyro?|omega|acc|accel)([xyz])")
_ROS = re.compile(r"(?:^|_)(?:angular_velocity|linear_acceleration)(?:_|$)")
"""Fields of a ROS message ``sensor_msgs/Imu``, which are in rad/s and m/s^2 by its definition."""


@dataclass(frozen=True)
class ImuColumn:
    """A column of a recorded IMU.

    Attributes
    ----------
    index : int
        Its place in the table.
    name : str
        As the table calls it.
    kind, axis : str
        `RATE`, `FORCE`, `ANGLE` or `VELOCITY`; ``x``, ``y`` or ``z``.
    unit : str
        Key of `UNITS` of its dimension; empty when the name gives none.
    unknown : str
        What stands as its unit and is not understood.
    sign : float
        1 or -1, or the factor of a map, by which the numbers are multiplied.
    """

    index: int
    name: str
    kind: str
    axis: str
    unit: str = ""
    unknown: str = ""
    sign: float = 1.0

    @property
    def factor(self) -> float:
        """SI over the column's unit, with its sign."""
        return self.sign * UNITS[DIMENSIONS[self.kind]][self.unit]


def imu_columns(names: Sequence[str]) -> dict[tuple[str, str], ImuColumn]:
    """Columns of an IMU by kind and axis; of several for one, the first."""
    found: dict[tuple[str, str], ImuColumn] = {}
    for index, name in enumerate(meant(names)):
        column = imu_column(index, name)
        if column is not None:
            column = replace(column, name=names[index].strip())
            found.setdefault((column.kind, column.axis), column)
    return found


def imu_column(index: int, name: str) -> ImuColumn | None:
    """Meaning of a name; None when it is no column of an IMU."""
    bare, texts = without_brackets(_lettered(name))
    plain = plain_name(bare)
    words = plain.split("_")
    for length in range(min(3, len(words) - 1), -1, -1):
        suffix = "_".join(words[len(words) - length :])
        meant = _meant(words[: len(words) - length])
        if meant is None:
            continue
        kind, axis = meant
        unit = unit_of(suffix, DIMENSIONS[kind]) if suffix else ""
        if suffix and not unit:
            continue
        said = written(texts, DIMENSIONS[kind])
        strange = said.unknown or (said.unit if said.unit and said.dimension != DIMENSIONS[kind] else "")
        given = "" if strange else said.unit or unit
        if not given and not strange and _ROS.search(plain):
            given = {RATE: "rad_s", FORCE: "mps2"}[kind]
        return ImuColumn(index, name.strip(), kind, axis, given, strange)
    return None


_OF_PX4 = {"_rad": "_rad_s", "_m_s2": "_m_s2"}
"""Ends of PX4's indexed names, and the units that they mean."""


def _lettered(name: str) -> str:
    """``gyro_rad[0]`` of PX4, a rate in rad/s, as ``gyro_x_rad_s``; other names as they are."""
    name = name.strip()
    if name[-3:] not in ("[0]", "[1]", "[2]"):
        return name
    axis, bare = AXES[int(name[-2])], name[:-3]
    end = next((end for end in _OF_PX4 if bare.endswith(end)), "")
    return f"{bare.removesuffix(end)}_{axis}{_OF_PX4.get(end, '')}"


def _meant(words: list[str]) -> tuple[str, str] | None:
    """Kind and axis of a name without its unit."""
    parted = [part for word in words for part in _parts(word)]
    if _OTHERS & set(parted):
        return None
    axes = [at for at, word in enumerate(parted) if word in ("x", "y", "z")]
    if len(axes) != 1 or axes[0] not in (0, len(parted) - 1):
        return None
    axis, rest = parted[axes[0]], parted[: axes[0]] + parted[axes[0] + 1 :]
    joined = [*rest, *("_".join(pair) for pair in zip(rest, rest[1:], strict=False))]
    kinds = {_KINDS[word] for word in joined if word in _KINDS}
    if ANGLE in kinds or VELOCITY in kinds:
        kinds -= {RATE, FORCE}
    if not kinds and rest and axes[0] and rest[0] in _FIRST:
        kinds = {_FIRST[rest[0]]}
    return (kinds.pop(), axis) if len(kinds) == 1 else None


def _parts(word: str) -> tuple[str, ...]:
    """``gx`` as ``g``, ``x``; any other word as it is."""
    together = _TOGETHER.fullmatch(word)
    return together.groups() if together else (word,)
