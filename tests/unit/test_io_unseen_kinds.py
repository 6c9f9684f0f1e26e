"""Files of known kinds of faults that no reader had seen: read rightly, or refused or told by name."""

from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from navcore.checks.file import check_file
from navcore.checks.report import FileReport
from navcore.foundation.earth import WGS84
from navcore.foundation.errors import InputError
from navcore.foundation.units import KNOT
from navcore.io.recording import read_recording
from navcore.motion.base import Site
from navcore.motion.track import TrackMotion
from navcore.sensors.recorded import recording_notices
from navcore.sensors.reference import Reference
from tests.nmea import sentence

START = datetime(2024, 5, 17, 9, 30, tzinfo=UTC)
START_TEXT = "2024-05-17T09:30:00.0Z"
COUNT = 120


def moment(k: float) -> datetime:
    """UTC of row k."""
    return START + timedelta(seconds=k)


def place(k: float) -> tuple[float, float]:
    """Latitude and longitude of a ship that makes about 8 kn."""
    return 50.0 + 1.85e-5 * k, -4.0 + 4.98e-5 * k


def checked(folder: Path, header: str, row: Callable[[int], str], count: int = COUNT) -> FileReport:
    """Report on a table."""
    path = folder / "log.csv"
    path.write_text("\n".join([header, *map(row, range(count))]) + "\n", encoding="utf-8")
    return check_file(path)


def said(report: FileReport) -> str:
    """Faults and warnings."""
    return "\n".join([*map(str, report.faults), *report.warnings])


# ---------------------------------------------------------------- times


@pytest.mark.parametrize(
    "form",
    [
        "%a %b %d %H:%M:%S %Y", "%a %b %d %H:%M:%S UTC %Y", "17. Mai 2024 %H:%M:%S", "17 mai 2024 %H:%M:%S",
        "17-MAG-2024 %H:%M:%S", "Fr. 17.05.2024 %H:%M:%S", "%Y-%m-%d %H:%M:%S (UTC)",
    ],
)  # fmt: skip
def test_the_whole_cell_of_a_time_is_read(tmp_path: Path, form: str) -> None:
    report = checked(tmp_path, "time;heading_deg", lambda k: f"{moment(k):{form}};60")
    assert report.ok, said(report)
    assert report.details["quantities"]["heading"]["start_utc"] == START_TEXT


@pytest.mark.parametrize(
    "form",
    [
        "%Y-%m-%d %H:%M:%S EDT",
        "%Y-%m-%d %H:%M:%S MESZ",
        "UTC+2 %Y-%m-%d %H:%M:%S",
        "17 floréal 2024 %H:%M:%S",
    ],
)
def test_what_is_not_understood_beside_a_time_refuses_it(tmp_path: Path, form: str) -> None:
    report = checked(tmp_path, "time;heading_deg", lambda k: f"{moment(k):{form}};60")
    assert "row 2: time = " in said(report) and "time.zone by a map" in said(report)


def test_seconds_since_2001_are_not_taken_for_the_nineties(tmp_path: Path) -> None:
    zero = datetime(2001, 1, 1, tzinfo=UTC)
    report = checked(tmp_path, "timestamp,heading_deg", lambda k: f"{(moment(k) - zero).total_seconds()},60")
    assert "1993-05-17" in said(report) and "2024-05-17T09:30:00Z" in said(report)
    assert not report.ok and "time.epoch" in said(report)


def test_unix_time_that_may_be_gps_time_names_both_dates(tmp_path: Path) -> None:
    report = checked(tmp_path, "time,heading_deg", lambda k: f"{1400000000 + k},60")
    assert report.ok and "2024-05-17T16:53:20Z" in said(report)
    assert report.details["quantities"]["heading"]["start_utc"].startswith("2014-05-13")


def test_rows_stamped_on_arrival_in_bursts_are_spread(tmp_path: Path) -> None:
    def row(k: int) -> str:
        lat, lon = place(0.25 * k)
        return f"{moment(2.5 * (k // 10) + 0.001 * (k % 10)):%Y-%m-%dT%H:%M:%S.%fZ},{lat:.7f},{lon:.7f},60"

    report = checked(tmp_path, "utc,lat,lon,heading_deg", row, 480)
    position = report.details["quantities"]["position"]
    assert position["count"] == 480 and position["gaps"] == 0 and position["interval_s"] == 0.25
    assert "bursts of 10" in said(report)


def test_rows_too_close_to_be_told_apart_are_counted(tmp_path: Path) -> None:
    report = checked(
        tmp_path, "utc,heading_deg",
        lambda k: f"{moment(k // 2 + 0.0005 * (k % 2)):%Y-%m-%dT%H:%M:%S.%fZ},{60 + 0.01 * k}",
    )  # fmt: skip
    assert "heading_deg: 60 readings within 1 ms" in said(report)
    assert [one["count"] for one in report.details["fields_left_out"]] == [60]


# ---------------------------------------------------------------- hemispheres, places


@pytest.mark.parametrize(
    ("header", "letter", "sign"), [("E/O", "O", -1), ("O/W", "O", 1), ("Est/Ouest", "Ouest", -1)]
)
def test_an_o_is_east_or_west_by_the_letter_beside_it(
    tmp_path: Path, header: str, letter: str, sign: int
) -> None:
    report = checked(
        tmp_path, f"utc,Latitude,N/S,Longitude,{header}",
        lambda k: f"{moment(k):%Y-%m-%dT%H:%M:%SZ},{place(k)[0]:.6f},N,{-place(k)[1]:.6f},{letter}",
    )  # fmt: skip
    low, high = report.details["quantities"]["position"]["lon_deg"]
    assert 3.9 < sign * low < 4.1 and 3.9 < sign * high < 4.1


def test_an_o_that_may_be_either_is_refused(tmp_path: Path) -> None:
    report = checked(
        tmp_path, "utc,lat,lon,side",
        lambda k: f"{moment(k):%Y-%m-%dT%H:%M:%SZ},{place(k)[0]:.6f},{-place(k)[1]:.6f},O",
    )  # fmt: skip
    assert "side = 'O': may mean east (Ost) or west" in said(report)


@pytest.mark.parametrize(("bad", "named"), [(range(5), "09:30:04.0Z"), (range(115, 120), "09:31:55.0Z")])
def test_positions_far_off_at_an_end_are_named(tmp_path: Path, bad: range, named: str) -> None:
    report = checked(
        tmp_path, "utc,lat,lon",
        lambda k: f"{moment(k):%Y-%m-%dT%H:%M:%SZ},{place(k)[0] + (k in bad):.6f},{place(k)[1]:.6f}",
    )  # fmt: skip
    (told,) = [one for one in report.warnings if "farther than a ship gets" in one]
    assert named in told and told.startswith("positions: 5 from")


# ---------------------------------------------------------------- sentences


def logged(folder: Path, lines: list[str]) -> FileReport:
    """Report on a log."""
    path = folder / "log.nmea"
    path.write_text("\n".join(lines) + "\n")
    return check_file(path)


def rmc(k: int, status: str = "A") -> str:
    """Fix of the ship."""
    lat, lon = place(k)
    return sentence(
        f"GPRMC,{moment(k):%H%M%S}.00,{status},50{60 * (lat - 50):08.5f},N,003{60 * (-lon - 3):08.5f},W,"
        "8.00,60.0,170524,,,A"
    )


def test_a_water_speed_that_is_empty_throughout_is_told(tmp_path: Path) -> None:
    report = logged(
        tmp_path, [line for k in range(60) for line in (rmc(k), sentence("VDVBW,,,V,8.0,0.1,A,,V,,V"))]
    )
    assert "VDVBW gives no speed through the water: its field is empty in all 60 sentences" in said(report)


def test_a_position_with_a_time_and_no_status_is_not_invalid(tmp_path: Path) -> None:
    lines = [
        line
        for k in range(60)
        for line in (
            sentence(f"GPZDA,{moment(k):%H%M%S}.00,17,05,2024,00,00"),
            sentence(f"GPGLL,5000.{k:05d},N,00400.00000,W,{moment(k):%H%M%S}.00"),
        )
    ]
    assert logged(tmp_path, lines).details["quantities"]["position"]["count"] == 60


@pytest.mark.parametrize(
    "fix",
    [
        "GPGGA,{t}.00,5000.{k:05d},N,00400.00000,W,1,08,1.0,10.0,M,48.0,M,,",
        "GNGNS,{t}.00,5000.{k:05d},N,00400.00000,W,AA,12,0.9,10.0,48.0,,",
        "GPGLL,5000.{k:05d},N,00400.00000,W,{t}.00,A,A",
    ],
)
def test_a_fix_without_a_date_puts_the_loggers_clock_right(tmp_path: Path, fix: str) -> None:
    lines: list[str] = []
    for k in range(60):
        stamp = f"{moment(k + 33):%Y-%m-%dT%H:%M:%S}.000Z "
        lines.append(stamp + sentence(fix.format(t=f"{moment(k):%H%M%S}", k=k)))
        lines.append(stamp + sentence(f"HEHDT,{60 + k}.0,T"))
    report = logged(tmp_path, lines)
    assert report.details["quantities"]["heading"]["start_utc"] == START_TEXT
    assert "the logger's clock is +33.0 s" in said(report)
    assert np.isfinite(read_recording(tmp_path / "log.nmea").quantities()["heading"].values).all()


# ---------------------------------------------------------------- readings that stand still or are far off


def track_of(folder: Path, row: Callable[[int], str]) -> Path:
    """A ship that turns, as a table; ``row`` gives the cells behind the time."""
    lines = [f"{moment(k):%Y-%m-%dT%H:%M:%SZ},{row(k)}" for k in range(400)]
    path = folder / "track.csv"
    path.write_text("\n".join(["utc,lat,lon,heading_deg,stw_kn", *lines]) + "\n")
    return path


def test_positions_that_stand_while_the_ship_moves_are_named(tmp_path: Path) -> None:
    def row(k: int) -> str:
        lat, lon = place(100 if 100 <= k < 160 else k)
        return f"{lat:.7f},{lon:.7f},60,8.1"

    (told,) = [one for one in check_file(track_of(tmp_path, row)).warnings if "positions" in one]
    assert "60 from 2024-05-17T09:31:40.0Z to 2024-05-17T09:32:39.0Z are the very same" in told


@pytest.mark.parametrize("bad", [range(50, 90), range(50, 55)])
def test_a_heading_that_is_far_off_for_a_while_is_named(tmp_path: Path, bad: range) -> None:
    path = track_of(
        tmp_path,
        lambda k: f"{place(k)[0]:.7f},{place(k)[1]:.7f},{0 if k in bad else 60 + 0.05 * k:.2f},8.1",
    )
    (told,) = [one for one in check_file(path).warnings if one.startswith("heading")]
    assert f"{len(bad)} samples from 2024-05-17T09:30:50.0Z" in told
    notices = recording_notices(
        TrackMotion(file=str(path)), Reference(kind="file", file=str(path), frame="body")
    )
    assert told in notices


@pytest.mark.parametrize("bad", [range(5), range(395, 400), range(100, 120)])
def test_a_run_names_the_bad_positions_and_no_good_one(tmp_path: Path, bad: range) -> None:
    path = track_of(tmp_path, lambda k: f"{place(k)[0] + (k in bad):.7f},{place(k)[1]:.7f},60,8.1")
    with pytest.raises(InputError) as caught:
        TrackMotion(file=str(path)).truth(10, 1.0, Site(0.0, 0.0, 0.0), WGS84)
    first, last = (f"{moment(k):%H:%M:%S}.0Z" for k in (bad[0], bad[-1]))
    assert f"positions: {len(bad)} from" in str(caught.value)
    assert first in str(caught.value) and last in str(caught.value)


def test_a_log_that_reads_nothing_is_no_stream(tmp_path: Path) -> None:
    path = track_of(tmp_path, lambda k: f"{place(k)[0]:.7f},{place(k)[1]:.7f},60,0")
    told = "\n".join(check_file(path).warnings)
    assert "is 0 while the ship makes 8.0 kn" in told and "stream" not in told


@pytest.mark.parametrize(("factor", "slip"), [(1.852, "km/h"), (1.0 / KNOT, "knots taken for m/s")])
def test_the_nearest_unit_is_named(tmp_path: Path, factor: float, slip: str) -> None:
    report = checked(
        tmp_path, "utc,lat,lon,sog_kn,cog_deg",
        lambda k: f"{moment(k):%Y-%m-%dT%H:%M:%SZ},{place(k)[0]:.7f},{place(k)[1]:.7f},{8 * factor:.3f},60",
    )  # fmt: skip
    assert slip in said(report)


# ---------------------------------------------------------------- files of other kinds

OTHERS = {
    b"\xaa\x44\x12\x1c\x2a\x00": "NovAtel",
    b"\x7f\x7f\x02\x02": "RDI PD0",
    b"\xc8\x00\x00\x00#IIP": ".kmall",
    b"\xc8\x00\x00\x00XML0": "Simrad",
    b"\x0a\x0d\x0d\x0a\x1c": "pcap",
    b"(1715938200.000000) can0 09F80100#11223344\n" * 20: "NMEA 2000",
    b"09:30:01.123 R 09F80100 11 22 33 44 55 66 77 88\n" * 20: "NMEA 2000",
    b"2024-05-17T09:30:01.000Z,2,129025,1,255,8,11,22,33,44,55,66,77,88\n" * 20: "NMEA 2000",
    b'{"context":"vessels.x","updates":[{"timestamp":"2024-05-17T09:30:00Z","values":[]}]}\n' * 20: "JSON",
    rb"{\rtf1\ansi utc,lat,lon}": "RTF",
}


@pytest.mark.parametrize("content", OTHERS, ids=lambda content: ascii(content[:12]))
def test_a_file_of_another_kind_is_refused_by_its_name(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "log"
    path.write_bytes(content + (b"" if content[-1:] in b"\n}" else b"\0" * 200))
    (fault,) = check_file(path).faults
    assert f"is {OTHERS[content]}" in str(fault) or OTHERS[content] in str(fault).partition(": ")[2]


def test_a_position_that_its_receiver_calls_unsafe_or_of_another_datum_is_told(tmp_path: Path) -> None:
    lines = [sentence("GPDTM,999,CH95,0.08,N,0.07,E,-47.7,W84")]
    lines += [sentence(rmc(k)[1:-3] + ",U") for k in range(60)]
    told = said(logged(tmp_path, [*lines, lines[0]]))
    assert "60 readings of GPRMC are unsafe for navigation" in told
    assert "of GPDTM are of a datum other than WGS 84" in told
