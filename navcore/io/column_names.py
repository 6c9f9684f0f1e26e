"""Names of the columns of a table: our own with their units, and those that ships' loggers use.

A name is read without regard to case, spaces and signs. A unit may stand behind it or in brackets:
``speed_kn``, ``SOG (m/s)``, ``Heading [deg]``, ``Latitude_deg``.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from navcore.io.dialects import meant
from navcore.io.times.named_counts import COUNT_NAMES, NamedCount, named_count
from navcore.io.written_units import UNITS, unaccented, unit_of, without_brackets, written

UTC, UNIX, SECONDS, DATE, CLOCK = "utc", "unix", "t_s", "date", "clock"
"""Columns of time: a date and time, Unix time, s since the file's own zero; a date and a time apart."""
_COUNT = "count"
"""Column of numbers whose name says what they count, such as MJD: the time (`UTC`) where no other one is."""


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


def _deviation_names(*bases: str) -> str:
    """Names of the standard deviation of a quantity: ``lat_sigma``, ``heading_std``, ``std_heading``, ..."""
    words = ("sigma", "std", "stdev", "stddev", "std_dev", "sd", "standard_deviation", "standard_error")
    return " ".join(f"{base}_{word} {word}_{base}" for word in words for base in bases)


QUANTITIES = {
    "lat": _of(
        "angle", -90, 90, "deg",
        "lat latitude ship_latitude gps_lat gps_latitude pos_lat lat_dd dec_lat decimal_latitude latitude_n "
        "breite breitengrad geographische_breite latitud latitudine",
    ),
    "lon": _of(
        "angle", -180, 360, "deg",
        "lon long longitude lng ship_longitude gps_lon gps_long gps_longitude pos_lon lon_dd dec_lon "
        "decimal_longitude longitude_e lange laenge langengrad laengengrad geographische_lange longitud "
        "longitudine",
    ),
    "height": _of("length", -1e4, 1e5, "m", "height altitude alt ellipsoidal_height gps_height gps_altitude"),
    "heading": _of(
        "angle", -360, 360, "deg",
        "heading hdg hdt heading_true true_heading ship_heading ship_hdg gyro gyro_heading heading_gyro "
        "gyro_hdg pl_hd pl_hd1 ths yaw steuerkurs kreiselkurs kreisel rechtweisender_kurs kurs_rw rwk cap "
        "cap_vrai cap_gyro rumbo_verdadero prua ship_true_heading ins_heading ins_yaw",
    ),
    "pitch": _of("angle", -90, 90, "deg", "pitch ship_pitch ins_pitch"),
    "roll": _of("angle", -180, 180, "deg", "roll ship_roll ins_roll"),
    "ve": _of(
        "speed", -1e3, 1e3, "mps", "ve v_e v_east vel_e vel_east velocity_e velocity_east east_velocity"
    ),
    "vn": _of(
        "speed", -1e3, 1e3, "mps", "vn v_n v_north vel_n vel_north velocity_n velocity_north north_velocity"
    ),
    "speed": _of(
        "speed", -1e3, 1e3, "kn",
        "speed stw speed_through_water speed_thru_water water_speed speed_water log_speed speed_log log sow "
        "speed_over_water lon_water_speed lon_water_spd longitudinal_water_speed water_speed_forward vhw "
        "fahrt_durchs_wasser fahrt_durch_wasser fdw fd_w "
        "vitesse_surface vitesse_eau vitesse_loch velocidad_agua",
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
        "sog speed_over_ground ground_speed gps_speed spd_over_grnd gps_sog vtg_speed spd "
        "fahrt_uber_grund fahrt_ueber_grund fug fueg vitesse_fond vitesse_sol velocidad_fondo",
    ),
    "cog": _of(
        "angle", -360, 360, "deg",
        "cog course course_over_ground course_made_good track_made_good gps_cog gps_course true_course "
        "true_track pl_crs gcrs bearing kurs_uber_grund kurs_ueber_grund kug kueg kurs route_fond route_sol "
        "rumbo_fondo",
    ),
    **{
        stem: _of(dimension, 0.0, 1e6 if dimension == "length" else 360.0, unit, _deviation_names(*bases))
        for stem, dimension, unit, bases in (
            ("north_sigma", "length", "m", ("lat", "latitude", "north", "position_north", "pos_n")),
            ("east_sigma", "length", "m", ("lon", "longitude", "east", "position_east", "pos_e")),
            ("ve_sigma", "speed", "mps", ("ve", "v_east", "velocity_east", "east_velocity", "v_e")),
            ("vn_sigma", "speed", "mps", ("vn", "v_north", "velocity_north", "north_velocity", "v_n")),
            ("heading_sigma", "angle", "deg", ("heading", "yaw", "true_heading", "hdg")),
            ("pitch_sigma", "angle", "deg", ("pitch",)),
            ("roll_sigma", "angle", "deg", ("roll",)),
        )
    },
}  # fmt: skip
"""By what the quantity is called here; ``speed`` is through the water, ``ground`` over it, along the axes."""
_IN_MPS = {"speed_made_good": "sog", "pl_spd": "sog", "pl_sow": "speed"}
"""Names of R2R and SAMOS, whose speeds are in m/s."""
_OF_ERDDAP = {
    "platform_speed_wrt_ground": "sog",
    "platform_speed": "sog",
    "platform_course": "cog",
    "platform_orientation": "heading",
    "platform_heading": "heading",
    "platform_yaw": "heading",
    "platform_yaw_angle": "heading",
    "platform_yaw_fore_starboard": "heading",
    "platform_pitch": "pitch",
    "platform_pitch_angle": "pitch",
    "platform_pitch_fore_up": "pitch",
    "platform_roll": "roll",
    "platform_roll_angle": "roll",
    "platform_roll_starboard_down": "roll",
    "height_above_reference_ellipsoid": "height",
    "eastward_platform_velocity": "ve",
    "northward_platform_velocity": "vn",
    "platform_speed_wrt_sea_water": "speed",
}
"""Standard names of the CF conventions, and those of SAMOS in ERDDAP."""
_TIMES = {
    UTC: "utc time timestamp datetime date_time iso_time isotime time_utc utc_time gps_time timestamp_utc "
    "gpst stamp header_stamp field_header_stamp rosbag_timestamp utc_timestamp datetime_utc date_time_utc "
    "utc_datetime time_iso iso8601 date_time_iso time_gmt "
    "gmt_time datetime_gmt gmt base_date_time basedatetime received_at recorded_at zeit uhrzeit zeitstempel "
    "datum_uhrzeit datum_zeit heure horodatage date_heure hora fecha_hora ora temps tiempo tempo",
    UNIX: "unix unix_time unixtime epoch epoch_time posix posix_time unix_s time_unix",
    SECONDS: "t_s t s sec seconds elapsed elapsed_s elapsed_seconds time_s time_sec time_seconds",
    DATE: "date date_utc utc_date gps_date date_gmt gmt_date datum fecha",
    _COUNT: COUNT_NAMES,
}
_NAMES = {name: stem for stem, quantity in QUANTITIES.items() for name in quantity.names}
_NAMES |= _OF_ERDDAP
_TIME_NAMES = {name: stem for stem, names in _TIMES.items() for name in names.split()}
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
        Of its numbers; empty for times whose unit is not named.
    unit_given : bool
        Whether the name gives the unit.
    unknown : str
        What stands in its brackets and is not understood.
    misfit : bool
        Whether the unit is of another quantity than the name: ``Log (nm)`` is a distance.
    """

    index: int
    name: str
    stem: str
    unit: str = ""
    unit_given: bool = True
    unknown: str = ""
    misfit: bool = False

    @property
    def factor(self) -> float:
        """SI over the column's unit."""
        return UNITS[QUANTITIES[self.stem].dimension][self.unit]

    @property
    def limits(self) -> tuple[float, float]:
        """Range in the column's unit."""
        quantity = QUANTITIES[self.stem]
        scale = UNITS[quantity.dimension]["deg" if quantity.dimension == "angle" else quantity_unit(quantity)]
        return quantity.low * scale / self.factor, quantity.high * scale / self.factor


def quantity_unit(quantity: Quantity) -> str:
    """Unit in which the range of a quantity stands."""
    return {"angle": "deg", "speed": "mps", "length": "m"}[quantity.dimension]


def known_columns(names: Sequence[str]) -> dict[str, Column]:
    """Columns that are used, by what they hold; of several for one quantity the best-known name.

    A column ``time`` beside a column ``date`` holds the time of day (`CLOCK`). A column ``speed`` beside
    positions and a course, without a heading, is a receiver's: over ground.
    """
    best: dict[str, tuple[int, Column]] = {}
    for index, name in enumerate(meant(names)):
        rank, column = _meaning(index, name)
        if column is None or column.misfit:
            continue
        column = replace(column, name=names[index].strip())
        if column.stem not in best or rank < best[column.stem][0]:
            best[column.stem] = rank, column
    chosen = {stem: column for stem, (_, column) in best.items()}
    if {"speed", "lat", "lon", "cog"} <= chosen.keys() and not {"sog", "heading"} & chosen.keys():
        bare = plain_name(without_brackets(chosen["speed"].name)[0])
        if bare.partition("_")[0] == "speed" and not {"water", "log"} & set(bare.split("_")):
            chosen["sog"] = replace(chosen.pop("speed"), stem="sog")
    if DATE in chosen:
        if UTC in chosen:
            column = chosen.pop(UTC)
            chosen[CLOCK] = replace(column, stem=CLOCK)
        else:
            column = chosen.pop(DATE)
            chosen[UTC] = replace(column, stem=UTC)
    count = chosen.pop(_COUNT, None)
    if count is not None and not {UTC, UNIX, CLOCK} & chosen.keys():
        dated = count_of(count)
        if SECONDS not in chosen or (dated is not None and dated.epoch):
            chosen[UTC] = replace(count, stem=UTC)
    return chosen


def count_of(column: Column) -> NamedCount | None:
    """What the numbers of a column of time count, where its name says so; of a path, its last part."""
    bare = without_brackets(column.name)[0]
    return named_count(plain_name(bare)) or named_count(plain_name(re.split(r"[./]", bare)[-1]))


def has_clock(names: Sequence[str]) -> bool:
    """Whether a column holds dates and times, or Unix time; a count of days may be one part of a date."""
    known = known_columns(names)
    return UNIX in known or (UTC in known and count_of(known[UTC]) is None)


def names_unit(column: Column) -> bool:
    """Whether the name of a column itself gives its unit."""
    bare, texts = without_brackets(column.name)
    last = plain_name(bare).rpartition("_")[2]
    dimension = QUANTITIES[column.stem].dimension
    return bool(written(texts, dimension).unit or unit_of(last, dimension))


def other_columns(names: Sequence[str], used: Mapping[str, Column]) -> list[Column]:
    """Columns whose quantity is read from another column."""
    places = {column.index for column in used.values()}
    others = (_meaning(index, name)[1] for index, name in enumerate(meant(names)) if index not in places)
    return [
        replace(column, name=names[column.index].strip())
        for column in others
        if column is not None and column.stem in QUANTITIES and column.stem in used and not column.unknown
        and not column.misfit
    ]  # fmt: skip


_WEEKS = frozenset("gps_week week gpsweek week_number wn gps_wn".split())
_SECONDS_OF_WEEK = frozenset(
    "gps_tow tow gps_sow sow seconds_of_week time_of_week gps_seconds gps_sec gps_s".split()
)


def week_columns(names: Sequence[str]) -> list[int]:
    """Places of the GPS week and its seconds; empty where one is missing or another time is there."""
    if has_clock(names):
        return []
    plain = [plain_name(without_brackets(name)[0]) for name in names]
    found = [
        next((i for i, name in enumerate(plain) if name in known), -1) for known in (_WEEKS, _SECONDS_OF_WEEK)
    ]
    return [] if -1 in found else found


def plain_name(name: str) -> str:
    """Lower case without accents, words joined by underscores."""
    return _SIGNS.sub("_", unaccented(_HUMP.sub("_", name.strip()[:80]).lower())).strip("_")


def misfits(names: Sequence[str]) -> list[Column]:
    """Columns whose unit is of another quantity than their name."""
    columns = (_meaning(index, name)[1] for index, name in enumerate(names))
    return [column for column in columns if column is not None and column.misfit]


_FIRST = -100
"""Rank of the time of a message itself, before that at which it was recorded."""
_LAST = 1000
"""Rank of a name whose brackets are not understood, behind all others."""


_OF_PATH = 50
"""Rank of a name that is the last part of a path, behind those that stand alone."""


def _meaning(index: int, name: str) -> tuple[int, Column | None]:
    """Rank (0 the usual name) and what the column holds; of a path, ``ref.lat``, its last part says it."""
    rank, column = _meaning_of(index, name)
    parts = re.split(r"[./]", name.strip()) if "." in name or name.startswith("/") else []
    for begin in range(1, len(parts)) if column is None else ():
        rank, column = _meaning_of(index, ".".join(parts[begin:]))
        if column is not None:
            first = _FIRST if parts[-2:] == ["header", "stamp"] else _OF_PATH
            return rank + first, replace(column, name=name.strip())
    if column is not None and parts[-2:] == ["header", "stamp"]:
        rank += _FIRST
    return rank, column


def _meaning_of(index: int, name: str) -> tuple[int, Column | None]:
    bare, texts = without_brackets(name)
    plain = plain_name(bare)
    for words, suffix in ((plain, ""), *_without_unit(plain)):
        stem = _IN_MPS.get(words) or _NAMES.get(words) or ""
        time = _TIME_NAMES.get(words) or ""
        dimension = QUANTITIES[stem].dimension if stem else "time"
        unit = unit_of(suffix, dimension)
        if not (stem or time) or (suffix and not unit):
            continue
        said = written(texts, dimension)
        misfit = bool(said.unit) and said.dimension != dimension
        unknown = said.unknown
        given = said.unit or unit
        if time:
            rank = _TIMES[time].split().index(words)
            column = Column(index, name.strip(), time, given, unknown=unknown, misfit=misfit)
        else:
            default = "mps" if words in _IN_MPS else QUANTITIES[stem].unit
            sure = bool(given) or words in _IN_MPS or (dimension != "speed" and not unknown)
            rank = 5 if words in _IN_MPS | _OF_ERDDAP else QUANTITIES[stem].names.index(words)
            column = Column(index, name.strip(), stem, given or default, sure, unknown, misfit)
        return rank + _LAST * bool(unknown), column
    return 0, None


def _without_unit(plain: str) -> list[tuple[str, str]]:
    """The name without its last one or two words, and these, which may be a unit."""
    words = plain.split("_")
    return [("_".join(words[:-n]), "_".join(words[-n:])) for n in (1, 2) if len(words) > n]
