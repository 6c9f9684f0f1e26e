"""A recorded IMU in a scenario: its alignment, the truth it is compared with, and its samples from t = 0 on.

The record runs without a break: ``imu.begin_s`` left out, then the alignment, then navigation. The vehicle
rests (`static`: at the place that the record gives, else the site) or follows a recorded track.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from navcore.alignment.fine import coarse_alignment, fine_alignment
from navcore.foundation import guarded
from navcore.foundation.compiled import plain
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.stage_cache import kept, recorded_state
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR
from navcore.io.column_map import map_beside, read_map
from navcore.mechanization.strapdown import Start, start_from
from navcore.mechanization.strapdown.attitude import angles_of
from navcore.mechanization.strapdown.run import turned_by
from navcore.motion.truth import HEADING, HEIGHT, LAT, PITCH, ROLL, Site, Truth
from navcore.scenario.model import Scenario
from navcore.scenario.sampling import Sampling, sampling
from navcore.sensors.imu import RECORDING, Imu
from navcore.sensors.recorded_imu import ImuRecord, check_rest, read_imu

CHUNK = 6000
"""Samples of a chunk."""
_COARSE_S = 120.0
"""Length of the coarse alignment where none is given."""
_REST_S = 60.0
"""Time from the start in which the force is held against gravity when there is no alignment."""
_SAME_PLACE_DEG = 0.001


@dataclass(frozen=True)
class RecordedImu:
    """The recorded samples of a run and where it starts.

    Attributes
    ----------
    record : ImuRecord
        The whole record.
    first : int
        Number of the first sample after t = 0.
    sampling : Sampling
        Rates and length.
    truth : Truth
        What the run is compared with.
    start : Start
        Navigation state at t = 0.
    warnings : tuple of str
        Warnings about the record and the start.
    """

    record: ImuRecord
    first: int
    sampling: Sampling
    truth: Truth
    start: Start
    warnings: tuple[str, ...]

    def before(self) -> np.ndarray:
        """Increment of the interval that ends at t = 0, shape (6,)."""
        return self.record.increments[max(self.first - 1, 0)]

    def chunks(self, with_sums: bool = False) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Increments from t = 0 on; nobody knows their errors, so there are no sums."""
        samples = self.record.increments[self.first : self.first + self.sampling.samples]
        for begin in range(0, len(samples), CHUNK):
            yield samples[begin : begin + CHUNK], np.empty((0, 6))


def recorded_imu(scenario: Scenario, start_utc: float | None = None) -> RecordedImu:
    """Read a scenario's recorded IMU, check it and align with it.

    Parameters
    ----------
    scenario : Scenario
        With ``imu.file``.
    start_utc : float, optional
        UTC of t = 0 of a recorded track.

    Raises
    ------
    InputError
        Unreadable, gaps, wrong axes, shorter than skipped part, alignment and run together.
    """
    imu, aligned = scenario.imu, scenario.alignment.kind == "compass"
    map_file = imu.map or map_beside(imu.file or "")
    column_map = read_map(map_file, "imu.map") if map_file else None
    record: ImuRecord = kept(
        (Text("imu record"), recorded_state(imu), imu.axes),
        lambda: guarded.call("imu.file", read_imu, imu.file or "", imu.axes, column_map),
    )
    rates = sampling(scenario.run, scenario.reference, record.rate_hz)
    begin = round(imu.begin_s * record.rate_hz)
    first = begin + (round(scenario.alignment.duration_s * record.rate_hz) if aligned else 0)
    _require_cover(scenario, record, rates, first)
    site = _place(scenario, record)
    until = first if aligned else begin + round(_REST_S * record.rate_hz)
    window_s = begin / record.rate_hz, min(until, len(record.increments)) / record.rate_hz
    check_rest(record, scenario.earth.gravity(site.lat, site.height), *window_s)
    truth = _truth(scenario, rates, site, start_utc)
    quaternion = _align(scenario, record, begin, first, truth) if aligned else None
    if quaternion is not None and not scenario.motion.recorded:
        values = truth.values.copy()
        q0, q1, q2, q3 = quaternion
        values[0, [PITCH, ROLL, HEADING]] = plain(angles_of)(q0, q1, q2, q3)
        truth = Truth(truth.step_s, values)
    errors = np.array(scenario.initial_error.state())
    if quaternion is not None:
        errors[[0, 1, 4, 5, 6]] = 0.0
    start = start_from(truth.values[0], errors)
    if quaternion is not None:
        start = Start(start.lat, start.lon, start.height, start.velocity, quaternion)
    return RecordedImu(record, first, rates, truth, start, tuple(_notices(scenario, record, site)))


def _require_cover(scenario: Scenario, record: ImuRecord, rates: Sampling, first: int) -> None:
    left_s = (len(record.increments) - first) / record.rate_hz
    if rates.records < 1:
        raise InputError(
            Fault(
                "",
                "run.duration_h",
                scenario.run.duration_h,
                Text("must hold at least one step of {record_step_s:g} s", record_step_s=rates.record_step_s),
            )
        )
    if rates.duration_s <= left_s + 1e-9:
        return
    spent = first / record.rate_hz
    raise InputError(
        Fault(
            "",
            "run.duration_h",
            scenario.run.duration_h,
            Text(
                "is longer than the recorded IMU: of its {duration_s:.6g} s, {spent:.6g} s "
                "are left out or used for the alignment, so that {left_s:.4g} h remain",
                duration_s=record.duration_s,
                spent=spent,
                left_s=max(left_s, 0.0) / HOUR,
            ),
        )
    )


def _place(scenario: Scenario, record: ImuRecord) -> Site:
    if record.lat is None or record.lon is None or record.height is None:
        return scenario.site.site()
    return Site(record.lat, record.lon, record.height)


def _truth(scenario: Scenario, rates: Sampling, site: Site, start_utc: float | None) -> Truth:
    grid = rates.records + 1, rates.record_step_s
    try:
        return scenario.motion.truth(*grid, site, scenario.earth, start_utc)
    except InputError as error:
        raise error.located("", "motion.") from None


def _align(scenario: Scenario, record: ImuRecord, begin: int, first: int, truth: Truth) -> np.ndarray:
    """Attitude at t = 0 by coarse, then fine alignment."""
    window, rate = record.increments[begin:first], record.rate_hz
    errors = scenario.initial_error.state()
    lat, height = float(truth.values[0, LAT]) + errors[2], float(truth.values[0, HEIGHT])
    coarse = min(round((scenario.alignment.coarse_s or _COARSE_S) * rate), len(window) // 2)
    attitude = coarse_alignment(window[:coarse], rate, lat)
    # A parked vehicle's coarse attitude serves again at the beginning: the loop gets the whole window.
    rest = window if not scenario.motion.recorded else window[coarse:]
    start = turned_by(-np.array(errors[4:7]), attitude)
    velocity = np.array(errors[:2])
    aligned = fine_alignment(
        rest, rate, start, lat, height, scenario.earth, scenario.alignment.loop(), velocity
    )
    return aligned.quaternion


def _notices(scenario: Scenario, record: ImuRecord, site: Site) -> Iterator[str]:
    yield from record.warnings
    if not scenario.motion.recorded:
        yield from _parked_notices(scenario, record, site)
    unused = [
        f"imu.{name}"
        for name, info in Imu.model_fields.items()
        if name not in RECORDING and getattr(scenario.imu, name) != info.default
    ]
    if unused:
        yield Text("{unused} not used: the recorded IMU brings its own errors", unused=", ".join(unused))


def _parked_notices(scenario: Scenario, record: ImuRecord, site: Site) -> Iterator[str]:
    given = scenario.site
    if max(abs(site.lat / DEG - given.lat_deg), abs(site.lon / DEG - given.lon_deg)) > _SAME_PLACE_DEG:
        yield (
            Text(
                "{source} gives its place, {lat:.4f}, {lon:.4f}°: used for the site's in all "
                "but ωₛ, and with it the networks",
                source=record.source,
                lat=site.lat / DEG,
                lon=site.lon / DEG,
            )
        )
    if scenario.alignment.kind == "compass":
        yield (
            Text(
                "the true attitude of a recorded IMU is not known: that of the alignment's end "
                "stands for it, "
                "φ tells what has changed since"
            )
        )
    else:
        yield Text(
            "the attitude of the recorded IMU is taken from motion.pitch_deg, roll_deg and heading_deg"
        )
