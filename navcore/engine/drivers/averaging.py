"""A method with ``damping = "averaging"`` among the others of a scenario: its run in either fidelity."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from navcore.averaging.error_model import AveragedErrorModel, start_error_model
from navcore.averaging.plan import Plan, prepare_averaging
from navcore.engine.drivers.common import law_of, network_of
from navcore.engine.environment import Environment
from navcore.law.law import Law
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario

if TYPE_CHECKING:
    from navcore.averaging.strapdown import AveragedStrapdown
    from navcore.engine.strapdown_environment import StrapdownEnvironment
    from navcore.mechanization.strapdown import Settings


def averaged_linear(
    scenario: Scenario, method: Method, env: Environment, state: np.ndarray
) -> tuple[AveragedErrorModel, tuple[str, ...]]:
    """Run of an averaging method on the error model, and what to tell the user.

    Raises
    ------
    InputError
        The vehicle moves at t = 0, or hardly ever stands still during the alignment.
    """
    plan = plan_of(scenario, method, env.truth_half.values[0])
    run = scenario.run
    law = law_of(method, network_of(scenario, method), run.step_s)
    averaged = start_error_model(
        plan,
        state,
        scenario.earth,
        run.step_s,
        env.steps,
        run.output_step_s,
        env.coefficients,
        env.sensors,
        law,
    )
    return averaged, plan.notices


def averaged_strapdown(
    scenario: Scenario, method: Method, env: StrapdownEnvironment, settings: Settings
) -> tuple[AveragedStrapdown, tuple[str, ...]]:
    """Run of an averaging method on the full mechanization, and what to tell the user.

    Raises
    ------
    InputError
        As of `averaged_linear`.
    """
    # Only now: the strapdown kernels are slow to import, and most runs are linear.
    from navcore.averaging.strapdown import start_strapdown

    plan = plan_of(scenario, method, env.truth.values[0])
    network = network_of(scenario, method)

    def law(interval_s: float) -> Law:
        return law_of(method, network, interval_s)

    averaged = start_strapdown(
        plan, env.start, settings, scenario.earth, law, env.truth.values, env.imu.before()
    )
    return averaged, plan.notices


def plan_of(scenario: Scenario, method: Method, true_row: np.ndarray) -> Plan:
    """Copies and forecast of an averaging method, from the true state at t = 0, shape (15,).

    Raises
    ------
    InputError
        The vehicle moves at t = 0, or hardly ever stands still during the alignment.
    """
    alignment = scenario.alignment
    return prepare_averaging(
        method.settings,
        true_row,
        scenario.omega_s,
        scenario.earth,
        scenario.imu,
        alignment.duration_s,
        alignment.motion,
        scenario.run.seed,
    )
