"""Form of a method that is one navigation with the damping law."""

import numpy as np

from navcore.exporting.form import WHOLE, Form
from navcore.exporting.ir import Program, Return, Var
from navcore.exporting.program import constants_of, inputs_of, place_of, read_program
from navcore.exporting.records import LOG_PARAMETERS, LOG_STATE
from navcore.exporting.replay import INPUTS, OUTPUTS, replayed
from navcore.exporting.step import Reading, step
from navcore.exporting.subject import Subject, hold_calls
from navcore.exporting.values import Group
from navcore.exporting.vectors import inputs_along, reference_of
from navcore.foundation.records import new_record
from navcore.law.called import Given
from navcore.law.law import Law
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from navcore.sensors.base import ReferenceErrors


def law_form(subject: Subject, given: np.ndarray | None = None) -> Form:
    """Form of a method that is one navigation with the damping law.

    Parameters
    ----------
    subject : Subject
        The method.
    given : ndarray, shape (calls, inputs), optional
        Inputs of the vectors; default those along its scenario.
    """
    scenario, method, law = subject.scenario, subject.method, subject.law()
    log = reference_of(subject) if method.reads_log else None
    reading = reading_of(scenario, method, log, subject.step_s)
    parameters, state = reading
    roots = {"s": law.s.copy(), "ring": law.ring.copy(), "log": state.copy()}
    places = place_of("s", law.s), place_of("ring", law.ring)
    arguments = [
        Group((constants_of("p", law.p), *places), Law),
        Group((constants_of("log", parameters), place_of("log", state)), Reading),
        inputs_of(Given, WHOLE),
    ]
    program = read_program(step, roots, arguments)
    given = inputs_along(subject) if given is None else given
    expected = replayed(law, reading, given)
    outputs = OUTPUTS[: _without_own_velocity(program)]
    return Form(
        subject,
        program,
        INPUTS,
        outputs,
        given,
        expected[:, : len(outputs)],
        0.0 if log is None else log.hold_s,
    )


def reading_of(scenario: Scenario, method: Method, log: ReferenceErrors | None, step_s: float) -> Reading:
    """Return how the log comes to a law that is called every ``step_s`` seconds.

    Parameters
    ----------
    scenario, method : Scenario, Method
        As exported.
    log : ReferenceErrors or None
        The log along the scenario; None where there is none.
    step_s : float
        s.
    """
    period, hold = 1, 0
    reads = log is not None and method.reads_log
    if log is not None:
        hold = hold_calls(log.hold_s, step_s)
        interval = float(np.median(np.diff(log.time_s))) if len(log.time_s) > 1 else step_s
        period = max(1, int(interval / step_s + 1e-6))
    earth, height = scenario.earth, scenario.site.height_m
    parameters = new_record(LOG_PARAMETERS, reads=reads, period=period, hold=hold, e2=earth.e2, height=height)
    return Reading(parameters, new_record(LOG_STATE, age=hold + 1))


def _without_own_velocity(program: Program) -> int:
    """Leave out the velocity given out where it is the computed one; return how many outputs stay."""
    last = program.functions[-1]
    end = last.body[-1]
    assert isinstance(end, Return)
    if end.values[6:] != (Var("v_e_mps", "real"), Var("v_n_mps", "real")):
        return len(OUTPUTS)
    end.values, last.results = end.values[:6], last.results[:6]
    return 6
