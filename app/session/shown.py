"""Source of the pictures: a session's run, or the pinned one while flipped, and its overlays."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import BaseModel

from navcore.engine.run import MethodRun, Run
from navcore.engine.spans import span_of
from navcore.engine.verification import Verification
from navcore.foundation.notation import with_unit
from navcore.foundation.text import Text
from navcore.foundation.units import HOUR
from navcore.quantities import NAMES
from navcore.scenario.model import Scenario
from schuler_bench.editing.form import field_words
from schuler_bench.jobs.asking import Asker
from schuler_bench.plots.envelope import Envelope, own_band
from schuler_bench.session.display import Display
from schuler_bench.session.history import differences
from schuler_bench.session.pins import LONGEST_NAME, Pin

if TYPE_CHECKING:
    from schuler_bench.session.session import Session


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
        Laid over it, named by what differs from it, with the methods that do (`schuler_bench.session.shown`).
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
    """Return what a session's pictures show now; None before its first run."""
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
        _placed(verified_beside(session.verifier, run.scenario), display),
        session.envelopes.beside(run.scenario, display.envelope) or own_band(run),
        selected,
    )


@dataclass(frozen=True)
class Verified:
    """A verification to be shown beside a run.

    Attributes
    ----------
    verification : Verification
        Of the same methods.
    old : bool
        It is of an earlier scenario.
    """

    verification: Verification
    old: bool


def verified_beside(verifier: Asker, scenario: Scenario) -> Verified | None:
    """Give the last verification for a run of a scenario, if its methods have the same names."""
    result, of = verifier.result, None if verifier.asked is None else verifier.asked.scenario
    if result is None or of is None or [m.name for m in of.method] != [m.name for m in scenario.method]:
        return None
    return Verified(result, of != scenario)


def _placed(verified: Verified | None, display: Display) -> Verified | None:
    if verified is None:
        return None
    both = verified.verification
    return replace(verified, verification=replace(both, linear=display.placed(both.linear)))


_MOST_PARTS = 2
_KINDS = ("id", "kind", "damping")
"""Fields whose value says by itself what it is."""


def laid(pins: Sequence[Pin], scenario: Scenario) -> tuple[Pin, ...]:
    """Give each pin the name of what differs from a scenario, and only the methods that a picture needs.

    These are the method that was edited when the run was pinned, and those that are others now. A name that
    the user gave is kept. Pins of a scenario with another title are left out: their curves say nothing here.

    Parameters
    ----------
    pins : sequence of Pin
        Pinned runs.
    scenario : Scenario
        What they are laid over.
    """
    alike = [pin for pin in pins if pin.scenario.title == scenario.title]
    return tuple(_with_needed(pin, scenario) for pin in titled(alike, scenario))


def titled(pins: Sequence[Pin], scenario: Scenario) -> tuple[Pin, ...]:
    """Give each pin that the user has not named the name of what differs from a scenario."""
    names: list[str] = []
    for pin in pins:
        name = difference(pin, scenario) if pin.unnamed else pin.name
        names.append(Text("{name} ({id})", name=name, id=pin.id) if name in names else name)
    return tuple(replace(pin, name=name) for pin, name in zip(pins, names, strict=True))


def difference(pin: Pin, scenario: Scenario) -> str:
    """Say in a few words in what a pin differs from a scenario; its own name where it does not."""
    if pin.scenario.title != scenario.title:
        return pin.origin or pin.name
    parts = list(dict.fromkeys(_parts(pin, scenario)))
    if not parts:
        return pin.name
    more = len(parts) - _MOST_PARTS
    words = Text.joined(", ", parts[:_MOST_PARTS]) + (Text(" + {more} more", more=more) if more > 0 else "")
    return words if len(words) <= LONGEST_NAME else Text("{words}…", words=words[: LONGEST_NAME - 1])


def edited(pin: Pin) -> int:
    """Place of the method that was edited when the run was pinned; the first one where it is unknown."""
    return next((place for place, m in enumerate(pin.scenario.method) if m.name == pin.method), 0)


def _with_needed(pin: Pin, scenario: Scenario) -> Pin:
    if pin.run is None:
        return pin
    present = {method.name: method for method in scenario.method}
    needed = tuple(
        method_run
        for method_run in pin.run.methods
        if method_run.method.name == pin.method or present.get(method_run.method.name) != method_run.method
    )
    return replace(pin, run=replace(pin.run, methods=needed)) if needed else pin


def _parts(pin: Pin, scenario: Scenario) -> Iterator[str]:
    """Differences, those of the edited method first: ``ζ 0.5``."""
    present = {method.name: method for method in scenario.method}
    others: list[str] = []
    for method in pin.scenario.method:
        now = present.get(method.name)
        words = [method.name] if now is None else _differing(method, now)
        if method.name == pin.method:
            yield from words
        else:
            others += [
                Text("{name}: {word}", name=method.name, word=word) if now is not None else word
                for word in words
            ]
    yield from others
    yield from _differing(*(one.model_copy(update={"method": ()}) for one in (pin.scenario, scenario)))


def _differing(old: BaseModel, new: BaseModel) -> list[str]:
    values = {path: value for path, value, _ in differences(old, new)}
    kinds = [
        path for path, value in values.items() if path.rpartition(".")[2] in _KINDS and value is not None
    ]
    # Another kind of block has other fields: they say nothing that its name does not.
    named = {kind.rpartition(".")[0] for kind in kinds}
    return [
        _words(path, value, old)
        for path, value in values.items()
        if path in kinds or path.rpartition(".")[0] not in named
    ]


def _words(path: str, value: Any, model: BaseModel) -> str:
    """Say what a field of a model, by its path, is set to: ``ζ 0.5``, ``log bias 0.3, 0 m/s``."""
    block, _, name = path.rpartition(".")
    if name in _KINDS:
        return str(value)
    if name.isdigit():
        name, unit = Text("{block} {name}", block=block.rpartition(".")[2], name=name), ""
    else:
        name, unit = field_words(model, path)
    if value is None:
        return Text("no {name}", name=name)
    numbers = value if isinstance(value, list) else [value]
    told = ", ".join(f"{one:g}" if isinstance(one, float) else str(one) for one in numbers)
    return Text("{name} {value}", name=name, value=with_unit(told, unit) if unit else told)


# ------------------------------------------------------------ the part that is measured

_FEWEST_ROWS = 2


@dataclass(frozen=True)
class Window:
    """Span over which the errors of a run are measured.

    Attributes
    ----------
    run : Run
        The run, its `MethodRun.errors` measured over the window.
    from_s, to_s : float or None
        Ends of the window, s; None: the whole run.
    told : str
        The window in words; empty while the whole run is asked for.
    possible : bool
        False where the window that was asked for holds nothing, so that the whole run is measured.
    """

    run: Run
    from_s: float | None = None
    to_s: float | None = None
    told: str = ""
    possible: bool = True

    def of(self, other: Run) -> Run:
        """Measure another run over the same window."""
        if self.from_s is None or self.to_s is None:
            return other
        return _measured(other, self.from_s, self.to_s)


def window_of(run: Run, display: Display) -> Window:
    """Measure a run over what the display asks for.

    "After settling" begins where the slowest of the damped, stable methods has come down to 2 % of an initial
    tilt: one window for all methods, so that their numbers can be compared.
    """
    if display.window == "whole" or not len(run.t_s):
        return Window(run)
    begins, end = 0.0, float(run.t_s[-1])
    why = ""
    if display.window == "settled":
        settling = [s for method in run.methods if (s := method.loop.settling_s) is not None]
        if not settling:
            return Window(
                run, told=Text("No method settles: the errors are of the whole run."), possible=False
            )
        begins, why = max(settling), Text(" (the slowest damped method has settled)")
    else:
        begins = display.window_from_h * HOUR
        end = end if display.window_to_h is None else min(end, display.window_to_h * HOUR)
    rows = int(np.count_nonzero((run.t_s >= begins) & (run.t_s <= end)))
    if rows < _FEWEST_ROWS:
        told = Text(
            "The run of {t_s:.3g} h has nothing between {begins:.3g} h{why} and "
            "{end:.3g} h: the errors are of the whole run.",
            t_s=run.t_s[-1] / HOUR,
            begins=begins / HOUR,
            why=why,
            end=end / HOUR,
        )
        return Window(run, told=told, possible=False)
    told = Text(
        "Errors from {begins:.3g} h{why} to {end:.3g} h, on {rows} output rows.",
        begins=begins / HOUR,
        why=why,
        end=end / HOUR,
        rows=rows,
    )
    return Window(_measured(run, begins, end), begins, end, told)


def _measured(run: Run, from_s: float, to_s: float) -> Run:
    def cut(method: MethodRun) -> MethodRun:
        return _method(method, run.truth, from_s, to_s)

    against = run.against
    if against is not None and against.recorded is not None:
        against = replace(against, recorded=cut(against.recorded))
    return replace(run, methods=tuple(map(cut, run.methods)), against=against)


def _method(method: MethodRun, truth: np.ndarray, from_s: float, to_s: float) -> MethodRun:
    """Statistics on the output rows; the largest magnitude on the curves too, which keep every extreme."""
    inside = (method.t_s >= from_s) & (method.t_s <= to_s)
    rows = method.rows[inside, : len(NAMES)]
    drawn = method.plot.values[(method.plot.t_s >= from_s) & (method.plot.t_s <= to_s)]
    if not len(rows):
        empty = dict.fromkeys(("mean", "std", "rms", "max_abs", "final"), float("nan"))
        return replace(method, errors=dict.fromkeys(NAMES, empty), spans=())
    largest = np.abs(np.concatenate([rows, drawn])).max(axis=0)
    return replace(
        method,
        errors={
            name: {
                "mean": float(rows[:, i].mean()),
                "std": float(rows[:, i].std()),
                "rms": float(np.sqrt(np.mean(rows[:, i] ** 2))),
                "max_abs": float(largest[i]),
                "final": float(rows[-1, i]),
            }
            for i, name in enumerate(NAMES)
        },
        spans=(span_of(method.t_s[inside], rows, truth[: len(inside)][inside]),),
    )
