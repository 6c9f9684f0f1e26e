"""Plan of an averaging method: its copies, its forecast, and its notices."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from navcore.averaging.copies import Copies, copies_of
from navcore.averaging.forecast import Forecast, forecast_from
from navcore.averaging.parameters import AlignmentMotion, Averaging
from navcore.averaging.record import RECORD_STEP_S, alignment_record, standing_row
from navcore.foundation.earth import Earth
from navcore.foundation.text import Text
from navcore.foundation.units import DEG_PER_HOUR, HOUR
from navcore.motion.truth import HEIGHT, LAT
from navcore.sensors.imu import Imu


@dataclass(frozen=True)
class Plan:
    """Plan from which an averaging method starts.

    Attributes
    ----------
    copies : Copies
        Copies and groups.
    forecast : Forecast
        Forecast IMU signals in the body axes of t = 0.
    record : ndarray, shape (seconds, 6)
        Alignment record that it was made from: increments over each second.
    standing : ndarray, shape (15,)
        Row of truth of the vehicle before t = 0.
    notices : tuple of str
        What the user should know, in plain words.
    """

    copies: Copies
    forecast: Forecast
    record: np.ndarray
    standing: np.ndarray
    notices: tuple[str, ...]


def prepare_averaging(
    averaging: Averaging,
    true_row: np.ndarray,
    omega_s: float,
    earth: Earth,
    imu: Imu,
    duration_s: float,
    motions: Sequence[AlignmentMotion],
    seed: int,
) -> Plan:
    """Make the plan of an averaging method.

    Parameters
    ----------
    averaging : Averaging
        The method's settings.
    true_row : ndarray, shape (15,)
        Truth at t = 0.
    omega_s : float
        Schuler frequency of the site, rad/s.
    earth : Earth
        WGS-84 or the sphere.
    imu : Imu
        Sensor errors.
    duration_s : float
        Length of the alignment, s.
    motions : sequence of AlignmentMotion
        Small motions of the base during the alignment.
    seed : int
        Seed of the scenario.

    Raises
    ------
    InputError
        The vehicle moves at t = 0, or hardly ever stands still during the alignment.
    """
    standing = standing_row(true_row)
    record = alignment_record(imu, standing, duration_s, motions, earth, seed)
    shifted = averaging.segments == "shifted"
    forecast = forecast_from(record, RECORD_STEP_S, averaging.order, shifted)
    chosen = copies_of(averaging, omega_s, float(standing[LAT]), float(standing[HEIGHT]), earth)
    return Plan(chosen, forecast, record, standing, _notices(chosen, forecast, imu, len(record)))


def _notices(chosen: Copies, forecast: Forecast, imu: Imu, seconds: int) -> tuple[str, ...]:
    still = sum(last - first for first, last in forecast.segments) * RECORD_STEP_S
    messages = []
    if still < seconds * RECORD_STEP_S:
        messages.append(
            Text(
                "the base moved during the alignment: {seconds:g} s of {seconds_2:g} s were "
                "left out of the forecast",
                seconds=seconds * RECORD_STEP_S - still,
                seconds_2=seconds * RECORD_STEP_S,
            )
        )
    if len(forecast.growth):
        ahead_s = max(chosen.ahead_s)
        change = forecast.at(np.array([ahead_s]))[0, :3] - forecast.gyro
        messages.append(
            Text(
                "the fit of order {order} moves the forecast of the gyros by {change:.2g} °/h within "
                "{hours:.1f} h",
                order=len(forecast.growth),
                change=float(np.abs(change).max()) / DEG_PER_HOUR,
                hours=ahead_s / HOUR,
            )
        )
        return tuple(messages)
    noise = imu.gyro().white / np.sqrt(still)
    if noise > 0.0:
        messages.append(
            Text(
                "the forecast of {ahead_s:.1f} h rests on {still:g} s of alignment: the "
                "gyros' random walk leaves {noise:.2g} °/h (1 σ) in it",
                ahead_s=max(chosen.ahead_s) / HOUR,
                still=still,
                noise=noise / DEG_PER_HOUR,
            )
        )
    return tuple(messages)
