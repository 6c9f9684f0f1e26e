"""What the pictures show: a session's run, or the pinned one while flipped, and what is laid over it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from app.jobs.verifier import Verified
from app.plots.envelope import Envelope
from app.session.display import Display
from app.session.history import fields_of
from app.session.pins import LONGEST_NAME, Pin
from navcore.engine.run import Run
from navcore.foundation.notation import symbol
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario

if TYPE_CHECKING:
    from app.session.session import Session


@dataclass(frozen=True)
class Shown:
    """Everything that the figures are made of.

    Attributes
    ----------
    run : Run
        Present run, or that of ``flipped``.
    number : int
        Of the present run.
    display : Display
        How it is shown.
    pins : tuple of Pin
        Laid over it, named by what differs from it, with the methods that do (`app.session.shown`).
    baseline : Pin or None
        What the table's numbers are compared with.
    flipped : Pin or None
        The pin that is shown in the place of the present run.
    verified : Verified or None
        Verification of the same methods.
    envelope : Envelope or None
        Bands behind the error curves.
    selected : int
        Method that the controls edit.
    """

    run: Run
    number: int
    display: Display
    pins: tuple[Pin, ...] = ()
    baseline: Pin | None = None
    flipped: Pin | None = None
    verified: Verified | None = None
    envelope: Envelope | None = None
    selected: int = 0


def shown(session: Session) -> Shown | None:
    """What a session's pictures show now; None before its first run."""
    with session.lock:
        run, number, display, selected = (
            session.run, session.run_number, session.display, session.selected,
        )  # fmt: skip
    if run is None:
        return None
    pins = session.pins.shown
    baseline = session.pins.baseline(display.baseline)
    if baseline is not None:
        baseline = next(pin for pin in titled(session.pins.all, run.scenario) if pin.id == baseline.id)
    if display.flipped and baseline is not None and baseline.run is not None:
        others = laid([pin for pin in pins if pin.id != baseline.id], baseline.scenario)
        return Shown(baseline.run, number, display, others, flipped=baseline, selected=selected)
    return Shown(
        run,
        number,
        display,
        laid(pins, run.scenario),
        baseline,
        None,
        session.verifier.beside(run.scenario),
        session.envelopes.beside(run.scenario, display.envelope),
        selected,
    )


_MOST_PARTS = 2
_KINDS = ("id", "kind", "damping")
"""Fields whose value says by itself what it is."""


def laid(pins: Sequence[Pin], scenario: Scenario) -> tuple[Pin, ...]:
    """Give each pin the name of what differs from a scenario, and only the methods that a picture needs.

    These are the method that was edited when the run was pinned, and those that are others now. A name that
    the user gave is kept.

    Parameters
    ----------
    pins : sequence of Pin
        Pinned runs.
    scenario : Scenario
        What they are laid over.
    """
    return tuple(_with_needed(pin, scenario) for pin in titled(pins, scenario))


def titled(pins: Sequence[Pin], scenario: Scenario) -> tuple[Pin, ...]:
    """Give each pin that the user has not named the name of what differs from a scenario."""
    names: list[str] = []
    for pin in pins:
        name = difference(pin, scenario) if pin.unnamed else pin.name
        names.append(f"{name} ({pin.id})" if name in names else name)
    return tuple(replace(pin, name=name) for pin, name in zip(pins, names, strict=True))


def difference(pin: Pin, scenario: Scenario) -> str:
    """Say in a few words in what a pin differs from a scenario; its own name where it does not."""
    if pin.scenario.title != scenario.title:
        return pin.origin or pin.name
    parts = list(dict.fromkeys(_parts(pin, scenario)))
    if not parts:
        return pin.name
    more = len(parts) - _MOST_PARTS
    words = ", ".join(parts[:_MOST_PARTS]) + (Text(" + {more} more", more=more) if more > 0 else "")
    return words if len(words) <= LONGEST_NAME else f"{words[: LONGEST_NAME - 1]}…"


def edited(pin: Pin) -> int:
    """Place of the method that was edited when the run was pinned; the first one where it is unknown."""
    return next((place for place, m in enumerate(pin.scenario.method) if m.name == pin.method), 0)


def _with_needed(pin: Pin, scenario: Scenario) -> Pin:
    if pin.run is None:
        return pin
    present = {method.name: method for method in scenario.method}
    needed = tuple(
        found
        for found in pin.run.methods
        if found.method.name == pin.method or present.get(found.method.name) != found.method
    )
    return replace(pin, run=replace(pin.run, methods=needed)) if needed else pin


def _parts(pin: Pin, scenario: Scenario) -> Iterator[str]:
    """Differences, those of the edited method first: ``ζ 0.5``."""
    old, new = fields_of(pin.scenario), fields_of(scenario)
    present = {method.name: place for place, method in enumerate(scenario.method)}
    others: list[str] = []
    for place, method in enumerate(pin.scenario.method):
        now = present.get(method.name)
        mine = _block(old, f"method.{place}.")
        words = [method.name] if now is None else _differing(mine, _block(new, f"method.{now}."))
        if method.name == pin.method:
            yield from words
        else:
            others += [f"{method.name}: {word}" if now is not None else word for word in words]
    yield from others
    yield from _differing(_block(old, "", "method."), _block(new, "", "method."))


def _block(fields: Mapping[str, Any], within: str, without: str = "\n") -> dict[str, Any]:
    return {
        path.removeprefix(within): value
        for path, value in fields.items()
        if path.startswith(within) and not path.startswith(without)
    }


def _differing(old: dict[str, Any], new: dict[str, Any]) -> list[str]:
    paths = [path for path in dict.fromkeys((*old, *new)) if old.get(path) != new.get(path)]
    kinds = [path for path in paths if path.rpartition(".")[2] in _KINDS and path in old]
    if kinds:
        # Another kind of block has other fields: they say nothing that its name does not.
        paths = [path for path in paths if path in kinds or not _beside(path, kinds)]
    return [_words(path, old.get(path)) for path in paths]


def _beside(path: str, kinds: list[str]) -> bool:
    return any(path.rpartition(".")[0] == kind.rpartition(".")[0] for kind in kinds)


def _words(path: str, value: Any) -> str:
    block, _, name = path.rpartition(".")
    if name.isdigit():
        name = f"{block.rpartition('.')[2]} {name}"
    if name in _KINDS:
        return str(value)
    name = symbol(name)
    if value is None:
        return Text("no {name}", name=name)
    return f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}"
