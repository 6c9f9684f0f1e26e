"""Motion of the water, which the log does not see: current and tide."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial
from typing import Annotated

import numpy as np
from pydantic import Field

from navcore.foundation.parameters import bounded, quantity, vector_quantity
from navcore.foundation.repeated import Repeated
from navcore.foundation.text import Text
from navcore.foundation.units import DEG, HOUR
from navcore.sensors.log_errors.base import LogPart, LogTerm

_Speed = Annotated[float, bounded(unit="m/s", ge=-50.0, le=50.0)]


class Current(Repeated):
    """Current that the ship passes through: on one leg of its course, say."""

    duration_s: float = quantity(
        3600.0,
        unit="s",
        gt=0.0,
        le=1e7,
        slider=(60.0, 36000.0),
        log=True,
        label=Text("lasts"),
        help=Text("Time within the current: that of the leg."),
    )
    current_mps: tuple[_Speed, _Speed] = vector_quantity(
        (0.0, 0.0),
        unit="m/s",
        elements=("E", "N"),
        slider=(-2.0, 2.0),
        label=Text("current"),
        help=Text("Velocity of the water over the ground, east, north, added to reference.current_mps."),
    )


def current_velocity(currents: Iterable[Current], time_s: np.ndarray) -> np.ndarray:
    """Velocity of the water in the currents that hold at each time (m,), E and N, m/s; shape (m, 2)."""
    total = np.zeros((time_s.size, 2))
    for current in currents:
        total[current.holds(time_s)] += current.current_mps
    return total


class Water(LogTerm):
    """Current and tide."""

    current_mps: tuple[_Speed, _Speed] = vector_quantity(
        (0.0, 0.0),
        unit="m/s",
        elements=("E", "N"),
        slider=(-2.0, 2.0),
        label=Text("current"),
        help=Text("Velocity of the water over the ground, east, north; the log misses it: δVr = -current."),
    )
    current: tuple[Current, ...] = Field(
        default=(),
        max_length=200,
        description=Text("Currents that hold for a time, on a leg say, [[reference.current]]; they add up."),
    )
    tide_mps: tuple[_Speed, _Speed] = vector_quantity(
        (0.0, 0.0),
        unit="m/s",
        elements=("E", "N"),
        slider=(-2.0, 2.0),
        label=Text("tide"),
        help=Text("Amplitude of the tidal stream, east, north: tide sin(2π t / period + phase) is added."),
    )
    tide_period_h: float = quantity(
        12.42,
        unit="h",
        ge=0.01,
        le=10000.0,
        slider=(1.0, 48.0),
        label=Text("tide period"),
        help=Text("12.42 h: the principal lunar tide."),
    )
    tide_phase_deg: float = quantity(
        0.0,
        unit="deg",
        ge=-360.0,
        le=360.0,
        slider=(-180.0, 180.0),
        label=Text("tide phase"),
        help=Text("Phase at t = 0."),
    )

    def parts(self) -> Iterator[LogPart]:
        """Yield the steady current, those that hold for a time, and the tide."""
        current = LogPart(("current_mps",), "log_current", Text("current and tide"))
        if any(self.current_mps):
            current = replace(current, water=lambda time_s: np.array([self.current_mps]))
        tide = LogPart(("tide_mps",), "log_tide", Text("current and tide"))
        if any(self.tide_mps):
            tide = replace(tide, water=self._tide)
        passing = LogPart(("current",), "log_current", Text("current and tide"))
        if any(any(current.current_mps) for current in self.current):
            passing = replace(passing, water=partial(current_velocity, self.current))
        yield from (current, passing, tide)

    def _tide(self, time_s: np.ndarray) -> np.ndarray:
        angle = 2.0 * np.pi * time_s / (self.tide_period_h * HOUR) + self.tide_phase_deg * DEG
        return np.sin(angle)[:, None] * np.array(self.tide_mps)
