"""The budget of a method whose law looks at the data: no covariance exists, so it is run with many seeds."""

from collections.abc import Callable

import numpy as np

from navcore.design.course import attitudes
from navcore.engine.ensemble import drawn
from navcore.engine.environment import truth_of
from navcore.engine.simulation import simulate
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.law.combination import realisation_of
from navcore.quantities import COMPONENTS
from navcore.scenario.initial_error import InitialError
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.scenario.start import aligned_errors, independent_errors

SEEDS = 24


def no_covariance(scenario: Scenario, method: Method) -> str:
    """Say why a method has no covariance; empty when it has one.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked.
    method : Method
        One of its methods.
    """
    kind = method.kind
    if kind.no_covariance or not kind.uses_network:
        return kind.no_covariance
    if method.policy.id not in ("constant", "schedule"):
        return Text('policy "{id}" looks at the data', id=method.policy.id)
    if method.policy.id == "schedule" and realisation_of(kind.law, kind.network(method)) != "feedback":
        return Text('policy "schedule" is followed in advance only with network.realisation = "feedback"')
    if method.policy.id == "schedule" and scenario.reference.interrupted:
        return Text('policy "schedule" begins anew after each outage of the log')
    outages = scenario.reference.interrupted and kind.referenced
    if method.switching.id == "hard" or (method.switching.id == "keep" and not outages):
        return ""
    return Text('switching "{id}" acts on what was measured before', id=method.switching.id)


def alone(scenario: Scenario, method: Method, later: int = 0) -> Scenario:
    """Return a scenario with one method on the linear error model; its seed is ``later`` seeds later."""
    fidelity = "error_model" if scenario.strapdown else scenario.run.fidelity
    settings = scenario.run.model_copy(update={"seed": scenario.run.seed + later, "fidelity": fidelity})
    update = {"run": settings, "method": (method,), "alignment": type(scenario.alignment)()}
    return scenario.model_copy(update=update)


def _started(scenario: Scenario, method: Method) -> Scenario:
    """Return a scenario with one method on the linear error model, which begins where its alignment ends."""
    if scenario.alignment.kind != "compass":
        return alone(scenario, method)
    attitude = attitudes(truth_of(scenario, 1, scenario.run.step_s).values[:1]).reshape(3, 3)
    eps, nabla = (attitude @ triad.constant for triad in (scenario.imu.gyro(), scenario.imu.accel()))
    start = independent_errors(scenario, np.array(scenario.initial_error.state()))
    left = InitialError.of_state(start + aligned_errors(scenario, eps, nabla))
    return alone(scenario, method).model_copy(update={"initial_error": left})


def seed_variance(
    scenario: Scenario,
    method: Method,
    seeds: int = SEEDS,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    first: int = 0,
) -> tuple[np.ndarray, np.ndarray]:
    """Mean squares of a method's errors over several seeds, on the linear error model.

    A bias or initial error with a stated standard deviation is drawn for each seed; one that is given as a
    number keeps it. After an alignment a run begins with what the biases leave of it.

    Parameters
    ----------
    scenario : Scenario
        Complete and checked; a strapdown scenario is run on the error model.
    method : Method
        One of its methods.
    seeds : int
        Number of runs; their seeds follow that of the scenario.
    progress : callable, optional
        Told the fraction done.
    cancelled : callable, optional
        When it says True, what was run so far is used.
    first : int
        Added to the seed of the scenario.

    Returns
    -------
    t_s : ndarray, shape (m,)
    variance : ndarray, shape (m, 7)
        For `navcore.quantities.COMPONENTS`.

    Raises
    ------
    InputError
        A run diverged: the method is unstable.
    """
    total: np.ndarray | None = None
    t_s, count = np.zeros(0), 0
    for k in range(seeds):
        if k and cancelled is not None and cancelled():
            break
        result = simulate(_started(drawn(scenario, first + k, stated_only=True), method)).methods[0]
        if result.status == "diverged":
            raise InputError(
                Fault(
                    "",
                    "method",
                    method.name,
                    Text("has no budget: it diverges ({reason})", reason=result.reason),
                )
            )
        squares = result.rows[:, : len(COMPONENTS)] ** 2
        total, t_s, count = squares if total is None else total + squares, result.t_s, count + 1
        if progress is not None:
            progress((k + 1) / seeds)
    assert total is not None
    return t_s, total / count
