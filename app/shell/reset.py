"""Back to how a scenario was opened: one field, in the palette and beside the buttons, or all."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits

if TYPE_CHECKING:
    from schuler_bench.editing.form import FieldSpec, Path
    from schuler_bench.shell.commands import Commands
    from schuler_bench.shell.control import Control

RESET_FIELD = "reset-field"
_SAME = 1e-9


def opened_value(
    opened: Scenario,
    scenario: Scenario,
    spec: FieldSpec,
    networks: dict[int, Mapping[str, Any]] | None = None,
) -> Any:
    """Value to which a field goes back.

    Parameters
    ----------
    opened, scenario : Scenario
        As it was opened and as it is now.
    spec : FieldSpec
        The field.
    networks : dict, optional
        Keeps the opened networks' values from one field to the next.

    Returns
    -------
    object
        What the opened scenario has there; the model's default when it has none: a method that was added,
        another kind of network, policy or motion.
    """
    path = spec.path
    if not _alike(opened, scenario, path[:-1] if path[-1] not in ("id", "kind") else path[:-2]):
        return spec.default
    if len(path) == 4 and path[2] == "network" and path[-1] != "id":
        known, index = {} if networks is None else networks, int(path[1])
        if index not in known:
            known[index] = edits.network_values(opened, index)
        return known[index].get(str(path[3]), spec.default)
    return edits.value_at(opened, path)


def _alike(opened: Any, scenario: Any, path: Path) -> bool:
    """Whether the models on the way to a field are of the same kinds in both scenarios."""
    for step in path:
        if isinstance(step, int):
            if max(len(opened), len(scenario)) <= step or step >= len(opened):
                return False
            opened, scenario = opened[step], scenario[step]
        else:
            opened, scenario = getattr(opened, step, None), getattr(scenario, step, None)
        if type(opened) is not type(scenario):
            return False
    return opened is not None


def differs(value: Any, other: Any) -> bool:
    """Whether two values of a field are different, rounding aside.

    Examples
    --------
    >>> differs(0.1 + 0.2, 0.3), differs("log", "none"), differs(None, 0.0)
    (False, True, True)
    """
    numbers = isinstance(value, int | float) and isinstance(other, int | float)
    return not math.isclose(value, other, rel_tol=_SAME) if numbers else value != other


class Resets:
    """The fields of a page that can be reset, as commands.

    Parameters
    ----------
    commands : Commands
        Of the page.
    put : callable
        ``put(control, value)`` changes a field.
    """

    def __init__(self, commands: Commands, put: Callable[[Control, Any], None]) -> None:
        self._commands, self._put = commands, put
        self._changed: dict[str, tuple[Control, Any]] = {}
        commands.register(RESET_FIELD, self._reset)

    def show(self, opened: Scenario, scenario: Scenario, controls: Iterable[Control]) -> None:
        """Offer a command for each control that shows another value than its field was opened with."""
        before, now = self._changed, dict[str, tuple["Control", Any]]()
        networks: dict[int, Mapping[str, Any]] = {}
        for control in controls:
            value = opened_value(opened, scenario, control.spec, networks)
            if value is not None and differs(control.value, value):
                now[control.spec.name] = (control, value)
        self._changed = now
        for name in before.keys() - now.keys():
            self._commands.remove(f"reset-{_slug(name)}")
        for name, (control, value) in now.items():
            if before.get(name, (None, None))[1] != value:
                title = Text(
                    "Reset {label} to {told}", label=control.spec.label, told=value_text(control, value)
                )
                self._commands.register(f"reset-{_slug(name)}", lambda _, name=name: self._reset(name), title)

    def of(self, control: Control | None) -> tuple[str, str] | None:
        """Argument of `RESET_FIELD` for a control, and the value it brings back; None if there is nothing."""
        name = "" if control is None else control.spec.name
        changed = self._changed.get(name)
        return None if changed is None else (name, value_text(*changed))

    def take_back(self, control: Control) -> None:
        """Reset the field of a control, if it has been changed."""
        self._reset(control.spec.name)

    def _reset(self, name: str) -> None:
        changed = self._changed.get(name.strip())
        if changed is not None:
            self._put(*changed)


def value_text(control: Control, value: Any) -> str:
    """A value of a control's field in a few characters."""
    text = f"{value:.6g}" if isinstance(value, float) else control.as_text(value)
    return text if len(text) <= 30 else f"{text[:29]}…"


def _slug(name: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", name.lower())[:70]
