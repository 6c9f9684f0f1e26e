"""Strapdown runs of one scenario with several draws of its errors: method by method, side by side."""

from collections.abc import Callable, Sequence
from typing import cast

from navcore.engine.drivers.common import law_of, network_of, requirement_spans, seen_by
from navcore.engine.drivers.strapdown import settings_of
from navcore.engine.strapdown_environment import strapdown_environment
from navcore.mechanization.strapdown import velocity_reference
from navcore.mechanization.strapdown.batch import WIDTH, BatchRun
from navcore.scenario.model import Scenario
from navcore.sensors.imu_simulation import ImuSimulation, side_by_side

_REPORTED = 6000
"""Samples between two reports, some 10 ms a method."""


def run_batches(scenarios: Sequence[Scenario], report: Callable[[float], bool]) -> list[BatchRun]:
    """Run every method of scenarios that differ in their seeds and constants.

    Parameters
    ----------
    scenarios : sequence of Scenario
        At most `navcore.mechanization.strapdown.batch.WIDTH`, with a simulated IMU, a locked vertical channel
        and methods that a damping law carries out.
    report : callable
        Given the scenarios done since the last call, a part of one counting as such; returns whether to stop.

    Returns
    -------
    list of BatchRun
        One a method; empty when it was stopped.
    """
    if report(0.0):
        return []
    one, environments = scenarios[0], [strapdown_environment(each) for each in scenarios]
    env, settings = environments[0], settings_of(one, environments[0].sampling)
    spans, starts = requirement_spans(one, settings.record_step_s), [each.start for each in environments]
    batches = [
        BatchRun(
            starts,
            [law_of(method, network_of(one, method), env.sampling.law_step_s) for _ in environments],
            [velocity_reference(seen_by(method, each.reference), env.truth) for each in environments],
            settings,
            one.earth,
            env.truth.values,
            spans,
            env.imu.before(),
        )
        for method in one.method
    ]
    simulated = [cast("ImuSimulation", each.imu) for each in environments]
    unreported = 0
    for lanes in side_by_side(simulated, WIDTH):
        for batch in batches:
            batch.advance(lanes)
        unreported += len(lanes)
        if unreported >= _REPORTED or batches[0].position == settings.samples:
            if report(len(scenarios) * unreported / settings.samples):
                return []
            unreported = 0
    return batches
