"""Files a visitor uploads: kept in a folder of the session, checked, made into scenarios that run on them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

from navcore.foundation import guarded
from navcore.foundation.assets import asset_path
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR
from navcore.motion.truth import LAT, LON
from navcore.scenario.model import Scenario
from schuler_bench.http.limits import MIB, Limits
from schuler_bench.session.folder import TEMPORARY, opened, remove_files, temporary_name

if TYPE_CHECKING:
    from navcore.checks.file import FileReport

LARGEST_FILE = Limits().upload_bytes
"""The server's limit of an upload: there is one."""
MOST_FILES = 12
LARGEST_FOLDER = 64 * MIB

_WITH_FILES = ("motion", "reference", "imu")
"""Blocks of a scenario that may name files: a visitor's must name none of the server's."""
IMU = "imu"
_ALIGNED_S = 600.0
_ALIGNED_PART = 0.5
"""Of a short IMU record, that is at most spent on the alignment."""
_SPEEDS = ("water", "ground", "velocity")


@dataclass(frozen=True)
class Upload:
    """One understood file.

    Attributes
    ----------
    path : Path
        Where it is stored.
    kind : str
        What it was understood as.
    quantities : frozenset of str
        What it holds: position, heading, velocity, water, ground, attitude, or `IMU`.
    text : tuple of str
        What it holds, for reading.
    warnings : tuple of str
        What the user should know.
    details : mapping
        What the check found in it.
    """

    path: Path
    kind: str
    quantities: frozenset[str]
    text: tuple[str, ...]
    warnings: tuple[str, ...]
    details: Mapping[str, Any] = field(default_factory=dict)


@dataclass
class Uploads:
    """The files of one session, in a folder that is made when the first one comes.

    Attributes
    ----------
    folder : Path
        Where they are stored.
    files : dict
        By name.
    has_room : callable
        ``has_room(size)``: whether the server can keep so many bytes more.
    keep_once : callable
        ``keep_once(path)`` lets a file share its content with equal ones.
    """

    folder: Path
    files: dict[str, Upload] = field(default_factory=dict)
    has_room: Callable[[int], bool] = lambda _: True
    keep_once: Callable[[Path], None] = lambda _: None

    def add(self, name: str, content: bytes) -> Upload:
        """Store and check a log, track, heading or IMU file.

        Parameters
        ----------
        name : str
            As the browser calls it; made safe.
        content : bytes
            The file.

        Raises
        ------
        InputError
            Too large, too many, or not understood (one fault for each thing wrong); nothing is kept then.
        """
        from schuler_bench.http.frames import safe_file_name

        name = safe_file_name(name)
        self._refuse_excess(name, len(content))
        path, fresh = self.folder / name, temporary_name()
        with opened(self.folder, make=True) as folder:
            try:
                with folder.create(fresh) as file:
                    file.write(content)
                report = guarded.call(name, check_recording, self.folder / fresh)
                if not report.ok:
                    raise InputError(Fault(name, f.field, f.value, f.allowed) for f in report.faults)
                self.keep_once(self.folder / fresh)
                folder.place(fresh, name)
            finally:
                folder.discard(fresh)
        self.files[name] = _understood(path, report)
        return self.files[name]

    def _refuse_excess(self, name: str, size: int) -> None:
        kept = sum(upload.path.stat().st_size for other, upload in self.files.items() if other != name)
        for excess, allowed in (
            (
                size > LARGEST_FILE,
                Text(
                    "has {size:.1f} MiB; at most {largest_file:.0f} MiB are accepted",
                    size=size / MIB,
                    largest_file=LARGEST_FILE / MIB,
                ),
            ),
            (
                not self.has_room(size),
                Text("cannot be kept: the room of this server for uploaded files is used up"),
            ),
            (
                name not in self.files and len(self.files) >= MOST_FILES,
                Text("at most {most_files} files are kept; remove the others first", most_files=MOST_FILES),
            ),
            (
                kept + size > LARGEST_FOLDER,
                Text(
                    "all files together have more than {largest_folder:.0f} MiB",
                    largest_folder=LARGEST_FOLDER / MIB,
                ),
            ),
        ):
            if excess:
                raise InputError(Fault(name, "", None, allowed))

    def reopen(self) -> None:
        """Take over the files that lie in the folder, from before the server was started; others are left."""
        from schuler_bench.http.frames import safe_file_name

        with opened(self.folder) as folder:
            for name in folder.files(TEMPORARY.fullmatch):
                folder.remove(name, "an upload that was not finished")
            files = folder.files(lambda name: safe_file_name(name) == name)
        for name in sorted(files, key=lambda name: files[name].st_mtime)[:MOST_FILES]:
            path = self.folder / name
            try:
                report = guarded.call(path.name, check_recording, path)
            except InputError:
                continue
            if report.ok:
                self.files[path.name] = _understood(path, report)

    def clear(self) -> None:
        """Remove all files and the folder."""
        self.files.clear()
        remove_files(self.folder)

    def holding(self, *quantities: str) -> list[str]:
        """Paths of the files that hold any of these quantities, in the order in which they came."""
        return [str(u.path) for u in self.files.values() if u.quantities.intersection(quantities)]


def check_recording(path: Path) -> FileReport:
    """Say what a log, track, heading or IMU file holds."""
    from navcore.checks.file import check_file
    from navcore.checks.imu import IMU_CHECKER

    return check_file(path, [IMU_CHECKER])


def _understood(path: Path, report: FileReport) -> Upload:
    held = (IMU,) if report.kind.startswith("recorded IMU") else report.details.get("quantities", ())
    return Upload(path, report.kind, frozenset(held), report.text, report.warnings, report.details)


def recorded_scenario(scenario: Scenario, uploads: Uploads) -> tuple[Scenario, list[str]]:
    """Let a scenario run on the uploaded recordings.

    A log among them becomes the reference; positions and heading become the motion, and the site is set to
    the track's start. The duration is set to the time that all of them share.

    Parameters
    ----------
    scenario : Scenario
        Its methods, sensors and initial errors are kept.
    uploads : Uploads
        At least one file.

    Returns
    -------
    Scenario, and in words what was changed.

    Raises
    ------
    InputError
        The recordings share no time, or cannot be used.
    """
    from navcore.sensors.recorded import recorded_window

    if uploads.holding(IMU):
        return _on_recorded_imu(scenario, uploads)
    data, notes = scenario.canonical(), []
    speeds = uploads.holding(*_SPEEDS)
    if uploads.holding("position") and uploads.holding("heading"):
        data["motion"] = {"kind": "track", "file": uploads.holding("position", "heading", "attitude")}
        notes.append(Text("The ship follows the uploaded track and heading."))
    elif uploads.holding("position", "heading"):
        missing = "heading" if uploads.holding("position") else Text("track (positions)")
        notes.append(
            Text("The track is not used yet: a {missing} is missing. Upload it too.", missing=missing)
        )
    # A speed log proper has speeds along the ship's axes; a receiver has its course and speed.
    logs = uploads.holding("water", "ground") or speeds
    if logs:
        kept = {k: v for k, v in data["reference"].items() if k in ("event", "outage")}
        data["reference"] = {"kind": "file", "file": logs, **kept, "frame": "body"}
        notes.append(
            Text(
                "The reference is the uploaded log {name}.",
                name=Text.joined(", ", (Path(path).name for path in logs)),
            )
        )
    parsed = Scenario.parse(data)
    window = recorded_window(parsed.motion, parsed.reference)
    if window is None:
        raise InputError(
            Fault("", "upload", None, Text("holds neither a log nor a track with heading: nothing to run on"))
        )
    step_s = parsed.run.step_s
    span_s = math.floor(window.span_s / step_s) * step_s
    data["run"] |= {
        "duration_h": span_s / HOUR,
        "output_step_s": min(parsed.run.output_step_s, max(step_s, 1.0)),
    }
    notes.append(Text("The duration is the {span_s:g} s that all uploaded streams share.", span_s=span_s))
    if parsed.motion.recorded:
        start = parsed.motion.truth(1, 1.0, parsed.site.site(), parsed.earth, window.start_s).values[0]
        lat_deg, lon_deg = float(start[LAT]) / DEG, float(start[LON]) / DEG
        data["site"] |= {"lat_deg": round(lat_deg, 6), "lon_deg": round(lon_deg, 6)}
        notes.append(
            Text(
                "The site is the track's start, {lat_deg:.4f}°, {lon_deg:.4f}°.",
                lat_deg=lat_deg,
                lon_deg=lon_deg,
            )
        )
    data["title"], data["source"] = Text("Uploaded recording"), Text.joined(", ", uploads.files)[:300]
    return Scenario.parse(data), notes


def _on_recorded_imu(scenario: Scenario, uploads: Uploads) -> tuple[Scenario, list[str]]:
    """Align and navigate on the newest uploaded IMU record, of a vehicle that stands."""
    name, upload = next((n, u) for n, u in reversed(uploads.files.items()) if IMU in u.quantities)
    data, details = scenario.canonical(), upload.details
    place, span_s = details["place"], float(details["span_s"])
    aligned_s = math.floor(min(_ALIGNED_S, _ALIGNED_PART * span_s))
    data["imu"] = {"file": str(upload.path), "axes": "frd" if details["up_axis"] == "-z" else "rfu"}
    data["motion"], data["reference"] = {"kind": "static"}, {"kind": "log"}
    data["alignment"] = {"kind": "compass", "duration_s": float(aligned_s)}
    data["run"] |= {
        "fidelity": "strapdown",
        "rate_hz": details["rate_hz"],
        "duration_h": math.floor(span_s - aligned_s - 1.0) / HOUR,
        "output_step_s": min(scenario.run.output_step_s, 1.0),
    }
    notes: list[str] = [
        Text(
            "Full strapdown on {name}: {aligned_s} s of alignment, then navigation, with "
            "a log that reads zero: the vehicle is taken to stand.",
            name=name,
            aligned_s=aligned_s,
        )
    ]
    if place is not None:
        data["site"] = place
        notes.append(
            Text(
                "The site is that of the file, {lat_deg:.4f}°, {lon_deg:.4f}°.",
                lat_deg=place["lat_deg"],
                lon_deg=place["lon_deg"],
            )
        )
    data["title"], data["source"] = Text("Recorded IMU"), name[:300]
    return Scenario.parse(data), notes


def shared_files(scenario: Scenario, names: Mapping[str, Path]) -> Scenario:
    """Let the file names of a scenario mean the uploaded files of the same name.

    A visitor's scenario must not read other files of the server than the recordings that come with it.

    Raises
    ------
    InputError
        A file is named that has not been uploaded.
    """
    ours = {path.name: path for path in asset_path("recordings").glob("*.csv")} | dict(names)
    data, faults = plain_names(scenario.canonical()), list[Fault]()

    def path_of(field: str, name: str) -> str:
        if name not in ours:
            wanted = Text("upload this file first, then the scenario")
            faults.append(Fault("", field, name, wanted))
        return str(ours.get(name, name))

    data = _renamed(data, path_of)
    if faults:
        raise InputError(faults)
    return Scenario.parse(data)


def opened_scenario(name: str, content: bytes, uploads: Uploads) -> Scenario:
    """Read an uploaded scenario file; the recordings it names must have been uploaded too.

    Raises
    ------
    InputError
        Not a scenario, or one fault for each thing wrong in it.
    """
    if len(content) > MIB:
        raise InputError(Fault(name, "", None, Text("is larger than 1 MiB: no scenario")))
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError:
        raise InputError(Fault(name, "", None, Text("is not UTF-8 text: no scenario"))) from None
    scenario = Scenario.parse(guarded.call(name, complete_scenario, text, name), name)
    try:
        return shared_files(scenario, {held: upload.path for held, upload in uploads.files.items()})
    except InputError as error:
        raise error.located(name) from None


def complete_scenario(text: str, name: str) -> dict[str, Any]:
    """Every field of a scenario given as TOML text; raises `InputError`."""
    from navcore.scenario.file import parse_toml

    return Scenario.parse(parse_toml(text, name), name).canonical()


def with_plain_names(scenario: Scenario) -> Scenario:
    """For a download: files by their names alone, to be put beside the scenario."""
    if all(getattr(getattr(scenario, block), "file", None) is None for block in _WITH_FILES):
        return scenario
    return Scenario.parse(plain_names(scenario.canonical()))


def plain_names(data: dict[str, Any]) -> dict[str, Any]:
    """A scenario's canonical data with its files by their names alone."""
    return _renamed(data, lambda _, name: Path(name.replace("\\", "/")).name)


def _renamed(data: dict[str, Any], rename: Callable[[str, str], str]) -> dict[str, Any]:
    """Give every file in a scenario's canonical data the name ``rename(field, name)``."""
    data = dict(data)
    for block, key in product(_WITH_FILES, ("file", "map")):
        named = data.get(block, {}).get(key)
        if named:
            single = isinstance(named, str)
            names = [rename(f"{block}.{key}", str(name)) for name in ([named] if single else named)]
            data[block] = data[block] | {key: names[0] if single else names}
    return data
