"""The columns of an uploaded table: what each is taken for, its first rows and a plot, to be changed."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from navcore.foundation.text import Text
from schuler_bench.plots import style
from schuler_bench.plots.table import cell, row, table
from schuler_bench.session.uploads import Upload
from schuler_bench.shell import notices
from schuler_bench.shell.view import Frame, if_user
from schuler_bench.views.files import meanings

_WIDTH, _HEIGHT = 280, 64
_AS_IS, _REVERSED = Text("as it is"), Text("reversed")
_SIGNS = {1: _AS_IS, -1: _REVERSED}
_LONGEST_CELLS = 40


class Columns:
    """Shows and changes the map of one uploaded table.

    Parameters
    ----------
    frame : Frame
        Of the page.
    mark : callable
        Called when `waits` may have changed.
    """

    def __init__(self, frame: Frame, mark: Callable[[], None]) -> None:
        self._frame, self._session, self._mark = frame, frame.session, mark
        self._upload: Upload | None = None
        self._data: Mapping[str, Any] = {}

    def build(self, order: float) -> None:
        """Make the widgets."""
        gui = self._frame.gui
        with gui.add_folder(Text("Columns"), order=order, visible=False) as self._folder:
            self._file: Any = gui.add_dropdown(Text("table"), ("",))
            self._shown = gui.add_html("")
            self._column: Any = gui.add_dropdown(Text("column"), ("",))
            self._plot = gui.add_html("")
            self._meaning: Any = gui.add_dropdown(Text("means"), tuple(meanings.MEANINGS.values()))
            self._unit: Any = gui.add_dropdown(
                Text("unit"), ("",), hint=Text("As guessed: from the name, or by the size of the numbers.")
            )
            self._sign: Any = gui.add_dropdown(
                Text("sign"),
                tuple(_SIGNS.values()),
                hint=Text("Reversed for a column that counts the other way: an axis that points down."),
            )
            self._zone: Any = gui.add_text(
                Text("time zone"),
                "",
                hint=Text("Of times that state none: Europe/Berlin, +02:00. Empty: UTC."),
            )
            self._skip: Any = gui.add_checkbox(
                Text("skip rows that cannot be read"), False, hint=Text("Their number is reported.")
            )
            self._use = gui.add_button(Text("Read by these columns"))
            self._save = gui.add_button(Text("Download the map"), color="gray")
            self._guess = gui.add_button(Text("Guess anew"), color="gray", visible=False)
        self._file.on_update(if_user(self._other_file))
        self._column.on_update(if_user(self._show))
        self._meaning.on_update(if_user(self._take_meaning))
        self._unit.on_update(if_user(self._take_unit))
        self._sign.on_update(if_user(self._take_sign))
        self._zone.on_update(if_user(self._take_zone))
        self._skip.on_update(if_user(self._take_skip))
        self._use.on_click(if_user(lambda: self._read_by(self._data)))
        self._guess.on_click(if_user(lambda: self._read_by(None)))
        self._save.on_click(if_user(self._give))
        self._upload = None

    def follow(self) -> None:
        """Show the newest table, or the one that was chosen; a change that is not used yet stays."""
        tables = {name: u for name, u in self._session.uploads.files.items() if u.table is not None}
        self._folder.visible = bool(tables)
        names = tuple(tables)
        if not names:
            self._upload = None
            return
        if tuple(self._file.options) != names:
            self._file.options = names
            self._file.value = names[-1]
        self._file.visible = len(names) > 1
        self._take(tables[self._file.value])

    @property
    def waits(self) -> bool:
        """Whether the table in view is still to be read by these columns."""
        upload = self._upload
        return upload is not None and (bool(upload.faults) or self._data != upload.map)

    def _other_file(self) -> None:
        with self._session.lock:
            self._take(self._session.uploads.files[self._file.value])

    def _take(self, upload: Upload) -> None:
        """Begin with another file, or with what is saved of it."""
        if upload is self._upload or upload.table is None:
            return
        self._upload, self._data = upload, upload.map
        self._column.options = upload.table.header
        asked = meanings.asks_for_the_order(upload.map, upload.table)
        unknown = (c for c in upload.table.header if not meanings.meaning_of(upload.map, c))
        used = (c for c in upload.table.header if meanings.meaning_of(upload.map, c))
        self._column.value = asked or next(unknown if upload.faults else used, upload.table.header[0])
        self._guess.visible = upload.mapped
        self._show()

    def _show(self) -> None:
        """Let the choosers and the pictures show the column that is chosen."""
        upload, data = self._upload, self._data
        if upload is None or upload.table is None:
            return
        column = self._column.value
        name = meanings.meaning_of(data, column)
        units = meanings.units_for(data, upload.table, column)
        self._meaning.value = meanings.MEANINGS[name]
        self._unit.options = tuple(units.values())
        self._unit.value = units.get(meanings.unit_of(data, column), next(iter(units.values())))
        quantity = data["quantity"].get(name)
        self._unit.visible = name != meanings.UNUSED
        self._sign.visible = quantity is not None
        self._sign.value = _SIGNS[quantity["sign"] if quantity else 1]
        self._zone.value, self._skip.value = data["time"].get("zone", ""), data["skip_bad_rows"]
        self._shown.content = _overview(upload, data, column)
        samples = upload.table.samples[upload.table.header.index(column)]
        self._plot.content = _plot(column, samples)
        self._use.color = None if self.waits else "gray"
        self._mark()

    def _change(self, data: Mapping[str, Any]) -> None:
        self._data = data
        self._show()

    def _take_meaning(self) -> None:
        name = next(name for name, words in meanings.MEANINGS.items() if words == self._meaning.value)
        self._change(meanings.with_meaning(self._data, self._column.value, name))

    def _take_unit(self) -> None:
        assert self._upload is not None and self._upload.table is not None
        units = meanings.units_for(self._data, self._upload.table, self._column.value)
        unit = next(unit for unit, words in units.items() if words == self._unit.value)
        self._change(meanings.with_choice(self._data, self._column.value, "unit", unit))

    def _take_sign(self) -> None:
        sign = next(sign for sign, words in _SIGNS.items() if words == self._sign.value)
        self._change(meanings.with_choice(self._data, self._column.value, "sign", sign))

    def _take_zone(self) -> None:
        self._change({**self._data, "time": self._data["time"] | {"zone": self._zone.value.strip()}})

    def _take_skip(self) -> None:
        self._change({**self._data, "skip_bad_rows": self._skip.value})

    def _read_by(self, data: Mapping[str, Any] | None) -> None:
        if self._upload is not None:
            self._frame.opening.use_map(self._upload.path.name, data)

    def _give(self) -> None:
        if self._upload is not None:
            self._frame.opening.give_map(self._upload.path.name, self._data)


def _overview(upload: Upload, data: Mapping[str, Any], chosen: str) -> str:
    """HTML of what is wrong with the file, and of its columns with their first cells and meanings."""
    held = upload.table
    assert held is not None
    faults = notices.note([str(fault) for fault in upload.faults], "error")
    order = meanings.asks_for_the_order(data, held)
    asked = [Text("{column}: does the day or the month come first? Choose the unit.", column=order)]
    head = row(cell(words, tag="th") for words in (Text("column"), Text("first rows"), Text("means")))
    lines = (_line(held.header, held.rows, data, at, name == chosen) for at, name in enumerate(held.header))
    return Text(
        '{faults}{asked}<div class="sb-columns" style="margin:0 10px 6px;max-height:30vh;overflow-y:auto">'
        "{table}</div>",
        faults=faults,
        asked=notices.note(asked, "warning") if order else "",
        table=table([head], lines),
    )


def _line(
    header: tuple[str, ...],
    rows: tuple[tuple[str, ...], ...],
    data: Mapping[str, Any],
    at: int,
    chosen: bool,
) -> str:
    name = header[at]
    first = ", ".join(cells[at] for cells in rows if at < len(cells))[:_LONGEST_CELLS]
    key = meanings.meaning_of(data, name)
    unit = meanings.shown(meanings.unit_of(data, name)) if key and key != meanings.TIME_REST else ""
    minus = "−" if data["quantity"].get(key, {}).get("sign") == -1 else ""
    means = Text("{minus}{meaning:html} {unit:html}", minus=minus, meaning=meanings.MEANINGS[key], unit=unit)
    content = Text("<b>{name:html}</b>" if chosen else "{name:html}", name=name)
    return row(
        [
            cell(content, "sb-w"),
            cell(Text("{first:html}", first=first), "sb-m sb-w"),
            cell(means, "sb-w" if key else "sb-m sb-w"),
        ],
        style="background:#EAF3FA" if chosen else "",
    )


def _plot(column: str, samples: tuple[float, ...]) -> str:
    """HTML of a small plot of a column's numbers through the file; empty where there are none."""
    known = [(at, value) for at, value in enumerate(samples) if math.isfinite(value)]
    if len(known) < 2:
        return ""
    low, high = min(value for _, value in known), max(value for _, value in known)
    across, up = (_WIDTH - 8) / max(len(samples) - 1, 1), (_HEIGHT - 8) / ((high - low) or 1.0)
    points = " ".join(f"{4 + across * at:.1f},{_HEIGHT - 4 - up * (value - low):.1f}" for at, value in known)
    label = Text("{column} through the file: {low:g} to {high:g}", column=column, low=low, high=high)
    return Text(
        '<figure style="margin:0 10px 8px;font-size:13px;color:{muted}">'
        '<svg viewBox="0 0 {width} {height}" width="100%" role="img" '
        'style="background:{ground}" aria-label="{label:html}">'
        '<polyline points="{points}" fill="none" stroke="{ink}" stroke-width="1.4"/></svg>'
        "<figcaption>{label:html}</figcaption></figure>",
        muted=style.MUTED,
        ground=style.SEA,
        width=_WIDTH,
        height=_HEIGHT,
        points=points,
        ink=style.METHOD_COLORS[0],
        label=label,
    )
