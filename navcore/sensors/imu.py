"""The inertial measurement unit: its errors as a scenario gives them, and their effect along a motion."""

import weakref
from collections.abc import Iterable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextvars import copy_context
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from pydantic import Field, create_model, model_validator

from navcore.foundation.earth import Earth
from navcore.foundation.parameters import FileName, choice, quantity
from navcore.foundation.stage_cache import kept
from navcore.foundation.text import Text
from navcore.io.column_map import map_field
from navcore.motion.truth import Truth
from navcore.sensors.base import SensorErrors
from navcore.sensors.data_sheets import names_of, with_part
from navcore.sensors.imu_errors import TERMS
from navcore.sensors.imu_errors.base import Clock, Part
from navcore.sensors.imu_errors.triad import Triad
from navcore.sensors.imu_kernels import attitude_changes, mean_attitude, scaled_signals, turn_errors
from navcore.sensors.recorded_imu import Axes

if TYPE_CHECKING:
    from navcore.sensors.imu_errors.bias import Bias, BiasDeviation
    from navcore.sensors.imu_errors.counts import Counts
    from navcore.sensors.imu_errors.coupling import Coupling
    from navcore.sensors.imu_errors.noise import Drift, White

    class _Errors(Bias, White, Drift, Coupling, Counts, BiasDeviation):
        pass
else:
    # pydantic takes the fields of the last base first
    _Errors = create_model("_Errors", __base__=tuple(TERMS[::-1]))

RECORDING = ("file", "map", "axes", "begin_s")
"""Fields of the block that say which recording is used; the others are errors."""


if TYPE_CHECKING:
    PartName = str
else:
    PartName = Literal[names_of("imu")]
    """Name of an IMU in the list."""


class Imu(_Errors):
    """Block ``imu``: errors of gyros and accelerometers in body axes, measured minus true.

    Scalars apply to all three axes. A Gauss-Markov value is held for a step of the run, which is right for
    correlation times well above the step.
    A recorded IMU (``file``, strapdown only) brings its own errors: those given here are then not used.
    """

    part: PartName | None = Field(
        default=None,
        description=Text(
            "An IMU from the list (schuler parts): its published figures fill the fields that are not given "
            "beside it."
        ),
        json_schema_extra={"label": Text("part")},
    )
    file: FileName | None = Field(
        default=None,
        description=Text(
            "Recorded IMU in place of the simulated one (strapdown): PSINS text, or CSV with t_s and "
            "gx_rad_s, gy_rad_s, gz_rad_s, fx_mps2, fy_mps2, fz_mps2 (means), or dax_rad ... dvz_mps "
            "(increments), or names such as GYRO X [rad/s]. Alignment and navigation take its samples one "
            "after the other."
        ),
        json_schema_extra={"label": Text("IMU file")},
    )
    map: FileName | None = map_field()
    axes: Axes = choice(
        "rfu",
        help=Text(
            "Where x, y and z of a recorded CSV point: r or l (right, left), f or b (forward, back), u or d "
            "(up, down). PSINS files are rfu."
        ),
    )
    begin_s: float = quantity(
        0.0,
        unit="s",
        ge=0.0,
        le=1e7,
        label="skip",
        help=Text("Time of the recorded IMU that is left out before."),
    )

    @model_validator(mode="before")
    @classmethod
    def _of_part(cls, data: Any) -> Any:
        """Take the figures of the part."""
        return with_part(data, "imu")

    def all_parts(self) -> tuple[Part, ...]:
        """Contributions of all terms, whether they do anything or not."""
        return _parts_of(self)  # pyright: ignore[reportArgumentType]

    def gyro(self) -> Triad:
        """Errors of the gyros, SI."""
        return Triad("gyro", self.all_parts())

    def accel(self) -> Triad:
        """Errors of the accelerometers, SI."""
        return Triad("accel", self.all_parts())


@lru_cache(maxsize=64)
def _parts_of(imu: Imu) -> tuple[Part, ...]:
    return tuple(part for term in TERMS for part in term.parts(imu))


def imu_errors(
    parts: Iterable[Part],
    truth_half: Truth,
    count: int,
    step_s: float,
    earth: Earth,
    seed: int,
    level_body: bool = False,
) -> SensorErrors:
    """Gyro and accelerometer errors in the navigation frame, mean over each step.

    The parts are summed in body axes, quantisation of the increments with carry last (a count's rest goes
    into the next increment). They are turned by Simpson's mean of the attitude over the step, the part that
    follows the true signal by Simpson's mean of the turned product.

    Parameters
    ----------
    parts : iterable of Part
        The errors: `Imu.all_parts`.
    truth_half : Truth
        True motion at half steps, 2 count + 1 rows, or one row at rest.
    count : int
        Number of steps.
    step_s : float
        Step of the mechanization, s.
    earth : Earth
        WGS-84 or the sphere.
    seed : int
        Seed of the scenario.
    level_body : bool
        True for the `channel` fidelity: a level body pointing north, no Earth rate, no coupling.

    Returns
    -------
    SensorErrors
        Arrays of shape (count, 3), or (1, 3) when constant in time.

    Raises
    ------
    ValueError
        The truth has neither 2 count + 1 rows nor one.
    """
    return imu_errors_side_by_side([parts], truth_half, count, step_s, earth, [seed], 1, level_body).alone()


def imu_errors_side_by_side(
    parts: Sequence[Iterable[Part]],
    truth_half: Truth,
    count: int,
    step_s: float,
    earth: Earth,
    seeds: Sequence[int],
    width: int,
    level_body: bool = False,
) -> SensorErrors:
    """Errors of several IMUs on one motion, as `imu_errors`, with the IMUs as the last axis.

    Parameters
    ----------
    parts, seeds : sequence
        One an IMU. They differ in their constant errors and their seeds alone.
    truth_half, count, step_s, earth, level_body
        As of `imu_errors`.
    width : int
        Size of the last axis. Places without an IMU repeat the first.

    Returns
    -------
    SensorErrors
        Arrays of shape (count, 3, width), or (1, 3, width) when constant in time.

    Raises
    ------
    ValueError
        As of `imu_errors`.
    """
    rows = truth_half.values.shape[0]
    if rows not in (1, 2 * count + 1):
        raise ValueError(f"{count} steps need 1 or {2 * count + 1} rows of truth at half steps, not {rows}")
    each = [tuple(one) for one in parts]
    sensors = [[Triad(name, one) for one in each] for name in ("gyro", "accel")]
    clocks = [Clock(step_s, count, seed) for seed in seeds]
    values = truth_half.values
    signal = coupled = np.zeros((2, 1, 3))
    if any(models[0].measures_motion for models in sensors):
        signal, coupled = np.empty((2, 2, 1 if rows == 1 else count, 3))
        coupling = np.stack([models[0].coupling for models in sensors])
        constants = (earth.e2, earth.g_equator, earth.somigliana_k)
        scaled_signals(values, level_body, *constants, coupling, signal, coupled)
    level = level_body or all(model.perfect for models in sensors for model in models)
    # Gyros, accelerometers and attitude at the same time: of a new seed this is a fifth of the whole run.
    with ThreadPoolExecutor(2) as pool:
        turning = pool.submit(copy_context().run, _attitude, truth_half, count, level)
        errors = [
            pool.submit(_navigation_errors, models, turning, signal[i], coupled[i], clocks, width)
            for i, models in enumerate(sensors)
        ]
        return SensorErrors(errors[0].result(), errors[1].result())


def _attitude(truth_half: Truth, count: int, level: bool) -> np.ndarray:
    """C_b^n of a level body pointing north, (1, 9), or that of the truth, which other seeds need as well."""
    if level:
        return np.eye(3).reshape(1, 9)
    key = "mean attitude", weakref.ref(truth_half), count
    return kept(key, lambda: _mean_attitude(truth_half.values, count))


def _mean_attitude(values: np.ndarray, count: int) -> np.ndarray:
    """C_b^n, mean over each step, row by row: (count, 9), or (1, 9) when the attitude never changes."""
    if not attitude_changes(values):
        values, count = np.repeat(values[:1], 3, axis=0), 1
    out = np.empty((count, 9))
    mean_attitude(values, out)
    return out


def _navigation_errors(
    models: Sequence[Triad],
    turned_by: Future[np.ndarray],
    signal: np.ndarray,
    coupled: np.ndarray,
    clocks: Sequence[Clock],
    width: int,
) -> np.ndarray:
    """Errors of gyros or accelerometers in the navigation frame, shape (count, 3, width) or (1, 3, width)."""
    if all(model.perfect for model in models):
        return np.zeros((1, 3, width))
    body = np.stack([model.body_errors(signal, clock) for model, clock in zip(models, clocks, strict=True)])
    turning = turned_by.result()
    moving = turning.shape[0] > 1 or (coupled.shape[0] > 1 and bool(models[0].coupling.any()))
    errors = np.empty((clocks[0].count if moving else body.shape[1], 3, width))
    turn_errors(turning, coupled, body, errors)
    return errors
