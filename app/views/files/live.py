"""Part of the tab "Files": the ship's INS as it comes, with the damped output beside it."""

from __future__ import annotations

import math
import threading
from typing import TYPE_CHECKING, Any

import numpy as np

from navcore.foundation.text import Text
from navcore.foundation.units import DEG
from navcore.io.series import utc_text
from schuler_bench.live.live import Curves, Live, Status, present
from schuler_bench.plots import style
from schuler_bench.plots.svg_axes import Box, Curve, axes, picture, word
from schuler_bench.plots.table import cell, row, table
from schuler_bench.shell import notices

if TYPE_CHECKING:
    from schuler_bench.shell.view import Frame

TITLE = Text("My ship's INS, live")
FILE = "live.nmea"
"""Name of what was heard, as a recording."""
_USE = Text("Take what was heard as a recording")
_USE_HINT = Text(
    "The sentences since the server was started, at most 32 MiB, become a file of this session: curves as "
    "recorded and with four methods."
)
_WIDTH, _HEIGHT, _LEFT, _RIGHT, _TOP, _PANEL, _BETWEEN = 312, 250, 46, 8, 20, 76, 40
_MOST = 240
"""Points of a curve."""
_PAUSE_S = 5.0
_TOLD = Text("velocity of the INS minus that of its log, and position moved by damping, over time")
RECORDED = style.TRUTH_COLOR


class LivePart:
    """Shows the live stream of the server, once a second; nothing where it listens to none.

    Parameters
    ----------
    frame : Frame
        Of the page.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame, self._live = frame, present()
        self._closed = threading.Event()
        self._thread: threading.Thread | None = None

    def build(self, order: float) -> None:
        """Make the widgets."""
        live = self._live
        if live is None:
            return
        gui = self._frame.gui
        gui.add_html(notices.heading(TITLE), order=order)
        self._shown: Any = gui.add_html(status_html(live.status, live.curves()), order=order + 0.1)
        use: Any = gui.add_button(_USE, color="gray", hint=_USE_HINT, order=order + 0.2)
        use.on_click(lambda _: self._use(live))
        if self._thread is None:
            self._thread = threading.Thread(target=self._follow, args=(live,), name="live-page", daemon=True)
            self._thread.start()

    def _use(self, live: Live) -> None:
        content = live.recording()
        if not content:
            notices.tell(self._frame.client, TITLE, [Text("Nothing was heard yet.")], "warning")
            return
        self._frame.opening.take_file(FILE, content)

    def _follow(self, live: Live) -> None:
        """Show each new status, in a thread of the page: the listener waits for no browser."""
        number = 0
        while not self._closed.is_set() and not live.ended:
            newest, status = live.wait(number, _PAUSE_S)
            if newest == number:
                continue
            number = newest
            content = status_html(status, live.curves())
            with self._frame.session.lock, self._frame.client.atomic():
                if self._closed.is_set():
                    return
                self._shown.content = content
            self._frame.client.flush()

    def close(self) -> None:
        """The browser has gone."""
        self._closed.set()


def status_html(status: Status, curves: Curves) -> str:
    """HTML of a live stream: what comes, the output as recorded and damped, and its course."""
    lines = list(status_lines(status))
    parts = [notices.small(Text.joined(Text(" "), lines))]
    if status.told:
        parts.append(notices.note((Text("{why:sentence}", why=status.told),), "warning"))
    if status.damped:
        parts.append(_table(status))
    if len(curves.time_s) > 1:
        parts.append(_svg(status.names, curves))
    return Text('<div id="sb-live">{parts}</div>', parts=Text.joined("", parts))


def status_lines(status: Status) -> list[str]:
    """Say what comes and what becomes of it."""
    lines: list[str] = [
        Text(
            "{sources}: {rate:.1f} sentences/s, {sentences} in all; {dropped} dropped, {malformed} "
            "malformed.",
            sources=", ".join(status.sources),
            rate=status.rate_hz,
            sentences=status.sentences,
            dropped=status.dropped,
            malformed=status.malformed,
        )
    ]
    if status.taken:
        lines.append(Text("Taken: {taken}.", taken=status.taken))
    if math.isfinite(status.newest_s):
        lines.append(Text("Newest position {utc}.", utc=utc_text(status.newest_s)))
    if math.isfinite(status.delay_s):
        lines.append(
            Text(
                "Damped output of {utc}, {delay:.0f} s behind.",
                utc=utc_text(status.damped_s),
                delay=status.delay_s,
            )
        )
    if status.left_out:
        lines.append(Text("{count} fixes far off their neighbours left out.", count=status.left_out))
    if status.restarts:
        lines.append(Text("Damping was begun anew {count} times.", count=status.restarts))
    if status.target:
        lines.append(Text("Sent on: {count} sentences, {target}.", count=status.sent, target=status.target))
    return lines


def _table(status: Status) -> str:
    assert status.recorded is not None and status.damped is not None
    head = [cell(words, tag="th") for words in ("", Text("position"), Text("E, N (m/s)"), Text("heading"))]
    rows = [_row(Text("as recorded"), status.recorded, RECORDED)]
    rows += [
        _row(name, status.damped[name], style.METHOD_COLORS[k % len(style.METHOD_COLORS)])
        for k, name in enumerate(status.names)
    ]
    return table([row(head)], rows)


def _row(name: str, output: np.ndarray, color: str) -> str:
    lat, lon, east, north, heading = output.tolist()
    if not math.isfinite(lat):
        return row([cell(_named(name, color)), cell(Text("diverged"))])
    place = Text(
        "{lat:.5f}° {side}<br>{lon:.5f}° {other}",
        lat=abs(lat) / DEG,
        side="S" if lat < 0.0 else "N",
        lon=abs(lon) / DEG,
        other="W" if lon < 0.0 else "E",
    )
    turned = Text("{heading:.2f}°", heading=heading / DEG) if math.isfinite(heading) else "-"
    speed = Text("{east:.2f}, {north:.2f}", east=east, north=north)
    return row([cell(_named(name, color)), cell(place), cell(speed, "sb-n"), cell(turned, "sb-n")])


def _named(name: str, color: str) -> str:
    return Text('<span style="color:{color}">●</span> {name:html}', color=color, name=name)


def _svg(names: tuple[str, ...], curves: Curves) -> str:
    """Draw the velocity against the log, and by how much each method has moved the position."""
    chosen = np.unique(np.linspace(0, len(curves.time_s) - 1, _MOST).astype(int))
    hours = (curves.time_s[chosen] - curves.time_s[0]) / 3600.0
    colors = [style.METHOD_COLORS[k % len(style.METHOD_COLORS)] for k in range(len(names))]
    against = np.nan_to_num(curves.against_log[chosen])
    moved = np.nan_to_num(curves.moved_m[chosen])
    upper = [Curve(hours, one, color) for one, color in zip(against.T, [RECORDED, *colors], strict=True)]
    lower = [Curve(hours, one, color) for one, color in zip(moved.T, colors, strict=True)]
    width, below = _WIDTH - _LEFT - _RIGHT, _TOP + _PANEL + _BETWEEN
    parts = (
        word(_LEFT, _TOP - 6.0, Text("velocity minus log (m/s)")),
        axes(Box(_LEFT, _TOP, width, _PANEL), upper),
        word(_LEFT, below - 6.0, Text("position moved by damping (m)")),
        axes(Box(_LEFT, below, width, _PANEL), lower),
        word(_WIDTH - _RIGHT, _HEIGHT - 6.0, Text("time (h)"), "end"),
    )
    return picture(_WIDTH, _HEIGHT, _TOLD, parts)
