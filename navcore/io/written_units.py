"""Units and qualifiers as headers write them: each is understood here, or the column is refused by name.

``[m/s]``, ``(m s-1)``, ``m·s⁻¹``, ``_mps``, ``degrees_north``, ``(deg, true)``, ``(°)``, ``[ms]`` of a time.
"""

import re
import unicodedata
from typing import NamedTuple

from navcore.foundation.units import ARCSEC, DEG, KNOT, MICRO_G, STANDARD_GRAVITY

UNITS = {
    "angle": {"deg": DEG, "rad": 1.0, "mrad": 1e-3, "urad": 1e-6, "arcsec": ARCSEC, "e7": 1e-7 * DEG,
        "cdeg": 0.01 * DEG,
    },
    "speed": {
        "mps": 1.0, "kn": KNOT, "kmh": 1.0 / 3.6, "cms": 0.01, "mms": 1e-3, "mph": 0.44704, "fps": 0.3048,
    },
    "length": {"m": 1.0, "cm": 0.01, "mm": 1e-3, "km": 1e3, "ft": 0.3048, "nm": 1852.0, "mi": 1609.344},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0, "day": 86400.0},
    "rate": {"rad_s": 1.0, "mrad_s": 1e-3, "deg_s": DEG, "mdeg_s": 1e-3 * DEG, "deg_h": DEG / 3600.0},
    "force": {
        "mps2": 1.0, "g": STANDARD_GRAVITY, "mg": 1e-3 * STANDARD_GRAVITY, "ug": MICRO_G, "gal": 0.01,
        "fps2": 0.3048,
    },
}  # fmt: skip
"""SI over each unit, by dimension."""
_SPELT = {
    "angle": {
        "deg": "degs degree degrees grad degre degres grados deg_true degt degrees_true "
        "degrees_north degrees_east degree_north "
        "degree_east degrees_n degrees_e degree_n degree_e",
        "rad": "rads radian radians",
        "mrad": "milliradian milliradians",
        "urad": "microradian microradians",
        "arcsec": "arcsecond arcseconds",
        "cdeg": "centidegree centidegrees centideg",
        "e7": "1e7 deg_e7 dege7 1e_7deg 1e_7_deg deg_1e7",
    },
    "speed": {
        "mps": "m_s ms meter_second meters_second metre_second metres_second m_sec m_s_1 ms_1 m_sec_1 "
        "meter_per_second meters_per_second metre_per_second metres_per_second meter_second_1 "
        "meters_second_1 metre_second_1 metres_second_1",
        "kn": "kt kts kns knot knots knoten nd nds noeud noeuds nudos nodi nmi_h nm_h nmi_h_1 nm_h_1",
        "kmh": "km_h kph kmph km_hr km_h_1 km_hr_1 kilometers_per_hour kilometres_per_hour",
        "cms": "cm_s cm_s_1 cm_sec",
        "mms": "mm_s mm_s_1",
        "mph": "mi_h mile_per_hour miles_per_hour",
        "fps": "ft_s ft_s_1 feet_per_second",
    },
    "length": {
        "m": "meter meters metre metres",
        "cm": "centimeter centimetre",
        "mm": "millimeter millimetre",
        "km": "kilometer kilometers kilometre kilometres",
        "ft": "feet foot",
        "nm": "nmi naut_mi nautical_mile nautical_miles",
        "mi": "mile miles",
    },
    "time": {
        "s": "sec secs second seconds sek sekunden secondes",
        "ms": "msec millis millisecond milliseconds",
        "us": "usec micros microsecond microseconds",
        "ns": "nsec nanos nanosecond nanoseconds",
        "min": "minute minutes minuten",
        "h": "hr hrs hour hours std stunden heures",
        "day": "d days",
    },
    "rate": {
        "rad_s": "rad_sec rad_s_1 rad_sec_1 radps rads_s rad_per_s rad_per_sec radian_s radians_s "
        "radian_per_second radians_per_second radian_second_1 radians_second",
        "mrad_s": "mrad_sec mrad_s_1",
        "deg_s": "dps deg_sec deg_s_1 deg_sec_1 deg_per_s deg_per_sec degps degree_s degrees_s "
        "degree_per_second degrees_per_second degrees_second",
        "mdeg_s": "mdps mdeg_s_1",
        "deg_h": "dph deg_hr deg_h_1 deg_hr_1 deg_hour degree_per_hour degrees_per_hour",
    },
    "force": {
        "mps2": "m_s2 m_s_2 m_s_s m_ss m_sec2 m_sec_2 mss m_per_s2 m_per_s_2 meter_per_second_squared "
        "meters_per_second_squared metre_per_second_squared metres_per_second_squared m_s_squared",
        "g": "gs g_n gn",
        "mg": "milli_g millig",
        "ug": "micro_g microg",
        "gal": "cm_s2 cm_s_2",
        "fps2": "ft_s2 ft_s_2",
    },
}
_NAMES = {
    dimension: {name: unit for unit in units for name in (unit, *_SPELT[dimension].get(unit, "").split())}
    for dimension, units in UNITS.items()
}
_HARMLESS = {
    "angle": frozenset("true t n e north east decimal dec dd wgs84 wgs_84".split()),
    "speed": frozenset("true water ground".split()),
    "length": frozenset("msl wgs84 ellipsoid ellipsoidal".split()),
    "time": frozenset("utc gmt z iso iso8601 8601 gps gpst unix epoch posix time".split()),
    "rate": frozenset(),
    "force": frozenset(),
}
"""Words that say what is taken anyway, or that other modules heed (``gps``)."""
_CONTRARY = frozenset("magnetic mag compass relative local lt".split())
"""Words that make another quantity of a column, whatever unit stands beside them."""
_STAMP_FORM = re.compile(r"(?:y{2,4}|h{1,2})[ymdhs_tz0-9]{0,40}", re.IGNORECASE)
_SPELLINGS = str.maketrans({"⁻": "-", "¹": "1", "²": "2", "·": " ", "⋅": " ", "µ": "u", "μ": "u"})
_LIGATURES = str.maketrans({"œ": "oe", "æ": "ae", "ß": "ss"})
_BRACKETS = re.compile(r"[\[(]([^\[\]()]{1,30})[\])]")
_LONGEST_NAME = 80
_SIGNS = re.compile(r"[^a-z0-9]+")


def unaccented(text: str) -> str:
    """Text without accents: ``Länge`` as ``lange``, ``nœuds`` as ``noeuds``; ASCII as it is."""
    if text.isascii():
        return text
    plain = unicodedata.normalize("NFKD", text.translate(_LIGATURES))
    return "".join(letter for letter in plain if not unicodedata.combining(letter))


class Written(NamedTuple):
    """Meaning of the words in the brackets of a column.

    Attributes
    ----------
    unit : str
        Key of `UNITS`; empty when none is named.
    dimension : str
        Of the unit; that of the quantity, as a rule.
    unknown : str
        Words that are not understood.
    """

    unit: str = ""
    dimension: str = ""
    unknown: str = ""


def without_brackets(name: str) -> tuple[str, list[str]]:
    """Name of a column before its first brackets, and what stands in all of them."""
    bracket = _BRACKETS.search(name[:_LONGEST_NAME])
    return name[: bracket.start()] if bracket else name, _BRACKETS.findall(name[:_LONGEST_NAME])


def unit_of(words: str, dimension: str) -> str:
    """Unit of this dimension that plain words (joined by underscores) name; empty when they name none."""
    return _NAMES[dimension].get(words, "")


def written(texts: list[str], dimension: str) -> Written:
    """Unit and qualifiers in the brackets of a column whose quantity has this dimension."""
    found, unknown = Written(dimension=dimension), ""
    for text in texts:
        words = _plain(text)
        rest = "_".join(word for word in words.split("_") if word not in _HARMLESS[dimension])
        if _CONTRARY & set(words.split("_")):
            return Written(dimension=dimension, unknown=text)
        unit = unit_of(words, dimension) or unit_of(rest, dimension)
        other = next((d for d in UNITS if unit_of(words, d)), "")
        if unit:
            found = found._replace(unit=unit)
        elif other:
            return Written(unit_of(words, other), other)
        elif rest and not (dimension == "time" and _STAMP_FORM.fullmatch(rest)):
            unknown = unknown or text
    return found if found.unit else found._replace(unknown=unknown)


def _plain(text: str) -> str:
    spelt = unaccented(re.sub("[°º]", " deg ", text.translate(_SPELLINGS).lower()))
    return _SIGNS.sub("_", spelt).strip("_")
