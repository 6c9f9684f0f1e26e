"""A scenario of fidelity `strapdown`: all methods ride on one stream of IMU samples, chunk by chunk."""

import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import cast

import numpy as np

from navcore.averaging.strapdown import AveragedStrapdown
from navcore.damping.base import Carrying
from navcore.engine.drivers.averaging import averaged_strapdown
from navcore.engine.drivers.common import (
    STOPPED,
    Cancelled,
    Progress,
    law_of,
    method_run,
    network_of,
    requirement_spans,
    seen_by,
    stability_of,
)
from navcore.engine.drivers.kalman import filtered_strapdown, own_sigma
from navcore.engine.drivers.user import UserRun, hosted
from navcore.engine.run import MethodRun, Run, Status, in_places
from navcore.engine.strapdown_environment import StrapdownEnvironment, strapdown_environment
from navcore.law.hosted import Start
from navcore.mechanization.recorder import output_steps
from navcore.mechanization.strapdown import Settings, StrapdownRun, start_run, velocity_reference
from navcore.mechanization.strapdown.drive import drive
from navcore.scenario.file import scenario_hash
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.sampling import Sampling


def run_strapdown(
    scenario: Scenario, progress: Progress | None = None, cancelled: Cancelled | None = None
) -> Run:
    """Run every method of a scenario on the full mechanization; as `navcore.engine.simulation.simulate`.

    Cancel is asked for after each chunk: a minute of samples.
    """
    began = time.perf_counter()
    return run_methods(scenario, strapdown_environment(scenario), progress, cancelled, began)


def run_methods(
    scenario: Scenario,
    env: StrapdownEnvironment,
    progress: Progress | None,
    cancelled: Cancelled | None,
    began: float,
    take_sums: Callable[[np.ndarray], None] | None = None,
) -> Run:
    """Run every method in a given environment.

    Parameters
    ----------
    scenario : Scenario
        Of fidelity ``strapdown``.
    env : StrapdownEnvironment
        Truth, samples, start and log.
    progress, cancelled : callable, optional
        As of `navcore.engine.simulation.simulate`.
    began : float
        Time of `time.perf_counter` at which the work began, s.
    take_sums : callable, optional
        Given the sums of the IMU's errors over each block of a chunk, shape (blocks, 6), rad and m/s, ENU.
    """
    settings = settings_of(scenario, env.sampling)
    started = [_STARTS[method.kind.carrying](scenario, method, env, settings) for method in scenario.method]
    for run, _ in started:
        run.recorder.spans[:] = requirement_spans(scenario, settings.record_step_s)
    # An averaging run is advanced like one of its copies.
    runs = cast("list[StrapdownRun]", [run for run, _ in started])

    def chunks() -> Iterator[np.ndarray]:
        for increments, sums in env.imu.chunks(with_sums=take_sums is not None):
            if take_sums is not None:
                take_sums(sums)
            yield increments

    drive(runs, chunks(), progress, cancelled)
    rates = env.sampling
    rows = output_steps(rates.records, rates.record_step_s, scenario.run.output_step_s)
    methods = zip(scenario.method, started, strict=True)
    return Run(
        scenario=scenario,
        methods=in_places(_finish(scenario, env, method, *run) for method, run in methods),
        t_s=rows * rates.record_step_s,
        truth=env.truth.at(rows),
        warnings=env.warnings,
        elapsed_s=time.perf_counter() - began,
        sampling=rates,
        scenario_sha256=scenario_hash(scenario),
    )


def settings_of(scenario: Scenario, rates: Sampling) -> Settings:
    """How the mechanization of a scenario runs at given rates."""
    return Settings(
        rates.rate_hz, rates.samples, rates.law_every, rates.record_every, scenario.run.output_step_s,
        scenario.run.vertical, scenario.run.compensation,
    )  # fmt: skip


def _damped(
    scenario: Scenario, method: Method, env: StrapdownEnvironment, settings: Settings
) -> tuple[StrapdownRun, tuple[str, ...]]:
    """Run of one navigation with the damping law."""
    law = law_of(method, network_of(scenario, method), env.sampling.law_step_s)
    log = velocity_reference(seen_by(method, env.reference), env.truth)
    run = start_run(env.start, settings, scenario.earth, law, env.truth.values, log, env.imu.before())
    return run, ()


def _by_user(
    scenario: Scenario, method: Method, env: StrapdownEnvironment, settings: Settings
) -> tuple[UserRun, tuple[str, ...]]:
    """Run of one navigation with a law of the user's own."""
    run, notices = _damped(scenario, method, env, settings)
    v_e, v_n, _ = env.start.velocity
    at = Start(env.start.lat, float(v_e), float(v_n), env.sampling.law_step_s)
    run.law, host = hosted(scenario, method, env.sampling.law_step_s, at)
    return UserRun(run, host), notices


_Started = StrapdownRun | AveragedStrapdown | UserRun
_STARTS: dict[
    Carrying, Callable[[Scenario, Method, StrapdownEnvironment, Settings], tuple[_Started, tuple[str, ...]]]
] = {"law": _damped, "copies": averaged_strapdown, "filter": filtered_strapdown, "user": _by_user}
"""How a method starts, and what the user should know, by the way it is carried out."""


def _finish(
    scenario: Scenario,
    env: StrapdownEnvironment,
    method: Method,
    run: _Started,
    notices: tuple[str, ...],
) -> MethodRun:
    status: Status = "ok"
    reason = run.reason
    if shared := getattr(run, "shared_state", ""):
        notices = (*notices, shared)
    if fault := getattr(run, "fault", ""):
        status, reason = "stopped", fault
    elif run.diverged:
        status = "diverged"
    elif run.position < run.settings.samples:
        status, reason = "stopped", STOPPED
    return method_run(
        method,
        network_of(scenario, method),
        partial(stability_of, scenario, method, env.sampling.law_step_s, env.reference, env.truth),
        run.recorder,
        run.settings.record_step_s,
        status,
        reason,
        run.position / run.settings.rate_hz,
        run.navigation,
        notices,
        own_sigma(run, env.truth.at(run.recorder.row_steps), scenario.earth),
    )
