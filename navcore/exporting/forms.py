"""How a method is exported, by the way it is carried out: its program, its vectors, and what to say of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from navcore.damping.base import Carrying
from navcore.exporting.ir import Program, Return, Var
from navcore.exporting.program import constants_of, inputs_of, place_of, read_program
from navcore.exporting.records import LOG_PARAMETERS, LOG_STATE
from navcore.exporting.replay import INPUTS, OUTPUTS, replayed
from navcore.exporting.step import Given, Reading, step
from navcore.exporting.subject import Subject, hold_calls
from navcore.exporting.values import Group
from navcore.exporting.vectors import inputs_along, reference_of
from navcore.foundation.records import new_record
from navcore.foundation.units import DEG
from navcore.law.law import Law

WHOLE = ("log_valid", "damped")
"""Inputs and outputs that are whole numbers."""
UNITS = {"mps": "m/s", "mps2": "m/s^2", "rad": "rad", "radps": "rad/s", "valid": "", "damped": "", "m": "m"}
"""Units by the last part of a name."""
ABOUT = {
    "v_e_mps": "computed velocity V_c, east",
    "v_n_mps": "computed velocity V_c, north",
    "lat_rad": "computed latitude",
    "log_e_mps": "velocity of the log, east",
    "log_n_mps": "velocity of the log, north",
    "log_valid": "0 invalid, 1 a sample, 2 none yet",
    "yaw_rad": "computed heading, clockwise from north",
    "accel_e_mps2": "acceleration of the ship, east",
    "accel_n_mps2": "acceleration of the ship, north",
    "v_star_e_mps": "V* = V_c + c, east: forms the transport rate about north",
    "v_star_n_mps": "V* = V_c + c, north: forms the transport rate about east",
    "feedback_e_mps2": "to be added to the velocity's rate, east",
    "feedback_n_mps2": "to be added to the velocity's rate, north",
    "azimuth_rate_radps": "to be added to the commanded rate about up",
    "damped": "1 while the law damps",
    "v_out_e_mps": "velocity to be given out, east",
    "v_out_n_mps": "velocity to be given out, north",
}
"""What inputs and outputs are."""


@dataclass(frozen=True)
class Form:
    """A method, ready for a target.

    Attributes
    ----------
    subject : Subject
        What is exported.
    program : Program
        Its law.
    inputs, outputs : tuple of str
        Names, with their units.
    given : ndarray, shape (calls, inputs)
        Inputs along the scenario.
    expected : ndarray, shape (calls, outputs)
        What the program's own law gives for them.
    hold_s : float
        Time for which a sample of the log counts, s; 0 where the law reads none.
    """

    subject: Subject
    program: Program
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    given: np.ndarray
    expected: np.ndarray
    hold_s: float

    @property
    def start(self) -> tuple[float, float, float]:
        """Latitude (rad) and velocity (m/s) at the first call."""
        lat, v_e, v_n = (
            float(self.given[0, self.inputs.index(n)]) for n in ("lat_rad", "v_e_mps", "v_n_mps")
        )
        return lat, v_e, v_n


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


FORMS: dict[Carrying, Callable[[Subject], Form]] = {"law": law_form}
"""How a form is made, by the way a method is carried out."""


def form_of(subject: Subject) -> Form:
    """Make the form of a method."""
    return FORMS[subject.method.kind.carrying](subject)


def unit_of(name: str) -> str:
    """Unit of an input or output, by its name."""
    return UNITS.get(name.rsplit("_", 1)[-1], "")


def latitude_deg(form: Form) -> float:
    """Latitude at the first call, deg."""
    return form.start[0] / DEG
