"""Tab "Compare": the pins of a session, and what is done with them; the mark while one is shown instead."""

from __future__ import annotations

import re
from collections.abc import Callable
from html import escape
from typing import TYPE_CHECKING, Any

from app.figures import style
from app.figures.units import number
from app.page import notices
from app.session.pins import COLORS, MOST_PINS, Pin
from app.session.session import Session, first_editable
from navcore.errors import InputError

if TYPE_CHECKING:
    import viser

    from app.page.commands import Commands

COMPARE = "Compare"
PIN, FLIP = "Pin this run", "Flip to the baseline"
CHOSEN, NAME, NOTE, COLOR, SHOWN = "pin", "pin name", "pin note", "pin colour", "pin shown"
BASELINE, DELTA = "compare with", "Δ of"
BACK, REMOVE = "Go back to this pin", "Remove this pin"
_FIRST = "the first pin"
_STATISTICS = {"rms": "rms", "max": "max_abs", "final": "final"}
_EMPTY = (
    "Nothing is pinned yet. Pin the present run (key P), then move a slider: every plot keeps the pinned run "
    "as thin dashed curves, the table shows the difference, and B flips between the two."
)


class Comparing:
    """What the user does with pins, by button or key.

    Parameters
    ----------
    client : viser.ClientHandle
        The browser, for notices.
    session : Session
        Whose pins they are.
    """

    def __init__(self, client: viser.ClientHandle, session: Session) -> None:
        self._client, self.session = client, session
        self._mark = client.gui.add_html("", order=4)

    def register(self, commands: Commands) -> None:
        """Add the commands."""
        commands.register("pin", lambda _: self.pin(), "Pin the present run", "P")
        commands.register("flip", lambda _: self.flip(), "Flip between this run and the baseline", "B")

    def pin(self) -> None:
        """Pin the present run."""
        session = self.session
        with session.lock:
            run, origin = session.run, session.origin
        if run is None:
            notices.tell(self._client, "Nothing to pin", ["there is no run yet"], "warning")
            return
        try:
            session.pins.add(run, origin)
        except InputError:
            lines = [f"There are {MOST_PINS} pins, which is the most. Remove one in the tab Compare."]
            notices.tell(self._client, "Not pinned", lines, "warning")

    def flip(self) -> None:
        """Show the baseline in the place of the present run, or the present run again."""
        session = self.session
        if not session.display.flipped and session.pins.baseline(session.display.baseline) is None:
            notices.tell(self._client, "Nothing to flip to", ["Pin a run first (key P)."], "warning")
            return
        session.show(None, flipped=not session.display.flipped)

    def go_back(self, pin: Pin) -> None:
        """Make the pinned scenario the present one."""
        session = self.session
        if session.display.flipped:
            session.show(None, flipped=False)
        session.change(pin.scenario, None, origin=pin.origin, selected=first_editable(pin.scenario))

    def mark(self, flipped: Pin | None) -> None:
        """Frame all plots, and say at the window's top which pin they show; nothing for the present run."""
        content = ""
        if flipped is not None:
            text = f"Showing the pin \u201c{flipped.name}\u201d, not the present run. Key B flips back."
            said = f'<div id="sb-flip" role="status" hidden>{escape(text)}</div>'
            content = f"{said}<style>{_frame(text, flipped.hex)}</style>"
        if self._mark.content != content:
            self._mark.content = content


def _frame(text: str, color: str) -> str:
    """Style that shows a text over the page; everything but plain letters is escaped, for it is a user's."""
    safe = re.sub(r"[^A-Za-z0-9 .,]", lambda found: f"\\{ord(found[0]):06x}", text)
    return (
        f'body::after{{content:"{safe}";position:fixed;z-index:9999;top:0;left:50%;transform:translateX(-50%);'
        f"padding:7px 18px;border-radius:0 0 6px 6px;background:{color};color:#fff;font:600 15px "
        f"{style.FONT_FAMILY};pointer-events:none}}"
        f".js-plotly-plot,.uplot,.sb-table{{outline:3px solid {color};outline-offset:-3px}}"
    )


class ComparePanel:
    """List of the pins, and controls of the one that is chosen.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    tab : viser.GuiTabHandle
        Where it stands.
    comparing : Comparing
        What its controls do.
    """

    def __init__(self, gui: viser.GuiApi, tab: viser.GuiTabHandle, comparing: Comparing) -> None:
        self._comparing, self._session = comparing, comparing.session
        self._options: dict[str, int] = {}
        pins = self._session.pins
        with tab:
            gui.add_html('<div class="sb-compare"></div>', order=0)
            pin = gui.add_button(PIN, hint="Keep the present run as a baseline. Key: P.", order=1)
            flip = gui.add_button(
                FLIP,
                hint="All plots show the baseline in the place of this run. Key: B.",
                order=2,
            )
            self._baseline: Any = gui.add_dropdown(
                BASELINE,
                (_FIRST,),
                order=3,
                hint="Baseline of the differences in the table, and of the flip.",
            )
            self._delta: Any = gui.add_dropdown(
                DELTA,
                tuple(_STATISTICS),
                order=4,
                hint="Number of each error that the table compares: rms, largest, last.",
            )
            self._list = gui.add_html("", order=5)
            self._chosen: Any = gui.add_dropdown(CHOSEN, ("",), order=6, hint="Pin that is edited here.")
            self._name = gui.add_text(NAME, "", order=7, hint="Shown in every legend.")
            self._color: Any = gui.add_dropdown(COLOR, tuple(COLORS), order=8, hint="Of its curves.")
            self._shown = gui.add_checkbox(SHOWN, True, order=9, hint="Lay it over every plot.")
            self._note = gui.add_text(NOTE, "", order=10, hint="What there is to say of it.")
            back = gui.add_button(
                BACK, order=11, hint="Its scenario becomes the present one; this can be undone."
            )
            remove = gui.add_button(REMOVE, order=12, color="orange", hint="Its curves go from every plot.")
        self._details = [self._chosen, self._name, self._color, self._shown, self._note, back, remove]
        pin.on_click(lambda _: comparing.pin())
        flip.on_click(lambda _: comparing.flip())
        back.on_click(lambda _: self._with_chosen(comparing.go_back))
        remove.on_click(lambda _: self._with_chosen(lambda chosen: pins.remove(chosen.id)))
        self._on(self._chosen, self.show)
        self._on(self._baseline, self._choose_baseline)
        self._on(self._delta, lambda: self._session.show(None, delta=_STATISTICS[self._delta.value]))
        self._on(self._name, lambda: self._edit(name=self._name.value))
        self._on(self._note, lambda: self._edit(note=self._note.value))
        self._on(self._color, lambda: self._edit(color=self._color.value))
        self._on(self._shown, lambda: self._edit(shown=self._shown.value))
        self._edited: int | None = None
        self.show()

    @staticmethod
    def _on(handle: Any, act: Callable[[], None]) -> None:
        handle.on_update(lambda event: act() if event.client is not None else None)

    def show(self) -> None:
        """Show the session's pins."""
        session = self._session
        pins, display = session.pins.all, session.display
        options = {_title(pin): pin.id for pin in pins}
        names = tuple(options) or ("",)
        chosen = next(
            (t for t, id in options.items() if id == self._options.get(self._chosen.value)), names[-1]
        )
        newest = bool(options) and max(options.values()) > max(self._options.values(), default=0)
        self._options = options
        _offer(self._chosen, names, names[-1] if newest else chosen)
        baseline = next((title for title, id in options.items() if id == display.baseline), _FIRST)
        _offer(self._baseline, (_FIRST, *options), baseline)
        self._delta.value = next(word for word, key in _STATISTICS.items() if key == display.delta)
        self._list.content = _list_html(pins, session.pins.baseline(display.baseline))
        for handle in self._details:
            handle.visible = bool(pins)
        pin = self._pin
        if pin is None:
            return
        # What the user is typing is theirs: texts change only with the pin.
        if pin.id != self._edited:
            self._edited = pin.id
            self._name.value, self._note.value = pin.name, pin.note
        self._color.value, self._shown.value = pin.color, pin.shown

    @property
    def _pin(self) -> Pin | None:
        return self._session.pins.get(self._options.get(self._chosen.value))

    def _with_chosen(self, act: Callable[[Pin], None]) -> None:
        if (pin := self._pin) is not None:
            act(pin)

    def _edit(self, **changes: Any) -> None:
        if (pin := self._pin) is not None:
            self._session.pins.change(pin.id, **changes)

    def _choose_baseline(self) -> None:
        self._session.show(None, baseline=self._options.get(self._baseline.value))


def _offer(handle: Any, options: tuple[str, ...], value: str) -> None:
    if handle.options != options:
        handle.options = options
    handle.value = value


def _title(pin: Pin) -> str:
    return f"{pin.id}: {pin.name}"


_CELL = "padding:3px 10px 3px 2px;vertical-align:top"


def _list_html(pins: tuple[Pin, ...], baseline: Pin | None) -> str:
    """Table of the pins: what they are of, and their position errors."""
    if not pins:
        return f'<div class="sb-no-pins">{notices.small(_EMPTY)}</div>'
    head = "".join(
        f'<th style="{_CELL};text-align:left;font-weight:600">{title}</th>'
        for title in ("pin", "of", "largest position error (m)", "note")
    )
    return (
        '<div class="sb-pins" style="margin:4px 10px 8px;overflow-x:auto">'
        f'<table style="border-collapse:collapse;width:100%;'
        f'font-size:{style.FONT_SIZE}px;color:{style.INK}"><thead><tr>{head}</tr></thead>'
        f"<tbody>{''.join(_row_html(pin, pin is baseline) for pin in pins)}</tbody></table></div>"
    )


def _row_html(pin: Pin, is_baseline: bool) -> str:
    bar = (
        f'<span style="display:inline-block;width:18px;border-top:3px dashed {pin.hex};margin-right:6px;'
        'vertical-align:middle"></span>'
    )
    marks = (", baseline" if is_baseline else "") + ("" if pin.shown else ", hidden")
    if pin.run is None:
        worst = "being computed"
    else:
        worst = ", ".join(
            f"{method.method.name} {number(method.errors['position_m']['max_abs'], 4)}"
            for method in pin.run.methods
        )
    cells = (
        f"{bar}<b>{escape(pin.name)}</b>{marks}",
        escape(pin.origin),
        escape(worst),
        escape(pin.note),
    )
    line = "".join(f'<td style="{_CELL}">{cell}</td>' for cell in cells)
    return f'<tr style="border-top:1px solid {style.GRID}">{line}</tr>'
