"""Names that say what numbers of time count: Julian dates, MJD, MATLAB's and spreadsheets' days, NTP.

One table serves columns, the units of NetCDF and HDF5 variables, and the unit of a map.
"""

import re
from typing import NamedTuple


class NamedCount(NamedTuple):
    """What a name says.

    Attributes
    ----------
    unit : str
        Key of `navcore.io.written_units.UNITS` of times.
    epoch : str
        Key of `navcore.io.times.counts.EPOCHS`; empty where the size of the numbers says which: a "julian
        day" may be a Julian date, an MJD or a day of the year.
    """

    unit: str
    epoch: str


_NAMES = {
    NamedCount("day", "jd"): "jd jdn julian_date julian_dates julian_day_number astronomical_julian_date "
    "jd_utc",
    NamedCount("day", "mjd"): "mjd modified_julian_date modified_julian_day modified_julian_days "
    "mod_julian_date mod_julian_day mjd_utc",
    NamedCount("day", "2000"): "mjd2000 mjd_2000 jd2000 jd_2000",
    NamedCount("day", "1950"): "cnes_julian_day cnes_jd jd_cnes julian_day_cnes",
    NamedCount("day", "matlab"): "datenum tnum matlab_time matlab_datenum matlab_date matlab_days",
    NamedCount("day", "excel"): "excel_date excel_time excel_serial excel_days ole_date oadate",
    NamedCount("s", "ntp"): "ntp ntp_time ntp_seconds",
    NamedCount("s", "labview"): "labview_time labview_timestamp",
    NamedCount("s", "j2000"): "j2000 j2000_s j2000_seconds seconds_since_j2000 time_j2000",
    NamedCount("day", ""): "julian_day julian_days julian jday jul_day julday julian_time decimal_julian_day "
    "doy decimal_doy day_of_year dayofyear yday yearday year_day decimal_day decimal_yearday jd_day",
}  # fmt: skip
_COUNTS = {name: count for count, names in _NAMES.items() for name in names.split()}
COUNT_NAMES = " ".join(_COUNTS)
"""All names, plain, the better-known ones first."""
_SIGNS = re.compile(r"[^a-z0-9]+")


def named_count(name: str) -> NamedCount | None:
    """Meaning of a plain name (`navcore.io.column_names.plain_name`), or of a unit as it is written."""
    return _COUNTS.get(_SIGNS.sub("_", name.strip().lower()).strip("_"))
