"""Passing disturbances of the log."""

from collections.abc import Iterable, Iterator
from functools import partial
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from navcore.foundation.parameters import bounded, quantity, vector_quantity
from navcore.foundation.repeated import Repeated
from navcore.foundation.text import Text
from navcore.sensors.log_errors.base import LogPart, LogTerm

_Acceleration = Annotated[float, bounded(unit="m/s2", ge=-50.0, le=50.0)]


class LogEvent(Repeated):
    """Passing disturbance of the log: an acceleration integrated into dV_r, which stays after the event."""

    duration_s: float = quantity(
        60.0,
        unit="s",
        gt=0.0,
        le=1e7,
        slider=(1.0, 7200.0),
        log=True,
        label=Text("lasts"),
        help=Text("Length of the event."),
    )
    accel_mps2: tuple[_Acceleration, _Acceleration] = vector_quantity(
        (0.0, 0.0),
        unit="m/s2",
        elements=("E", "N"),
        slider=(-0.1, 0.1),
        label=Text("acceleration of δVr"),
        help=Text(
            "East, north (Liu 2021, fig. 4). Its integral stays after the event; events add up, and so do "
            "the repetitions of one."
        ),
    )
    sine_hz: float = quantity(
        0.0,
        unit="Hz",
        ge=0.0,
        le=10.0,
        slider=(0.0, 0.1),
        label=Text("frequency"),
        help=Text("0: constant acceleration; else the acceleration is a sin(2π f (t - t_h))."),
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
        since, before = event.since(time_s)
        elapsed = _integral(event, np.clip(since, 0.0, event.duration_s))
        if event.repeat > 1:
            elapsed = elapsed + before * _integral(event, event.duration_s)
        for axis, acceleration in enumerate(event.accel_mps2):  # by axis: many times faster than rows of two
            if acceleration != 0.0:
                total[:, axis] += elapsed * acceleration
    return total


def _integral(event: LogEvent, elapsed: Any) -> Any:
    """Integral over ``elapsed`` s of an event's acceleration as a part of its size, s."""
    if event.sine_hz > 0.0:
        angular = 2.0 * np.pi * event.sine_hz
        return (1.0 - np.cos(angular * elapsed)) / angular
    return elapsed


class LogEvents(LogTerm):
    """Events of the log."""

    event: tuple[LogEvent, ...] = Field(
        default=(), max_length=200, description=Text("Disturbances of the log, [[reference.event]].")
    )

    def parts(self) -> Iterator[LogPart]:
        """Yield all events as one part."""
        after = partial(event_velocity, self.event) if self.event else None
        yield LogPart(("event",), "log_events", Text("log events"), after=after)
