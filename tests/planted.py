"""Five good recordings of different formats, and the faults that are planted into them one at a time.

Four are of a ship that zigzags: a receiver's track and heading in one file, the log in another. The fifth is
the IMU of a moored ship that rocks. A fault changes the numbers of one column, as a wrong unit, sign, epoch
or clock does, while its header says what it did before.
"""

from __future__ import annotations

import gzip
import math
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyarrow
from pyarrow import parquet
from scipy.io import savemat

from navcore.checks.file import check_file
from navcore.checks.imu import IMU_CHECKER
from navcore.foundation.errors import InputError
from navcore.foundation.units import DEG, KNOT
from navcore.io.recording import read_recording
from navcore.motion.track import TrackMotion
from navcore.sensors.recorded import recording_notices
from navcore.sensors.reference import Reference
from tests.nmea import START as NMEA_START
from tests.nmea import gga, rmc, sentence, stamped, write

Columns = dict[str, np.ndarray]
LARGE = 0.05
"""A fault counts when it moves a value by more."""
_SPAN_S = 1500
_BEGIN = datetime(2024, 5, 13, 9, tzinfo=UTC).timestamp()
_WEEK_S = 604800.0


def ship() -> tuple[Columns, Columns]:
    """Track and log of a ship under way at 9 to 13 kn off South Africa, 1 Hz, with noise and a current."""
    t = np.arange(float(_SPAN_S))
    noise = np.random.default_rng(5).normal
    heading = np.deg2rad(70.0 + 75.0 * np.clip(2.0 * np.sin(2 * np.pi * t / 600.0), -1.0, 1.0))
    forward = 5.6 + 1.1 * np.sin(2 * np.pi * t / 430.0)
    starboard = 0.5 * np.cos(2 * np.pi * t / 330.0)
    east = forward * np.sin(heading) + starboard * np.cos(heading) + 0.25
    north = forward * np.cos(heading) - starboard * np.sin(heading) - 0.15
    lat, lon = math.radians(-34.2), math.radians(18.1)
    places = {
        "lat": np.rad2deg(lat + np.cumsum(north) / 6.36e6) + noise(0, 2e-6, t.size),
        "lon": np.rad2deg(lon + np.cumsum(east) / (6.385e6 * math.cos(lat))) + noise(0, 2e-6, t.size),
    }
    course = np.rad2deg(np.arctan2(east, north)) % 360.0
    track = {
        "time": _BEGIN + t,
        **places,
        "sog": np.hypot(east, north) / KNOT + noise(0, 0.05, t.size),
        "cog": (course + noise(0, 0.5, t.size)) % 360.0,
        "ve": east + noise(0, 0.03, t.size),
        "vn": north + noise(0, 0.03, t.size),
        "heading": (np.rad2deg(heading) + noise(0, 0.2, t.size)) % 360.0,
    }
    log = {
        "time": _BEGIN + t + 0.4,
        "speed": forward / KNOT + noise(0, 0.05, t.size),
        "starboard": starboard / KNOT + noise(0, 0.05, t.size),
    }
    return track, log


def rocking_imu() -> Columns:
    """Means of 0.02 s of a ship at 34.2 N that rolls and pitches at its berth, x right, y forward, z up."""
    t = 0.02 * np.arange(1, 15001)
    roll = np.deg2rad(3.0) * np.sin(2 * np.pi * t / 8.0)
    pitch = np.deg2rad(2.0) * np.sin(2 * np.pi * t / 5.5)
    yaw = np.deg2rad(1.0) * np.sin(2 * np.pi * t / 14.0)
    up = np.column_stack([-np.cos(pitch) * np.sin(roll), np.sin(pitch), np.cos(pitch) * np.cos(roll)])
    rates = np.gradient(np.column_stack([pitch, roll, yaw]), t, axis=0)
    sine, cosine = np.sin(roll), np.cos(roll)
    body = np.column_stack([
        cosine * rates[:, 0] - sine * np.cos(pitch) * rates[:, 2],
        rates[:, 1] + np.sin(pitch) * rates[:, 2],
        sine * rates[:, 0] + cosine * np.cos(pitch) * rates[:, 2],
    ])  # fmt: skip
    earth = 7.292115e-5 * np.array([0.0, math.cos(math.radians(34.2)), math.sin(math.radians(34.2))])
    noise = np.random.default_rng(6).normal
    body = body + earth + noise(0, 1e-6, body.shape)
    force = 9.797 * up + noise(0, 1e-3, up.shape)
    return {"t": t} | {
        f"{kind}{axis}": values[:, i]
        for kind, values in (("g", body), ("f", force))
        for i, axis in enumerate("xyz")
    }


class Fault(NamedTuple):
    """What is done to one column.

    Attributes
    ----------
    name : str
    columns : tuple of str
        To which of them it may be done.
    change : callable
        Numbers to numbers.
    """

    name: str
    columns: tuple[str, ...]
    change: Callable[[np.ndarray], np.ndarray]


def _times(factor: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda values: values * factor


def _later(seconds: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda values: values + seconds


_EARLY = 100


def _early(values: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Other numbers for the first rows."""
    return np.where(np.arange(values.size) < _EARLY, others, values)


_SPEEDS_KN, _SPEEDS_MPS = ("sog", "speed", "starboard"), ("ve", "vn")
_ANGLES, _PLACES = ("cog", "heading"), ("lat", "lon")
_RATES, _FORCES = ("gx", "gy", "gz"), ("fx", "fy", "fz")
SHIP_FAULTS = (
    *(Fault(f"{unit} as kn", _SPEEDS_KN, _times(size)) for unit, size in
      (("m/s", KNOT), ("km/h", 1.852), ("cm/s", 100 * KNOT),
       ("mph", 1.1508), ("ft/s", 1.6878), ("0.1 kn", 10.0))),
    *(Fault(f"{unit} as m/s", _SPEEDS_MPS, _times(size)) for unit, size in
      (("kn", 1 / KNOT), ("km/h", 3.6), ("cm/s", 100.0), ("ft/s", 3.2808))),
    *(Fault(f"{unit} as deg", (*_ANGLES, *_PLACES), _times(size)) for unit, size in
      (("rad", DEG), ("mrad", 1e3 * DEG), ("arcmin", 60.0), ("turns", 1 / 360))),
    Fault("the other sign", (*_SPEEDS_KN, *_SPEEDS_MPS, *_PLACES), np.negative),
    Fault("counter-clockwise", _ANGLES, lambda values: -values % 360.0),
    Fault("from where it comes", _ANGLES, lambda values: (values + 180.0) % 360.0),
    Fault("from east", _ANGLES, lambda values: (90.0 - values) % 360.0),
    Fault("without sign", _PLACES, np.abs),
    Fault("degrees and minutes as deg", _PLACES, lambda v: np.trunc(v) * 100.0 + (v - np.trunc(v)) * 60.0),
    *(Fault(name, ("time",), _later(size)) for name, size in
      (("a clock 79 s slow", -79.0), ("a clock 79 s fast", 79.0), ("leap seconds", 18.0),
       ("a clock 3 min fast", 180.0),
       ("an hour", 3600.0), ("five hours west", -18000.0), ("1024 weeks", -1024 * _WEEK_S),
       ("GPS time", -315964800.0), ("NTP time", 2208988800.0))),
    Fault("minutes as seconds", ("time",), lambda values: _BEGIN + (values - _BEGIN) / 60.0),
    Fault("ms as seconds", ("time",), lambda values: _BEGIN + (values - _BEGIN) * 1e3),
    Fault("a clock that was set late", ("time",), lambda v: _early(v, 10.0 + np.arange(v.size))),
    Fault("a clock of 2000 that was set late", ("time",), lambda values: _early(values, values - 7.6e8)),
    Fault("1024 weeks at first", ("time",), lambda values: _early(values, values - 1024 * _WEEK_S)),
    Fault("leap seconds at first", ("time",), lambda values: _early(values, values + 18.0)),
    Fault("an hour at first", ("time",), lambda values: _early(values, values + 3600.0)),
    Fault("an hour less at first", ("time",), lambda values: _early(values, values - 3600.0)),
    Fault("seven minutes at first", ("time",), lambda values: _early(values, values + 420.0)),
    Fault("days as seconds", ("time",), lambda values: values / 86400.0 + 25569.0),
    Fault("rounded days as seconds", ("time",), lambda values: np.round(values / 86400.0 + 25569.0, 4)),
    Fault("LabVIEW time", ("time",), _later(2082844800.0)),
    Fault("whole minutes", ("time",), lambda values: np.floor(values / 60.0) * 60.0),
)  # fmt: skip
IMU_FAULTS = (
    *(Fault(f"{unit} as rad/s", _RATES, _times(size)) for unit, size in
      (("deg/s", 1 / DEG), ("deg/h", 3600 / DEG), ("mrad/s", 1e3))),
    *(Fault(f"{unit} as m/s²", _FORCES, _times(size)) for unit, size in
      (("g", 1 / 9.80665), ("mg", 1e3 / 9.80665), ("cm/s²", 100.0), ("ft/s²", 3.2808))),
    Fault("the other sign", (*_RATES, *_FORCES), np.negative),
    *(Fault(f"{unit} as s", ("t",), _times(size)) for unit, size in
      (("ms", 1e3), ("µs", 1e6), ("min", 1 / 60), ("h", 1 / 3600))),
)  # fmt: skip


def _iso(times: np.ndarray) -> list[str]:
    moments = (datetime.fromtimestamp(round(t, 3), UTC) for t in times.tolist())
    return [f"{m:%Y-%m-%dT%H:%M:%S}.{m.microsecond // 1000:03d}Z" for m in moments]


def _csv(path: Path, columns: dict[str, object]) -> Path:
    cells = [
        c if isinstance(c, list) else [f"{v:.10g}" for v in np.asarray(c).tolist()] for c in columns.values()
    ]
    path.write_text(
        "\n".join([",".join(columns), *(",".join(row) for row in zip(*cells, strict=True))]) + "\n"
    )
    return path


def _nmea(folder: Path, track: Columns, log: Columns) -> list[Path]:
    zero = NMEA_START.timestamp()
    rows = zip(*(track[k].tolist() for k in ("time", "lat", "lon", "sog", "cog", "heading")), strict=True)
    lines = (
        stamped(t - zero, body)
        for t, lat, lon, sog, cog, heading in rows
        for body in (
            rmc(t - zero, lat, lon, sog, cog), gga(t - zero, lat, lon, 20.0), f"HEHDT,{heading:.2f},T"
        )
    )  # fmt: skip
    speeds = zip(*(log[k].tolist() for k in ("time", "speed", "starboard")), strict=True)
    log_lines = (stamped(t - zero, f"VDVBW,{f:.2f},{s:.2f},A,,,,,,,") for t, f, s in speeds)
    return [write(folder / "track.nmea", lines), write(folder / "log.nmea", log_lines)]


def _text(folder: Path, track: Columns, log: Columns) -> list[Path]:
    names = {"lat": "lat_deg", "lon": "lon_deg", "sog": "SOG (kn)", "cog": "COG (deg)", "heading": "heading"}
    first = {"utc": _iso(track["time"]), **{name: track[k] for k, name in names.items()}}
    second = {"utc": _iso(log["time"]), "speed_kn": log["speed"], "speed_starboard_kn": log["starboard"]}
    return [_csv(folder / "track.csv", first), _csv(folder / "log.csv", second)]


def _velocities(track: Columns) -> Columns:
    names = {"lat": "latitude", "lon": "longitude", "ve": "ve_mps", "vn": "vn_mps", "heading": "heading_deg"}
    return {"unix_time": track["time"], **{name: track[k] for k, name in names.items()}}


def _speeds(log: Columns) -> Columns:
    return {"unix_time": log["time"], "speed_kn": log["speed"], "speed_starboard_kn": log["starboard"]}


def _parquet(folder: Path, track: Columns, log: Columns) -> list[Path]:
    parquet.write_table(pyarrow.table(_velocities(track)), folder / "track.parquet")
    parquet.write_table(pyarrow.table(_speeds(log)), folder / "log.parquet")
    return [folder / "track.parquet", folder / "log.parquet"]


def _mat(folder: Path, track: Columns, log: Columns) -> list[Path]:
    savemat(folder / "track.mat", _velocities(track))
    np.savez(folder / "log.npz", allow_pickle=False, **_speeds(log))
    return [folder / "track.mat", folder / "log.npz"]


def write_imu(folder: Path, columns: Columns) -> Path:
    names = {"t": "t_s", **{k: f"{k}_{'rad_s' if k[0] == 'g' else 'mps2'}" for k in (*_RATES, *_FORCES)}}
    return _csv(folder / "imu.csv", {name: columns[k] for k, name in names.items()})


FORMATS: dict[str, tuple[Callable[[Path, Columns, Columns], list[Path]], frozenset[str]]] = {
    "NMEA": (_nmea, frozenset({"ve", "vn"})),
    "CSV": (_text, frozenset({"ve", "vn"})),
    "Parquet": (_parquet, frozenset({"sog", "cog"})),
    "MAT and npz": (_mat, frozenset({"sog", "cog"})),
}
"""Writer, and the columns that the format's file does not hold."""
IMU = "IMU"


def _lines(change: Callable[[str], str]) -> Callable[[bytes], bytes]:
    """Change of every line."""
    return lambda content: "".join(f"{change(line)}\n" for line in content.decode().splitlines()).encode()


def _bodies(old: str, new: str, every: int = 1) -> Callable[[bytes], bytes]:
    """Change of the body of every so many sentences, with a right checksum."""
    count = 0

    def changed(line: str) -> str:
        nonlocal count
        before, _, behind = line.partition("$")
        body = behind.partition("*")[0]
        count += old in body
        return before + sentence(body.replace(old, new)) if old in body and count % every == 0 else line

    return _lines(changed)


def _outage(content: bytes) -> bytes:
    lines = content.decode().splitlines()
    return (
        "\n".join(line for k, line in enumerate(lines) if not 600 < k < 900 or "HDT" in line).encode() + b"\n"
    )


def _cut_off(content: bytes) -> bytes:
    """Sentences without a checksum, of which some end within a number."""
    lines = [line.partition("*")[0] for line in content.decode().splitlines()]
    return "".join(
        f"{line[:-3] if 'HDT' in line and k % 9 == 0 else line}\n" for k, line in enumerate(lines)
    ).encode()


FILE_FAULTS: dict[str, tuple[str, str, Callable[[bytes], bytes]]] = {
    "every line twice": ("NMEA", "track", _lines(lambda line: f"{line}\n{line}")),
    "every row twice": ("CSV", "track", _lines(lambda line: line if line[:1] == "u" else f"{line}\n{line}")),
    "the file behind itself": ("CSV", "log", lambda content: content + content.partition(b"\n")[2]),
    "NUL before each sentence": ("NMEA", "track", lambda content: content.replace(b"$", b"\0$")),
    "sentences that are cut off": ("NMEA", "track", _cut_off),
    "simulated": ("NMEA", "track", _bodies(",,,A", ",,,S")),
    "estimated": ("NMEA", "track", _bodies(",1,08,", ",6,08,")),
    "not valid": ("NMEA", "track", _bodies(",,,A", ",,,N")),
    "a log that has lost the water": ("NMEA", "log", _bodies(",A,", ",V,")),
    "a log that now and then has lost the water": ("NMEA", "log", _bodies(",A,", ",V,", 3)),
    "an outage of the satellites": ("NMEA", "track", _outage),
    "no header": ("CSV", "track", lambda content: content.partition(b"\n")[2]),
    "decimal commas": ("CSV", "log", lambda content: content.replace(b",", b";").replace(b".", b",")),
    "gzip": ("CSV", "log", lambda content: gzip.compress(content)),
}
"""Format, part, and what is done to its whole file."""


def told_of_file(name: str, folder: Path) -> tuple[list[str], bool]:
    """All that is said of a file with such a fault, and whether it is read as without the fault."""
    form, part, change = FILE_FAULTS[name]
    track, log = ship()
    good = FORMATS[form][0](folder, track, log)[part == "log"]
    before = read_recording(good).quantities()
    good.write_bytes(change(good.read_bytes()))
    report = check_file(good, [IMU_CHECKER])
    words = [*report.warnings, *map(str, report.faults)]
    if not report.ok:
        return words, False
    after = read_recording(good).quantities()
    same = before.keys() == after.keys() and all(
        np.array_equal(before[k].time_s, after[k].time_s)
        and np.array_equal(before[k].values, after[k].values, equal_nan=True)
        for k in before
    )
    return words, same


class Case(NamedTuple):
    """One recording with one fault, or none (``fault`` None).

    Attributes
    ----------
    format, column : str
    fault : Fault or None
    part : str
        ``track`` or ``log`` of a ship's files; empty for the IMU.
    """

    format: str
    column: str = ""
    fault: Fault | None = None
    part: str = ""

    @property
    def name(self) -> str:
        """For people."""
        return f"{self.format}, {self.part} {self.column}: {self.fault.name if self.fault else 'as it is'}"


def cases() -> Iterator[Case]:
    """All combinations."""
    track, log = ship()
    for form, (_, absent) in FORMATS.items():
        for part, columns in (("track", track), ("log", log)):
            for fault in SHIP_FAULTS:
                for column in fault.columns:
                    if column in columns and column not in absent:
                        yield Case(form, column, fault, part)
    for fault in IMU_FAULTS:
        for column in fault.columns:
            yield Case(IMU, column, fault)


def moved(case: Case) -> float:
    """By how much the fault moves a value, as a part of the column's size."""
    assert case.fault is not None
    columns = (
        rocking_imu() if case.format == IMU else dict(zip(("track", "log"), ship(), strict=True))[case.part]
    )
    before = columns[case.column]
    off = np.abs(case.fault.change(before) - before)
    return float(np.median(off) / np.median(np.abs(before - (_BEGIN if case.column == "time" else 0.0))))


def told(case: Case, folder: Path) -> list[str]:
    """All that checks and a run on the files say: warnings, refusals."""
    if case.format == IMU:
        columns = rocking_imu()
        if case.fault is not None:
            columns[case.column] = case.fault.change(columns[case.column])
        files = [write_imu(folder, columns)]
    else:
        parts = dict(zip(("track", "log"), ship(), strict=True))
        if case.fault is not None:
            parts[case.part][case.column] = case.fault.change(parts[case.part][case.column])
        try:
            files = FORMATS[case.format][0](folder, parts["track"], parts["log"])
        except (ValueError, OverflowError, OSError):
            return ["no such file can be written"]
    words: list[str] = []
    for file in files:
        report = check_file(file, [IMU_CHECKER])
        words += [*report.warnings, *map(str, report.faults)]
    if case.format == IMU:
        return words
    try:
        motion = TrackMotion(file=str(files[0]))
        reference = Reference(kind="file", file=str(files[1]), frame="body")
        words += recording_notices(motion, reference)
    except InputError as error:
        words += map(str, error.faults)
    return words
