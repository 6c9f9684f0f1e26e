"""Names of the columns of a table: our own with their units, and those that ships' loggers use.

A name is read without regard to case, spaces and signs. A unit may stand behind it or in brackets:
``speed_kn``, ``SOG (m/s)``, ``Heading [deg]``, ``Latitude_deg``.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass

from navcore.foundation.units import DEG, KNOT

UTC, UNIX, SECONDS, DATE, CLOCK = "utc", "unix", "t_s", "date", "clock"
"""Columns of time: a date and time, Unix time, s since the file's own zero; a date and a time apart."""
_UNITS = {
    "angle": {"deg": DEG, "rad": 1.0},
    "speed": {"mps": 1.0, "kn": KNOT, "kmh": 1.0 / 3.6, "cms": 0.01},
    "length": {"m": 1.0},
}
_SPELT = {
    "deg": "degree degrees degrees_true deg_true degrees_north degrees_east degree_north degree_east",
    "rad": "radian radians",
    "mps": "m_s ms meter_second meters_second metre_second m_sec",
    "kn": "kt kts knot knots",
    "kmh": "km_h kph",
    "cms": "cm_s",
    "m": "meter meters metre metres",
}
_UNIT_NAMES = {name: unit for unit, names in _SPELT.items() for name in (unit, *names.split())}


@dataclass(frozen=True)
class Quantity:
    """A quantity that a column may hold.

    Attributes
    ----------
    dimension : str
        ``angle``, ``speed`` or ``length``.
    low, high : float
        Range in deg, m/s or m.
    unit : str
        Taken when the name gives none.
    names : tuple of str
        What it is called without the unit, the usual first.
    """

    dimension: str
    low: float
    high: float
    unit: str
    names: tuple[str, ...]


def _of(dimension: str, low: float, high: float, unit: str, names: str) -> Quantity:
    return Quantity(dimension, low, high, unit, tuple(names.split()))


QUANTITIES = {
    "lat": _of(
        "angle", -90, 90, "deg",
        "lat latitude ship_latitude gps_lat gps_latitude pos_lat lat_dd dec_lat decimal_latitude latitude_n",
    ),
    "lon": _of(
        "angle", -180, 360, "deg",
        "lon long longitude lng ship_longitude gps_lon gps_long gps_longitude pos_lon lon_dd dec_lon "
        "decimal_longitude longitude_e",
    ),
    "height": _of("length", -1e4, 1e5, "m", "height altitude alt ellipsoidal_height gps_height gps_altitude"),
    "heading": _of(
        "angle", -360, 360, "deg",
        "heading hdg hdt heading_true true_heading ship_heading ship_hdg gyro gyro_heading heading_gyro "
        "gyro_hdg pl_hd pl_hd1 ths yaw",
    ),
    "pitch": _of("angle", -90, 90, "deg", "pitch ship_pitch"),
    "roll": _of("angle", -180, 180, "deg", "roll ship_roll"),
    "ve": _of(
        "speed", -1e3, 1e3, "mps", "ve v_e v_east vel_e vel_east velocity_e velocity_east east_velocity"
    ),
    "vn": _of(
        "speed", -1e3, 1e3, "mps", "vn v_n v_north vel_n vel_north velocity_n velocity_north north_velocity"
    ),
    "speed": _of(
        "speed", -1e3, 1e3, "kn",
        "speed stw speed_through_water speed_thru_water water_speed speed_water log_speed speed_log log sow "
        "speed_over_water lon_water_speed lon_water_spd longitudinal_water_speed water_speed_forward vhw",
    ),
    "speed_starboard": _of(
        "speed", -1e3, 1e3, "kn",
        "speed_starboard trans_water_speed trans_water_spd transverse_water_speed water_speed_starboard",
    ),
    "ground": _of(
        "speed", -1e3, 1e3, "kn",
        "ground lon_ground_speed lon_grnd_spd longitudinal_ground_speed ground_speed_forward",
    ),
    "ground_starboard": _of(
        "speed", -1e3, 1e3, "kn",
        "ground_starboard trans_ground_speed trans_grnd_spd transverse_ground_speed ground_speed_starboard",
    ),
    "sog": _of(
        "speed", -1e3, 1e3, "kn",
        "sog speed_over_ground ground_speed gps_speed spd_over_grnd gps_sog vtg_speed",
    ),
    "cog": _of(
        "angle", -360, 360, "deg",
        "cog course course_over_ground course_made_good track_made_good gps_cog gps_course true_course "
        "true_track pl_crs",
    ),
}  # fmt: skip
"""By what the quantity is called here; ``speed`` is through the water, ``ground`` over it, along the axes."""
_IN_MPS = {"speed_made_good": "sog", "pl_spd": "sog", "pl_sow": "speed"}
"""Names of R2R and SAMOS, whose speeds are in m/s."""
_TIMES = {
    UTC: "utc time timestamp datetime date_time iso_time isotime time_utc utc_time gps_time timestamp_utc "
    "utc_timestamp datetime_utc date_time_utc utc_datetime time_iso iso8601 date_time_iso",
    UNIX: "unix unix_time unixtime epoch epoch_time posix posix_time unix_s time_unix",
    SECONDS: "t_s t s sec seconds elapsed elapsed_s elapsed_seconds time_s time_sec time_seconds",
    DATE: "date date_utc utc_date gps_date",
}
_NAMES = {name: stem for stem, quantity in QUANTITIES.items() for name in quantity.names}
_TIME_NAMES = {name: stem for stem, names in _TIMES.items() for name in names.split()}
_BRACKETS = re.compile(r"[\[(]([^\[\]()]{1,30})[\])]")
_SIGNS = re.compile(r"[^a-z0-9]+")
_HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")


@dataclass(frozen=True)
class Column:
    """A column that is used.

    Attributes
    ----------
    index : int
        Its place in the table.
    name : str
        As the table calls it.
    stem : str
        What it holds: a key of `QUANTITIES`, or a column of time.
    unit : str
        Of its numbers; empty for times.
    unit_given : bool
        Whether the name gives the unit.
    """

    index: int
    name: str
    stem: str
    unit: str = ""
    unit_given: bool = True

    @property
    def factor(self) -> float:
        """SI over the column's unit."""
        return _UNITS[QUANTITIES[self.stem].dimension][self.unit]

    @property
    def limits(self) -> tuple[float, float]:
        """Range in the column's unit."""
        quantity = QUANTITIES[self.stem]
        scale = _UNITS[quantity.dimension][
            "deg" if quantity.dimension == "angle" else quantity_unit(quantity)
        ]
        return quantity.low * scale / self.factor, quantity.high * scale / self.factor


def quantity_unit(quantity: Quantity) -> str:
    """Unit in which the range of a quantity stands."""
    return {"angle": "deg", "speed": "mps", "length": "m"}[quantity.dimension]


def known_columns(names: Sequence[str]) -> dict[str, Column]:
    """Columns that are used, by what they hold; of several for one quantity the best-known name.

    A column ``time`` beside a column ``date`` holds the time of day (`CLOCK`).
    """
    best: dict[str, tuple[int, Column]] = {}
    for index, name in enumerate(names):
        meaning = _meaning(name)
        if meaning is None:
            continue
        rank, stem, unit, unit_given = meaning
        if stem not in best or rank < best[stem][0]:
            best[stem] = rank, Column(index, name.strip(), stem, unit, unit_given)
    chosen = {stem: column for stem, (_, column) in best.items()}
    if DATE in chosen:
        if UTC in chosen:
            column = chosen.pop(UTC)
            chosen[CLOCK] = Column(column.index, column.name, CLOCK)
        else:
            column = chosen.pop(DATE)
            chosen[UTC] = Column(column.index, column.name, UTC)
    return chosen


def plain_name(name: str) -> str:
    """Lower case, words joined by underscores."""
    return _SIGNS.sub("_", _HUMP.sub("_", name.strip()[:80]).lower()).strip("_")


def _meaning(name: str) -> tuple[int, str, str, bool] | None:
    """Rank (0 the usual name), what the column holds, its unit and whether the name gives it."""
    bracket = _BRACKETS.search(name[:80])
    given = _UNIT_NAMES.get(plain_name(bracket[1]), "") if bracket else ""
    plain = plain_name(name[: bracket.start()] if bracket else name)
    for words, unit in ((plain, given), *_without_unit(plain)):
        if words in _IN_MPS:
            return 5, _IN_MPS[words], unit or "mps", True
        stem = _NAMES.get(words)
        if stem is not None and (not unit or unit in _UNITS[QUANTITIES[stem].dimension]):
            rank = QUANTITIES[stem].names.index(words)
            unit_given = bool(unit) or QUANTITIES[stem].dimension != "speed"
            return rank, stem, unit or QUANTITIES[stem].unit, unit_given
    if plain in _TIME_NAMES:
        stem = _TIME_NAMES[plain]
        return _TIMES[stem].split().index(plain), stem, "", True
    return None


def _without_unit(plain: str) -> list[tuple[str, str]]:
    """The name without its last one to three words, where these are a unit."""
    words = plain.split("_")
    return [
        ("_".join(words[:-n]), unit)
        for n in (1, 2)
        if len(words) > n and (unit := _UNIT_NAMES.get("_".join(words[-n:])))
    ]
