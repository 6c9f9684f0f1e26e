"""What all methods of a scenario share: truth, coefficients, sensor errors and log; made once and kept.

Kept by what each stage depends on, so that a slider on a network or policy recomputes none of it, and one on
a sensor error neither the truth nor its coefficients.
"""

from __future__ import annotations

from dataclasses import dataclass

from navcore.errors import InputError
from navcore.mechanization.trajectory import Coefficients, coefficients
from navcore.motion.base import LAT, Truth
from navcore.motion.track import TrackMotion
from navcore.scenario import Scenario
from navcore.sensors.base import ReferenceErrors, SensorErrors
from navcore.sensors.imu import imu_errors
from navcore.sensors.recorded import recorded_window, recording_notices
from navcore.sensors.reference import reference_errors
from navcore.stage_cache import file_state, kept
from navcore.units import DEG

FAR_FROM_SITE_DEG = 2.0
"""Latitude by which a track may start off the site before the user is told, deg."""


@dataclass(frozen=True)
class Environment:
    """Shared inputs of all methods.

    Attributes
    ----------
    steps : int
        Integration steps.
    truth_half : Truth
        True motion on the half-step grid.
    coefficients : Coefficients
        Coefficients of the error model on it.
    sensors : SensorErrors
        Inertial sensor errors, mean over each step.
    reference : ReferenceErrors
        Log errors at the log's epochs.
    warnings : tuple of str
        What the recordings made necessary to say.
    """

    steps: int
    truth_half: Truth
    coefficients: Coefficients
    sensors: SensorErrors
    reference: ReferenceErrors
    warnings: tuple[str, ...]


def site_notices(scenario: Scenario, truth: Truth) -> list[str]:
    """Say so when a recorded track starts far from the site, whose gravity gives omega_s."""
    start = float(truth.values[0, LAT]) / DEG
    if abs(start - scenario.site.lat_deg) < FAR_FROM_SITE_DEG:
        return []
    return [
        f"the track starts at latitude {start:.2f} deg, the site is at {scenario.site.lat_deg:g} deg: "
        "omega_s, and with it every network, is that of the site"
    ]


def environment(scenario: Scenario) -> Environment:
    """Make, or take from the cache, what all methods share.

    Raises
    ------
    InputError
        The motion cannot be carried out, or a recording cannot serve the run.
    """
    steps, h, earth = scenario.steps, scenario.run.step_s, scenario.earth
    channel = scenario.run.fidelity == "channel"
    motion_key = (scenario.motion, file_state(getattr(scenario.motion, "file", None)))
    log_key = (scenario.reference, file_state(scenario.reference.file))
    # t = 0 is the first epoch that track and log share, so each depends on the other's files.
    truth_key = (motion_key, log_key[1], scenario.site, steps, h, earth.name)
    seed = scenario.run.seed

    window = recorded_window(scenario.motion, scenario.reference)
    start_utc = None if window is None else window.start_s

    def make_truth() -> Truth:
        grid = (2 * steps + 1, 0.5 * h, scenario.site.site(), earth)
        try:
            if isinstance(scenario.motion, TrackMotion):
                return scenario.motion.truth(*grid, start_utc=start_utc)
            return scenario.motion.truth(*grid)
        except InputError as error:
            raise error.located("", "motion.") from None

    def make_sensors() -> SensorErrors:
        errors = imu_errors(scenario.imu, truth, steps, h, earth, seed, level_body=channel)
        # `channel` has no heading: its up gyro drives nothing.
        return SensorErrors(errors.gyro * (1.0, 1.0, 0.0), errors.accel) if channel else errors

    def make_reference() -> ReferenceErrors:
        try:
            return reference_errors(scenario.reference, truth, steps * h, seed, step_s=h, start_utc=start_utc)
        except InputError as error:
            raise error.located("", "reference.") from None

    truth = kept(("truth", truth_key), make_truth)
    return Environment(
        steps=steps,
        truth_half=truth,
        coefficients=kept(
            ("coefficients", truth_key, channel), lambda: coefficients(truth, earth, coupled=not channel)
        ),
        sensors=kept(
            ("sensors", truth_key, channel, scenario.imu, seed),
            make_sensors,
        ),
        reference=kept(("reference", truth_key, log_key, seed), make_reference),
        warnings=(*recording_notices(scenario.motion, scenario.reference), *site_notices(scenario, truth)),
    )
