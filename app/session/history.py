"""Undo and redo over all changes of a scenario: steps that a user would call one, each with a name."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel, TypeAdapter

from navcore.foundation.notation import symbol
from navcore.foundation.parameters import sharing
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario

if TYPE_CHECKING:
    from schuler_bench.session.pins import Pin

MOST_STEPS = 200
DRAG_S = 1.0
"""Changes of one field that follow each other faster than this are one step: a slider being dragged."""
_LONGEST = 24
_ANY = TypeAdapter(Any)
_NO_DRAG: tuple[tuple[str, ...], float] = ((), 0.0)


@dataclass(frozen=True)
class State:
    """State that undo brings back.

    Attributes
    ----------
    scenario : Scenario
        As edited.
    origin : str
        Preset it came from.
    selected : int
        Method that the controls edited.
    opened : Scenario
        As it was opened, before all editing.
    taken : tuple of Pin
        Pins that were taken from links.
    """

    scenario: Scenario
    origin: str
    selected: int
    opened: Scenario
    taken: tuple[Pin, ...] = ()


class History:
    """States in the order in which they came, and where among them the user stands.

    Parameters
    ----------
    state : State
        To begin with.
    clock : callable, optional
        Seconds, monotonic.

    Attributes
    ----------
    steps : list of (State, str)
        Every state, oldest first, and the name of the change that led to it.
    at : int
        Index of the present one.
    """

    def __init__(self, state: State, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self.steps: list[tuple[State, str]] = [(state, "")]
        self.at = 0
        self._drag: tuple[tuple[str, ...], float] = _NO_DRAG

    @classmethod
    def of(cls, steps: Sequence[tuple[State, str]], at: int) -> History:
        """A history with these `steps` that stands `at` one of them; ValueError if there is none such."""
        if not 0 <= at < len(steps):
            raise ValueError(f"no step {at} among {len(steps)}")
        history = cls(steps[0][0])
        history.steps, history.at = list(steps), at
        return history

    @property
    def state(self) -> State:
        """Where the user stands."""
        return self.steps[self.at][0]

    @property
    def undo_name(self) -> str | None:
        """Name the change that undo would take back; None when there is none."""
        return self.steps[self.at][1] if self.at > 0 else None

    @property
    def redo_name(self) -> str | None:
        """Name the change that redo would bring back; None when there is none."""
        return self.steps[self.at + 1][1] if self.at + 1 < len(self.steps) else None

    def push(self, state: State, name: str = "", gesture: str = "") -> None:
        """Note a change; what had been undone is forgotten. Nothing happens when nothing changed.

        Parameters
        ----------
        state : State
            After the change.
        name : str
            What was done, in words; else it follows from what changed.
        gesture : str
            Changes of one gesture that follow each other are one step, however long it takes.
        """
        before = self.state
        if state == before:
            return
        fields = changed_fields(before.scenario, state.scenario)
        if not fields and (state.origin, state.taken) == (before.origin, before.taken):
            self._replace(state)  # another method was selected: no step of its own
            return
        # Two hundred scenarios that differ in a field each are kept as what differs.
        state = replace(state, scenario=sharing(state.scenario, before.scenario))
        now, (dragged, last_s) = self._clock(), self._drag
        moved = (gesture,) if gesture else () if name else fields
        self._drag = moved, now
        del self.steps[self.at + 1 :]
        if moved and moved == dragged and (gesture or now - last_s < DRAG_S):
            before = self.steps[self.at - 1][0]
            self.steps.pop()
            self.at -= 1
            if before.scenario == state.scenario and before.origin == state.origin:
                self._replace(state)  # dragged back to where it was
                self._drag = _NO_DRAG  # its step is gone: what follows is another one
                return
        self.steps.append((state, name or change_name(before, state)))
        del self.steps[: max(0, len(self.steps) - MOST_STEPS - 1)]
        self.at = len(self.steps) - 1

    def undo(self) -> State | None:
        """Go one step back; None at the beginning."""
        return self._walk(-1)

    def redo(self) -> State | None:
        """Go one step forward again; None at the end."""
        return self._walk(1)

    def _walk(self, by: int) -> State | None:
        if not 0 <= self.at + by < len(self.steps):
            return None
        self.at, self._drag = self.at + by, _NO_DRAG
        return self.state

    def take_back(self, to: State) -> None:
        """Forget the present step, whose scenario was refused: the user stands at ``to`` again.

        Parameters
        ----------
        to : State
            The last one that was good; if no step has it (it was passed within a drag), the present step
            ends there.
        """
        self._drag = _NO_DRAG
        for at in (*range(self.at - 1, -1, -1), self.at + 1):
            if at < len(self.steps) and self.steps[at][0] == to:
                # Undone into: later steps stay. Else the refused step goes, and what was never run with it.
                del self.steps[at + 1 if at < self.at else self.at : self.at + 1]
                self.at = min(at, self.at)
                return
        self._replace(to)
        if self.at:
            self.steps[self.at] = to, change_name(self.steps[self.at - 1][0], to)

    def _replace(self, state: State) -> None:
        self.steps[self.at] = state, self.steps[self.at][1]


def differences(before: Any, after: Any, path: str = "") -> list[tuple[str, Any, Any]]:
    """Dotted path, value before and value after of each field that differs; lists of numbers are values.

    Parameters
    ----------
    before, after : object
        Parameter models, lists of such, or values. What is equal in both is not looked into.
    path : str
        Of both.
    """
    old, new = _parts(before), _parts(after)
    if not (old or new):
        return [(path, _ANY.dump_python(before, mode="json"), _ANY.dump_python(after, mode="json"))]
    changes: list[tuple[str, Any, Any]] = []
    for name in old | new:
        one, other = old.get(name), new.get(name)
        if one is not other and one != other:
            changes += differences(one, other, f"{path}.{name}" if path else name)
    return changes


def _parts(value: Any) -> dict[str, Any]:
    """Fields of a model, or models of a list by place; nothing of a value."""
    if isinstance(value, BaseModel):
        return dict(value)
    models = isinstance(value, tuple) and len(value) > 0 and isinstance(value[0], BaseModel)
    return dict(zip(map(str, range(len(value))), value, strict=True)) if models else {}


def changed_fields(before: Scenario, after: Scenario) -> tuple[str, ...]:
    """Dotted paths of the fields that differ, e.g. ``method.0.network.xi``, sorted."""
    return tuple(sorted(path for path, _, _ in differences(before, after)))


def change_name(before: State, after: State) -> str:
    """Say what changed, in a few words.

    Parameters
    ----------
    before, after : State
        On both sides of the change.
    """
    if after.taken != before.taken:
        return Text("take pins from a link")
    if after.origin != before.origin:
        return Text("open {origin}", origin=after.origin)
    count = len(after.scenario.method) - len(before.scenario.method)
    if count:
        return Text("add a method") if count > 0 else Text("remove a method")
    changes = sorted(differences(before.scenario, after.scenario), key=itemgetter(0))
    if len(changes) == 1:
        field, old, new = changes[0]
        return Text(
            "{field}: {before} → {after}",
            field=_named(field, after.scenario),
            before=_short(old),
            after=_short(new),
        )
    blocks = {field.rpartition(".")[0] or field for field, _, _ in changes}
    if len(blocks) == 1:
        return Text("change of {block}", block=blocks.pop())
    return Text("change of {fields} fields", fields=len(changes))


def _named(field: str, scenario: Scenario) -> str:
    """A field as the page calls it: of a method by the method's name."""
    block, _, rest = field.partition(".")
    index, _, inner = rest.partition(".")
    if block != "method" or not inner:
        return field
    inner = symbol(inner.removeprefix("network.")) if inner.startswith("network.") else inner
    return Text("{inner} of {short}", inner=inner, short=_short(scenario.method[int(index)].name))


def _short(value: Any) -> str:
    if value is None:
        return "none"
    text = f"{value:g}" if isinstance(value, float) else str(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"


def first_editable(scenario: Scenario) -> int:
    """Index of the first method with something to tune; 0 if there is none."""
    tunable = (
        i for i, m in enumerate(scenario.method) if not m.undamped and len(type(m.network).model_fields) > 1
    )
    return next(tunable, 0)
