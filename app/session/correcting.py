"""Corrections of a scenario's recordings, and what one of them does to the run's errors."""

from __future__ import annotations

from contextlib import suppress

from navcore.engine.measures import measure
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.text import Text
from navcore.scenario.model import Scenario
from navcore.sensors.corrections import Correction, corrections
from schuler_bench.editing import edits

_POSITION = "position_rms_m"


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
    return edits.with_value(scenario, correction.field, correction.value)


def effect_lines(run: Run, correction: Correction) -> list[str]:
    """Run the corrected scenario; a line a method: its RMS position error before and with the correction.

    Raises
    ------
    InputError
        The corrected recordings share too little time for the run.
    """
    after = simulate(corrected(run.scenario, correction))
    return [
        Text(
            "{name}: position error {before:.3g} m (RMS), {after:.3g} m with the correction.",
            name=old.method.name,
            before=_position(run, place),
            after=_position(after, place),
        )
        for place, old in enumerate(run.methods)
    ]


def _position(run: Run, place: int) -> float:
    return measure(run.methods[place], _POSITION)
