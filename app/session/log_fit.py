"""The error of a scenario's recorded log against its recorded track, in numbers and in words."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.motion.track import TrackMotion
from navcore.scenario.model import Scenario

if TYPE_CHECKING:
    from navcore.sensors.fit import LogAlongTrack, LogErrorFit
    from navcore.sensors.reference import Reference


def can_fit(scenario: Scenario) -> bool:
    """Whether a scenario has both a recorded log and the track recorded with it."""
    return scenario.reference.kind == "file" and isinstance(scenario.motion, TrackMotion)


@dataclass(frozen=True, eq=False)
class FittedLog:
    """A fit and what it was made from.

    Attributes
    ----------
    fit : LogErrorFit
        Of the speed that the scenario uses.
    log : LogAlongTrack
        That speed beside the track.
    other : LogErrorFit or None
        Of the other speed, where the log gives both: through the water, and over ground.
    other_speed : str
        "water" or "ground".
    """

    fit: LogErrorFit
    log: LogAlongTrack
    other: LogErrorFit | None
    other_speed: str


def fit_of(scenario: Scenario) -> FittedLog:
    """Fit delay, bias, noise and drift of the recorded log, of both its speeds where it has them.

    Raises
    ------
    InputError
        A recording is missing, or the record is too short for a fit.
    """
    from navcore.sensors.fit import fit_delay, fit_log_error, log_along_track
    from navcore.sensors.log_files import log_recording

    motion, reference = scenario.motion, scenario.reference
    if not isinstance(motion, TrackMotion) or reference.kind != "file":
        allowed = Text('must be a recorded log ("file") beside a recorded track ("track")')
        raise InputError(Fault("", "reference.kind", reference.kind, allowed))

    def fitted(used: Reference) -> tuple[LogErrorFit, LogAlongTrack]:
        log = log_along_track(used, motion)
        delay_s = fit_delay(log)
        return fit_log_error(*log.error(delay_s), delay_s=delay_s), log

    recording = log_recording(reference)
    other_speed = "ground" if reference.speed == "water" else "water"
    other = None
    if recording.water is not None and recording.ground is not None:
        with suppress(InputError):
            other, _ = fitted(reference.model_copy(update={"speed": other_speed}))
    fit, log = fitted(reference)
    return FittedLog(fit, log, other, other_speed)


def with_fitted_log(scenario: Scenario, fit: LogErrorFit) -> Scenario:
    """Replace the recorded log by a simulated one with the fitted error; events and outages stay."""
    reference = fit.reference().model_copy(
        update={"event": scenario.reference.event, "outage": scenario.reference.outage}
    )
    return Scenario.parse(scenario.canonical() | {"reference": reference.model_dump(mode="json")})


def fit_lines(fitted: FittedLog) -> list[str]:
    """Say what the fit found, a line each."""
    fit = fitted.fit
    (starboard, forward), (of_starboard, of_forward) = fit.bias, fit.bias_std
    return [
        Text(
            "Error of the log along the ship's axes, over {span_s:.0f} s at {rate_hz:.3g} Hz:",
            span_s=fit.span_s,
            rate_hz=fit.rate_hz,
        ),
        Text("Delay {delay_s:.1f} s.", delay_s=fit.delay_s),
        Text(
            "Bias to starboard {starboard:.3f} ± {of_starboard:.3f} m/s.",
            starboard=starboard,
            of_starboard=of_starboard,
        ),
        Text("Bias forward {forward:.3f} ± {of_forward:.3f} m/s.", forward=forward, of_forward=of_forward),
        Text("White noise {noise:.3f} m/s a sample.", noise=fit.noise),
        Text(
            "Drift {drift:.3f} m/s with a correlation time of {drift_tau_s:.1f} s.",
            drift=fit.drift,
            drift_tau_s=fit.drift_tau_s,
        ),
        *_other_lines(fitted),
    ]


def _other_lines(fitted: FittedLog) -> list[str]:
    """Say what the log's other speed would give."""
    if fitted.other is None:
        return []
    words = {"ground": Text("the speed over ground"), "water": Text("the speed through the water")}
    told = Text(
        'The log gives {other} too: its drift is {drift:.3f} m/s; choose it by speed = "{speed}".',
        other=words[fitted.other_speed],
        drift=fitted.other.drift,
        speed=fitted.other_speed,
    )
    through = Text("Through the water, the stream counts as a drift of the log.")
    return [told, through] if fitted.other_speed == "ground" else [told]
