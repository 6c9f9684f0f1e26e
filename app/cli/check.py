"""``schuler check``: what a log, track or scenario holds, and what is wrong with it."""

from __future__ import annotations

import os
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
        The file.
    map : str
        Map (TOML) that says what the columns of the file mean.
    write_map : str
        Write the guess of such a map to this file, to be edited.
    force : bool
        Let --write-map replace a file that it has not written, or that was edited since.
    json : bool
        Print one JSON document.
    """

    file: Annotated[Positional[str], arg(metavar="FILE")]
    map: str | None = None
    write_map: str | None = None
    force: bool = False
    json: bool = False

    def execute(self) -> int:
        """Print the report; 0 when the file was understood, else 2."""
        if self.write_map is not None:
            self._write_map(self.write_map)
        report = guarded_check(self.file, self.map)
        if self.json or report.ok:
            emit_result(self.json, report.as_dict(), report.lines)
        for fault in report.faults:
            say(str(fault))
        return 0 if report.ok else 2

    def _write_map(self, target: str) -> None:
        from navcore.checks.map_guess import guessed_map
        from navcore.foundation.errors import Fault, InputError
        from navcore.foundation.out import require_file, write_file

        if self.map is not None:
            raise InputError(Fault("", _WRITE_MAP, target, "does not go with --map"))
        require_file(target, "check", [self.file], force=self.force, option=_WRITE_MAP)
        text = guessed_map(self.file)
        write_file(target, text, "check", [self.file], force=self.force, option=_WRITE_MAP)
        say(f"map: {target}")


def guarded_check(file: str, map_file: str | None = None) -> FileReport:
    """Check a file in a child process with bounds on memory and time: it may come from anywhere.

    A preset is checked here: it is ours, and no kernel is compiled but those that its check needs.
    """
    from navcore.checks.report import FileReport
    from navcore.foundation import guarded
    from navcore.foundation.errors import InputError

    if map_file is None and _is_preset(file):
        return _check_preset(file)
    readers = (*_READERS, *_BY_ENDING.get(PurePath(file).suffix.lower(), ()))
    if _holds_a_scenario(file):
        _compile_kernels()
        readers += _SCENARIO_READERS
    guarded.start(readers, guarded.Limits(2 << 30, cpu_s=120, wall_s=600.0))
    try:
        return guarded.call(file, check, file, map_file)
    except InputError as error:
        return FileReport(file, "", faults=error.faults)
    finally:
        guarded.stop()


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
