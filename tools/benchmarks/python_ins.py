"""python-ins (``pyins``; M. Mayorov, MIT) on the work of `schuler_bench.bench.strapdown.StaticRecord`.

One hour at 200 Hz at rest, height held, increments in. Its bare kernel takes rotation vectors and velocity
increments that are compensated already; its public call makes the table of the trajectory from them. Ours
compensates inside, and records errors, statistics and output rows.
"""

from __future__ import annotations

import importlib
import warnings
from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np

from navcore.foundation.units import DEG
from navcore.motion.truth import LAT, LON
from schuler_bench.bench.rounds import Timed, seconds_of
from schuler_bench.bench.strapdown import RATE_HZ, SITE, StaticRecord

STILL_MPS = 1e-5
"""Velocity that neither may exceed at the end: the work was done, and done right."""


class PythonIns:
    """Its work on a record at rest.

    Parameters
    ----------
    record : StaticRecord
        The increments; turned to its axes: north, east, down and forward, right, down.

    Raises
    ------
    ModuleNotFoundError
        The extra ``benchmarks`` is not installed.
    """

    def __init__(self, record: StaticRecord) -> None:
        self._strapdown: ModuleType = importlib.import_module("pyins.strapdown")
        self._kernel: Callable[..., None] = importlib.import_module("pyins._numba_integrate").integrate
        util: Any = importlib.import_module("pyins.util")
        pandas = importlib.import_module("pandas")
        forward_right_down = record.increments[:, [1, 0, 2, 4, 3, 5]] * (1.0, 1.0, -1.0, 1.0, 1.0, -1.0)
        samples = np.vstack([forward_right_down[:1], forward_right_down])
        times = np.arange(len(samples)) / RATE_HZ
        self._samples = pandas.DataFrame(samples, index=times, columns=util.GYRO_COLS + util.ACCEL_COLS)
        self._increments = self._strapdown.compute_increments_from_imu(self._samples, "increment")
        start = [SITE.lat / DEG, SITE.lon / DEG, SITE.height, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
        assert abs(record.truth[0, LAT] - SITE.lat) + abs(record.truth[0, LON] - SITE.lon) < 1e-12
        self._start = pandas.Series(start, index=util.TRAJECTORY_COLS)
        self._columns = [
            np.ascontiguousarray(self._increments[[f"{kind}_{axis}" for axis in "xyz"]])
            for kind in ("theta", "dv")
        ]
        self._dt = np.ascontiguousarray(self._increments["dt"])

    def kernel(self) -> Timed:
        """Its compiled loop alone."""

        def once() -> float:
            count = len(self._dt) + 1
            place, velocity, matrix = np.zeros((count, 3)), np.zeros((count, 3)), np.zeros((count, 3, 3))
            place[0], matrix[0] = self._start.to_numpy()[:3], np.eye(3)
            theta, dv = self._columns
            seconds = seconds_of(
                lambda: self._kernel(self._dt, place, velocity, matrix, theta, dv, 0, with_altitude=False)
            )
            _assert_still(velocity[-1])
            return seconds

        return once

    def public_call(self) -> Timed:
        """Call of its user: ``Integrator.integrate`` on a table of increments."""

        def once() -> float:
            with warnings.catch_warnings():
                # Its `DataFrame.transpose(copy=True)` does not please pandas 3.
                warnings.filterwarnings("ignore", message="The copy keyword")
                integrator = self._strapdown.Integrator(self._start, with_altitude=False)
                seconds = seconds_of(lambda: integrator.integrate(self._increments))
            _assert_still(integrator.get_pva().to_numpy()[3:6])
            return seconds

        return once


def _assert_still(velocity: np.ndarray) -> None:
    if not np.abs(velocity).max() < STILL_MPS:
        raise ArithmeticError(f"an IMU at rest came to move: {velocity} m/s")
