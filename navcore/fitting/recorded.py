"""The error of a scenario's recorded log against its recorded track, and the scenario that has it."""

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.fitting.along_track import LogAlongTrack, log_along_track
from navcore.fitting.drift import Estimate
from navcore.fitting.log import LogErrorFit, Tide, fit_log
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.stage_cache import kept, recorded_state
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR, PPM
from navcore.motion.track import TrackMotion
from navcore.scenario.model import Scenario
from navcore.sensors.log_files import log_recording
from navcore.sensors.reference import Reference

_LARGEST_SCALE = 0.3
_SPEEDS = {"water": Text("the speed through the water"), "ground": Text("the speed over ground")}


@dataclass(frozen=True, eq=False)
class FittedLog(Answer):
    """A fit and what it was made from.

    Attributes
    ----------
    fit : LogErrorFit
        Of the speed that the scenario uses.
    log : LogAlongTrack
        That speed beside the track.
    speed : str
        Which it is: "water" or "ground".
    other : LogErrorFit or None
        Of the other speed, where the log gives both.
    """

    fit: LogErrorFit
    log: LogAlongTrack
    speed: str
    other: LogErrorFit | None = None

    @property
    def other_speed(self) -> str:
        """The speed that the scenario does not use."""
        return "ground" if self.speed == "water" else "water"

    def document(self) -> dict[str, Any]:
        """Return the document of interface.md."""
        fit = self.fit
        found: dict[str, Any] = {
            "bias_mps": [_document(one) for one in fit.bias],
            "noise_mps": _document(fit.noise),
            "drift_mps": _document(fit.drift),
            "drift_tau_s": _document(fit.drift_tau_s),
            "scale_ppm": _document(fit.scale, PPM),
            "delay_s": _document(fit.delay_s),
            "current_mps": None if fit.current is None else [_document(one) for one in fit.current],
            "tide": [
                {
                    "period_h": tide.period_s / HOUR,
                    "sine_mps": [_document(one) for one in tide.sine],
                    "cosine_mps": [_document(one) for one in tide.cosine],
                }
                for tide in fit.tides
            ],
        }
        return {"log": found, "speed": self.speed, "rate_hz": fit.rate_hz, "span_s": fit.span_s}

    def rows(self) -> Iterator[Table | str]:
        """Give the values with their intervals, and what the other speed would give."""
        fit = self.fit
        yield Text(
            "error of {speed} along the ship's axes, over {span_s:.0f} s at {rate_hz:.3g} Hz; 95 % intervals",
            speed=_SPEEDS[self.speed],
            span_s=fit.span_s,
            rate_hz=fit.rate_hz,
        )
        yield Table(
            (
                Column(""),
                Column(Text("value")),
                Column(Text("from")),
                Column(Text("to")),
                Column(Text("unit"), left=True),
            ),
            self._cells(),
        )
        yield from self._notes()

    def _cells(self) -> tuple[tuple[str | float | None, ...], ...]:
        fit = self.fit
        starboard, forward = fit.bias
        rows: list[tuple[str, Estimate | None, float, str]] = [
            (Text("delay"), fit.delay_s, 1.0, "s"),
            (Text("bias to starboard"), starboard, 1.0, "m/s"),
            (Text("bias forward"), forward, 1.0, "m/s"),
            (Text("scale error"), fit.scale, PPM, "ppm"),
            (Text("noise of a sample"), fit.noise, 1.0, "m/s"),
            (Text("drift"), fit.drift, 1.0, "m/s"),
            (Text("drift time"), fit.drift_tau_s, 1.0, "s"),
        ]
        if fit.current is not None:
            rows += [
                (Text("current to the east"), fit.current[0], 1.0, "m/s"),
                (Text("current to the north"), fit.current[1], 1.0, "m/s"),
            ]
        for tide in fit.tides:
            hours = f"{tide.period_s / HOUR:.2f} h"
            for axis, word in enumerate((Text("east"), Text("north"))):
                told = Text("tide {hours}, {axis}, sine", hours=hours, axis=word)
                rows.append((told, tide.sine[axis], 1.0, "m/s"))
                told = Text("tide {hours}, {axis}, cosine", hours=hours, axis=word)
                rows.append((told, tide.cosine[axis], 1.0, "m/s"))
        return tuple(
            (name, *(3 * [None] if one is None else [value / size for value in one]), unit)
            for name, one, size, unit in rows
        )

    def _notes(self) -> Iterator[str]:
        fit = self.fit
        if fit.delay_s is None:
            yield Text("The delay cannot be told: the ship moves too evenly.")
        elif fit.delay_s.high < 0.0:
            yield Text(
                "The log is early: its clock is off. reference.clock_s = {value:.1f} corrects it.",
                value=-fit.delay_s.value,
            )
        if fit.one_axis:
            yield Text(
                "The log measures the speed forward alone: nothing is known of its error to starboard."
            )
        if self.speed == "water" and fit.current is None:
            yield Text("The ship keeps its heading: a current cannot be told from a bias, which includes it.")
        if fit.drift.value == 0.0:
            yield Text("No drift can be told from the white noise.")
        if self.other is not None:
            yield Text(
                'The log gives {other} too: its drift is {drift:.3f} m/s; choose it by speed = "{speed}".',
                other=_SPEEDS[self.other_speed],
                drift=self.other.drift.value,
                speed=self.other_speed,
            )

    def blocks(self) -> dict[str, Any]:
        """Return the block ``reference`` of a scenario whose simulated log errs so."""
        fields = reference_of(self.fit).model_dump(mode="json")
        defaults = Reference().model_dump(mode="json")
        given = {name: value for name, value in fields.items() if value != defaults[name]}
        return {"reference": given | {"rate_hz": fields["rate_hz"]}}


def can_fit(scenario: Scenario) -> bool:
    """Whether a scenario has both a recorded log and the track recorded with it; that of an INS errs too."""
    recorded = scenario.reference.kind == "file" and isinstance(scenario.motion, TrackMotion)
    return recorded and not scenario.on_ins


def fit_of(scenario: Scenario) -> FittedLog:
    """Fit the error of the recorded log, of both its speeds where it has them.

    Raises
    ------
    InputError
        A recording is missing, or the record is too short for a fit.
    """
    motion, reference = scenario.motion, scenario.reference
    if not isinstance(motion, TrackMotion) or reference.kind != "file":
        allowed = Text('must be a recorded log ("file") beside a recorded track ("track")')
        raise InputError(Fault("", "reference.kind", reference.kind, allowed))
    return fit_recorded(motion, reference)


def fit_recorded(motion: TrackMotion, reference: Reference) -> FittedLog:
    """Fit the error of a recorded log beside its track; raises `InputError` as `fit_of`."""
    key = (
        "fitted log",
        recorded_state(motion),
        recorded_state(reference),
        motion.smoothing_s,
        motion.heading_clock_s,
        reference.speed,
        reference.clock_s,
        reference.factor,
    )
    return kept(key, lambda: _fitted(motion, reference))


def _fitted(motion: TrackMotion, reference: Reference) -> FittedLog:
    recording = log_recording(reference)
    there = {name for name in ("water", "ground") if getattr(recording, name) is not None}
    speed = reference.speed if reference.speed in there else next(iter(there), reference.speed)
    fits: dict[str, LogErrorFit] = {}
    logs: dict[str, LogAlongTrack] = {}
    for name in sorted(there - {speed}):
        with suppress(InputError):
            other = log_along_track(reference.model_copy(update={"speed": name}), motion)
            fits[name] = fit_log(other, through_water=name == "water")
    logs[speed] = log_along_track(reference, motion)
    fits[speed] = fit_log(logs[speed], through_water=speed == "water")
    return FittedLog(
        fits[speed], logs[speed], speed, next((fits[name] for name in fits if name != speed), None)
    )


def reference_of(fit: LogErrorFit) -> Reference:
    """Simulated log with the fitted error.

    The deviation of its bias holds the fitted value and what the fit leaves open: by it a budget and the
    shares of a design count both. Of the tides the first one is taken, along the axis in which it is largest,
    for a scenario's tide has one phase.
    """
    given: dict[str, Any] = {
        "kind": "log",
        "frame": "body",
        "bias_mps": tuple(_rounded(one.value) for one in fit.bias),
        "bias_std_mps": _bias_deviation(fit),
        "noise_mps": _rounded(fit.noise.value),
        "drift_mps": _rounded(fit.drift.value),
        "drift_tau_s": _rounded(fit.drift_tau_s.value),
        "delay_s": _rounded(max(fit.late_s, 0.0)),
        "rate_hz": _rounded(fit.rate_hz),
    }
    if fit.scale is not None and abs(fit.scale.value) > _LARGEST_SCALE:
        allowed = Text(
            "gives {scale:+.0%} of the changes of speed that the track has: that is no scale error of a log",
            scale=1.0 + fit.scale.value,
        )
        raise InputError(Fault("", "reference.file", None, allowed))
    if fit.scale is not None:
        given["scale_ppm"] = _rounded(fit.scale.value / PPM)
    if fit.current is not None:
        given["current_mps"] = tuple(_rounded(one.value) for one in fit.current)
    if fit.tides:
        given |= _tide(fit.tides[0])
    return Reference(**given)


def _bias_deviation(fit: LogErrorFit) -> float:
    known = [one for one in fit.bias if np.isfinite(one.deviation)]
    return _rounded(float(np.sqrt(np.mean([one.value**2 + one.deviation**2 for one in known]))))


def _tide(tide: Tide) -> dict[str, Any]:
    """Fields of the straight stream that is nearest to a tide, by its singular value decomposition."""
    waves = np.array([[one.value for one in tide.sine], [one.value for one in tide.cosine]])
    turned, sizes, along = np.linalg.svd(waves)
    return {
        "tide_mps": tuple(_rounded(float(value)) for value in sizes[0] * along[0]),
        "tide_period_h": _rounded(tide.period_s / HOUR),
        "tide_phase_deg": _rounded(float(np.arctan2(turned[1, 0], turned[0, 0])) / DEG),
    }


def with_fitted_log(scenario: Scenario, fit: LogErrorFit) -> Scenario:
    """Replace the recorded log by a simulated one with the fitted error; events and outages stay."""
    reference = reference_of(fit).model_copy(
        update={"event": scenario.reference.event, "outage": scenario.reference.outage}
    )
    return Scenario.parse(scenario.canonical() | {"reference": reference.model_dump(mode="json")})


def _document(one: Estimate | None, size: float = 1.0) -> dict[str, float | None]:
    if one is None:
        return {"value": None, "low": None, "high": None}
    ends = {name: value if np.isfinite(value) else None for name, value in one.document(size).items()}
    return ends | {"value": _rounded(one.value / size)}


def _rounded(value: float) -> float:
    """Six significant digits: the same number in the document, in the block and in the scenario."""
    return float(f"{value:.6g}")
