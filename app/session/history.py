"""Undo and redo over all changes of a scenario: steps that a user would call one, each with a name."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from navcore.foundation.notation import symbol
from navcore.foundation.parameters import sharing
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario

MOST_STEPS = 200
DRAG_S = 1.0
"""Changes of one field that follow each other faster than this are one step: a slider being dragged."""
_LONGEST = 24


@dataclass(frozen=True)
class State:
    """What undo brings back.

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
    """

    scenario: Scenario
    origin: str
    selected: int
    opened: Scenario


@dataclass(frozen=True)
class _Step:
    state: State
    name: str


class History:
    """States in the order in which they came, and where among them the user stands.

    Parameters
    ----------
    state : State
        To begin with.
    clock : callable, optional
        Seconds, monotonic.
    """

    def __init__(self, state: State, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._steps = [_Step(state, "")]
        self._at = 0
        self._drag: tuple[tuple[str, ...], float] = ((), 0.0)

    @property
    def steps(self) -> tuple[tuple[State, str], ...]:
        """Every state, oldest first, and the name of the change that led to it."""
        return tuple((step.state, step.name) for step in self._steps)

    @property
    def at(self) -> int:
        """Index of the present one among `steps`."""
        return self._at

    @classmethod
    def of(cls, steps: Sequence[tuple[State, str]], at: int) -> History:
        """A history with these `steps` that stands `at` one of them; ValueError if there is none such."""
        if not 0 <= at < len(steps):
            raise ValueError(f"no step {at} among {len(steps)}")
        made = cls(steps[0][0])
        made._steps = [_Step(state, name) for state, name in steps]
        made._at = at
        return made

    @property
    def state(self) -> State:
        """Where the user stands."""
        return self._steps[self._at].state

    @property
    def undo_name(self) -> str | None:
        """What undo would take back, in words; None when there is nothing."""
        return self._steps[self._at].name if self._at > 0 else None

    @property
    def redo_name(self) -> str | None:
        """What redo would bring back, in words; None when there is nothing."""
        return self._steps[self._at + 1].name if self._at + 1 < len(self._steps) else None

    def push(self, state: State, name: str = "", gesture: str = "") -> None:
        """Note a change; what had been undone is forgotten. Nothing happens when nothing changed.

        Parameters
        ----------
        state : State
            After the change.
        name : str
            What was done, in words; else it is told from what changed.
        gesture : str
            Changes of one gesture that follow each other are one step, however long it takes.
        """
        before = self.state
        if state == before:
            return
        fields = changed_fields(before.scenario, state.scenario)
        if not fields and state.origin == before.origin:
            self._replace(state)  # another method was selected: no step of its own
            return
        # Two hundred scenarios that differ in a field each are kept as what differs.
        state = replace(state, scenario=sharing(state.scenario, before.scenario))
        now, (dragged, last_s) = self._clock(), self._drag
        moved = (gesture,) if gesture else () if name else fields
        self._drag = moved, now
        del self._steps[self._at + 1 :]
        if moved and moved == dragged and (gesture or now - last_s < DRAG_S):
            start = self._steps[self._at - 1].state
            if start.scenario == state.scenario and start.origin == state.origin:
                self._at -= 1  # dragged back to where it was
                del self._steps[self._at + 1 :]
                self._replace(state)
                self._drag = ((), 0.0)  # its step is gone: what follows is another one
                return
            self._steps[self._at] = _Step(state, name or change_name(start, state))
            return
        self._steps.append(_Step(state, name or change_name(before, state)))
        del self._steps[: max(0, len(self._steps) - MOST_STEPS - 1)]
        self._at = len(self._steps) - 1

    def undo(self) -> State | None:
        """Go one step back; None at the beginning."""
        if self._at == 0:
            return None
        self._at, self._drag = self._at - 1, ((), 0.0)
        return self.state

    def redo(self) -> State | None:
        """Go one step forward again; None at the end."""
        if self._at + 1 >= len(self._steps):
            return None
        self._at, self._drag = self._at + 1, ((), 0.0)
        return self.state

    def take_back(self, to: State) -> None:
        """Forget the present step, whose scenario was refused: the user stands at ``to`` again.

        Parameters
        ----------
        to : State
            The last one that was good; if no step has it (it was passed within a drag), the present step
            ends there.
        """
        self._drag = ((), 0.0)
        for at in (*range(self._at - 1, -1, -1), self._at + 1):
            if at < len(self._steps) and self._steps[at].state == to:
                # Undone into: later steps stay. Else the refused step goes, and what was never run with it.
                del self._steps[at + 1 if at < self._at else self._at : self._at + 1]
                self._at = min(at, self._at)
                return
        if self._at == 0:
            self._replace(to)
        else:
            self._steps[self._at] = _Step(to, change_name(self._steps[self._at - 1].state, to))

    def _replace(self, state: State) -> None:
        self._steps[self._at] = _Step(state, self._steps[self._at].name)


def changed_fields(before: Scenario, after: Scenario) -> tuple[str, ...]:
    """Dotted paths of the fields that differ, e.g. ``method.0.network.xi``, sorted."""
    old, new = fields_of(before), fields_of(after)
    return tuple(sorted(path for path in old.keys() | new.keys() if old.get(path) != new.get(path)))


def change_name(before: State, after: State) -> str:
    """Say what changed, in a few words.

    Parameters
    ----------
    before, after : State
        On both sides of the change.
    """
    if after.origin != before.origin:
        return Text("open {origin}", origin=after.origin)
    count = len(after.scenario.method) - len(before.scenario.method)
    if count:
        return "add a method" if count > 0 else "remove a method"
    fields = changed_fields(before.scenario, after.scenario)
    if len(fields) != 1:
        blocks = {field.rsplit(".", 1)[0] for field in fields}
        return (
            Text("change of {pop}", pop=blocks.pop())
            if len(blocks) == 1
            else Text("change of {fields} fields", fields=len(fields))
        )
    (field,) = fields
    old, new = fields_of(before.scenario).get(field), fields_of(after.scenario).get(field)
    return f"{_named(field, after.scenario)}: {_short(old)} → {_short(new)}"


def _named(field: str, scenario: Scenario) -> str:
    """A field as the page calls it: of a method by the method's name."""
    block, _, rest = field.partition(".")
    index, _, inner = rest.partition(".")
    if block != "method" or not inner:
        return field
    inner = symbol(inner.removeprefix("network.")) if inner.startswith("network.") else inner
    return Text("{inner} of {short}", inner=inner, short=_short(scenario.method[int(index)].name))


def fields_of(scenario: Scenario) -> Mapping[str, Any]:
    """Values of all fields by dotted path, e.g. ``method.0.network.xi``; kept for the last few scenarios."""
    key: Any = scenario  # frozen, and so hashable, which its type does not tell
    return _kept_fields(key)


@lru_cache(maxsize=32)
def _kept_fields(scenario: Scenario) -> Mapping[str, Any]:
    return _flat(scenario.canonical())


def _flat(value: Any, path: str = "") -> dict[str, Any]:
    """Leaves of a nested mapping by dotted path; lists of numbers are leaves."""
    if isinstance(value, dict):
        items = [(str(key), item) for key, item in value.items()]
    elif isinstance(value, list) and any(isinstance(item, dict) for item in value):
        items = [(str(index), item) for index, item in enumerate(value)]
    else:
        return {path: value}
    return {
        leaf: item
        for key, inner in items
        for leaf, item in _flat(inner, f"{path}.{key}" if path else key).items()
    }


def _short(value: Any) -> str:
    if value is None:
        return "none"
    text = f"{value:g}" if isinstance(value, float) else str(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}…"
