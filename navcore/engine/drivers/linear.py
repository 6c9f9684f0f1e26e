"""A scenario of fidelity `channel` or `error_model`: two methods at a time on the linear error model."""

import math
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np

from navcore.averaging.error_model import AveragedErrorModel
from navcore.damping.base import Carrying
from navcore.engine.drivers.averaging import averaged_linear
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
    watches,
)
from navcore.engine.drivers.kalman import Gains, filtered_linear, own_sigma
from navcore.engine.drivers.user import UserRun, hosted
from navcore.engine.environment import Environment, environment
from navcore.engine.run import MethodRun, Run, Status, in_places
from navcore.foundation.text import Text
from navcore.law.hosted import Start
from navcore.mechanization.error_model import ErrorModelRun
from navcore.mechanization.kalman.error_model import FilteredErrorModel
from navcore.mechanization.recorder import make_recorder, output_steps
from navcore.motion.truth import LAT, VE, VN
from navcore.scenario.file import scenario_hash
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

_Started = ErrorModelRun | AveragedErrorModel | FilteredErrorModel | UserRun
CHUNK = 50_000
"""Steps between two looks at the cancel flag, some 10 ms."""


def run_linear(
    scenario: Scenario,
    progress: Progress | None = None,
    cancelled: Cancelled | None = None,
    before: Run | None = None,
) -> Run:
    """Run every method of a scenario on the linear error model; as `navcore.engine.simulation.simulate`."""
    began = time.perf_counter()
    env = environment(scenario)
    state = np.array(scenario.initial_error.state())
    return run_methods(scenario, env, state, progress, cancelled, began, unchanged_methods(scenario, before))


def unchanged_methods(scenario: Scenario, before: Run | None) -> tuple[MethodRun, ...]:
    """Methods of an earlier run that come out the same in this scenario.

    Methods do not see each other: the result of one depends on itself and on everything in the scenario but
    the other methods. Recordings may have been exchanged under the same name, so nothing is taken over from
    a run on files.
    """
    if before is None or scenario.reference.file is not None or hasattr(scenario.motion, "file"):
        return ()
    if scenario.imu.file is not None or all_but_methods(scenario) != all_but_methods(before.scenario):
        return ()
    return tuple(method for method in before.methods if method.status != "stopped")


def all_but_methods(scenario: Scenario) -> Scenario:
    """Return what all methods share: a method of two scenarios in which it is equal comes out the same."""
    watched = tuple(sorted({*watches(scenario)} - {(0.0, math.inf)}))
    return scenario.model_copy(update={"method": (), "title": "", "source": "", "requirement": watched})


def run_methods(
    scenario: Scenario,
    env: Environment,
    state: np.ndarray,
    progress: Progress | None,
    cancelled: Cancelled | None,
    began: float,
    known: tuple[MethodRun, ...] = (),
) -> Run:
    """Run every method in a given environment.

    Parameters
    ----------
    scenario : Scenario
        Of fidelity ``channel`` or ``error_model``.
    env : Environment
        Truth, coefficients, sensor errors and log.
    state : ndarray, shape (7,)
        Errors at t = 0, SI.
    progress, cancelled : callable, optional
        As of `navcore.engine.simulation.simulate`.
    began : float
        Time of `time.perf_counter` at which the work began, s.
    known : tuple of MethodRun, optional
        Results of methods in this very environment; an equal method is not run again.
    """
    results = [next((other for other in known if other.method == method), None) for method in scenario.method]
    done = [0.0 if other is None else 1.0 for other in results]

    def advance(index: int) -> MethodRun:
        def report(fraction: float) -> None:
            done[index] = fraction
            if progress is not None:
                progress(sum(done) / len(done))

        return results[index] or _run_method(scenario, scenario.method[index], env, state, report, cancelled)

    if results.count(None) > 1:
        with ThreadPoolExecutor(2) as pool:
            methods = tuple(pool.map(advance, range(len(results))))
    else:
        methods = tuple(map(advance, range(len(results))))
    steps = output_steps(env.steps, scenario.run.step_s, scenario.run.output_step_s)
    return Run(
        scenario=scenario,
        methods=in_places(methods),
        t_s=steps * scenario.run.step_s,
        truth=env.truth_half.at(2 * steps),
        warnings=env.warnings,
        elapsed_s=time.perf_counter() - began,
        scenario_sha256=scenario_hash(scenario),
    )


def _run_method(
    scenario: Scenario,
    method: Method,
    env: Environment,
    state: np.ndarray,
    report: Progress,
    cancelled: Cancelled | None,
) -> MethodRun:
    step_s = scenario.run.step_s
    run, notices, status, reason = carried_out(scenario, method, env, state, report, cancelled)
    report(1.0)
    return method_run(
        method,
        network_of(scenario, method),
        partial(stability_of, scenario, method, step_s, env.reference, env.truth_half),
        run.recorder,
        step_s,
        status,
        reason,
        run.position * step_s,
        notices=notices,
        sigma=own_sigma(run, env.truth_half.at(2 * run.recorder.row_steps), scenario.earth),
    )


def carried_out(
    scenario: Scenario,
    method: Method,
    env: Environment,
    state: np.ndarray,
    report: Progress,
    cancelled: Cancelled | None,
    gains: Gains | None = None,
) -> tuple[_Started, tuple[str, ...], Status, str]:
    """Run a method to its end in an environment.

    Parameters
    ----------
    scenario, method : Scenario, Method
        What the method knows of: its law, and a Kalman filter's model.
    env, state, report, cancelled
        As of `run_methods`.
    gains : Gains, optional
        Of a Kalman filter, shared by runs on the same truth.

    Returns
    -------
    run : ErrorModelRun or like it
        With the recorder.
    notices : tuple of str
        What the user should know.
    status, reason : str
        How it ended and why.
    """
    if gains is None:
        run, notices = _STARTS[method.kind.carrying](scenario, method, env, state)
    else:
        run, notices = filtered_linear(scenario, method, env, state, gains)
    run.recorder.spans[:] = requirement_spans(scenario, scenario.run.step_s)
    status, reason = _carry_out(run, report, cancelled)
    if shared := getattr(run, "shared_state", ""):
        notices = (*notices, shared)
    return run, notices, status, reason


def _damped(
    scenario: Scenario, method: Method, env: Environment, state: np.ndarray
) -> tuple[ErrorModelRun, tuple[str, ...]]:
    """Run of one navigation with the damping law."""
    step_s = scenario.run.step_s
    run = ErrorModelRun(
        step_s=step_s,
        steps=env.steps,
        coefficients=env.coefficients,
        sensors=env.sensors,
        reference=seen_by(method, env.reference),
        law=law_of(method, network_of(scenario, method), step_s),
        x=state.copy(),
        recorder=make_recorder(
            env.steps, step_s, scenario.run.output_step_s, env.coefficients.axes, env.rows
        ),
    )
    return run, ()


def _by_user(
    scenario: Scenario, method: Method, env: Environment, state: np.ndarray
) -> tuple[_Started, tuple[str, ...]]:
    """Run of one navigation with a law of the user's own."""
    run, notices = _damped(scenario, method, env, state)
    true = env.truth_half.values[0]
    at = Start(
        float(true[LAT] + state[2]), float(true[VE] + state[0]), float(true[VN] + state[1]), run.step_s
    )
    run.law, host = hosted(scenario, method, run.step_s, at)
    return UserRun(run, host), notices


_STARTS: dict[
    Carrying, Callable[[Scenario, Method, Environment, np.ndarray], tuple[_Started, tuple[str, ...]]]
] = {"law": _damped, "copies": averaged_linear, "filter": filtered_linear, "user": _by_user}
"""How a method starts, and what the user should know, by the way it is carried out."""


def _carry_out(run: _Started, report: Progress, cancelled: Cancelled | None) -> tuple[Status, str]:
    """Advance to the end; how it ended and why."""
    while not run.advance(CHUNK):
        report(run.position / max(run.steps, 1))
        if cancelled is not None and cancelled():
            return "stopped", STOPPED
    if fault := getattr(run, "fault", ""):
        return "stopped", fault
    if run.diverged:
        return (
            "diverged",
            Text("the error left the range of the linear model (tilt 1 rad, velocity 1e5 m/s)"),
        )
    return "ok", ""
