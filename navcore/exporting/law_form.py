"""Form of a method that is one navigation with the damping law."""

import numpy as np

from navcore.exporting.form import WHOLE, Form
from navcore.exporting.ir import Program, Return, Var
from navcore.exporting.program import constants_of, inputs_of, place_of, read_program
from navcore.exporting.records import LOG_PARAMETERS, LOG_STATE
from navcore.exporting.replay import INPUTS, OUTPUTS, replayed
from navcore.exporting.step import Given, Reading, step
from navcore.exporting.subject import Subject, hold_calls
from navcore.exporting.values import Group
from navcore.exporting.vectors import inputs_along, reference_of
from navcore.foundation.records import new_record
from navcore.law.law import Law


def law_form(subject: Subject, given: np.ndarray | None = None) -> Form:
    """Form of a method that is one navigation with the damping law.

    Parameters
    ----------
    subject : Subject
        The method.
    given : ndarray, shape (calls, inputs), optional
        Inputs of the vectors; default those along its scenario.
    """
    scenario, method = subject.scenario, subject.method
    law, reads, hold_s = subject.law(), method.reads_log, 0.0
    period, hold = 1, 0
    if reads:
        log = reference_of(subject)
        hold_s, hold = float(log.hold_s), hold_calls(log.hold_s, subject.step_s)
        interval = float(np.median(np.diff(log.time_s))) if len(log.time_s) > 1 else subject.step_s
        period = max(1, int(interval / subject.step_s + 1e-6))
    earth = scenario.earth
    parameters = new_record(
        LOG_PARAMETERS, reads=reads, period=period, hold=hold, e2=earth.e2, height=scenario.site.height_m
    )
    state = new_record(LOG_STATE, age=hold + 1)
    roots = {"s": law.s.copy(), "ring": law.ring.copy(), "log": state.copy()}
    places = place_of("s", law.s), place_of("ring", law.ring)
    arguments = [
        Group((constants_of("p", law.p), *places), Law),
        Group((constants_of("log", parameters), place_of("log", state)), Reading),
        inputs_of(Given, WHOLE),
    ]
    program = read_program(step, roots, arguments)
    given = inputs_along(subject) if given is None else given
    expected = replayed(law, Reading(parameters, state), given)
    outputs = OUTPUTS[: _without_own_velocity(program)]
    return Form(subject, program, INPUTS, outputs, given, expected[:, : len(outputs)], hold_s)


def _without_own_velocity(program: Program) -> int:
    """Leave out the velocity given out where it is the computed one; return how many outputs stay."""
    last = program.functions[-1]
    end = last.body[-1]
    assert isinstance(end, Return)
    if end.values[6:] != (Var("v_e_mps", "real"), Var("v_n_mps", "real")):
        return len(OUTPUTS)
    end.values, last.results = end.values[:6], last.results[:6]
    return 6
