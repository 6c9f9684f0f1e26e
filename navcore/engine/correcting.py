"""Corrections of a scenario's recordings, and what one of them does to the run's errors."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from navcore.engine.measures import measure
from navcore.engine.simulation import Cancelled, Progress, simulate
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.progress import part_of
from navcore.foundation.text import Text
from navcore.scenario.file import set_field
from navcore.scenario.model import Scenario
from navcore.sensors.corrections import Correction, corrections

_POSITION = "position_rms_m"


@dataclass(frozen=True)
class Tried(Answer):
    """What a correction changes.

    Attributes
    ----------
    correction : Correction or None
        The first one that a field of the scenario makes; None where the recordings agree.
    effects : tuple of (str, float, float)
        Of each method its name, and the RMS position error before and with it, m.
    stopped : bool
        It was cancelled.
    """

    correction: Correction | None
    effects: tuple[tuple[str, float, float], ...] = ()
    stopped: bool = False

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        one = self.correction
        named = None if one is None or one.field is None else ".".join(one.field)
        return {
            "finding": None if one is None else one.finding,
            "field": named,
            "value": None if named is None or one is None else one.value,
            "methods": [
                {"name": name, "before_m": before, "with_it_m": after} for name, before, after in self.effects
            ],
        }

    def rows(self) -> Iterator[Table | str]:
        """Give what does not agree, and the position error of each method before and with the correction."""
        if self.correction is None:
            yield Text("the recordings agree")
            return
        yield self.correction.notice
        named, before, after = Text("position error (RMS)"), Text("before"), Text("with it")
        yield Table((Column(named), Column(before, "m", 3), Column(after, "m", 3)), self.effects)

    def told(self) -> list[str]:
        """Give a sentence a method."""
        return [
            Text(
                "{name}: position error {before:.3g} m (RMS), {after:.3g} m with the correction.",
                name=name,
                before=before,
                after=after,
            )
            for name, before, after in self.effects
        ]


def correction_of(scenario: Scenario) -> Correction | None:
    """First correction of the scenario's recordings that one of its fields makes; None where all agree."""
    with suppress(InputError):
        found = corrections(scenario.motion, scenario.reference)
        return next((one for one in found if one.field is not None), None)
    return None


def corrected(scenario: Scenario, correction: Correction) -> Scenario:
    """Return the scenario with a correction; raises `InputError` when the value is out of range."""
    if correction.field is None:
        return scenario
    data, field = scenario.canonical(), ".".join(correction.field)
    if fault := set_field(data, field, correction.value):
        raise InputError(Fault("", field, correction.value, fault))
    return Scenario.parse(data)


def tried(scenario: Scenario, progress: Progress | None = None, cancelled: Cancelled | None = None) -> Tried:
    """Run a scenario as it is and with the correction of its recordings.

    Raises
    ------
    InputError
        The corrected recordings share too little time for the run.
    """
    found = correction_of(scenario)
    if found is None:
        return Tried(None)
    before = simulate(scenario, part_of(progress, 0.0, 0.5), cancelled)
    after = simulate(corrected(scenario, found), part_of(progress, 0.5, 1.0), cancelled)
    if "stopped" in (before.status, after.status):
        return Tried(found, stopped=True)
    effects = (
        (old.method.name, measure(old, _POSITION), measure(new, _POSITION))
        for old, new in zip(before.methods, after.methods, strict=True)
    )
    return Tried(found, tuple(effects))
