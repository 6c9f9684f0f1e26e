"""Inputs that all methods of a scenario share: truth, coefficients, sensor errors and log; kept by stages.

Kept by what each stage depends on, so that a slider on a network or policy recomputes none of it, and one on
a sensor error neither the truth nor its coefficients.
"""

import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass

import numpy as np

from navcore.engine.notices import input_notices, site_notices
from navcore.foundation.errors import InputError
from navcore.foundation.stage_cache import kept, recorded_state
from navcore.mechanization.trajectory import Coefficients, coefficients
from navcore.motion.truth import Stretches, Truth
from navcore.scenario.model import Scenario
from navcore.sensors.base import ReferenceErrors, SensorErrors
from navcore.sensors.imu import imu_errors_side_by_side
from navcore.sensors.log import reference_errors_side_by_side
from navcore.sensors.recorded import recorded_window

_MOST_SHARED, _MOST_AVERAGED = 200_000, 20_000
"""Rows of a motion that its run has made, a day at half seconds, and of a longer one the rows to average."""


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
        What the recordings and the motion make necessary to say.
    rows : ndarray of int, or None
        Steps at which a method's state is kept; None for those of ``run.output_step_s``.
    """

    steps: int
    truth_half: Truth
    coefficients: Coefficients
    sensors: SensorErrors
    reference: ReferenceErrors
    warnings: tuple[str, ...]
    rows: np.ndarray | None = None


def start_utc(scenario: Scenario) -> float | None:
    """UTC of t = 0, s: begin of what everything recorded shares; None where nothing is recorded.

    Raises
    ------
    InputError
        As of `navcore.sensors.recorded.recorded_window`.
    """
    window = recorded_window(scenario.motion, scenario.reference)
    return None if window is None else window.start_s


def _truth_key(scenario: Scenario, steps: int, step_s: float) -> Hashable:
    motion_key = (scenario.motion, recorded_state(scenario.motion))
    # t = 0 is the first epoch that track and log share, so each depends on the other's files and clock.
    log_key = recorded_state(scenario.reference), scenario.reference.clock_s
    return (motion_key, log_key, scenario.site, steps, step_s, scenario.earth.name)


def truth_of(scenario: Scenario, steps: int, step_s: float) -> Truth:
    """Make, or take from the cache, the true motion at 0, step_s / 2, ..., steps * step_s.

    Raises
    ------
    InputError
        The motion cannot be carried out, or a recording cannot serve the run.
    """
    begin = start_utc(scenario)

    def make() -> Truth:
        site = scenario.site.site()
        try:
            return scenario.motion.truth(2 * steps + 1, 0.5 * step_s, site, scenario.earth, begin)
        except InputError as error:
            raise error.located("", f"{scenario.motion.block}.") from None

    return kept(("truth", _truth_key(scenario, steps, step_s)), make)


def stretches_of(scenario: Scenario, steps: int, step_s: float) -> Stretches:
    """Parts of the motion (`Truth.stretches`), for the verdict on its stability.

    Their means need no row at each half step: of a long run so many would take gigabytes.

    Raises
    ------
    InputError
        As `truth_of`.
    """
    rows = 2 * steps + 1
    every = 1 if rows <= _MOST_SHARED else math.ceil(rows / _MOST_AVERAGED)
    return truth_of(scenario, max(1, steps // every), every * step_s).stretches


def coefficients_of(scenario: Scenario, steps: int, step_s: float) -> Coefficients:
    """Coefficients of the error model along `truth_of`, made or taken from the cache."""
    channel = scenario.run.fidelity == "channel"
    truth = truth_of(scenario, steps, step_s)
    return kept(
        ("coefficients", _truth_key(scenario, steps, step_s), channel),
        lambda: coefficients(truth, scenario.earth, coupled=not channel),
    )


def environment(scenario: Scenario) -> Environment:
    """Make, or take from the cache, what all methods share.

    Raises
    ------
    InputError
        The motion cannot be carried out, or a recording cannot serve the run.
    """
    steps, h = scenario.steps, scenario.run.step_s
    truth, truth_key = truth_of(scenario, steps, h), _truth_key(scenario, steps, h)
    channel, seed = scenario.run.fidelity == "channel", scenario.run.seed
    log_key = (scenario.reference, recorded_state(scenario.reference))
    return Environment(
        steps=steps,
        truth_half=truth,
        coefficients=coefficients_of(scenario, steps, h),
        sensors=kept(
            ("sensors", truth_key, channel, scenario.imu, seed),
            lambda: _sensors([scenario], truth, 1).alone(),
        ),
        reference=kept(
            ("reference", truth_key, log_key, seed), lambda: _reference([scenario], truth, 1).alone()
        ),
        warnings=(*input_notices(scenario), *site_notices(scenario, truth)),
    )


def environment_side_by_side(scenarios: Sequence[Scenario], width: int) -> Environment:
    """Make, or take from the cache, what all methods share on several seeds of one scenario.

    Parameters
    ----------
    scenarios : sequence of Scenario
        They differ in their seeds and constant errors alone.
    width : int
        Size of the last axis of all errors of the sensors and the log: a scenario each; places without one
        repeat the first.

    Raises
    ------
    InputError
        As of `environment`.
    """
    one = scenarios[0]
    steps, h = one.steps, one.run.step_s
    truth, truth_key = truth_of(one, steps, h), _truth_key(one, steps, h)
    each = tuple((scenario.imu, scenario.reference, scenario.run.seed) for scenario in scenarios)
    key = "side by side", truth_key, one.run.fidelity, recorded_state(one.reference), each, width
    sensors, reference = kept(
        key, lambda: (_sensors(scenarios, truth, width), _reference(scenarios, truth, width))
    )
    return Environment(steps, truth, coefficients_of(one, steps, h), sensors, reference, ())


def _sensors(scenarios: Sequence[Scenario], truth: Truth, width: int) -> SensorErrors:
    """Errors of the inertial sensors of scenarios, shape (n, 3, width)."""
    one = scenarios[0]
    channel, seeds = one.run.fidelity == "channel", [scenario.run.seed for scenario in scenarios]
    parts = [scenario.imu.all_parts() for scenario in scenarios]
    errors = imu_errors_side_by_side(
        parts, truth, one.steps, one.run.step_s, one.earth, seeds, width, level_body=channel
    )
    if channel:
        errors.gyro[:, 2] = 0.0  # there is no heading: the up gyro drives nothing
    return errors


def _reference(scenarios: Sequence[Scenario], truth: Truth, width: int) -> ReferenceErrors:
    """Errors of the reference velocities of scenarios, shape (m, 2, width)."""
    one = scenarios[0]
    references, seeds = zip(*((scenario.reference, scenario.run.seed) for scenario in scenarios), strict=True)
    try:
        return reference_errors_side_by_side(
            references,
            truth,
            one.steps * one.run.step_s,
            seeds,
            width,
            step_s=one.run.step_s,
            start_utc=start_utc(one),
        )
    except InputError as error:
        raise error.located("", "reference.") from None
