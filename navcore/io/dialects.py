"""Columns of messages whose definition gives the units: ArduPilot's and MAVLink's, as their tools write them.

Such a header is known by some of its names together; it is then read as if its names said what the definition
says. Names that are not in the table stay as they are.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from navcore.foundation.text import Text


class Dialect(NamedTuple):
    """A kind of message.

    Attributes
    ----------
    name : str
        For people.
    signs : frozenset of str
        Names, all of which its header holds.
    columns : dict
        What its columns are, by name, in names that `navcore.io.column_names`, `navcore.io.imu_columns` and
        `navcore.io.table_flags` know; empty for one that is not what it seems.
    instance : str
        Column that tells several sensors of one kind apart, whose messages stand between each other.
    """

    name: str
    signs: frozenset[str]
    columns: Mapping[str, str]
    instance: str = "I"


_AXES = "xyz"
_ARDUPILOT_TIMES = {"timestamp": "unix_time", "TimeUS": "t (us)"}
_MAVLINK_TIMES = {"timestamp": "unix_time", "time_boot_ms": "t (ms)", "time_usec": "t (us)"}


def _of(name: str, signs: str, columns: Mapping[str, str]) -> Dialect:
    return Dialect(name, frozenset(signs.split()), columns)


DIALECTS = (
    _of(
        Text("an ArduPilot message GPS"),
        "Status GWk Lat Lng Spd GCrs",
        _ARDUPILOT_TIMES
        | {"Status": "fix_type", "Lat": "lat (deg)", "Lng": "lon (deg)", "Alt": "alt (m)", "Spd": "sog (m/s)"}
        | {"GCrs": "cog (deg)", "Yaw": ""},
    ),
    _of(
        Text("an ArduPilot message IMU"),
        "GyrX GyrY GyrZ AccX AccY AccZ",
        _ARDUPILOT_TIMES
        | {f"Gyr{axis.upper()}": f"gyro_{axis} (rad/s)" for axis in _AXES}
        | {f"Acc{axis.upper()}": f"acc_{axis} (m/s^2)" for axis in _AXES},
    ),
    _of(
        Text("an ArduPilot message ATT"),
        "DesYaw Roll Pitch Yaw",
        _ARDUPILOT_TIMES | {"Roll": "roll (deg)", "Pitch": "pitch (deg)", "Yaw": "yaw (deg)"},
    ),
    _of(
        Text("a MAVLink message HIGHRES_IMU"),
        "xacc yacc zacc xgyro ygyro zgyro fields_updated",
        _MAVLINK_TIMES
        | {f"{axis}gyro": f"gyro_{axis} (rad/s)" for axis in _AXES}
        | {f"{axis}acc": f"acc_{axis} (m/s^2)" for axis in _AXES},
    ),
    _of(
        Text("a MAVLink message SCALED_IMU"),
        "xacc yacc zacc xgyro ygyro zgyro",
        _MAVLINK_TIMES
        | {f"{axis}gyro": f"gyro_{axis} (mrad/s)" for axis in _AXES}
        | {f"{axis}acc": f"acc_{axis} (mg)" for axis in _AXES},
    ),
    _of(
        Text("a MAVLink message GLOBAL_POSITION_INT"),
        "lat lon relative_alt vx vy hdg",
        _MAVLINK_TIMES
        | {"lat": "lat (1e-7 deg)", "lon": "lon (1e-7 deg)", "alt": "alt (mm)", "vx": "vn (cm/s)"}
        | {"vy": "ve (cm/s)", "hdg": "heading (cdeg)"},
    ),
    _of(
        Text("a PX4 message vehicle_gps_position"),
        "fix_type lat lon eph vel_m_s cog_rad",
        {
            "timestamp": "t (us)",
            "time_utc_usec": "unix_time",
            "lat": "lat (1e-7 deg)",
            "lon": "lon (1e-7 deg)",
        }
        | {"alt": "alt (mm)", "vel_m_s": "sog (m/s)", "cog_rad": "cog (rad)", "heading": ""}
        | {"vel_n_m_s": "", "vel_e_m_s": ""},
    ),
    _of(
        Text("a MAVLink message GPS_RAW_INT"),
        "fix_type lat lon eph vel cog",
        _MAVLINK_TIMES
        | {"lat": "lat (1e-7 deg)", "lon": "lon (1e-7 deg)", "alt": "alt (mm)", "vel": "sog (cm/s)"}
        | {"cog": "cog (cdeg)", "yaw": ""},
    ),
)
"""Of messages with the same names the one with more of them first."""


def dialect_of(names: Sequence[str]) -> Dialect | None:
    """Kind of message that a header is of; None for all others."""
    held = {name.strip() for name in names}
    return next((dialect for dialect in DIALECTS if dialect.signs <= held), None)


def instance_place(names: Sequence[str]) -> int | None:
    """Place of the column that tells several sensors of one kind apart; None without one."""
    dialect = dialect_of(names)
    plain = [name.strip() for name in names]
    return plain.index(dialect.instance) if dialect is not None and dialect.instance in plain else None


def instance_words(count: int, instance: str) -> str:
    """Say how many rows of other sensors are left out."""
    return Text(
        "{count} rows of other sensors of this kind left out: only those of number {instance} are read",
        count=count,
        instance=instance,
    )


def meant(names: Sequence[str]) -> list[str]:
    """Names of the columns as the definition of their message means them."""
    dialect = dialect_of(names)
    if dialect is None:
        return list(names)
    return [dialect.columns.get(name.strip(), name) for name in names]


def dialect_words(names: Sequence[str]) -> list[str]:
    """Say of which message the columns are."""
    dialect = dialect_of(names)
    if dialect is None:
        return []
    return [Text("the columns are those of {message}: in the units of its definition", message=dialect.name)]
