"""The error of a scenario's recorded log against its recorded track, in numbers and in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.motion.track import TrackMotion
from navcore.scenario.model import Scenario

if TYPE_CHECKING:
    from navcore.sensors.fit import LogErrorFit


def can_fit(scenario: Scenario) -> bool:
    """Whether a scenario has both a recorded log and the track recorded with it."""
    return scenario.reference.kind == "file" and isinstance(scenario.motion, TrackMotion)


def fit_of(scenario: Scenario) -> LogErrorFit:
    """Fit delay, bias, noise and drift of the recorded log.

    Raises
    ------
    InputError
        A recording is missing, or the record is too short for a fit.
    """
    from navcore.sensors.fit import fit_delay, fit_log_error, log_along_track

    if not isinstance(scenario.motion, TrackMotion) or scenario.reference.kind != "file":
        allowed = Text('must be a recorded log ("file") beside a recorded track ("track")')
        raise InputError(Fault("", "reference.kind", scenario.reference.kind, allowed))
    log = log_along_track(scenario.reference, scenario.motion)
    delay_s = fit_delay(log)
    return fit_log_error(*log.error(delay_s), delay_s=delay_s)


def with_fitted_log(scenario: Scenario, fit: LogErrorFit) -> Scenario:
    """Replace the recorded log by a simulated one with the fitted error; events and outages stay."""
    reference = fit.reference().model_copy(
        update={"event": scenario.reference.event, "outage": scenario.reference.outage}
    )
    return Scenario.parse(scenario.canonical() | {"reference": reference.model_dump(mode="json")})


def fit_lines(fit: LogErrorFit) -> list[str]:
    """Say what the fit found, a line each."""
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
    ]
