"""The reference velocity (log): its settings, and its errors at its own epochs."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from navcore.foundation.parameters import FileName, Parameters, bounded, quantity, vector_quantity
from navcore.foundation.units import HOUR
from navcore.motion.base import Truth
from navcore.sensors.base import ReferenceErrors

_Speed = Annotated[float, bounded(unit="m/s", ge=-50.0, le=50.0)]
_Acceleration = Annotated[float, bounded(unit="m/s2", ge=-50.0, le=50.0)]


class LogEvent(Parameters):
    """Passing disturbance of the log: an acceleration integrated into dV_r, which stays after the event."""

    t_h: float = quantity(
        0.0, unit="h", ge=0.0, le=10000.0, slider=(0.0, 72.0), label="begins", help="Time of the event."
    )
    duration_s: float = quantity(
        60.0,
        unit="s",
        gt=0.0,
        le=1e7,
        slider=(1.0, 7200.0),
        log=True,
        label="lasts",
        help="Length of the event.",
    )
    accel_mps2: tuple[_Acceleration, _Acceleration] = vector_quantity(
        (0.0, 0.0),
        unit="m/s2",
        elements=("E", "N"),
        slider=(-0.1, 0.1),
        label="acceleration of δVr",
        help="East, north (Liu 2021, fig. 4). Its integral stays after the event; events add up.",
    )
    sine_hz: float = quantity(
        0.0,
        unit="Hz",
        ge=0.0,
        le=10.0,
        slider=(0.0, 0.1),
        label="frequency",
        help="0: constant acceleration; else the acceleration is a sin(2π f (t - t_h)).",
    )


class Outage(Parameters):
    """Time in which the log gives nothing."""

    t_h: float = quantity(
        0.0, unit="h", ge=0.0, le=10000.0, slider=(0.0, 72.0), label="begins", help="Time of the outage."
    )
    duration_s: float = quantity(
        600.0,
        unit="s",
        gt=0.0,
        le=1e7,
        slider=(1.0, 36000.0),
        log=True,
        label="lasts",
        help="Length of the outage.",
    )


class Reference(Parameters):
    """Block ``reference``: the velocity that external damping compares with.

    The simulated log (``kind = "log"``) reads, in its own axes,
    ``(1 + scale) (V - V_water) + bias + drift + noise``, rounded to ``lsb_mps``, with V and the velocity of
    the water ``V_water`` (current and tide) taken ``delay_s`` earlier; events are added to that. The recorded
    one (``kind = "file"``) uses only ``file``, ``speed``, ``frame``, ``event`` and ``outage``.
    """

    kind: Literal["none", "log", "file"] = Field(
        default="none",
        description="none: no reference; log: simulated; file: recorded.",
        json_schema_extra={"label": "reference"},
    )
    frame: Literal["enu", "body"] = Field(
        default="enu",
        description="enu: the log gives east and north. body: it gives starboard and forward (and so bias, "
        "drift, noise and resolution count) and is turned by the computed heading: a heading error enters.",
        json_schema_extra={"label": "frame"},
    )
    bias_mps: tuple[_Speed, _Speed] = vector_quantity(
        (0.0, 0.0),
        unit="m/s",
        elements=("E / starboard", "N / forward"),
        slider=(-2.0, 2.0),
        label="bias",
        help="Constant error: east, north; with frame = body starboard, forward.",
    )
    bias_std_mps: float | None = quantity(
        None,
        unit="m/s",
        ge=0.0,
        le=50.0,
        slider=(0.0, 2.0),
        label="bias, standard deviation",
        help="Standard deviation of the bias on each axis, in the error budget and the tuning. Not given: "
        "the size of each bias_mps.",
    )
    noise_mps: float = quantity(
        0.0,
        unit="m/s",
        ge=0.0,
        le=50.0,
        slider=(0.0, 1.0),
        label="noise",
        help="Standard deviation of one sample, on each axis. At rates above one sample a step the samples "
        "of a step are averaged.",
    )
    rate_hz: float = quantity(
        1.0,
        unit="Hz",
        ge=0.001,
        le=1000.0,
        slider=(0.1, 10.0),
        log=True,
        label="rate",
        help="Samples a second.",
    )
    drift_mps: float = quantity(
        0.0,
        unit="m/s",
        ge=0.0,
        le=50.0,
        slider=(0.0, 1.0),
        label="drift",
        help="Standard deviation of a slow error, on each axis (first-order Gauss-Markov).",
    )
    drift_tau_s: float = quantity(
        600.0,
        unit="s",
        gt=0.0,
        le=1e7,
        slider=(10.0, 36000.0),
        log=True,
        label="drift time",
        help="Correlation time of the drift.",
    )
    scale_ppm: float = quantity(
        0.0,
        unit="ppm",
        ge=-500000.0,
        le=500000.0,
        slider=(-20000.0, 20000.0),
        label="scale error",
        help="Relative error of the measured velocity.",
    )
    delay_s: float = quantity(
        0.0,
        unit="s",
        ge=0.0,
        le=3600.0,
        slider=(0.0, 60.0),
        label="delay",
        help="The sample at t is the velocity at t - delay (before t = 0: that at t = 0).",
    )
    lsb_mps: float = quantity(
        0.0,
        unit="m/s",
        ge=0.0,
        le=10.0,
        slider=(0.0, 0.2),
        label="resolution",
        help="Readings are rounded to this.",
    )
    current_mps: tuple[_Speed, _Speed] = vector_quantity(
        (0.0, 0.0),
        unit="m/s",
        elements=("E", "N"),
        slider=(-2.0, 2.0),
        label="current",
        help="Velocity of the water over the ground, east, north; the log misses it: δVr = -current.",
    )
    tide_mps: tuple[_Speed, _Speed] = vector_quantity(
        (0.0, 0.0),
        unit="m/s",
        elements=("E", "N"),
        slider=(-2.0, 2.0),
        label="tide",
        help="Amplitude of the tidal stream, east, north: tide sin(2π t / period + phase) is added.",
    )
    tide_period_h: float = quantity(
        12.42,
        unit="h",
        ge=0.01,
        le=10000.0,
        slider=(1.0, 48.0),
        label="tide period",
        help="12.42 h: the principal lunar tide.",
    )
    tide_phase_deg: float = quantity(
        0.0,
        unit="deg",
        ge=-360.0,
        le=360.0,
        slider=(-180.0, 180.0),
        label="tide phase",
        help="Phase at t = 0.",
    )
    event: tuple[LogEvent, ...] = Field(
        default=(), max_length=200, description="Disturbances of the log, [[reference.event]]."
    )
    outage: tuple[Outage, ...] = Field(
        default=(), max_length=200, description="Times without log, [[reference.outage]]."
    )
    file: FileName | tuple[FileName, ...] | None = Field(
        default=None,
        description="Recorded log: NMEA 0183 (VBW, VHW, VTG, RMC), CSV, Parquet or MAT; several files are "
        "joined by UTC. Speeds along the ship's axes are preferred to course and speed over ground.",
        json_schema_extra={"label": "log files"},
    )
    speed: Literal["water", "ground"] = Field(
        default="water",
        description="Which speed of a recorded VBW sentence is used; the other one when the log lacks this.",
        json_schema_extra={"label": "speed"},
    )


def event_velocity(events: Iterable[LogEvent], time_s: np.ndarray) -> np.ndarray:
    """Velocity error that events have left behind at each time.

    Constant acceleration a: a tau; with a frequency f: a (1 - cos 2 pi f tau) / (2 pi f), where tau is the
    time since the beginning of the event, at most its duration (Liu 2021, fig. 4; contract "Events").

    Parameters
    ----------
    events : iterable of LogEvent
        They add up.
    time_s : ndarray, shape (m,)
        Times after the start of navigation.

    Returns
    -------
    ndarray, shape (m, 2)
        dV_r, E and N, m/s.
    """
    total = np.zeros((time_s.size, 2))
    for event in events:
        elapsed = np.clip(time_s - event.t_h * HOUR, 0.0, event.duration_s)
        if event.sine_hz > 0.0:
            angular = 2.0 * np.pi * event.sine_hz
            elapsed = (1.0 - np.cos(angular * elapsed)) / angular
        for axis, acceleration in enumerate(event.accel_mps2):  # by axis: many times faster than rows of two
            if acceleration != 0.0:
                total[:, axis] += elapsed * acceleration
    return total


def in_service(outages: Iterable[Outage], time_s: np.ndarray) -> np.ndarray:
    """Whether the log works at each time, ndarray of bool, shape (m,)."""
    valid = np.ones(time_s.size, dtype=bool)
    for outage in outages:
        begin = outage.t_h * HOUR
        valid &= (time_s < begin) | (time_s >= begin + outage.duration_s)
    return valid


def reference_errors(
    reference: Reference,
    truth: Truth,
    duration_s: float,
    seed: int,
    *,
    step_s: float | None = None,
    start_utc: float | None = None,
) -> ReferenceErrors:
    """Errors of the reference velocity at its epochs.

    Parameters
    ----------
    reference : Reference
        Settings; ``kind = "none"`` gives no epochs at all.
    truth : Truth
        True motion on a grid over the run (cubic interpolation between its points).
    duration_s : float
        Length of the run; epochs are 0, 1/rate, ... up to it.
    seed : int
        Seed of the run.
    step_s : float, optional
        Step of the mechanization, within which faster samples are averaged; default: two grid steps of the
        truth.
    start_utc : float, optional
        UTC of t = 0 that a recorded log shares with a recorded track; default: the first epoch of the log.

    Raises
    ------
    InputError
        The recorded log is missing, wrong or shorter than the run (field names relative to the block).
    """
    if reference.kind == "none":
        return ReferenceErrors(np.zeros(0), np.zeros((0, 2)), np.zeros(0, dtype=bool), False, 0.0)
    if reference.kind == "file":
        from navcore.sensors.recorded import recorded_errors

        return recorded_errors(reference, truth, duration_s, start_utc=start_utc)
    from navcore.sensors.simulated_log import simulated_errors

    return simulated_errors(
        reference, truth, duration_s, seed, 2.0 * truth.step_s if step_s is None else step_s
    )
