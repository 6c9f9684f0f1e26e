"""Numbers of time are known by their size and by what comes of them, whatever their step."""

from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.io.column_map import parse_map
from navcore.io.recording import read_recording
from navcore.io.series import Series
from navcore.io.times.counts import EPOCHS, Ambiguous, read_counts
from navcore.io.times.steps import leap_seconds

START = datetime(2024, 5, 17, 9, 30, tzinfo=UTC).timestamp()
LEAP = 18.0
SIZES = {
    "s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "day": 86400.0, "h": 3600.0, "tick": 1e-7,
}  # fmt: skip
COUNTS = [
    ("s", "unix"), ("ms", "unix"), ("us", "unix"), ("ns", "unix"),
    ("day", "excel"), ("day", "mjd"), ("day", "matlab"), ("day", "jd"),
    ("tick", "filetime"), ("tick", "dotnet"),
]  # fmt: skip
"""Unit and epoch that the numbers alone tell apart."""


def _counted(unit: str, epoch: str, step_s: float = 1.0, count: int = 120) -> np.ndarray:
    return (START + step_s * np.arange(count) - EPOCHS[epoch]) / SIZES[unit]


@pytest.mark.parametrize(("unit", "epoch"), COUNTS)
@pytest.mark.parametrize("step_s", [0.1, 1.0, 10.0])
def test_the_size_of_the_numbers_says_epoch_and_unit(unit: str, epoch: str, step_s: float) -> None:
    found = read_counts(_counted(unit, epoch, step_s))
    assert found.dated
    assert found.time_s[[0, -1]] == pytest.approx([START, START + 119 * step_s], abs=0.05)
    assert bool(found.told) == (epoch != "unix")


@pytest.mark.parametrize(
    ("unit", "epoch"), [("day", "unix"), ("day", "2000"), ("s", "ntp"), ("s", "labview")]
)
def test_of_several_epochs_that_can_be_it_is_asked_with_their_dates(unit: str, epoch: str) -> None:
    shift = -4 * 365.25 * 86400.0 if epoch == "ntp" else 0.0
    with pytest.raises(Ambiguous, match=r"since .* \(20\d\d-.* or .* since"):
        read_counts(_counted(unit, epoch) + shift)


@pytest.mark.parametrize("places", [3, 4, 5, 6])
def test_rounded_days_are_days(tmp_path: Path, places: int) -> None:
    path = tmp_path / "log.csv"
    rows = zip(_counted("day", "excel"), range(120), strict=True)
    path.write_text("time,heading_deg\n" + "".join(f"{t:.{places}f},{60 + 0.1 * k:.1f}\n" for t, k in rows))
    if places == 3:  # two or three stamps for two minutes
        with pytest.raises(InputError, match="too coarse or rounded"):
            read_recording(path)
        return
    heading = read_recording(path).heading
    assert heading is not None
    assert heading.time_s.size == 120
    assert heading.time_s[[0, -1]] == pytest.approx([START, START + 119.0], abs=9.0)


def test_a_day_alone_is_no_time_of_many_rows(tmp_path: Path) -> None:
    for name, cell in (("days", "45429"), ("dates", "2024-05-17")):
        path = tmp_path / f"{name}.csv"
        path.write_text("time,heading_deg\n" + "".join(f"{cell},{k}\n" for k in range(20)))
        with pytest.raises(InputError, match="1 times of 20 rows"):
            read_recording(path)


def test_rows_within_less_than_a_millisecond_are_no_log(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("t_s,heading_deg\n" + "".join(f"{5.0 + 1e-6 * k:.6f},{k}\n" for k in range(50)))
    with pytest.raises(InputError, match="counted in another unit, such as days or years"):
        read_recording(path)


def _mapped(folder: Path, time: str, cells: list[str]) -> Series:
    path = folder / "log.csv"
    path.write_text("zeit;kurs\n" + "".join(f"{cell};{k},5\n" for k, cell in enumerate(cells)))
    column_map = parse_map(
        f'time = {{ column = "zeit", {time} }}\ndecimal = ","\n[quantity.heading]\ncolumn = "kurs"\n', "map"
    )
    heading = read_recording(path, column_map).heading
    assert heading is not None
    return heading


MAPS = [
    ('unit = "day"', "day", "excel"),
    ('unit = "day", epoch = "1899-12-30"', "day", "excel"),
    ('unit = "days since 1904-01-01"', "day", "excel1904"),
    ('unit = "day", epoch = "matlab"', "day", "matlab"),
    ('unit = "hours since 1900-01-01 00:00:00"', "h", "1900"),
    ('unit = "s", epoch = "2000-01-01"', "s", "2000"),
    ('unit = "ms", epoch = "unix"', "ms", "unix"),
    ('unit = "us"', "us", "unix"),
    ('unit = "s", epoch = "labview"', "s", "labview"),
    ('unit = "day", epoch = "2000-01-01T12:00:00"', "day", "j2000"),
]


@pytest.mark.parametrize(("time", "unit", "epoch"), MAPS)
def test_a_map_takes_any_unit_and_epoch_with_a_decimal_comma(
    tmp_path: Path, time: str, unit: str, epoch: str
) -> None:
    cells = [f"{value:.8f}".replace(".", ",") for value in _counted(unit, epoch, count=20)]
    series = _mapped(tmp_path, time, cells)
    assert series.dated
    assert series.time_s == pytest.approx(START + np.arange(20.0), abs=1e-2)
    assert series.values[1, 0] == pytest.approx(np.deg2rad(1.5))


def test_a_map_counts_gps_seconds_and_weeks_that_have_rolled_over(tmp_path: Path) -> None:
    gps = START + LEAP - EPOCHS["gps"] + np.arange(5.0)
    series = _mapped(tmp_path, 'unit = "s", epoch = "gps"', [f"{t:.1f}".replace(".", ",") for t in gps])
    assert series.time_s == pytest.approx(START + np.arange(5.0))
    path = tmp_path / "weeks.csv"
    weeks, seconds = gps // 604800 % 1024, gps % 604800
    path.write_text(
        "week,sow,hdg\n" + "".join(f"{w:.0f},{s:.1f},5\n" for w, s in zip(weeks, seconds, strict=True))
    )
    column_map = parse_map(
        'time = { column = ["week", "sow"], unit = "gps_week_s" }\n[quantity.heading]\ncolumn = "hdg"\n',
        "map",
    )
    read = read_recording(path, column_map)
    assert read.heading is not None
    assert read.heading.time_s == pytest.approx(START + np.arange(5.0))
    assert any("2048 added" in told for told in read.warnings)


@pytest.mark.parametrize(
    "time", ['unit = "day", epoch = "yesterday"', 'unit = "fortnights"', 'unit = "iso", epoch = "excel"']
)
def test_a_map_refuses_what_it_does_not_know(tmp_path: Path, time: str) -> None:
    with pytest.raises(InputError, match="time.epoch|time.unit"):
        _mapped(tmp_path, time, ["1", "2"])


def test_dates_and_times_run_together_are_read(tmp_path: Path) -> None:
    found = read_counts(np.array([20240517093000.0, 20240517093059.0, 20240517093100.0]))
    assert found.time_s == pytest.approx([START, START + 59.0, START + 60.0])


def test_leap_seconds_of_some_dates() -> None:
    assert [leap_seconds(datetime(y, 1, 2, tzinfo=UTC).timestamp()) for y in (1980, 1999, 2016, 2017)] == [
        0,
        13,
        17,
        18,
    ]


def test_weeks_and_seconds_of_gps_in_two_columns_need_no_map(tmp_path: Path) -> None:
    gps = START + LEAP - EPOCHS["gps"] + np.arange(5.0)
    path = tmp_path / "log.csv"
    rows = "".join(f"{t // 604800:.0f},{t % 604800:.1f},{60 + k}\n" for k, t in enumerate(gps))
    path.write_text("gps_week,gps_tow,heading_deg\n" + rows)
    heading = read_recording(path).heading
    assert heading is not None
    assert heading.time_s == pytest.approx(START + np.arange(5.0))
    rows = "".join(f"{t // 604800:.0f} {t % 604800:.1f} 50.0 -4.0 12.0 1\n" for t in gps)
    (tmp_path / "log.pos").write_text("%  GPST  latitude(deg) longitude(deg)  height(m)   Q\n" + rows)
    position = read_recording(tmp_path / "log.pos").position
    assert position is not None
    assert position.time_s == pytest.approx(START + np.arange(5.0))


def test_times_of_day_as_digits_are_told_from_seconds() -> None:
    digits = np.array([93058.0, 93059.0, 93100.0, 93101.0])
    assert read_counts(digits).time_s == pytest.approx(34258.0 + np.arange(4.0))
    assert read_counts(93000.0 + np.arange(200.0)).time_s[-1] == 93199.0


@pytest.mark.parametrize("first", [138.4, 2024.375])
def test_days_of_a_year_and_years_are_asked_for(tmp_path: Path, first: float) -> None:
    path = tmp_path / "log.csv"
    path.write_text("time,heading_deg\n" + "".join(f"{first + k / 3e7:.10f},{k}\n" for k in range(50)))
    with pytest.raises(InputError, match="such as days or years"):
        read_recording(path)
