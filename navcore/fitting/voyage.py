"""A voyage like a recorded one: legs in the place of the track, a log that errs as fitted, a chosen IMU."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from navcore.fitting.course import fit_legs
from navcore.fitting.recorded import FittedLog, fit_recorded
from navcore.foundation.answers import Answer, Column, Table
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR
from navcore.motion.legs import LegsMotion
from navcore.motion.track import TrackMotion
from navcore.motion.truth import LAT, LON, VE, VN
from navcore.scenario.file import to_toml
from navcore.scenario.model import Scenario
from navcore.sensors.recorded import recorded_window

_STEP_S = 10.0
_MOST_ROWS = 20_000
_SHORTEST_S = 600.0
_KEPT = ("title", "run", "requirement", "imu", "initial_error", "gravity")


@dataclass(frozen=True, eq=False)
class Voyage(Answer):
    """A scenario like a recorded voyage.

    Attributes
    ----------
    scenario : Scenario
        With simulated sensors; nothing of it is read from a recording.
    legs : int
        In the place of the track.
    velocity_rms_mps : float
        Of the difference of legs and track, m/s.
    position_max_m, end_m : float
        Largest distance of both, and that of their ends, m.
    log : FittedLog or None
        Error of the log; None where none was recorded.
    span_s : float
        Length of the recorded voyage, s.
    """

    scenario: Scenario
    legs: int
    velocity_rms_mps: float
    position_max_m: float
    end_m: float
    log: FittedLog | None
    span_s: float

    @property
    def text(self) -> str:
        """The scenario as TOML."""
        return to_toml(self.scenario)

    def document(self) -> dict[str, Any]:
        """Return what ``--json`` prints."""
        found: dict[str, Any] = {
            "legs": self.legs,
            "velocity_rms_mps": self.velocity_rms_mps,
            "position_max_m": self.position_max_m,
            "end_m": self.end_m,
            "recorded_h": self.span_s / HOUR,
            "duration_h": self.scenario.run.duration_h,
        }
        return found | ({} if self.log is None else self.log.document())

    def rows(self) -> Iterator[Table | str]:
        """Give how the voyage follows the recorded one, and its log."""
        yield Text(
            "{legs} legs in the place of a track of {recorded:.3g} h; the voyage lasts {hours:.3g} h",
            legs=self.legs,
            recorded=self.span_s / HOUR,
            hours=self.scenario.run.duration_h,
        )
        rows = (
            (Text("velocity of legs minus track, RMS"), self.velocity_rms_mps, "m/s"),
            (Text("legs from track, largest"), self.position_max_m, "m"),
            (Text("legs from track, at the end"), self.end_m, "m"),
        )
        yield Table((Column(""), Column(Text("value")), Column(Text("unit"), left=True)), rows)
        if self.log is None:
            yield Text("No log was recorded: that of the scenario stays.")
        else:
            yield from self.log.rows()

    def plays(self) -> tuple[str, ...]:
        """Name the voyage."""
        return (Text("a voyage like it"),)

    def played(self, place: int) -> dict[str, str]:
        """Return the scenario."""
        del place
        return {"voyage.toml": self.text}


def track_of(scenario: Scenario) -> TrackMotion:
    """Recorded track of a scenario: that of its motion, or of the reference or the INS of ``[ins]``.

    Raises
    ------
    InputError
        Nothing is recorded.
    """
    if scenario.on_ins:
        ins, truth = scenario.ins, scenario.truth
        files = [*_names(truth.file), *_names(ins.file)]
        return TrackMotion(file=tuple(files), map=truth.map or ins.map)
    if isinstance(scenario.motion, TrackMotion):
        return scenario.motion
    allowed = Text('must be a recorded track ("track"), or [ins] in its place')
    raise InputError(Fault("", "motion.kind", scenario.motion.kind, allowed))


def _names(file: Any) -> tuple[str, ...]:
    return () if file is None else (file,) if isinstance(file, str) else tuple(file)


def voyage_like(
    scenario: Scenario, hours: float | None = None, within_mps: float = 0.3, imu: str = ""
) -> Voyage:
    """Make a voyage like a recorded one.

    Parameters
    ----------
    scenario : Scenario
        On a recorded track and log, or on ``[ins]``; its methods, limits and initial errors stay.
    hours : float, optional
        Length; the legs are sailed again and again. Default: that of the recording.
    within_mps : float
        See `navcore.fitting.course.fit_legs`.
    imu : str
        Part of the list (``schuler parts``) that rides along; default: the scenario's IMU.

    Raises
    ------
    InputError
        Nothing is recorded, or too little.
    """
    motion = track_of(scenario)
    reference = scenario.reference
    window = recorded_window(motion, reference)
    assert window is not None
    if window.span_s < _SHORTEST_S:
        allowed = Text(
            "holds {span:.0f} s; at least {least:.0f} s are needed", span=window.span_s, least=_SHORTEST_S
        )
        raise InputError(Fault("", "motion.file", None, allowed))
    step_s = max(_STEP_S, window.span_s / _MOST_ROWS)
    count = int(window.span_s / step_s) + 1
    truth = motion.truth(count, step_s, scenario.site.site(), scenario.earth, window.start_s).values
    fitted = fit_legs(np.arange(count) * step_s, truth[:, [VE, VN]], within_mps)
    log = fit_recorded(motion, reference) if reference.kind == "file" else None
    span_s = sum(leg.duration_s for leg in fitted)
    length_s = span_s if hours is None else hours * HOUR
    given = scenario.canonical()
    data: dict[str, Any] = {name: given[name] for name in _KEPT if name in given}
    if scenario.on_ins:  # which knows nothing of the sensors
        data.pop("imu", None)
        data.pop("initial_error", None)
    data["source"] = Text("a voyage like {source}", source=scenario.source or scenario.title)[:300]
    data["run"] = data.get("run", {}) | {"duration_h": length_s / HOUR}
    lat_deg, lon_deg = (float(truth[0, column]) / DEG for column in (LAT, LON))
    data["site"] = {"lat_deg": round(lat_deg, 6), "lon_deg": round((lon_deg + 180.0) % 360.0 - 180.0, 6)}
    legs = [leg.model_dump(exclude_none=True) for leg in fitted]
    rounds = max(int(-(-length_s // span_s)), 1)
    data["motion"] = {"kind": "legs", "leg": legs} | ({"repeat": rounds} if rounds > 1 else {})
    data["reference"] = given["reference"] if log is None else log.blocks()["reference"]
    if imu:
        data["imu"] = {"part": imu}
    data["method"] = given["method"]
    made = Scenario.parse(data)
    assert isinstance(made.motion, LegsMotion)
    sailed = made.motion.truth(count, step_s, made.site.site(), made.earth).values
    meridian, prime_vertical = made.earth.radii(float(truth[-1, LAT]))
    off = sailed - truth
    apart = np.hypot(off[:, LAT] * meridian, off[:, LON] * prime_vertical * np.cos(truth[:, LAT]))
    rms = float(np.sqrt(np.mean(np.sum(off[:, [VE, VN]] ** 2, axis=1))))
    return Voyage(made, len(fitted), rms, float(apart.max()), float(apart[-1]), log, window.span_s)
