"""Laws whose gains change at known times: `schedule`, carried out as a staircase of constant gains."""

import numpy as np

from navcore.design.course import Course
from navcore.design.form import LawForm, feedback_form, law_form
from navcore.law.policy.schedule import Schedule
from navcore.scenario.method import Method

_STAIRS = 12
"""Constant sets of gains that stand for the passage from one set to the other."""


def scheduled_times(method: Method) -> tuple[float, ...]:
    """Times at which the gains of a method change, s."""
    if not isinstance(method.policy, Schedule) or method.undamped:
        return ()
    return tuple((np.arange(1, _STAIRS + 1) * method.policy.duration_s / _STAIRS).tolist())


def law_stages(method: Method, omega_s: float, course: Course) -> tuple[tuple[LawForm, ...], np.ndarray]:
    """Forms that a method's law has one after the other, and which holds in each interval of the course.

    Parameters
    ----------
    method : Method
        With a policy that is known in advance.
    omega_s : float
        Schuler frequency, rad/s.
    course : Course
        With edges at `scheduled_times`.
    """
    last = law_form(method, omega_s)
    times = scheduled_times(method)
    if not times:
        return (last,), np.zeros(len(course.kind), dtype=np.int64)
    policy = method.policy
    first, final = np.array(getattr(policy, "from")), np.array(policy.to)  # pyright: ignore[reportAttributeAccessIssue]
    forms = []
    for stair in range(_STAIRS):
        share = (stair + 0.5) / _STAIRS
        k1, k2, k3 = (first + share * (final - first)).tolist()
        forms.append(feedback_form((k1, k2, k3), omega_s))
    middle = 0.5 * (course.t_s[:-1] + course.t_s[1:])
    return (*forms, last), np.searchsorted(np.array(times), middle)
