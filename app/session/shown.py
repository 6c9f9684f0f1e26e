"""What the pictures show: a session's run, or the pinned one while flipped, and what is laid over it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from app.jobs.verifier import Verified
from app.plots.envelope import Envelope
from app.session.display import Display
from app.session.laid import laid, titled
from app.session.pins import Pin
from navcore.engine.run import Run

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
        Laid over it, named by what differs from it, with the methods that do (`app.session.laid`).
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
