"""Tables whose columns are named with their unit, to a `Recording`; a fault for each wrong cell or column."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from navcore.errors import Fault, InputError
from navcore.io.series import Recording, Series, SourceReport, stream_report, tidy
from navcore.units import DEG, KNOT

TIME_COLUMNS = ("utc", "t_s")
"""``utc``: ISO 8601; ``t_s``: seconds since the file's own zero. One of them is needed; ``utc`` wins."""
_LIMITS: dict[str, tuple[float, float, float]] = {
    "lat_deg": (-90.0, 90.0, DEG),
    "lon_deg": (-180.0, 360.0, DEG),
    "height_m": (-1e4, 1e5, 1.0),
    "heading_deg": (-360.0, 360.0, DEG),
    "pitch_deg": (-90.0, 90.0, DEG),
    "roll_deg": (-180.0, 180.0, DEG),
    "ve_mps": (-1e3, 1e3, 1.0),
    "vn_mps": (-1e3, 1e3, 1.0),
    "speed_mps": (-1e3, 1e3, 1.0),
    "speed_kn": (-2e3, 2e3, KNOT),
    "speed_starboard_mps": (-1e3, 1e3, 1.0),
    "speed_starboard_kn": (-2e3, 2e3, KNOT),
}
QUANTITY_COLUMNS = tuple(_LIMITS)
"""``speed_*`` is what a log measures along the ship's axis (forward), ``speed_starboard_*`` across it."""
_TOGETHER = (("lat_deg", "lon_deg"), ("ve_mps", "vn_mps"), ("pitch_deg", "roll_deg"))
_MOST_FAULTS = 10


def known_columns(names: Sequence[str]) -> dict[str, int]:
    """Index of each column that is used, by its name in lower case."""
    lowered = [name.strip().lower() for name in names]
    return {name: lowered.index(name) for name in (*TIME_COLUMNS, *QUANTITY_COLUMNS) if name in lowered}


def require_columns(where: str, names: Sequence[str]) -> dict[str, int]:
    """Index of each used column.

    Raises
    ------
    InputError
        No time, no quantity, a column twice, or one of a pair missing.
    """
    found = known_columns(names)
    faults: list[Fault] = []
    if not any(name in found for name in TIME_COLUMNS):
        faults.append(Fault(where, "", None, "missing column: utc (ISO 8601) or t_s (seconds)"))
    if not any(name in found for name in QUANTITY_COLUMNS):
        faults.append(
            Fault(where, "", None, f"no column of a quantity; known: {', '.join(QUANTITY_COLUMNS)}")
        )
    for pair in _TOGETHER:
        faults += [
            Fault(where, "", None, f"missing column: {name} (its partner is there)")
            for name, other in (pair, pair[::-1])
            if other in found and name not in found
        ]
    if any(n.startswith("speed_starboard") for n in found) and not {"speed_mps", "speed_kn"} & found.keys():
        faults.append(
            Fault(where, "", None, "missing column: speed_mps or speed_kn (starboard speed is there)")
        )
    lowered = [name.strip().lower() for name in names]
    faults += [Fault(where, "", name, "column given twice") for name in found if lowered.count(name) > 1]
    if faults:
        raise InputError(faults)
    return found


def numbers(where: str, name: str, cells: Sequence[str], rows: Sequence[int]) -> np.ndarray:
    """Cells of a numeric column as floats; raises `InputError` naming row and column of wrong ones."""
    try:
        return np.array(cells, dtype=float)
    except ValueError:
        raise InputError(_cell_faults(where, name, cells, rows)) from None


def _cell_faults(where: str, name: str, cells: Sequence[str], rows: Sequence[int]) -> list[Fault]:
    faults: list[Fault] = []
    for row, cell in zip(rows, cells, strict=True):
        try:
            float(cell)
        except ValueError:
            hint = " (decimal comma?)" if "," in cell else ""
            faults.append(Fault(f"{where}, row {row}", name, cell, f"is not a number{hint}"))
    return _limited(where, faults)


def _limited(where: str, faults: list[Fault]) -> list[Fault]:
    more = len(faults) - _MOST_FAULTS
    if more <= 0:
        return faults
    return [*faults[:_MOST_FAULTS], Fault(where, "", None, f"and {more} more faults of this kind")]


def utc_seconds(where: str, cells: Sequence[str], rows: Sequence[int]) -> np.ndarray:
    """ISO 8601 cells as UTC s since 1970 (no zone means UTC); raises `InputError` naming the row."""
    from datetime import UTC, datetime

    times = np.empty(len(cells))
    faults: list[Fault] = []
    for index, cell in enumerate(cells):
        try:
            moment = datetime.fromisoformat(cell.strip())
        except ValueError:
            faults.append(Fault(f"{where}, row {rows[index]}", "utc", cell, "is not an ISO 8601 time"))
            continue
        times[index] = (moment if moment.tzinfo else moment.replace(tzinfo=UTC)).timestamp()
    if faults:
        raise InputError(_limited(where, faults))
    return times


def table_recording(
    where: str,
    kind: str,
    columns: Mapping[str, np.ndarray],
    rows: Sequence[int] | np.ndarray,
    warnings: Sequence[str] = (),
) -> Recording:
    """Check the numbers of a table and sort them into quantities.

    Parameters
    ----------
    where, kind : str
        File name, and what it was read as.
    columns : mapping of str to ndarray, shape (n,)
        By column name, in the units of the names; ``utc`` in s since 1970.
    rows : sequence of int, shape (n,)
        Row numbers for faults.
    warnings : sequence of str
        Passed on.

    Raises
    ------
    InputError
        A value is not finite or out of range; time is unordered or repeated.
    """
    clock = next(name for name in TIME_COLUMNS if name in columns)
    time_s = columns[clock]
    faults = _range_faults(where, columns, rows) or _order_faults(where, clock, time_s, rows)
    if faults:
        raise InputError(faults)

    def series(*names: str) -> Series | None:
        if not all(name in columns for name in names):
            return None
        values = np.column_stack([columns[name] * _LIMITS[name][2] for name in names])
        return tidy(time_s, values, where, "+".join(names), dated=clock == "utc")

    used = tuple(name for name in QUANTITY_COLUMNS if name in columns)
    report = stream_report("rows", time_s.size, True, time_s)
    return Recording(
        position=_with_height(series("lat_deg", "lon_deg"), columns),
        velocity=series("ve_mps", "vn_mps"),
        water=_axes_speed(where, columns, time_s, clock == "utc"),
        heading=series("heading_deg"),
        attitude=series("pitch_deg", "roll_deg"),
        sources=(
            SourceReport(
                where, f"{kind} with {', '.join(used)}", time_s.size, (report,), warnings=tuple(warnings)
            ),
        ),
    )


def _with_height(position: Series | None, columns: Mapping[str, np.ndarray]) -> Series | None:
    if position is None:
        return None
    height = columns.get("height_m", np.full(position.time_s.size, np.nan))
    return replace(position, values=np.column_stack([position.values, height]))


def _axes_speed(
    where: str, columns: Mapping[str, np.ndarray], time_s: np.ndarray, dated: bool
) -> Series | None:
    forward = _in_mps(columns, "speed")
    if forward is None:
        return None
    starboard = _in_mps(columns, "speed_starboard")
    across = np.zeros_like(forward) if starboard is None else starboard
    return tidy(time_s, np.column_stack([across, forward]), where, "speed", dated=dated)


def _in_mps(columns: Mapping[str, np.ndarray], stem: str) -> np.ndarray | None:
    for unit, factor in (("mps", 1.0), ("kn", KNOT)):
        if f"{stem}_{unit}" in columns:
            return columns[f"{stem}_{unit}"] * factor
    return None


def _range_faults(
    where: str, columns: Mapping[str, np.ndarray], rows: Sequence[int] | np.ndarray
) -> list[Fault]:
    faults: list[Fault] = []
    for name, values in columns.items():
        low, high = _LIMITS[name][:2] if name in _LIMITS else (-1e12, 1e12)
        outside = np.flatnonzero(~((values >= low) & (values <= high)))
        column = [
            Fault(
                f"{where}, row {rows[i]}",
                name,
                float(values[i]),
                f"must be a number from {low:g} to {high:g}",
            )
            for i in outside[: _MOST_FAULTS + 1]
        ]
        faults += _limited(where, column)
    return faults


def _order_faults(
    where: str, clock: str, time_s: np.ndarray, rows: Sequence[int] | np.ndarray
) -> list[Fault]:
    steps = np.diff(time_s)
    wrong = np.flatnonzero(steps <= 0.0)
    if wrong.size == 0:
        return []
    index = int(wrong[0])
    what = (
        "is the same time as the row before"
        if steps[index] == 0.0
        else f"runs backwards by {-steps[index]:g} s"
    )
    more = f" ({wrong.size} such rows)" if wrong.size > 1 else ""
    return [
        Fault(f"{where}, row {rows[index + 1]}", clock, None, f"time {what}{more}; put the rows in order")
    ]
