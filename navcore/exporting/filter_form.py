"""Form of a free navigation that a Kalman filter corrects."""

import numpy as np

from navcore.engine.drivers.kalman import filter_model
from navcore.engine.environment import truth_of
from navcore.exporting.filter_step import Motion, filter_step
from navcore.exporting.form import WHOLE, Form
from navcore.exporting.ir import Num
from navcore.exporting.program import constants_of, inputs_of, place_of, read_program
from navcore.exporting.records import MOTION, MOTION_STATE
from navcore.exporting.replay import INPUTS
from navcore.exporting.replay_filter import FILTER_OUTPUTS, replayed_filter
from navcore.exporting.subject import Subject
from navcore.exporting.values import Group, Named, Place, Value
from navcore.exporting.vectors import inputs_along
from navcore.foundation.records import new_record
from navcore.law.called import Given
from navcore.mechanization.kalman.filter import FilterState, filter_state
from navcore.motion.truth import PITCH, ROLL

_USAGE = (
    "In each call give what has just been computed; then take off_... off velocity, position and attitude",
    "(C_b^n becomes (I + [off_phi x]) C_b^n) before the navigation goes on. Until the next call",
    "- form the transport rate with v_star: omega_E = -v_star_n/(M + h), omega_N = v_star_e/(N + h);",
    "- add feedback_e, feedback_n to the rate of the velocity, and azimuth_rate to the rate about up:",
    "  they hold what the filter knows of the errors of gyros and accelerometers.",
    "The sensors' axes are those of the ship, tilted by pitch and roll at the start of the scenario.",
)
_KEPT = ("P", "sensors", "turn", "moved", "inputs", "scratch", "errors")
"""Arrays of a filter's state that an exported one has too."""


def filter_form(subject: Subject, given: np.ndarray | None = None) -> Form:
    """Form of a free navigation that a Kalman filter corrects; parameters as of `law_form`."""
    scenario = subject.scenario
    given = inputs_along(subject) if given is None else given
    truth = truth_of(scenario, 1, subject.step_s).values[0]
    model, P, _ = filter_model(scenario, subject.method, subject.step_s, truth, np.zeros(0, dtype=bool))
    earth = scenario.earth
    parameters = new_record(
        MOTION,
        step=subject.step_s,
        e2=earth.e2,
        g_equator=earth.g_equator,
        k_gravity=earth.somigliana_k,
        height=scenario.site.height_m,
        pitch=truth[PITCH],
        roll=truth[ROLL],
    )
    state, memory = filter_state(P, 0), new_record(MOTION_STATE)
    kept = {name: np.array(getattr(state, name)) for name in _KEPT}
    roots = {"motion": memory.copy(), "filter": kept}
    places = {name: Place(("filter", name), (), one.dtype, one.shape) for name, one in kept.items()}
    parts: dict[str, Value] = {name: Named(("filter", name), one) for name, one in state._asdict().items()}
    parts |= {**places, "known": Num(False)}
    arguments = [
        Group((constants_of("motion", parameters), place_of("motion", memory)), Motion),
        constants_of("model", model),
        Group(tuple(parts[name] for name in FilterState._fields), FilterState),
        inputs_of(Given, WHOLE),
    ]
    program = read_program(filter_step, roots, arguments)
    expected = replayed_filter(Motion(parameters, memory), model, state, given)
    return Form(subject, program, INPUTS, FILTER_OUTPUTS, given, expected, 0.0, usage=_USAGE)
