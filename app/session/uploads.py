"""Files a visitor uploads: kept in a folder of the session, checked, with the maps of their columns."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from navcore.foundation import guarded
from navcore.foundation.assets import asset_path
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.stage_cache import MAP_SUFFIX
from navcore.foundation.text import Text
from navcore.io.column_map import map_beside, parse_map
from navcore.io.recording import NO_TABLE
from navcore.scenario.file import FILE_FIELDS, names_files
from navcore.scenario.model import Scenario
from schuler_bench.http.limits import MIB, Limits
from schuler_bench.session.folder import TEMPORARY, opened, remove_files, temporary_name

if TYPE_CHECKING:
    from navcore.checks.map_guess import Preview
    from navcore.checks.report import FileReport

LARGEST_FILE = Limits().upload_bytes
"""The server's limit of an upload: there is one."""
MOST_FILES = 12
LARGEST_FOLDER = 64 * MIB

IMU = "imu"


@dataclass(frozen=True)
class Upload:
    """One file, understood or a table whose columns are still to be named.

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
    faults : tuple of Fault
        Why it cannot be used before a map says what its columns mean.
    table : Preview or None
        Of a table that a map may describe.
    map : mapping
        Data of its map, or of the guess where none is saved; empty without a table.
    mapped : bool
        Whether a map is saved beside it.
    """

    path: Path
    kind: str
    quantities: frozenset[str]
    text: tuple[str, ...]
    warnings: tuple[str, ...]
    details: Mapping[str, Any] = field(default_factory=dict)
    faults: tuple[Fault, ...] = ()
    table: Preview | None = None
    map: Mapping[str, Any] = field(default_factory=dict)
    mapped: bool = False


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
        """Store and check a log, track, heading or IMU file; a map saved beside its name is used again.

        Parameters
        ----------
        name : str
            As the browser calls it; made safe.
        content : bytes
            The file.

        Raises
        ------
        InputError
            Too large, too many, or not understood and no table (one fault for each thing wrong); nothing is
            kept then.
        """
        from schuler_bench.http.frames import safe_file_name

        name = safe_file_name(name)
        self._refuse_excess(name, len(content))
        path, fresh = self.folder / name, temporary_name()
        with opened(self.folder, make=True) as folder:
            try:
                with folder.create(fresh) as file:
                    file.write(content)
                found = self._found(path, self.folder / fresh, _map_beside(path))
                self.keep_once(self.folder / fresh)
                folder.place(fresh, name)
            finally:
                folder.discard(fresh)
        self.files[name] = found
        return found

    def _found(self, path: Path, stored: Path, map_text: str) -> Upload:
        """Content of a stored file that is to be at ``path``; raises `InputError` when it is not kept."""
        report, table, data = guarded.call(path.name, look_at, stored, map_text)
        faults = tuple(Fault(_own(f.where, stored, path), f.field, f.value, f.allowed) for f in report.faults)
        if faults and table is None:
            raise InputError(Fault(path.name, f.field, f.value, f.allowed) for f in faults)
        imu = report.kind.startswith("recorded IMU")
        held = frozenset((IMU,) if imu else report.details.get("quantities", ()))
        said = report.text, report.warnings, report.details
        return Upload(path, report.kind, held, *said, faults, table, data, bool(map_text))

    def use_map(self, name: str, data: Mapping[str, Any] | None) -> Upload:
        """Read a table by a map from now on, which is saved beside it; None: by the guess.

        Raises
        ------
        InputError
            The map is wrong, or the table cannot be read by it; nothing is changed then.
        """
        from navcore.checks.map_guess import as_toml

        before, beside, fresh = self.files[name], name + MAP_SUFFIX, temporary_name()
        if before.table is None:
            raise InputError(Fault(name, "map", None, NO_TABLE))
        text = "" if data is None else as_toml(dict(data), before.table, name)
        found = self._found(before.path, before.path, text)
        if text and found.faults:
            raise InputError(found.faults)
        with opened(self.folder) as folder:
            folder.discard(beside)
            if text:
                with folder.create(fresh) as file:
                    file.write(text.encode())
                folder.place(fresh, beside)
        self.files[name] = found
        return found

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
            files = folder.files(lambda name: safe_file_name(name) == name and not name.endswith(MAP_SUFFIX))
        for name in sorted(files, key=lambda name: files[name].st_mtime)[:MOST_FILES]:
            path = self.folder / name
            with suppress(InputError, UnicodeDecodeError):
                self.files[name] = self._found(path, path, _map_beside(path))

    def clear(self) -> None:
        """Remove all files and the folder."""
        self.files.clear()
        remove_files(self.folder)

    def holding(self, *quantities: str) -> list[str]:
        """Paths of the files that hold any of these quantities, in the order in which they came."""
        return [str(u.path) for u in self.files.values() if u.quantities.intersection(quantities)]


def look_at(path: Path, map_text: str = "") -> tuple[FileReport, Preview | None, dict[str, Any]]:
    """Say what a recording holds, and of a table what it looks like and what its map says."""
    from navcore.checks.file import check_file
    from navcore.checks.imu import IMU_CHECKER, check_mapped
    from navcore.checks.map_guess import guess, preview_of

    report = check_mapped(path, parse_map(map_text, "map")) if map_text else check_file(path, [IMU_CHECKER])
    try:
        table = preview_of(path)
    except InputError:
        table = None
    return report, table, {} if table is None else tomllib.loads(map_text) if map_text else guess(table)


def _map_beside(path: Path) -> str:
    """Text of the map that is saved beside a file; empty where there is none."""
    beside = map_beside(path)
    return "" if beside is None else beside.read_text(encoding="utf-8")


def _own(where: str, stored: Path, path: Path) -> str:
    """A fault's place with the file's own name in place of that under which it is stored."""
    if isinstance(where, Text):
        values = where.values.items()
        own = {name: _own(value, stored, path) if isinstance(value, str) else value for name, value in values}
        return Text(*where.forms, **own)
    return where.replace(str(stored), path.name).replace(stored.name, path.name)


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
    if not names_files(scenario):
        return scenario
    return Scenario.parse(plain_names(scenario.canonical()))


def plain_names(data: dict[str, Any]) -> dict[str, Any]:
    """A scenario's canonical data with its files by their names alone."""
    return _renamed(data, lambda _, name: Path(name.replace("\\", "/")).name)


def _renamed(data: dict[str, Any], rename: Callable[[str, str], str]) -> dict[str, Any]:
    """Give every file in a scenario's canonical data the name ``rename(field, name)``."""
    data = dict(data)
    for block, key in FILE_FIELDS:
        named = data.get(block, {}).get(key)
        if named:
            single = isinstance(named, str)
            names = [rename(f"{block}.{key}", str(name)) for name in ([named] if single else named)]
            data[block] = data[block] | {key: names[0] if single else names}
    return data
