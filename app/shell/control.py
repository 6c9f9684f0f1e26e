"""One control: a field's slider with its exact number box, or a chooser or text, and the note below it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, suppress
from typing import TYPE_CHECKING, Any

from navcore.foundation.with_unit import read_with_unit
from schuler_bench.bridge.boxes import LIST, mark_number_box
from schuler_bench.bridge.controls import id_of, set_slider_range
from schuler_bench.bridge.mends import plain_viser
from schuler_bench.editing import typed
from schuler_bench.editing.choices import choice_words, chosen
from schuler_bench.editing.form import FieldSpec, Path, Slider
from schuler_bench.editing.rounding import round_step
from schuler_bench.shell import notices

if TYPE_CHECKING:
    import viser

_TEXTS = {
    "roots": (typed.read_roots, typed.write_roots),
    "numbers": (typed.read_numbers, typed.write_numbers),
    "pairs": (typed.read_pairs, typed.write_pairs),
}
"""Kinds of fields that are shown as text: how that is read and written."""
EXACT = ", exact"
"""Ends the label of a number box that stands beside a slider."""
_NUMBERS = ("number", "integer")
_CAST: dict[str, Callable[[Any], Any]] = {"flag": bool, "choice": choice_words}
_UNKNOWN = object()

Edit = Callable[["Control", bool], None]
"""``edit(control, by_slider)``: the user has moved the slider, or filled the box."""


class Control:
    """Widgets of one field; it shows values and reports what the user does, nothing else.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client; widgets go into its present container.
    spec : FieldSpec
        The field.
    edit : callable
        Called when the user has changed a widget, in any thread; it may `take` the value then.
    order : float
        Place in the container; the control takes ``order`` to ``order + 0.9``.
    value : object
        To show first.
    """

    def __init__(self, gui: viser.GuiApi, spec: FieldSpec, edit: Edit, order: float, value: Any) -> None:
        self.spec = spec
        self.value: Any = value
        self._slider_moved = self._behind = self.removed = False
        self._mark = ""
        self._last: Any = _UNKNOWN
        self._range, self._slider = self._make_slider(gui, order)
        self._box = Widget(self._make_box(gui, order))
        self._widgets = [self._box] if self._slider is None else [self._slider, self._box]
        for widget in self._widgets:
            by_slider = widget is self._slider
            widget.handle.on_update(
                lambda event, by_slider=by_slider: edit(self, by_slider) if event.client is not None else None
            )
        self._note = gui.add_html("", order=order + 0.5, visible=False)

    # ------------------------------------------------------------ making

    def _make_slider(self, gui: viser.GuiApi, order: float) -> tuple[Slider | None, Widget | None]:
        """Make the slider, if the field has one."""
        spec = self.spec
        if spec.slider is None:
            return None, None
        number = float(self.value or 0.0)
        slider = spec.slider.reaching(number, spec.allowed)
        handle = gui.add_slider(
            spec.label,
            *slider.ends,
            slider.step,
            slider.position(number),
            marks=_marks(slider),
            hint=spec.hint or None,
            order=order,
        )
        return slider, Widget(handle)

    def _make_box(self, gui: viser.GuiApi, order: float) -> Any:
        """Make what holds the exact value."""
        spec, value, hint = self.spec, self.value, self.spec.hint or None
        if spec.kind == "choice":
            words = tuple(map(choice_words, spec.choices))
            return gui.add_dropdown(
                spec.label, words, initial_value=choice_words(str(value)), hint=hint, order=order
            )
        if spec.kind == "flag":
            return gui.add_checkbox(spec.label, bool(value), hint=hint, order=order)
        if spec.kind not in _NUMBERS:
            box = gui.add_text(spec.label, self.as_text(value), hint=hint, order=order)
            if spec.kind in _TEXTS:
                mark_number_box(gui, box, LIST)
            return box
        label, slider = spec.label + (EXACT if spec.slider is not None else ""), spec.slider
        step = 1.0
        if slider is not None and spec.kind == "number":
            step = round_step(slider.low) if slider.log else slider.step
        box = gui.add_text(label, self.as_text(value), hint=hint, order=order + 0.2)
        mark_number_box(gui, box, step)
        return box

    # ------------------------------------------------------------ showing

    def show(self, value: Any) -> None:
        """Show a value; widgets that show it already send nothing. None leaves what is shown."""
        if (value is None and self.spec.kind == "number") or value == self._last:
            return
        self.value, self._behind = value, False
        self._box.show(self._as_shown(value))
        self._show_on_slider(value)
        self._last = _UNKNOWN if any(widget.awaited for widget in self._widgets) else value

    def take(self, by_slider: bool) -> Any:
        """Value that the user has given: a number, a choice, or text as typed."""
        self._slider_moved, self._last, self._behind = by_slider, _UNKNOWN, False
        if by_slider and self._slider is not None and self._range is not None:
            return self._range.value(self._slider.take())
        return self._given(self._box.take())

    def follow(self, value: Any) -> None:
        """Take over the value the user has just given, leaving the moved widget alone.

        The box follows its slider in `catch_up`, with the picture: alone it would cost the page a frame.
        """
        self.value, self._last, self._behind = value, _UNKNOWN, self._slider_moved
        if not self._slider_moved:
            self._show_on_slider(value)
            if self.spec.kind in _NUMBERS and not _is_plain(self._box.known):
                self._box.show(self.as_text(value))

    def restore(self) -> None:
        """Show the last good value in the place of one that is refused."""
        self._last = _UNKNOWN
        if self.value is None:
            self._box.show(self._as_shown(None))
        self.show(self.value)

    def catch_up(self) -> None:
        """Show in the box what its slider has given."""
        if self._behind:
            self._behind = False
            self._box.show(self._as_shown(self.value))

    def _show_on_slider(self, value: Any) -> None:
        """Show a value that did not come from the slider; the range grows where it must hold the value."""
        if self._slider is None or self.spec.slider is None or self._slider.awaited:
            return
        slider = self.spec.slider.reaching(float(value), self.spec.allowed)
        if slider != self._range:
            self._range = slider
            set_slider_range(self._slider.handle, *slider.ends, slider.step, _marks(slider))
        self._slider.show(slider.position(value))

    def _as_shown(self, value: Any) -> Any:
        return _CAST[self.spec.kind](value) if self.spec.kind in _CAST else self.as_text(value)

    def _given(self, shown: Any) -> Any:
        return chosen(self.spec.choices, shown) if self.spec.kind == "choice" else shown

    def as_text(self, value: Any) -> str:
        """Text of a value in a text box; a number that is not given is marked below its box."""
        kind = self.spec.kind
        if kind in _NUMBERS:
            return typed.write_number(value or 0)
        return _TEXTS[kind][1](value) if kind in _TEXTS else str(value or "")

    def read(self, entered: Any) -> Any:
        """Value of the field from what its box holds; raises ValueError for text that cannot be read."""
        kind = self.spec.kind
        if kind in _NUMBERS and isinstance(entered, str):
            return read_with_unit(entered, typed.unit_of(self.spec.label), whole=kind == "integer")
        return _TEXTS[kind][0](entered) if kind in _TEXTS else entered

    @property
    def held(self) -> Any:
        """Value that the box holds, or is to show."""
        if self.spec.kind in _NUMBERS and not self._behind:
            with suppress(ValueError):
                return self.read(self._box.handle.value)
            return self.value
        return self._given(self._as_shown(self.value) if self._behind else self._box.handle.value)

    @property
    def moving(self) -> bool:
        """Whether the user has given another value that is still to be dealt with."""
        return self._widgets[0 if self._slider_moved else -1].awaited

    @property
    def holds_numbers(self) -> bool:
        """Whether its box is one for a number, or for several."""
        return self.spec.kind in (*_NUMBERS, *_TEXTS)

    @property
    def typed(self) -> bool:
        """Whether the last value came letter by letter, so that a wrong one may only be unfinished.

        The page sends a number, or several, when it is complete (static/boxes.js).
        """
        whole = self.holds_numbers and not plain_viser()
        return self.spec.kind not in ("choice", "flag") and not whole and not self._slider_moved

    def mark(self, words: str) -> None:
        """Say below the control where its value is from, if it is not given."""
        if words != self._mark:
            self._mark = words
            self.say("")

    def say(self, html: str) -> None:
        """Put a note below the control, or take it away."""
        html = html or (notices.small(self._mark) if self._mark else "")
        if self._note.content != html:
            self._note.content = html
        self._note.visible = bool(html)

    def refuse(self, lines: list[str]) -> None:
        """Say below the control why a value was refused."""
        self.say(notices.note(lines, "error"))

    def remove(self) -> None:
        """Take the widgets off the page."""
        self.removed = True
        for handle in (self._note, *(widget.handle for widget in self._widgets)):
            handle.remove()

    @property
    def ids(self) -> list[str]:
        """Ids of its widgets in viser."""
        return [id_of(widget.handle) for widget in self._widgets]


def _is_plain(text: str) -> bool:
    """Whether a box holds a number as it is shown there: it may be typed on, and is left alone."""
    try:
        return text.isascii() and math.isfinite(float(text))
    except ValueError:
        return False


def _marks(slider: Slider) -> tuple[tuple[float, str], tuple[float, str]]:
    """Numbers below a slider's ends."""
    low, high = slider.ends
    return (low, f"{slider.low:g}"), (high, f"{slider.high:g}")


class Widget:
    """A viser widget, and the value in it that has been dealt with.

    viser stores what a browser sends before it calls back, and calls back concurrently: a value other than
    the known one belongs to an event that is still to come, and must not be overwritten by an older one.
    """

    def __init__(self, handle: Any) -> None:
        self.handle = handle
        self.known = handle.value

    def take(self) -> Any:
        """Value the user has given; it counts as dealt with."""
        self.known = self.handle.value
        return self.known

    @property
    def awaited(self) -> bool:
        """Whether the user has given another value that is still to be dealt with."""
        return self.handle.value != self.known

    def show(self, value: Any) -> None:
        """Show a value, unless the user has just given another one."""
        if not self.awaited:
            self.handle.value = value
            self.known = self.handle.value


class Section:
    """Controls in one container.

    Parameters
    ----------
    gui : viser.GuiApi
        Of the client.
    container : context manager
        A folder or tab that holds the controls.
    edit : callable
        As for `Control`.
    order : float
        Place of the first control in the container.
    """

    def __init__(
        self, gui: viser.GuiApi, container: AbstractContextManager[Any], edit: Edit, order: float
    ) -> None:
        self._gui, self._container, self._edit, self._order = gui, container, edit, order
        self.controls: dict[Path, Control] = {}

    def show(
        self,
        specs: list[FieldSpec],
        values: Mapping[Path, Any],
        moved: Control | None,
        unset: Mapping[Path, str] | None = None,
    ) -> None:
        """Show these fields with these values; widgets are made anew only when the fields are others.

        Parameters
        ----------
        specs : list of FieldSpec
            What to show, in order.
        values : mapping
            Path -> value; a missing one leaves what is shown.
        moved : Control or None
            The control that the user is moving.
        unset : mapping, optional
            Path -> where the value of a field is from that is not given.
        """
        if [control.spec for control in self.controls.values()] != specs:
            self._rebuild(specs, values)
        for path, control in self.controls.items():
            if control is not moved:
                control.show(values.get(path))
            control.mark((unset or {}).get(path, ""))

    def _rebuild(self, specs: list[FieldSpec], values: Mapping[Path, Any]) -> None:
        for control in self.controls.values():
            control.remove()
        with self._container:
            self.controls = {
                spec.path: Control(
                    self._gui, spec, self._edit, self._order + index, values.get(spec.path, spec.default)
                )
                for index, spec in enumerate(specs)
            }


def controls_of(sections: Mapping[str, Section]) -> list[Control]:
    """All controls of some sections, in order."""
    return [control for section in sections.values() for control in section.controls.values()]
