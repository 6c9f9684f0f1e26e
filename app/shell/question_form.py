"""Form of a question: a control for each of its fields; what is entered is kept with the display."""

import json
from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any

from navcore.foundation.errors import InputError
from navcore.questions.base import Question
from schuler_bench.editing import form
from schuler_bench.shell.control import Control, Section
from schuler_bench.shell.view import Frame


class QuestionForm:
    """Controls of the fields of a question.

    Parameters
    ----------
    frame : Frame
        Of the page.
    container : context manager
        Where the controls stand.
    question : type of Question
        What is asked.
    order : float
        Place of the first control.
    without : sequence of str
        Names of fields that the page gives by itself.
    """

    def __init__(
        self,
        frame: Frame,
        container: Any,
        question: type[Question],
        order: float,
        without: Sequence[str] = (),
    ) -> None:
        self._frame, self._question = frame, question
        self._id: str = question.model_fields["id"].default
        shown = {one.name for one in question.options()}.difference(without)
        self._specs = [spec for spec in form.fields(question, (self._id,)) if str(spec.path[-1]) in shown]
        self._section = Section(frame.gui, container, self._edit, order)

    def show(self, visible: bool = True, known: Mapping[str, Any] = MappingProxyType({})) -> None:
        """Show the controls with their values; none of them where not ``visible``.

        Parameters
        ----------
        visible : bool
            The form is shown.
        known : mapping of str to object
            Values in force where none is given, by field.
        """
        given = {**known, **self.given()}
        values = {spec.path: given.get(str(spec.path[-1]), spec.default) for spec in self._specs}
        self._section.show(self._specs if visible else [], values, None)

    def given(self) -> dict[str, Any]:
        """Values of the fields that a page has set."""
        before = f"{self._id}."
        return {
            key.removeprefix(before): json.loads(text)
            for key, text in self._frame.session.display.given
            if key.startswith(before)
        }

    def _edit(self, control: Control, by_slider: bool) -> None:
        name, entered = str(control.spec.path[-1]), control.take(by_slider)
        session = self._frame.session
        try:
            value = control.read(entered)
            value = int(value) if control.spec.kind == "integer" else value
            self._question.ask({"scenario": session.scenario, **self.given(), name: value})
        except (InputError, ValueError) as error:
            lines = [str(fault) for fault in error.faults] if isinstance(error, InputError) else [str(error)]
            control.refuse(lines)
            return
        control.say("")
        control.follow(value)
        key = f"{self._id}.{name}"
        others = tuple(pair for pair in session.display.given if pair[0] != key)
        self._frame.show(given=(*others, (key, json.dumps(value))))
