"""Check several recordings together: what they share, and what of their streams does not agree."""

from collections.abc import Sequence
from typing import Any

from navcore.checks.file import NAMES
from navcore.checks.report import FileReport
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.io.agreement import agreement_warnings, clock_text
from navcore.io.courses import course_warnings
from navcore.io.plausible import speed_warnings
from navcore.io.recording import load, shared_window
from navcore.io.series import utc_text


def check_together(files: Sequence[str], map_file: str | None = None) -> FileReport:
    """Say what several files hold together.

    Parameters
    ----------
    files : sequence of str
        Logs, tracks and headings, each understood by itself; a quantity comes from the first that holds it.
    map_file : str, optional
        Map of the tables among them.

    Returns
    -------
    FileReport
        Not ok where they cannot be joined.
    """
    name = ", ".join(files)
    try:
        recording = load(list(files), map_file=map_file)
        series = recording.quantities()
        window = shared_window(series.values())
    except InputError as error:
        return FileReport(name, "", faults=error.faults)
    dated = all(one.dated for one in series.values())
    when = Text(" from {start}", start=utc_text(window.start_s)) if dated else ""
    details: dict[str, Any] = {
        "shared_s": round(window.span_s, 3),
        "start_utc": utc_text(window.start_s) if dated else None,
        "taken": {quantity: one.source for quantity, one in series.items()},
    }
    text = [Text("  {span_s:.1f} s are shared by all streams{when}", span_s=window.span_s, when=when)]
    text += [
        Text("  {quantity} from {source}", quantity=NAMES[quantity], source=one.source)
        for quantity, one in series.items()
    ]
    text += [Text("  {choice}", choice=choice) for source in recording.sources for choice in source.choices]
    if clock := clock_text(recording):
        text.append(Text("  {clock}", clock=clock))
    warnings = (*speed_warnings(recording), *course_warnings(recording), *agreement_warnings(recording))
    return FileReport(name, Text("together"), details, tuple(text), warnings)
