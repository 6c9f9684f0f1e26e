"""Tab "Compare": the pins of a session, and the controls of the one that is chosen."""

import re
from collections.abc import Callable
from typing import Any

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.quantities import STATISTICS
from schuler_bench.plots import style
from schuler_bench.session.history import first_editable
from schuler_bench.session.pins import COLORS, MOST_PINS, Pin
from schuler_bench.session.shown import Shown, titled, window_of
from schuler_bench.session.taking import take_pins
from schuler_bench.shell import notices
from schuler_bench.shell.view import Frame, PictureView, Tab, if_user
from schuler_bench.views.compare.table import COLUMNS, lines_of, lines_without_pins, pins_html

PIN, FLIP = Text("Pin this run"), Text("Flip to the baseline")
CHOSEN, NAME, NOTE, COLOR, SHOWN = (
    Text("pin"),
    Text("pin name"),
    Text("pin note"),
    Text("pin colour"),
    Text("pin shown"),
)
BASELINE, DELTA = Text("compare with"), Text("Δ of")
LINK, TAKE = Text("link with pins"), Text("Take the pins from a link")
BACK, REMOVE = Text("Go back to this pin"), Text("Remove this pin")
_NO_LINK = Text("expected a link that Share made on this server")
_HERE = Text("all of them are here already")
_FIRST = Text("the first pin")
_STATISTICS = {word: statistic for statistic, word in STATISTICS.items()}
_EMPTY = Text(
    "Nothing is pinned yet. Pin the present run (key P), then move a slider: every plot keeps the pinned run "
    "as thin dashed curves, the table shows the difference, and B flips between the two."
)


class CompareView(PictureView[str]):
    """Table of the pins, and controls of the one that is chosen."""

    title = Text("Compare")
    place = "lower"
    tab = Text("Errors")
    look_for = Text("Pinned runs beside the present one: a heading sorts, B flips.")

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._mark = frame.gui.add_html("", order=4)
        add = frame.commands.register
        add("pin", lambda _: self._pin_run(), Text("Pin the present run"), "P")
        add("flip", lambda _: self._flip(), Text("Flip between this run and the baseline"), "B")
        add("sort-pins", self._sort)

    def build(self, tab: Tab) -> None:
        """Make the widgets."""
        gui, pins = self.frame.gui, self.session.pins
        self._options: dict[str, int] = {}
        with tab:
            gui.add_html('<div class="sb-compare"></div>', order=0)
            pin = gui.add_button(PIN, hint=Text("Keep the present run as a baseline. Key: P."), order=1)
            flip = gui.add_button(
                FLIP,
                color="gray",
                hint=Text("All plots show the baseline in the place of this run. Key: B."),
                order=2,
            )
            self._baseline: Any = gui.add_dropdown(
                BASELINE,
                (_FIRST,),
                order=3,
                hint=Text("Baseline of the differences in the table, and of the flip."),
            )
            self._delta: Any = gui.add_dropdown(
                DELTA,
                tuple(_STATISTICS),
                order=4,
                hint=Text("Number of each error that the table compares: rms, largest, last."),
            )
            self._list = gui.add_html("", order=5)
            made = Text("Made with Share, by a reviewer say. Your scenario and pins stay.")
            self._link = gui.add_text(LINK, "", order=5.3, hint=made)
            beside = Text("Its pins stand beside yours; undo takes them back.")
            take = gui.add_button(TAKE, order=5.6, color="gray", hint=beside)
            self._chosen: Any = gui.add_dropdown(
                CHOSEN, ("",), order=6, hint=Text("Pin that is edited here.")
            )
            self._name = gui.add_text(NAME, "", order=7, hint=Text("Shown in every legend."))
            self._color: Any = gui.add_dropdown(COLOR, tuple(COLORS), order=8, hint=Text("Of its curves."))
            self._shown = gui.add_checkbox(SHOWN, True, order=9, hint=Text("Lay it over every plot."))
            self._note = gui.add_text(NOTE, "", order=10, hint=Text("What there is to say of it."))
            back = gui.add_button(
                BACK,
                order=11,
                color="gray",
                hint=Text("Its scenario becomes the present one; this can be undone."),
            )
            remove = gui.add_button(
                REMOVE, order=12, color="orange", hint=Text("Removes its curves from every plot.")
            )
        self._details = [self._chosen, self._name, self._color, self._shown, self._note, back, remove]
        pin.on_click(lambda _: self._pin_run())
        flip.on_click(lambda _: self._flip())
        back.on_click(lambda _: self._with_chosen(self._go_back))
        remove.on_click(lambda _: self._with_chosen(lambda chosen: pins.remove(chosen.id)))
        take.on_click(lambda _: self._take())
        self._chosen.on_update(if_user(self._show))
        show = self.frame.show
        self._baseline.on_update(if_user(lambda: show(baseline=self._options.get(self._baseline.value))))
        self._delta.on_update(if_user(lambda: show(delta=_STATISTICS[self._delta.value])))
        fields = {"name": self._name, "note": self._note, "color": self._color, "shown": self._shown}
        for field, box in fields.items():
            box.on_update(if_user(lambda field=field, box=box: self._edit(**{field: box.value})))
        self._edited: int | None = None
        self._show()

    def follow_display(self) -> None:
        """Show the session's pins."""
        self._show()

    @property
    def of_selected(self) -> bool:
        """The present run stands there with the method that the controls edit."""
        return True

    def picture(self, found: Shown) -> str:
        """Make the table of the pins and the present run, HTML."""
        session = self.session
        pins = titled(session.pins.all, found.run.scenario)
        window = window_of(found.run, found.display)
        if not pins:
            return Text(
                '<div class="sb-no-pins">{small}</div><details id="sb-could-pin" data-sb-folds open>'
                "<summary>What could be pinned</summary>{table}</details>",
                small=notices.small(_EMPTY),
                table=pins_html(lines_without_pins(window, found.run), found.display.pins_by, None),
            )
        lines = lines_of(window, found.run, found.selected, pins)
        baseline = session.pins.baseline(found.display.baseline)
        note = notices.note([window.told] if window.told else [], "info" if window.possible else "warning")
        return note + pins_html(lines, found.display.pins_by, None if baseline is None else baseline.id)

    def show(self, picture: str) -> None:
        """Show the table, and the pins' present names in the choosers."""
        self._list.content = picture
        self._show()

    def _sort(self, column: str) -> None:
        """Sort the table by a column; by the same one again, the other way round."""
        if column in COLUMNS:
            self.frame.show(pins_by=f"-{column}" if self.session.display.pins_by == column else column)

    def draw(self, found: Shown) -> None:
        """Frame all plots, and say at the window's top which pin they show; nothing for the present run."""
        content = ""
        if found.flipped is not None:
            text = Text(
                "Showing the pin “{name}”, not the present run. Key B flips back.", name=found.flipped.name
            )
            role = Text('<div id="sb-flip" role="status" hidden>{text:html}</div>', text=text)
            content = Text("{role}<style>{frame}</style>", role=role, frame=_frame(text, found.flipped.hex))
        if self._mark.content != content:
            self._mark.content = content

    def _pin_run(self) -> None:
        """Pin the present run; one that is still under way as soon as it is there."""
        self.session.after_run(self._pin_ready)

    def _pin_ready(self) -> None:
        session, client = self.session, self.frame.client
        with session.lock:
            run, origin, place = session.run, session.origin, session.selected
        if run is None:
            notices.tell(client, Text("Nothing to pin"), [Text("there is no run yet")], "warning")
            return
        try:
            edited = run.methods[min(place, len(run.methods) - 1)].method.name
            session.pins.add(run, origin, method=edited)
        except InputError:
            lines = [
                Text(
                    "There are {most_pins} pins, which is the most. Remove one in Compare (tab Errors).",
                    most_pins=MOST_PINS,
                )
            ]
            notices.tell(client, Text("Not pinned"), lines, "warning")

    def _take(self) -> None:
        """Take the pins of the state that was shared under the link."""
        client, link = self.frame.client, self._link.value
        with notices.told(client, Text("No pin was taken"), self.frame.refresh):
            count = take_pins(self.session, link)
            if count is None:
                raise InputError(Fault("", "link", link[:80], _NO_LINK))
            self._link.value = ""
            words = Text.plural("{count} pin", "{count} pins", count=count) if count else _HERE
            notices.tell(client, Text("Pins from a link"), [words], "info")

    def _flip(self) -> None:
        """Show the baseline in the place of the present run, or the present run again."""
        session = self.session
        if not session.display.flipped and session.pins.baseline(session.display.baseline) is None:
            notices.tell(
                self.frame.client, Text("Nothing to flip to"), [Text("Pin a run first (key P).")], "warning"
            )
            return
        session.show(None, flipped=not session.display.flipped)

    def _go_back(self, pin: Pin) -> None:
        """Make the pinned scenario the present one."""
        session = self.session
        if session.display.flipped:
            session.show(None, flipped=False)
        session.change(pin.scenario, None, origin=pin.origin, selected=first_editable(pin.scenario))

    def _show(self) -> None:
        session = self.session
        display = session.display
        pins = titled(session.pins.all, session.scenario if session.run is None else session.run.scenario)
        options = {f"{pin.id}: {pin.name}": pin.id for pin in pins}
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
        for handle in self._details:
            handle.visible = bool(pins)
        pin = self._pin
        if pin is None:
            return
        # What the user is typing is theirs: texts change only with the pin.
        if pin.id != self._edited:
            self._edited = pin.id
            # A name that is made of what differs changes with the run: it stands in the table alone.
            self._name.value, self._note.value = "" if pin.unnamed else pin.name, pin.note
        self._color.value, self._shown.value = pin.color, pin.shown

    @property
    def _pin(self) -> Pin | None:
        return self.session.pins.get(self._options.get(self._chosen.value))

    def _with_chosen(self, act: Callable[[Pin], None]) -> None:
        if (pin := self._pin) is not None:
            act(pin)

    def _edit(self, **changes: Any) -> None:
        self._with_chosen(lambda pin: self.session.pins.change(pin.id, **changes))


def _offer(handle: Any, options: tuple[str, ...], value: str) -> None:
    if handle.options != options:
        handle.options = options
    handle.value = value


def _frame(text: str, color: str) -> str:
    """Style that shows a text over the page; everything but plain letters is escaped, for it is a user's."""
    safe = re.sub(r"[^A-Za-z0-9 .,]", lambda match: f"\\{ord(match[0]):06x}", text)
    return (
        f'body::after{{content:"{safe}";position:fixed;z-index:9999;top:0;left:50%;transform:translateX(-50%);'
        f"padding:7px 18px;border-radius:0 0 6px 6px;background:{color};color:#fff;font:600 15px "
        f"{style.FONT_FAMILY};pointer-events:none}}"
        f".js-plotly-plot,.uplot,.sb-table{{outline:3px solid {color};outline-offset:-3px}}"
    )


VIEW = CompareView
