"""Pinned runs of a session: baselines that every picture can be laid over, with name, colour and note."""

import logging
import threading
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from typing import Any

from navcore.engine.run import Run
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from schuler_bench.jobs.envelopes import Simulate
from schuler_bench.jobs.load import spare_load
from schuler_bench.jobs.rows import few_rows
from schuler_bench.jobs.scheduler import Lane, Load
from schuler_bench.jobs.worker import Watch, Worker

MOST_PINS = 8
LONGEST_NAME, LONGEST_NOTE = 40, 400
Kept = list[dict[str, Any]]
"""Pins as they are in a file."""
COLORS: dict[str, str] = {
    Text("black"): "#1F2933",
    Text("magenta"): "#C2185B",
    Text("brown"): "#795548",
    "petrol": "#00697A",
    "violet": "#5E35B1",
    "slate": "#546E7A",
    "moss": "#5B7F00",
    "rust": "#A63C00",
}
"""Colours of pins, in the order in which they are given out: none is one of the first methods'."""
_log = logging.getLogger("schuler.pins")


@dataclass(frozen=True)
class Pin:
    """One pinned run.

    Attributes
    ----------
    id : int
        Names it within the session; never used again.
    name, note : str
        As the user calls it, and what they say of it.
    color : str
        Key of `COLORS`.
    shown : bool
        It is laid over the pictures.
    scenario : Scenario
        What was run.
    origin : str
        Preset it came from.
    run : Run or None
        The run, with few output rows; None until it has been computed again after a restart.
    method : str
        Name of the method that was edited when the run was pinned; empty where that is unknown.
    """

    id: int
    name: str
    note: str
    color: str
    shown: bool
    scenario: Scenario
    origin: str
    run: Run | None
    method: str = ""

    @property
    def unnamed(self) -> bool:
        """Whether the user has given it no name: what differs names it (`schuler_bench.session.shown`)."""
        return self.name == _made_name(self.id)

    @property
    def hex(self) -> str:
        """Colour, ``#RRGGBB``."""
        return COLORS[self.color]


class Pins:
    """The pins of a session; every change is reported.

    Parameters
    ----------
    changed : callable
        ``changed()`` after every change, from the thread that made it or from the one that computes.
    simulate : callable
        ``simulate(scenario, progress, cancelled)``, for pins that were read from a file.
    visitor : object, optional
        Whose they are, for the turns.
    """

    def __init__(self, changed: Callable[[], None], simulate: Simulate, visitor: object = None) -> None:
        self._changed, self._simulate = changed, simulate
        self._lock = threading.Lock()
        self._pins: tuple[Pin, ...] = ()
        self._next = 1
        self._worker: Worker[int] = Worker(self._compute, visitor=visitor, load=lambda _: self._load())

    # ------------------------------------------------------------ asking

    @property
    def all(self) -> tuple[Pin, ...]:
        """Every pin, oldest first."""
        return self._pins

    @property
    def shown(self) -> tuple[Pin, ...]:
        """Those that are laid over the pictures now."""
        return tuple(pin for pin in self._pins if pin.shown and pin.run is not None)

    def get(self, id: int | None) -> Pin | None:
        """The pin of that id; None when there is none."""
        return next((pin for pin in self._pins if pin.id == id), None)

    def baseline(self, id: int | None) -> Pin | None:
        """Baseline of comparisons: the pin of that id, else the first; None when it has no run."""
        pin = self.get(id) or next(iter(self._pins), None)
        return None if pin is None or pin.run is None else pin

    # ------------------------------------------------------------ changing

    def add(self, run: Run, origin: str, name: str = "", method: str = "") -> Pin:
        """Pin a run.

        Parameters
        ----------
        run : Run
            What is kept.
        origin : str
            Preset it came from.
        name : str
            As the user calls it.
        method : str
            Name of the method that is edited at present.

        Raises
        ------
        InputError
            There are `MOST_PINS` already.
        """
        with self._lock:
            _refuse_too_many(len(self._pins) + 1)
            id, self._next = self._next, self._next + 1
            color = _free_color(self._pins)
            title = _short(name) or _made_name(id)
            pin = Pin(id, title, "", color, True, run.scenario, origin, few_rows(run), method)
            self._pins = (*self._pins, pin)
        self._changed()
        return pin

    def take(self, kept: Kept) -> tuple[Pin, ...]:
        """Add the pins of another session, as its `to_json` gave them, but those that are here already.

        Raises
        ------
        InputError
            There would be more than `MOST_PINS`.
        ValueError, TypeError, KeyError
            It is not what `to_json` gives.
        """
        with self._lock:
            known, fresh = [_content(pin) for pin in self._pins], list[Pin]()
            for entry in kept:
                pin = _read(self._next + len(fresh), entry)
                if _content(pin) not in known:
                    color = _free_color((*self._pins, *fresh), first=pin.color)
                    fresh.append(replace(pin, color=color))
            _refuse_too_many(len(self._pins) + len(fresh))
            self._next += len(fresh)
        self.exchange((), tuple(fresh))
        return tuple(fresh)

    def exchange(self, old: Collection[Pin], new: Collection[Pin]) -> None:
        """Take some pins away, and put others at the end; their runs are computed in the background."""
        gone = {pin.id for pin in old if pin not in new}
        self._exchange(
            lambda pins: (
                *(pin for pin in pins if pin.id not in gone),
                *(pin for pin in new if pin not in old),
            )
        )
        if any(pin.run is None for pin in self._pins):
            self._worker.submit(0)

    def change(self, id: int, **changes: Any) -> None:
        """Give a pin another name, note, colour, or show or hide it; unknown ids do nothing.

        Raises
        ------
        InputError
            The colour is not one of `COLORS`.
        """
        if "name" in changes:
            changes["name"] = _short(changes["name"]) or _made_name(id)
        if "note" in changes:
            changes["note"] = str(changes["note"]).strip()[:LONGEST_NOTE]
        if changes.get("color", next(iter(COLORS))) not in COLORS:
            raise InputError(
                [
                    Fault(
                        "pins",
                        "color",
                        changes["color"],
                        Text("must be one of {colors}", colors=", ".join(COLORS)),
                    )
                ]
            )
        self._exchange(lambda pins: tuple(replace(pin, **changes) if pin.id == id else pin for pin in pins))

    def remove(self, id: int) -> None:
        """Take a pin away; unknown ids do nothing."""
        self._exchange(lambda pins: tuple(pin for pin in pins if pin.id != id))

    def _exchange(self, change: Callable[[tuple[Pin, ...]], tuple[Pin, ...]]) -> None:
        with self._lock:
            before = self._pins
            self._pins = after = change(before)
        if after != before:
            self._changed()

    def stop(self) -> None:
        """End the thread."""
        self._worker.stop()

    def wait_idle(self, timeout_s: float | None = None) -> bool:
        """Block until every pin has been computed; False after the timeout."""
        return self._worker.wait_idle(timeout_s)

    # ------------------------------------------------------------ kept in a file

    def to_json(self) -> Kept:
        """Form of the pins in a file: everything but the runs, which are computed again."""
        return [
            {
                "name": "" if pin.unnamed else pin.name,
                "note": pin.note,
                "color": pin.color,
                "shown": pin.shown,
                "origin": pin.origin,
                "method": pin.method,
                "scenario": pin.scenario.canonical(),
            }
            for pin in self._pins
        ]

    def from_json(self, kept: Any) -> None:
        """Take over what `to_json` gave, in place of all pins; the runs are computed in the background.

        Parameters
        ----------
        kept : object
            As read from a file, which is not trusted.

        Raises
        ------
        InputError, ValueError, TypeError, KeyError
            It is not what `to_json` gives.
        """
        pins = tuple(_read(id, entry) for id, entry in enumerate(list(kept)[:MOST_PINS], start=1))
        with self._lock:
            self._pins, self._next = pins, len(pins) + 1
        if pins:
            self._worker.submit(0)

    def _load(self) -> Load:
        """One after the other is computed: the largest counts."""
        loads = [spare_load(pin.scenario) for pin in self._pins if pin.run is None]
        return max(loads, key=lambda load: load.bytes, default=Load(Lane.SPARE))

    def _compute(self, _: int, watch: Watch) -> None:
        for pin in self._pins:
            if pin.run is not None or watch.cancelled():
                continue
            try:
                run = self._simulate(pin.scenario, lambda _: None, watch.cancelled)
            except InputError as error:
                _log.warning("%s cannot be run again: %s", pin.name, error)
                continue
            if run.status != "stopped":
                self.change(pin.id, run=few_rows(run))


def _refuse_too_many(count: int) -> None:
    if count > MOST_PINS:
        allowed = Text("at most {most_pins}: remove one first", most_pins=MOST_PINS)
        raise InputError([Fault("pins", "", count, allowed)])


def _free_color(pins: Sequence[Pin], first: str = next(iter(COLORS))) -> str:
    taken = {pin.color for pin in pins}
    return next((color for color in (first, *COLORS) if color not in taken), first)


def _content(pin: Pin) -> tuple[object, ...]:
    """Fields that make it another pin for a reader: neither its id nor its look."""
    return "" if pin.unnamed else pin.name, pin.note, pin.scenario, pin.method


def _read(id: int, entry: Any) -> Pin:
    if entry["color"] not in COLORS:
        raise ValueError(f"no such colour: {entry['color']!r}")
    return Pin(
        id=id,
        name=_short(entry["name"]) or _made_name(id),
        note=str(entry["note"])[:LONGEST_NOTE],
        color=entry["color"],
        shown=bool(entry["shown"]),
        scenario=Scenario.parse(entry["scenario"]),
        origin=str(entry["origin"])[:60],
        run=None,
        method=str(entry.get("method", ""))[:200],
    )


def _made_name(id: int) -> str:
    return Text("pin {id}", id=id)


def _short(name: object) -> str:
    return " ".join(str(name).split())[:LONGEST_NAME]
