"""Runs of a scenario with other seeds, each with its own noise and its own constants (design.md, shares).

A seed draws the bias of every gyro, accelerometer and axis of the log, and the errors at the start, from
normal distributions with mean zero and the standard deviations that the error budget knows. All else stays.
"""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from navcore.engine.drivers.kalman import Gains
from navcore.engine.drivers.linear import carried_out
from navcore.engine.environment import environment
from navcore.engine.run import Span, spans
from navcore.engine.simulation import simulate
from navcore.foundation.units import ARCMIN, ARCSEC, DEG_PER_HOUR, MICRO_G
from navcore.mechanization.recorder import FINAL, POSITION
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.stochastic import stochastic_model

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


def drawn(scenario: Scenario, number: int) -> Scenario:
    """Return the scenario of the seed ``run.seed + number``, with constants drawn for it."""
    seed = (scenario.run.seed + number) % 2**31
    model = stochastic_model(scenario)
    generator = np.random.default_rng([_STREAM, seed])
    gyro, accel = generator.standard_normal((2, 3)) * (model.gyro_bias, model.accel_bias)
    log = generator.standard_normal(2) * model.log_bias
    dv_e, dv_n, lat, lon, phi_e, phi_n, phi_u = (generator.standard_normal(7) * model.initial).tolist()
    start = {
        "attitude_arcmin": (phi_e / ARCMIN, phi_n / ARCMIN, phi_u / ARCMIN),
        "velocity_mps": (dv_e, dv_n),
        "position_arcsec": (lat / ARCSEC, lon / ARCSEC),
    }
    biases = {
        "gyro_bias_dph": tuple((gyro / DEG_PER_HOUR).tolist()),
        "accel_bias_ug": tuple((accel / MICRO_G).tolist()),
    }
    return scenario.model_copy(
        update={
            "run": scenario.run.model_copy(update={"seed": seed}),
            "imu": scenario.imu.model_copy(update=biases),
            "reference": scenario.reference.model_copy(update={"bias_mps": tuple(log.tolist())}),
            "initial_error": scenario.initial_error.model_copy(update=start),
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
        Designed for the scenario's sensors; a Kalman filter is told the scenario's standard deviations.
    numbers : sequence of int
        Added to the seed of the run.
    progress : callable, optional
        Told the fraction done, 0..1.
    cancelled : callable, optional
        When it says True, the seeds that were completed are given.

    Returns
    -------
    list of tuple of Outcome
        For each seed one a method.
    """
    kept = {"method": tuple(methods), "run": scenario.run.model_copy(update={"output_step_s": 86400.0})}
    bare = scenario.model_copy(update=kept)
    found: list[tuple[Outcome, ...]] = []
    gains = {k: Gains() for k, method in enumerate(bare.method) if method.kind.carrying == "filter"}

    def of(number: int) -> tuple[Outcome, ...] | None:
        if cancelled is not None and cancelled():
            return None
        one = tuple(_strapdown(bare, number) if bare.strapdown else _linear(bare, number, gains))
        if progress is not None:
            progress((len(found) + 1) / len(numbers))
        return one

    def take(one: tuple[Outcome, ...] | None) -> None:
        if one is not None:
            found.append(one)

    # the first seed alone: it computes the gains of a filter that the others share
    for number in numbers[:1]:
        take(of(number))
    for k in [*gains]:
        if not found or not found[0][k].ended:
            del gains[k]
    with ThreadPoolExecutor(_WORKERS) as pool:
        for one in pool.map(of, numbers[1:]):
            take(one)
    return found


def _linear(scenario: Scenario, number: int, gains: Mapping[int, Gains]) -> Iterator[Outcome]:
    made = drawn(scenario, number)
    env, state = environment(made), np.array(made.initial_error.state())
    for k, method in enumerate(scenario.method):
        run, _, status, _ = carried_out(scenario, method, env, state, lambda _: None, None, gains.get(k))
        final = float(run.recorder.stats[POSITION, FINAL])
        yield Outcome(
            status == "ok" and math.isfinite(final), spans(run.recorder, scenario.run.step_s), final
        )


def _strapdown(scenario: Scenario, number: int) -> Iterator[Outcome]:
    for run in simulate(drawn(scenario, number)).methods:
        yield Outcome(run.status == "ok", run.spans, run.errors["position_m"]["final"])
