"""Names that say what numbers count: Julian dates, MJD, days of a year; in tables, NetCDF and maps alike."""

from pathlib import Path

import numpy as np
import pytest

from navcore.io.column_map import parse_map
from navcore.io.column_names import known_columns
from navcore.io.imu_table import read_imu_table
from navcore.io.recording import read_recording
from navcore.io.series import Recording
from navcore.io.times.named_counts import named_count

START = 1715938200.0
"""2024-05-17T09:30:00Z, day 138 of the year."""
DAY = 86400.0
DAYS = (START + 2.0 * np.arange(60)) / DAY
ZEROS = {
    "jd": 2440587.5,
    "mjd": 40587.0,
    "2000": -10957.0,
    "1950": 7305.0,
    "matlab": 719529.0,
    "excel": 25569.0,
}
"""Days at the epoch of Unix time."""
NAMES = {
    "julian_day": "jd",
    "JD": "jd",
    "Julian Date": "jd",
    "JulianDay (UTC)": "jd",
    "julian_day (days)": "mjd",
    "MJD": "mjd",
    "Modified Julian Date": "mjd",
    "mjd2000": "2000",
    "CNES Julian day": "1950",
    "datenum": "matlab",
    "excel_time": "excel",
    "nav.jd": "jd",
}


def _read(folder: Path, header: str, cells: np.ndarray, more: str = "") -> Recording:
    path = folder / "log.csv"
    rows = "".join(f"{cell:.9f},{60 + k}{more}\n" for k, cell in enumerate(cells))
    path.write_text(f"{header}\n{rows}")
    return read_recording(path)


def _starts(read: Recording, dated: bool = True, at: float = START) -> None:
    assert read.heading is not None and read.heading.dated == dated
    np.testing.assert_allclose(read.heading.time_s, at + 2.0 * np.arange(60), atol=1e-3)


@pytest.mark.parametrize("name", NAMES)
def test_a_named_count_is_dated_and_told(tmp_path: Path, name: str) -> None:
    read = _read(tmp_path, f"{name},heading_deg", DAYS + ZEROS[NAMES[name]])
    _starts(read)
    assert any(f"column {name} counts days since" in told for told in read.warnings)


@pytest.mark.parametrize("zero", ZEROS)
def test_a_name_that_means_several_counts_goes_by_the_size(tmp_path: Path, zero: str) -> None:
    if zero != "2000":  # of that size are also days since 1970
        _starts(_read(tmp_path, "julian_day,heading_deg", DAYS + ZEROS[zero]))


def test_a_name_whose_dates_cannot_be_goes_by_the_size(tmp_path: Path) -> None:
    _starts(_read(tmp_path, "mjd,heading_deg", DAYS + ZEROS["jd"]))


@pytest.mark.parametrize("name", ["doy", "Day of Year", "jday", "julian_day", "yearday"])
def test_days_of_a_year_have_no_date_without_a_year_and_say_the_remedy(tmp_path: Path, name: str) -> None:
    days = DAYS - 19723.0 + 1.0  # 2024-01-01 is day 19723 of Unix time
    assert int(days[0]) == 138
    read = _read(tmp_path, f"{name},heading_deg", days)
    _starts(read, dated=False, at=float(days[0]) * DAY)
    (told,) = [words for words in read.warnings if "a zero that is not known" in words]
    assert "2023-12-31" in told and "column year" in told
    path = tmp_path / "log.csv"
    text = f'time = {{ column = "{name}", unit = "day", epoch = "2023-12-31" }}\n[quantity.heading_deg]\n'
    _starts(read_recording(path, parse_map(f'{text}column = "heading_deg"\n', "map")))
    _starts(_read(tmp_path, f"{name},heading_deg,year", days, ",2024"))


@pytest.mark.parametrize(("unit", "zero"), [("mjd", "mjd"), ("Julian date", "jd"), ("julian day", "jd")])
def test_a_map_takes_the_same_names_as_units(tmp_path: Path, unit: str, zero: str) -> None:
    path = tmp_path / "log.csv"
    rows = "".join(f"{cell:.9f},{60 + k}\n" for k, cell in enumerate(DAYS + ZEROS[zero]))
    path.write_text(f"zeit,kurs\n{rows}")
    text = f'time = {{ column = "zeit", unit = "{unit}" }}\n[quantity.heading_deg]\ncolumn = "kurs"\n'
    _starts(read_recording(path, parse_map(text, "map")))


def test_another_time_goes_before_a_count_and_a_date_before_the_own_zero() -> None:
    assert known_columns(["doy", "utc", "heading"])["utc"].name == "utc"
    assert "utc" not in known_columns(["t_s", "doy", "heading"])
    assert known_columns(["t_s", "mjd", "heading"])["utc"].name == "mjd"
    assert known_columns(["date", "time", "jday", "heading"]).keys() == {"date", "clock", "heading"}


def test_an_imu_may_have_a_julian_date() -> None:
    times = (START + 0.01 * np.arange(200)) / DAY + ZEROS["jd"]
    rows = "".join(f"{time:.10f},0,0,1e-5,0,0,9.8\n" for time in times)
    header = "jd,gx_rad_s,gy_rad_s,gz_rad_s,fx_mps2,fy_mps2,fz_mps2\n"
    table = read_imu_table((header + rows).encode(), "imu.csv")
    np.testing.assert_allclose(table.time_s, 0.01 * np.arange(200), atol=2e-4)


def test_names_of_counts_are_known_however_they_are_written() -> None:
    assert named_count("Modified Julian Date") == named_count("mjd")
    assert named_count("days") is None
