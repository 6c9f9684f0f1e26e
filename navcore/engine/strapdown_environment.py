"""Inputs that all methods of a strapdown scenario share: truth, IMU samples, start and log."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from navcore.engine.alignment_start import aligned_start, start_errors
from navcore.engine.notices import input_notices, site_notices
from navcore.engine.recorded_start import RecordedImu, recorded_imu
from navcore.foundation.errors import InputError
from navcore.foundation.stage_cache import kept, recorded_state
from navcore.foundation.text import Text
from navcore.mechanization.strapdown import Start, start_from
from navcore.motion.truth import VE, VN, Truth
from navcore.scenario.model import Scenario
from navcore.scenario.sampling import Sampling
from navcore.sensors.base import ReferenceErrors
from navcore.sensors.imu_simulation import ImuSimulation
from navcore.sensors.log import reference_errors
from navcore.sensors.recorded import recorded_window

_AT_REST_MPS = 0.1


class ImuStream(Protocol):
    """Increments of an IMU, made or read chunk by chunk; see `ImuSimulation`."""

    def before(self) -> np.ndarray:
        """Increment of the interval that ends at t = 0, shape (6,)."""
        ...

    def chunks(self, with_sums: bool = False) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Increments (n, 6) from the start on, and sums of their errors over each block if asked for."""
        ...


@dataclass(frozen=True)
class StrapdownEnvironment:
    """Shared inputs of all methods.

    Attributes
    ----------
    sampling : Sampling
        Rates and length.
    truth : Truth
        True motion at the recorded states.
    imu : ImuStream
        The samples: every method gets the same chunk.
    block : int
        Samples over which the stream sums its errors up; 0 for a recorded IMU, whose errors nobody knows.
    start : Start
        Navigation state at t = 0.
    errors : ndarray, shape (7,)
        Its errors, SI, in the order of the error model.
    reference : ReferenceErrors
        Log errors at the log's epochs.
    warnings : tuple of str
        Warnings about recordings and alignment.
    """

    sampling: Sampling
    truth: Truth
    imu: ImuStream
    block: int
    start: Start
    errors: np.ndarray
    reference: ReferenceErrors
    warnings: tuple[str, ...]


def strapdown_environment(scenario: Scenario) -> StrapdownEnvironment:
    """Make what all methods share; truth and log are taken from the cache where nothing changed.

    Raises
    ------
    InputError
        The motion cannot be carried out, a recording cannot serve the run, or the alignment is refused.
    """
    if scenario.imu.file is not None:
        return _of_record(scenario)
    rates, window = scenario.sampling, recorded_window(scenario.motion, scenario.reference)
    start_utc = None if window is None else window.start_s
    seed = scenario.run.seed
    files = recorded_state(scenario.motion), recorded_state(scenario.reference), scenario.reference.clock_s
    truth_key = (Text("strapdown truth"), scenario.motion, files, scenario.site, rates, scenario.earth.name)
    try:
        imu = ImuSimulation(
            scenario.motion,
            scenario.site.site(),
            scenario.earth,
            scenario.imu,
            rates.rate_hz,
            rates.samples,
            seed,
            start_utc,
        )
        truth = kept(
            truth_key,
            lambda: Truth(rates.record_step_s, imu.truth_rows(rates.records + 1, rates.record_step_s)),
        )
    except InputError as error:
        raise error.located("", "motion.") from None
    warnings = [*input_notices(scenario), *site_notices(scenario, truth)]
    initial = np.array(scenario.initial_error.state())
    start = start_from(truth.values[0], initial)
    if scenario.alignment.kind == "compass":
        start = aligned_start(scenario, truth.values[0])
        speed = float(np.hypot(truth.values[0, VE], truth.values[0, VN]))
        if speed > _AT_REST_MPS:
            warnings.append(
                Text(
                    "the alignment is made at rest, though the motion begins at {speed:.3g} m/s: "
                    "navigation starts at once with that speed",
                    speed=speed,
                )
            )
    return StrapdownEnvironment(
        sampling=rates,
        truth=truth,
        imu=imu,
        block=imu.block,
        start=start,
        errors=start_errors(start, truth.values[0]),
        reference=kept(
            (Text("strapdown log"), truth_key, scenario.reference, seed),
            lambda: _reference_errors(scenario, rates, truth, start_utc),
        ),
        warnings=tuple(warnings),
    )


def _of_record(scenario: Scenario) -> StrapdownEnvironment:
    """Environment of a recorded IMU."""
    window = recorded_window(scenario.motion, scenario.reference)
    start_utc = None if window is None else window.start_s
    recorded: RecordedImu = recorded_imu(scenario, start_utc)
    truth = recorded.truth
    notices = input_notices(scenario)
    tracked = scenario.motion.recorded
    return StrapdownEnvironment(
        sampling=recorded.sampling,
        truth=truth,
        imu=recorded,
        block=0,
        start=recorded.start,
        errors=start_errors(recorded.start, truth.values[0]),
        reference=_reference_errors(scenario, recorded.sampling, truth, start_utc),
        warnings=(*notices, *(site_notices(scenario, truth) if tracked else ()), *recorded.warnings),
    )


def _reference_errors(
    scenario: Scenario, rates: Sampling, truth: Truth, start_utc: float | None
) -> ReferenceErrors:
    try:
        return reference_errors(
            scenario.reference,
            truth,
            rates.duration_s,
            scenario.run.seed,
            step_s=rates.law_step_s,
            start_utc=start_utc,
        )
    except InputError as error:
        raise error.located("", "reference.") from None
