"""The damped output of a ship's own INS as a recording in the form in which it came in (theory.md 22)."""

from pathlib import Path

import numpy as np

from navcore.engine.environment import start_utc
from navcore.engine.run import MethodRun, Run
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io import csv, nmea_recording
from navcore.io.column_map import map_beside, read_map
from navcore.io.formats import format_of
from navcore.io.nmea import read_nmea
from navcore.io.rewritten import Moved
from navcore.io.rewritten_nmea import rewritten_line
from navcore.io.rewritten_table import rewritten_table
from navcore.motion.truth import HEADING, LAT, LON, VE, VN
from navcore.scenario.own_ins import Ins

_SAME_S = 1e-3


def moved_by(run: Run, method: MethodRun, clock_s: float = 0.0) -> Moved:
    """Return what damping changes in the INS's output, by the recording's own clock.

    Parameters
    ----------
    run : Run
        On ``[ins]``.
    method : MethodRun
        Of it.
    clock_s : float
        Correction of the recording's clock, s, which is taken off again.
    """
    assert method.output is not None and method.moved is not None
    rows = len(method.t_s)
    recorded = run.truth[:rows]
    place = method.output[:, :2] - recorded[:, [LAT, LON]]
    place[:, 1] = np.remainder(place[:, 1] + np.pi, 2.0 * np.pi) - np.pi
    begins = (start_utc(run.scenario) or 0.0) - clock_s
    return Moved(
        begins + method.t_s,
        place,
        method.output[:, 2:4] - recorded[:, [VE, VN]],
        method.moved[:, :3],
        np.unwrap(recorded[:, HEADING]),
    )


def damped_files(run: Run, method: MethodRun) -> dict[str, str]:
    """Write the files of an INS anew with the damped output in them.

    Parameters
    ----------
    run : Run
        On ``[ins]``.
    method : MethodRun
        Of it; what lies before the run stays as it was recorded, what lies behind its end is left out.

    Returns
    -------
    dict
        Text by name of the file.

    Raises
    ------
    InputError
        The run is on no INS, or a file is neither NMEA 0183 nor a text table.
    """
    ins = run.scenario.ins
    if run.against is None or ins.file is None:
        raise InputError(Fault("", "ins", None, Text("is needed: the output of a ship's own INS")))
    moved = moved_by(run, method, ins.clock_s)
    names = [ins.file] if isinstance(ins.file, str) else list(ins.file)
    return {Path(name).name: damped_file(Path(name), moved, ins) for name in names}


def damped_file(path: Path, moved: Moved, ins: Ins) -> str:
    """Return the text of one file of an INS with its readings moved; raises `InputError`."""
    named = ins.map or map_beside(path)
    kind = format_of(path)
    if kind is nmea_recording:
        return _damped_nmea(path, moved)
    if kind is csv or named:
        return rewritten_table(path, moved, None if named is None else read_map(named))
    allowed = Text(
        "can be written anew only as NMEA 0183 or a text table; the time series hold the damped output"
    )
    raise InputError(Fault(path.name, "ins.file", None, allowed))


def _damped_nmea(path: Path, moved: Moved) -> str:
    log = read_nmea(path)
    lines: list[str | None] = list(log.text.split("\n"))
    numbers, time_s = log.ordered.lines, log.ordered.time_s
    inside = (time_s >= moved.time_s[0]) & (time_s <= moved.time_s[-1] + _SAME_S)
    chosen, first = np.unique(numbers[inside], return_index=True)
    at = moved.at(time_s[inside][first])
    for place, number in enumerate(chosen.tolist()):
        lines[number - 1] = rewritten_line(lines[number - 1] or "", at.row(place))
    for number in numbers[time_s > moved.time_s[-1] + _SAME_S].tolist():
        lines[number - 1] = None
    return "\n".join(line for line in lines if line is not None)
