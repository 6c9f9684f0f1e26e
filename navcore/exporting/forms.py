"""How a method is exported, by the way it is carried out."""

from collections.abc import Callable

from navcore.damping.base import Carrying
from navcore.exporting.averaging_form import averaging_form
from navcore.exporting.filter_form import filter_form
from navcore.exporting.form import Form
from navcore.exporting.law_form import law_form
from navcore.exporting.outside_form import outside_form
from navcore.exporting.subject import Subject
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.scenario.method import Method

FORMS: dict[Carrying, Callable[[Subject], Form]] = {
    "law": law_form,
    "filter": filter_form,
    "copies": averaging_form,
}
"""How a form is made, by the way a method is carried out."""


def form_of(subject: Subject, outside: bool = False) -> Form:
    """Make the form of a method; ``outside`` for a box beside an INS."""
    _refuse_added(subject.method)
    return outside_form(subject) if outside else FORMS[subject.method.kind.carrying](subject)


def _refuse_added(method: Method) -> None:
    """Refuse a policy or switching method that came from outside the program: its source is not read."""
    if method.kind.carrying == "user":
        allowed = Text("is from outside the program: a law with it cannot be exported")
        raise InputError(Fault("", "damping", method.damping, allowed))
    for name, kinds in (("policy", POLICIES), ("switching", SWITCHINGS)):
        id = getattr(method, name).id
        if method.kind.carrying == "law" and id not in kinds.own:
            allowed = Text("is from outside the program: a law with it cannot be exported")
            raise InputError(Fault("", f"{name}.id", id, allowed))
