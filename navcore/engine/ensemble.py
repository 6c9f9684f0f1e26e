"""Runs of a scenario with other seeds, each with its own noise and its own constants (design.md, shares).

A seed draws the bias of every gyro, accelerometer and axis of the log, and the errors at the start, from
normal distributions with mean zero and the standard deviations that the error budget knows. All else stays.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from navcore.engine.drivers.common import law_of, network_of, requirement_spans, seen_by
from navcore.engine.drivers.kalman import Gains
from navcore.engine.drivers.linear import carried_out
from navcore.engine.environment import Environment, environment, environment_side_by_side
from navcore.engine.simulation import simulate
from navcore.engine.spans import Span, spans
from navcore.foundation.units import ARCMIN, ARCSEC, DEG_PER_HOUR, MICRO_G
from navcore.mechanization.error_batch import WIDTH, ErrorModelBatch
from navcore.mechanization.recorder import FINAL, NAMES, POSITION
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import CONSTANTS, require_sensors, stated_constants, stochastic_model

SEARCHED = 1_000_000
"""Added to the seed of a run by what a search draws, so that it never meets what judges it."""
_STREAM = 0x636F6E73
_WORKERS = 2


@dataclass(frozen=True)
class Outcome:
    """One method on one seed.

    Attributes
    ----------
    ended : bool
        It went through; False when it diverged.
    spans : tuple of Span
        Lengths of the errors, as of `navcore.engine.run.MethodRun`.
    final_m : float
        Position error at the end, m.
    """

    ended: bool
    spans: tuple[Span, ...]
    final_m: float


def drawn(scenario: Scenario, number: int, *, stated_only: bool = False) -> Scenario:
    """Return the scenario of the seed ``run.seed + number``, with constants drawn for it.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    number : int
        Added to its seed.
    stated_only : bool
        Draw only biases and initial errors whose standard deviation the scenario states; the others keep the
        numbers that it gives. By default all are drawn (`stochastic_model`).
    """
    require_sensors(scenario)
    seed = (scenario.run.seed + number) % 2**31
    model = stochastic_model(scenario)
    generator = np.random.default_rng([_STREAM, seed])
    gyro, accel = generator.standard_normal((2, 3)) * (model.gyro_bias, model.accel_bias)
    log = generator.standard_normal(2) * model.log_bias
    dv_e, dv_n, lat, lon, phi_e, phi_n, phi_u = (generator.standard_normal(7) * model.initial).tolist()
    drawn_values = {
        "gyro_bias": tuple((gyro / DEG_PER_HOUR).tolist()),
        "accel_bias": tuple((accel / MICRO_G).tolist()),
        "log_bias": tuple(log.tolist()),
        "initial_tilt": (phi_e / ARCMIN, phi_n / ARCMIN),
        "initial_heading": (phi_u / ARCMIN,),
        "initial_velocity": (dv_e, dv_n),
        "initial_position": (lat / ARCSEC, lon / ARCSEC),
    }
    stated = stated_constants(scenario) if stated_only else frozenset(drawn_values)
    numbers = {source: getattr(getattr(scenario, block), field) for source, block, _, field in CONSTANTS}
    numbers["initial_tilt"], numbers["initial_heading"] = (
        numbers["initial_tilt"][:2],
        numbers["initial_heading"][2:],
    )
    made = numbers | {source: drawn_values[source] for source in stated}
    return scenario.model_copy(
        update={
            "run": scenario.run.model_copy(update={"seed": seed}),
            "imu": scenario.imu.model_copy(
                update={"gyro_bias_dph": made["gyro_bias"], "accel_bias_ug": made["accel_bias"]}
            ),
            "reference": scenario.reference.model_copy(update={"bias_mps": made["log_bias"]}),
            "initial_error": scenario.initial_error.model_copy(
                update={
                    "attitude_arcmin": (*made["initial_tilt"], *made["initial_heading"]),
                    "velocity_mps": made["initial_velocity"],
                    "position_arcsec": made["initial_position"],
                }
            ),
        }
    )


def outcomes(
    scenario: Scenario,
    methods: Sequence[Method],
    numbers: Sequence[int],
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> list[tuple[Outcome, ...]]:
    """Run methods on several seeds, all on the same draws.

    Parameters
    ----------
    scenario : Scenario
        Its own methods do not count.
    methods : sequence of Method
        Designed for the scenario's sensors; a Kalman filter gets the scenario's standard deviations.
    numbers : sequence of int
        Added to the seed of the run.
    progress : callable, optional
        Told the fraction done, 0..1.
    cancelled : callable, optional
        When it says True, the seeds that were completed are given.

    Returns
    -------
    list of tuple of Outcome
        For each seed one a method; on ``[ins]``, where there is one recording and nothing to draw, one of it.
    """
    kept = {"method": tuple(methods), "run": scenario.run.model_copy(update={"output_step_s": 86400.0})}
    bare = scenario.model_copy(update=kept)
    if scenario.on_ins:
        return [_of_recording(bare, progress, cancelled)]
    done: list[tuple[Outcome, ...]] = []
    gains = {k: Gains() for k, method in enumerate(bare.method) if method.kind.carrying == "filter"}
    finished = 0.0

    def report(seeds: float) -> bool:
        nonlocal finished
        finished += seeds
        if progress is not None and seeds:
            progress(min(finished / len(numbers), 1.0))
        return cancelled is not None and cancelled()

    def one(number: int) -> list[tuple[Outcome, ...]]:
        if report(0.0):
            return []
        outcome = tuple(_strapdown(bare, number))
        report(1.0)
        return [outcome]

    def block(some: Sequence[int]) -> list[tuple[Outcome, ...]]:
        return batch_outcomes([drawn(bare, number) for number in some], report, bare, gains)

    with ThreadPoolExecutor(_WORKERS) as pool:
        # the first seed alone: it computes the gains of a filter that the others share
        first = int(bool(gains) and not bare.strapdown)
        for number in numbers[:first]:
            done += block([number])
        for k in [*gains]:
            if not done or not done[0][k].ended:
                del gains[k]
        width = width_of(bare)
        parts = [numbers[i : i + width] for i in range(first, len(numbers), width)] if width else ()
        for some in pool.map(block, parts) if width else pool.map(one, numbers):
            done += some
    return done


def _of_recording(
    scenario: Scenario, progress: Callable[[float], None] | None, cancelled: Callable[[], bool] | None
) -> tuple[Outcome, ...]:
    run = simulate(scenario, progress, cancelled)
    return tuple(
        Outcome(one.status == "ok", one.spans, one.errors[NAMES[POSITION]]["final"]) for one in run.methods
    )


def width_of(scenario: Scenario) -> int:
    """Runs of other seeds that go side by side; 0 of a strapdown that `run_batches` cannot carry out."""
    if not scenario.strapdown:
        return WIDTH
    from navcore.mechanization.strapdown.batch import WIDTH as STRAPDOWN_WIDTH

    laws = all(method.kind.carrying == "law" for method in scenario.method)
    able = scenario.imu.file is None and laws and scenario.run.vertical == "locked"
    return STRAPDOWN_WIDTH if able else 0


def batch_outcomes(
    scenarios: Sequence[Scenario],
    report: Callable[[float], bool],
    told: Scenario | None = None,
    gains: Mapping[int, Gains] = MappingProxyType({}),
) -> list[tuple[Outcome, ...]]:
    """Run scenarios side by side that differ in seeds and constants.

    Parameters
    ----------
    scenarios : sequence of Scenario
        At most `width_of` them.
    report : callable
        Given the scenarios done since the last call, a part of one counting as such; returns whether to stop.
    told : Scenario, optional
        What a Kalman filter knows of: the standard deviations, not the constants; else each scenario itself.
    gains : mapping of int to Gains, optional
        Of the Kalman filters of the error model, by the method's place.

    Returns
    -------
    list of tuple of Outcome
        For each scenario one a method; empty when it was stopped.
    """
    if not scenarios[0].strapdown:
        return _linear(scenarios, report, told, gains)
    from navcore.engine.drivers.batch import run_batches

    batches = run_batches(scenarios, report)
    step_s = scenarios[0].sampling.record_step_s
    return [
        tuple(
            Outcome(not b.diverged[k], spans(b.spans[k], step_s, b.readings[k]), float(b.position_m[k]))
            for b in batches
        )
        for k in range(len(scenarios) if batches else 0)
    ]


def _linear(
    scenarios: Sequence[Scenario],
    report: Callable[[float], bool],
    told: Scenario | None,
    gains: Mapping[int, Gains],
) -> list[tuple[Outcome, ...]]:
    if report(0.0):
        return []
    each, columns = scenarios[0].method, []
    side_by_side = [len(scenarios) > 1 and method.kind.carrying == "law" for method in each]
    env = environment_side_by_side(scenarios, WIDTH) if any(side_by_side) else None
    inputs = [] if all(side_by_side) else [_inputs(one) for one in scenarios]
    for k, method in enumerate(each):
        if env and side_by_side[k]:
            columns.append(_side_by_side(scenarios, method, env))
        else:
            pairs = zip(scenarios, inputs, strict=True)
            columns.append([_outcome(told or one, method, *given, gains.get(k)) for one, given in pairs])
        if report(len(scenarios) / len(each)):
            return []
    return [*zip(*columns, strict=True)]


def _side_by_side(scenarios: Sequence[Scenario], method: Method, env: Environment) -> list[Outcome]:
    one = scenarios[0]
    step_s = one.run.step_s
    batch = ErrorModelBatch(
        step_s,
        env.steps,
        env.coefficients,
        env.sensors,
        seen_by(method, env.reference),
        law_of(method, network_of(one, method), step_s),
        [np.array(scenario.initial_error.state()) for scenario in scenarios],
        requirement_spans(one, step_s),
    )
    batch.advance(env.steps + 1)
    lanes = zip(batch.diverged, batch.spans, batch.readings, batch.position_m.tolist(), strict=True)
    return [
        Outcome(not lost and math.isfinite(final), spans(own, step_s, read), final)
        for lost, own, read, final in lanes
    ]


def linear_outcomes(scenario: Scenario, known: Mapping[Method, Outcome]) -> tuple[Outcome, ...]:
    """Run a scenario as it stands on the linear error model.

    Parameters
    ----------
    scenario : Scenario
        Of fidelity ``channel`` or ``error_model``.
    known : mapping of Method to Outcome
        Methods whose outcome is known in all else of this scenario; they are not run again.

    Returns
    -------
    tuple of Outcome
        One a method.

    Raises
    ------
    InputError
        The motion cannot be carried out, or a recording cannot serve the run.
    """
    env, state = _inputs(scenario)
    return tuple(known.get(each) or _outcome(scenario, each, env, state, None) for each in scenario.method)


def _inputs(scenario: Scenario) -> tuple[Environment, np.ndarray]:
    return environment(scenario), np.array(scenario.initial_error.state())


def _outcome(
    scenario: Scenario, method: Method, env: Environment, state: np.ndarray, gains: Gains | None
) -> Outcome:
    run, _, status, _ = carried_out(scenario, method, env, state, lambda _: None, None, gains)
    final = float(run.recorder.stats[POSITION, FINAL])
    return Outcome(
        status == "ok" and math.isfinite(final),
        spans(run.recorder.spans, scenario.run.step_s, run.recorder.readings),
        final,
    )


def _strapdown(scenario: Scenario, number: int) -> Iterator[Outcome]:
    for run in simulate(drawn(scenario, number)).methods:
        yield Outcome(run.status == "ok", run.spans, run.errors["position_m"]["final"])
