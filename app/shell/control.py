"""One control: a field's slider with its exact number box, or a chooser or text, and the note below it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any

from app.bridge.controls import id_of, set_slider_range
from app.editing import form, typed
from app.editing.form import FieldSpec, Path, Slider
from app.shell import notices

if TYPE_CHECKING:
    import viser

DECIMALS = 12
"""Decimals that a number box takes and shows."""
_READ = {"roots": typed.read_roots, "numbers": typed.read_numbers, "pairs": typed.read_pairs}
_WRITE = {"roots": typed.write_roots, "numbers": typed.write_numbers, "pairs": typed.write_pairs}
_AS_THEY_ARE = ("integer", "choice", "flag")
EXACT = ", exact"
"""Ends the label of a number box that stands beside a slider."""
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
        self.value = value
        self._range = spec.slider
        self._slider: Widget | None = None
        self._slider_moved = self._behind = False
        self._shown: Any = _UNKNOWN
        self.removed = False
        make = {
            "choice": self._make_choice,
            "flag": self._make_flag,
            "integer": self._make_integer,
            "number": self._make_number,
        }
        self._box = Widget(make.get(spec.kind, self._make_text)(gui, order, value))
        self._box.handle.on_update(lambda event: edit(self, False) if event.client is not None else None)
        if self._slider is not None:
            self._slider.handle.on_update(
                lambda event: edit(self, True) if event.client is not None else None
            )
        self._note = gui.add_html("", order=order + 0.5, visible=False)

    # ------------------------------------------------------------ making

    def _make_choice(self, gui: viser.GuiApi, order: float, value: Any) -> Any:
        spec = self.spec
        return gui.add_dropdown(
            spec.label, spec.choices, initial_value=str(value), hint=spec.hint or None, order=order
        )

    def _make_flag(self, gui: viser.GuiApi, order: float, value: Any) -> Any:
        return gui.add_checkbox(self.spec.label, bool(value), hint=self.spec.hint or None, order=order)

    def _make_integer(self, gui: viser.GuiApi, order: float, value: Any) -> Any:
        spec, label = self.spec, self._make_slider(gui, order, value)
        return gui.add_number(label, int(value), step=1, hint=spec.hint or None, order=order + 0.2)

    def _make_text(self, gui: viser.GuiApi, order: float, value: Any) -> Any:
        return gui.add_text(self.spec.label, self.as_text(value), hint=self.spec.hint or None, order=order)

    def _make_slider(self, gui: viser.GuiApi, order: float, value: Any) -> str:
        """Make the slider, if the field has one; return the label of the box beside it."""
        spec = self.spec
        if spec.slider is None:
            return spec.label
        shown = 0.0 if value is None else float(value)
        self._range = slider = spec.slider.reaching(shown, spec.allowed)
        (low, high), position = slider.ends, slider.position(shown)
        self._slider = Widget(
            gui.add_slider(
                spec.label,
                low,
                high,
                slider.step,
                position,
                marks=_marks(slider),
                hint=spec.hint or None,
                order=order,
            )
        )
        return spec.label + EXACT

    def _make_number(self, gui: viser.GuiApi, order: float, value: Any) -> Any:
        spec, label = self.spec, self._make_slider(gui, order, value)
        shown = 0.0 if value is None else float(value)
        # Explicitly a float, or viser would cast every later value to a whole number.
        box = gui.add_number(label, shown, step=self._box_step(), hint=spec.hint or None, order=order + 0.2)
        box.precision = DECIMALS
        return box

    def _box_step(self) -> float:
        slider = self.spec.slider
        if slider is None:
            return 1.0
        return form.round_step(slider.low) if slider.log else slider.step

    # ------------------------------------------------------------ showing

    def show(self, value: Any) -> None:
        """Show a value; widgets that show it already send nothing. None leaves what is shown."""
        if (value is None and self.spec.kind == "number") or value == self._shown:
            return
        self.value, self._behind = value, False
        self._box.show(self._as_shown(value))
        self._show_on_slider(value)
        self._shown = _UNKNOWN if self._awaited else value

    @property
    def _awaited(self) -> bool:
        """Whether a widget has a value that is still to be dealt with."""
        return any(widget.awaited for widget in (self._box, self._slider) if widget is not None)

    def take(self, by_slider: bool) -> Any:
        """What the user has given: a number, a choice, or text as typed."""
        self._slider_moved, self._shown, self._behind = by_slider, _UNKNOWN, False
        if by_slider and self._slider is not None and self._range is not None:
            return self._range.value(self._slider.take())
        return self._box.take()

    def follow(self, value: Any) -> None:
        """Take over the value the user has just given, leaving the widget in hand alone.

        The box follows its slider in `catch_up`, with the picture: alone it would cost the page a frame.
        """
        self.value, self._shown, self._behind = value, _UNKNOWN, self._slider_moved
        if not self._slider_moved:
            self._show_on_slider(value)

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
        if self.spec.kind == "number":
            return float(value)
        return value if self.spec.kind in _AS_THEY_ARE else self.as_text(value)

    def as_text(self, value: Any) -> str:
        """Text of a value in a text box."""
        write = _WRITE.get(self.spec.kind)
        return str(value or "") if write is None else write(value)

    def read(self, shown: Any) -> Any:
        """Value of the field from what its box holds; raises ValueError for text that cannot be read."""
        read = _READ.get(self.spec.kind)
        return shown if read is None else read(shown)

    @property
    def held(self) -> Any:
        """What the box holds, or is to show."""
        return self._as_shown(self.value) if self._behind else self._box.handle.value

    @property
    def moving(self) -> bool:
        """Whether the user has given another value that is still to be dealt with."""
        widget = self._slider if self._slider_moved and self._slider is not None else self._box
        return widget.awaited

    @property
    def typed(self) -> bool:
        """Whether the last value was typed letter by letter, so that a wrong one may only be unfinished."""
        return self.spec.kind not in ("choice", "flag") and not self._slider_moved

    def say(self, html: str) -> None:
        """Put a note below the control, or take it away."""
        if self._note.content != html:
            self._note.content = html
        self._note.visible = bool(html)

    def refuse(self, lines: list[str]) -> None:
        """Say below the control why a value was not taken over."""
        self.say(notices.note(lines, "error"))

    def remove(self) -> None:
        """Take the widgets off the page."""
        self.removed = True
        self._note.remove()
        for widget in (self._slider, self._box):
            if widget is not None:
                widget.handle.remove()

    @property
    def ids(self) -> list[str]:
        """Ids of its widgets in viser."""
        return [id_of(widget.handle) for widget in (self._slider, self._box) if widget is not None]


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

    def show(self, specs: list[FieldSpec], values: Mapping[Path, Any], moved: Control | None) -> None:
        """Show these fields with these values; widgets are made anew only when the fields are others.

        Parameters
        ----------
        specs : list of FieldSpec
            What to show, in order.
        values : mapping
            Path -> value; a missing one leaves what is shown.
        moved : Control or None
            The control that the user is moving.
        """
        if [control.spec for control in self.controls.values()] != specs:
            self._rebuild(specs, values)
            return
        for path, control in self.controls.items():
            if control is not moved:
                control.show(values.get(path))

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
