"""``schuler check``: what a log, track or scenario holds, and what is wrong with it."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import PurePath
from typing import TYPE_CHECKING, Annotated

from tyro.conf import Positional, arg

from schuler_bench.cli.terminal import emit_result, say

if TYPE_CHECKING:
    from navcore.checks.report import FileReport


_WRITE_MAP = "--write-map"
_READERS = ("navcore.checks.imu", "navcore.io.csv", "navcore.io.nmea_recording", "navcore.io.tables")
_SCENARIO_READERS = ("schuler_bench.cli.check_scenario",)
_SCIENTIFIC = ("scipy.io", "h5py")
_BY_ENDING = {
    ".parquet": ("pyarrow.parquet",),
    **dict.fromkeys((".mat", ".nc", ".nc4", ".cdf", ".h5", ".hdf5"), _SCIENTIFIC),
}
"""Modules that read the file, imported before the bounds are set."""


@dataclass(frozen=True)
class CheckCommand:
    """Say what a log, track, heading, IMU or scenario (or a preset, by its name) holds and what is wrong.

    Attributes
    ----------
    file : str
        The file; of several recordings also what does not agree between them.
    map : str
        Map (TOML) that says what the columns of the file mean.
    write_map : str
        Write the guess of such a map to this file, to be edited.
    force : bool
        Let --write-map replace a file that it has not written, or that was edited since.
    json : bool
        Print one JSON document.
    """

    file: Annotated[Positional[tuple[str, ...]], arg(metavar="FILE")]
    map: str | None = None
    write_map: str | None = None
    force: bool = False
    json: bool = False

    def execute(self) -> int:
        """Print the report; 0 when every file was understood, else 2."""
        from navcore.foundation.errors import Fault, InputError

        if not self.file:
            raise InputError(Fault("schuler", "", None, "check needs FILE"))
        if self.write_map is not None:
            self._write_map(self.write_map)
        reports = [guarded_check(file, self.map) for file in self.file]
        good = all(report.ok for report in reports)
        if len(reports) > 1 and good:
            reports.append(_guarded(check_together, self.file, self.map))
            good = reports[-1].ok
        if self.json or any(report.ok for report in reports):
            emit_result(self.json, self._document(reports), lambda: _lines(reports))
        for fault in (fault for report in reports for fault in report.faults):
            say(str(fault))
        return 0 if good else 2

    def _document(self, reports: list[FileReport]) -> dict[str, object]:
        """One report as it is; of several files one each, and what they hold together."""
        documents = [report.as_dict() for report in reports]
        if len(self.file) == 1:
            return documents[0]
        together = documents[len(self.file)] if len(documents) > len(self.file) else None
        return {"files": documents[: len(self.file)], "together": together}

    def _write_map(self, target: str) -> None:
        from navcore.checks.map_guess import guessed_map
        from navcore.foundation.errors import Fault, InputError
        from navcore.foundation.out import require_file, write_file

        if self.map is not None:
            raise InputError(Fault("", _WRITE_MAP, target, "does not go with --map"))
        if len(self.file) > 1:
            raise InputError(Fault("", _WRITE_MAP, target, "is the map of one FILE"))
        require_file(target, "check", self.file, force=self.force, option=_WRITE_MAP)
        text = guessed_map(next(iter(self.file)))
        write_file(target, text, "check", self.file, force=self.force, option=_WRITE_MAP)
        say(f"map: {target}")


def guarded_check(file: str, map_file: str | None = None) -> FileReport:
    """Check a file in a child process with bounds on memory and time: it may come from anywhere.

    A preset is checked here: it is ours, and no kernel is compiled but those that its check needs.
    """
    if map_file is None and _is_preset(file):
        return _check_preset(file)
    more = ()
    if _holds_a_scenario(file):
        _compile_kernels()
        more = _SCENARIO_READERS
    return _guarded(_check_one, (file,), map_file, more)


def _guarded(
    work: Callable[..., FileReport], files: tuple[str, ...], map_file: str | None, more: tuple[str, ...] = ()
) -> FileReport:
    """Do a check in the child."""
    from navcore.checks.report import FileReport
    from navcore.foundation import guarded
    from navcore.foundation.errors import InputError

    endings = (ending for file in files for ending in _BY_ENDING.get(PurePath(file).suffix.lower(), ()))
    readers = (*_READERS, *dict.fromkeys(endings), *more)
    guarded.start(readers, guarded.Limits(2 << 30, cpu_s=120, wall_s=600.0))
    try:
        return guarded.call(files[0], work, files, map_file)
    except InputError as error:
        return FileReport(", ".join(files), "", faults=error.faults)
    finally:
        guarded.stop()


def _check_one(files: tuple[str, ...], map_file: str | None = None) -> FileReport:
    return check(files[0], map_file)


def check_together(files: tuple[str, ...], map_file: str | None = None) -> FileReport:
    """Say what several recordings hold together, in this process."""
    from navcore.checks import together

    return together.check_together(files, map_file)


def _lines(reports: list[FileReport]) -> list[str]:
    """Text of the reports that were understood, an empty line between them."""
    lines: list[str] = []
    for report in (report for report in reports if report.ok):
        lines += [*([""] if lines else []), *report.lines()]
    return lines


def _holds_a_scenario(file: str) -> bool:
    return PurePath(file).suffix.lower() == ".toml"


def _is_preset(file: str) -> bool:
    if os.path.exists(file):  # no name is too long for it
        return False
    from navcore.scenario.file import presets

    return file in presets()


def _compile_kernels() -> None:
    """Compile what the check needs: a bounded child has no time for it, and cannot keep it."""
    from navcore.foundation.kernel_cache import ready

    if not ready():
        from navcore.warm import compile_for_checks

        compile_for_checks(lambda what: say(f"kernels: {what}"))


def check(file: str, map_file: str | None = None) -> FileReport:
    """Check a file (by a map), or a preset by its name, in this process."""
    from navcore.checks.file import check_file
    from navcore.checks.imu import IMU_CHECKER, check_mapped
    from navcore.io.column_map import map_beside

    if mapped := map_file or map_beside(file):
        return check_mapped(file, mapped)
    if _is_preset(file):
        return _check_preset(file)
    if not _holds_a_scenario(file):
        return check_file(file, [IMU_CHECKER])
    from schuler_bench.cli.check_scenario import SCENARIO_CHECKER

    return check_file(file, [SCENARIO_CHECKER])


def _check_preset(name: str) -> FileReport:
    from navcore.checks.report import FileReport
    from navcore.foundation.errors import InputError
    from schuler_bench.cli.check_scenario import check_scenario

    try:
        return check_scenario(name)
    except InputError as error:
        return FileReport(name, "", faults=error.faults)
