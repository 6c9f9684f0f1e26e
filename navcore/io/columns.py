"""Tables whose columns are known by name, to a `Recording`; a fault for each wrong cell or column."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.column_names import (
    CLOCK,
    DATE,
    QUANTITIES,
    SECONDS,
    UNIX,
    UTC,
    Column,
    known_columns,
    misfits,
    plain_name,
)
from navcore.io.placeholders import AIS_NO_COURSE, not_available
from navcore.io.radians import with_radians
from navcore.io.series import LeftOut, Recording, Series, SourceReport, stream_report, tidy
from navcore.io.table_times import Table, of_one_clock, order_faults, rate_faults

MOST_COLUMNS = 1000
MOST_CELLS = 6_000_000
"""Cells of the columns that are used; more are refused before they are unpacked."""
_TOGETHER = (("lat", "lon", "deg"), ("ve", "vn", "mps"), ("pitch", "roll", "deg"))
_ACROSS = (("speed_starboard", "speed"), ("ground_starboard", "ground"))
_MOST_FAULTS = 10
_MOST_NAMED = 30
_MISSING_NUMBERS = (-99.0, -999.0, -999.9, -9999.0, -99999.0, -8888.0, 999.9, 9999.0, 99999.0)
"""Numbers that stand for no reading, where they are out of the column's range."""


def require_columns(where: str, names: Sequence[str]) -> dict[str, Column]:
    """Columns that are used, by what they hold.

    Raises
    ------
    InputError
        No time, no quantity, a column twice, one of a pair missing, or too many columns. Names what was found
        and what is needed.
    """
    if len(names) > MOST_COLUMNS:
        raise InputError(
            Fault(
                where,
                "",
                None,
                Text("has more than {most_columns} columns: no log", most_columns=MOST_COLUMNS),
            )
        )
    columns = known_columns(names)
    held = listed(names)
    faults: list[Fault] = []
    if not {UTC, UNIX, SECONDS} & columns.keys() and not {DATE, CLOCK} <= columns.keys():
        missing = Text("missing column: utc (ISO 8601) or t_s (seconds); columns found: {held}", held=held)
        faults.append(Fault(where, "", None, missing))
    if not QUANTITIES.keys() & columns.keys():
        missing = Text(
            "no column of a quantity; columns found: {held}; known: lat_deg, lon_deg, "
            "height_m, heading_deg, pitch_deg, roll_deg, ve_mps, vn_mps, sog_kn with "
            "cog_deg, speed_kn or speed_mps (through the water), speed_starboard_kn, "
            "ground_kn, ground_starboard_kn",
            held=held,
        )
        faults.append(Fault(where, "", None, missing))
    faults += pair_faults(where, columns)
    lowered = [name.strip().lower() for name in names]
    faults += [
        Fault(where, "", column.name.lower(), Text("column given twice"))
        for column in columns.values()
        if lowered.count(column.name.lower()) > 1
    ]
    faults += [
        Fault(
            where,
            "",
            column.name,
            Text(
                "names a unit or qualifier that is not understood: {unknown}; "
                "rename the column, with a unit as in heading_deg, speed_mps, time (ms)",
                unknown=column.unknown,
            ),
        )
        for column in columns.values()
        if column.unknown
    ]
    if faults:
        raise InputError(faults)
    return columns


def pair_faults(where: str, columns: Mapping[str, Column]) -> list[Fault]:
    """A fault for each column whose partner is missing."""
    faults: list[Fault] = []
    for first, second, unit in _TOGETHER:
        faults += [
            Fault(
                where,
                "",
                None,
                Text(
                    "missing column: {name}_{unit} (its partner {name_2} is there)",
                    name=name,
                    unit=unit,
                    name_2=columns[other].name,
                ),
            )
            for name, other in ((first, second), (second, first))
            if other in columns and name not in columns
        ]
    for across, along in _ACROSS:
        if across in columns and along not in columns:
            needed = Text("{along}_mps or {along}_kn", along=along)
            faults.append(
                Fault(
                    where,
                    "",
                    None,
                    Text("missing column: {needed} (starboard speed is there)", needed=needed),
                )
            )
    return faults


def listed(names: Sequence[str]) -> str:
    """Names for a message, the first of many."""
    listed = ", ".join(name.strip()[:40] for name in names[:_MOST_NAMED])
    return listed + (
        Text(" and {names} more", names=len(names) - _MOST_NAMED) if len(names) > _MOST_NAMED else ""
    )


def limited(where: str, faults: list[Fault]) -> list[Fault]:
    """The first ten faults of a kind, and how many more there are."""
    more = len(faults) - _MOST_FAULTS
    if more <= 0:
        return faults
    return [
        *faults[:_MOST_FAULTS],
        Fault(where, "", None, Text("and {more} more faults of this kind", more=more)),
    ]


def _is_bare(column: Column) -> bool:
    """Whether a name says speed and its unit alone."""
    return not {"over", "ground", "made", "grnd", "gps"} & set(plain_name(column.name).split("_"))


def column_warnings(names: Sequence[str], known: Mapping[str, Column]) -> list[str]:
    """Warn of columns that are not used, in case one is misspelt, and of units that were guessed."""
    used = {column.index for column in known.values()}
    unused = [name for index, name in enumerate(names) if index not in used and name.strip()]
    words: list[str] = [Text("columns not used: {listed}", listed=listed(unused))] if unused else []
    guessed = [column for column in known.values() if not column.unit_given]
    words += [
        Text("column {name} names no unit: taken as {unit}", name=column.name, unit=column.unit)
        for column in guessed
    ]
    words += [
        Text("column {name} left out: {unit} is no unit of what its name says", name=c.name, unit=c.unit)
        for c in misfits(names)
    ]
    if (
        "sog" in known
        and plain_name(known["sog"].name).partition("_")[0] == "speed"
        and _is_bare(known["sog"])
    ):
        name = known["sog"].name
        words.append(Text("column {name} taken as over ground, beside a course and no heading", name=name))
    if ("sog" in known) != ("cog" in known):
        there = known.get("sog") or known["cog"]
        words.append(
            Text("column {name} not used: speed and course over ground serve only together", name=there.name)
        )
    return words


def understood(table: Table) -> Table:
    """Check the numbers and times of a table, and tell radians from degrees; raises as `table_recording`."""
    table = of_one_clock(_without_placeholders(table))
    faults = _range_faults(table) or order_faults(table) or rate_faults(table)
    if faults:
        raise InputError(faults)
    return with_radians(table)


def table_recording(table: Table) -> Recording:
    """Check the numbers of a table and sort them into quantities; an empty cell is a missing sample.

    Raises
    ------
    InputError
        A value is not finite or out of range; time is unordered or repeated; every cell of a table is empty.
    """
    table = understood(table)
    close: dict[str, int] = {}

    def series(what: str, *stems: str, optional: int = 0) -> Series | None:
        """Series of columns; the last ``optional`` ones may be absent (0 then)."""
        needed = stems[: len(stems) - optional]
        if not all(stem in table.values for stem in needed):
            return None
        size = table.time_s.size
        whole = ~np.logical_or.reduce([table.missing.get(s, np.zeros(size, bool)) for s in stems])
        values = np.column_stack(
            [
                table.values[s] * table.columns[s].factor if s in table.values else np.zeros(size)
                for s in stems
            ]
        )
        found = tidy(table.time_s[whole], values[whole], table.where, what, dated=table.dated, tabled=True)
        close[what] = int(np.count_nonzero(whole)) - (0 if found is None else found.time_s.size)
        return found

    quantities = {
        "position": _with_height(series("lat_deg+lon_deg", "lat", "lon"), table),
        "velocity": series("ve_mps+vn_mps", "ve", "vn") or _over_ground(series("sog+cog", "sog", "cog")),
        "water": _axes(series("speed", "speed", "speed_starboard", optional=1)),
        "ground": _axes(series("ground", "ground", "ground_starboard", optional=1)),
        "heading": series("heading_deg", "heading"),
        "attitude": series("pitch_deg+roll_deg", "pitch", "roll"),
    }
    deviations = {
        "position": series("lat_sigma+lon_sigma", "north_sigma", "east_sigma"),
        "velocity": series("ve_sigma+vn_sigma", "ve_sigma", "vn_sigma"),
        "heading": series("heading_sigma", "heading_sigma"),
        "attitude": series("pitch_sigma+roll_sigma", "pitch_sigma", "roll_sigma"),
    }
    if not any(quantities.values()):
        raise InputError(
            Fault(table.where, "", None, Text("every cell of the columns that are used is empty"))
        )
    known = {
        name: one for name, one in deviations.items() if one is not None and quantities[name] is not None
    }
    return Recording(**quantities, sources=(_account(table, close),), deviations=known)


def _account(table: Table, close: Mapping[str, int]) -> SourceReport:
    """Account of a table, and of readings that stand too close to another one to be told from it."""
    used = [table.columns[stem].name.lower() for stem in table.values]
    empty = {table.columns[s].name: int(np.count_nonzero(gone)) for s, gone in table.missing.items()}
    counts = [Text("{name} {count}", name=name, count=count) for name, count in empty.items() if count]
    warnings = [Text("empty cells, missing samples: {told}", told=", ".join(counts))] if counts else []
    warnings += [
        Text("{what}: {count} readings within 1 ms of the one before left out", what=what, count=count)
        for what, count in close.items()
        if count
    ]
    report = stream_report("rows", table.time_s.size, True, table.time_s)
    return SourceReport(
        table.where,
        Text("{kind} with {used}", kind=table.kind, used=", ".join(used)),
        table.time_s.size + sum(one.count for one in table.left_out),
        (report,),
        warnings=(*table.warnings, *warnings),
        used=table.time_s.size,
        lines_left_out=table.left_out,
        fields_left_out=(
            *(
                LeftOut(name, "", Text("empty or not available"), count)
                for name, count in empty.items()
                if count
            ),
            *(
                LeftOut(what, "", Text("another stands at the same time"), count)
                for what, count in close.items()
                if count
            ),
        ),
        choices=table.choices,
    )


def _with_height(position: Series | None, table: Table) -> Series | None:
    if position is None:
        return None
    height = np.full(position.time_s.size, np.nan)
    if "height" in table.values:
        known = np.where(table.missing.get("height", False), np.nan, table.values["height"])
        height = known[np.searchsorted(table.time_s, position.time_s)]
    return replace(position, values=np.column_stack([position.values, height]))


def _over_ground(polar: Series | None) -> Series | None:
    """East and north velocity of speed and course over ground."""
    if polar is None:
        return None
    speed, course = polar.values.T
    return replace(polar, values=np.column_stack([speed * np.sin(course), speed * np.cos(course)]))


def _axes(forward_first: Series | None) -> Series | None:
    """Starboard, forward of forward, starboard."""
    return (
        None if forward_first is None else replace(forward_first, values=forward_first.values[:, ::-1].copy())
    )


def _without_placeholders(table: Table) -> Table:
    """Take as missing what stands for no reading: NaN among numbers, -999 and the like out of range."""
    missing, told = dict(table.missing), []
    no_reading = {stem: not_available(stem, table.columns[stem].unit, v) for stem, v in table.values.items()}
    if {"lat", "lon"} <= no_reading.keys():
        no_reading["lat"] = no_reading["lon"] = no_reading["lat"] & no_reading["lon"]
    if "cog" in table.values and any(gone.any() for gone in no_reading.values()):
        no_reading["cog"] |= table.values["cog"] == AIS_NO_COURSE
    for stem, values in table.values.items():
        low, high = table.columns[stem].limits
        gone = np.isin(values, _MISSING_NUMBERS) & ~((values >= low) & (values <= high))
        gone |= no_reading[stem]
        if gone.any():
            numbers = ", ".join(f"{number:g}" for number in np.unique(values[gone])[:_MOST_FAULTS])
            count = int(np.count_nonzero(gone))
            name = table.columns[stem].name
            told.append(
                Text(
                    "{name} = {numbers}: not available, {count} missing samples",
                    name=name,
                    numbers=numbers,
                    count=count,
                )
            )
        if not np.isnan(values).all():
            gone |= np.isnan(values)
        if gone.any():
            missing[stem] = missing.get(stem, False) | gone
    return replace(table, missing=missing, warnings=(*table.warnings, *told))


def _hint(name: str, value: float) -> str:
    """Unit that a latitude or longitude out of range may be in; or empty."""
    if not name.startswith(("lat", "lon", "lng")):
        return ""
    if 100.0 <= abs(value) <= 18000.0 and abs(value) % 100.0 < 60.0:
        return Text(
            " (degrees and minutes run together? Give degrees, or write each with its side in one cell, "
            "4530.5N)"
        )
    if not 1e5 < abs(value) <= 1.8e9:
        return ""
    return Text(" (counts of 1e-7°? Name the column {name}_e7)", name=name)


def _range_faults(table: Table) -> list[Fault]:
    faults: list[Fault] = []
    checked = {
        table.columns[stem].name.lower(): (
            values,
            *table.columns[stem].limits,
            table.missing.get(stem, False),
        )
        for stem, values in table.values.items()
    }
    checked[table.clock] = (table.time_s, -6e10, 2.5e11, False)  # the years 69 to 9892
    for name, (values, low, high, missing) in checked.items():
        outside = np.flatnonzero(~((values >= low) & (values <= high)) & ~np.asarray(missing))
        column = [
            Fault(
                Text("{where}, row {rows}", where=table.where, rows=table.rows[i]), name, float(values[i]),
                Text(
                    "must be a number from {low:g} to {high:g}{hint}",
                    low=low,
                    high=high,
                    hint=_hint(name, float(values[i])),
                ),
            )
            for i in outside[:_MOST_FAULTS]
        ]  # fmt: skip
        if outside.size > _MOST_FAULTS:
            more = Text("and {size} more faults of this kind", size=outside.size - _MOST_FAULTS)
            column.append(Fault(table.where, "", None, more))
        faults += column
    return faults
