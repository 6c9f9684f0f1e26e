"""How a method is exported, by the way it is carried out."""

from collections.abc import Callable

from navcore.damping.base import Carrying
from navcore.exporting.averaging_form import averaging_form
from navcore.exporting.filter_form import filter_form
from navcore.exporting.form import Form
from navcore.exporting.law_form import law_form
from navcore.exporting.outside_form import outside_form
from navcore.exporting.subject import Subject

FORMS: dict[Carrying, Callable[[Subject], Form]] = {
    "law": law_form,
    "filter": filter_form,
    "copies": averaging_form,
}
"""How a form is made, by the way a method is carried out."""


def form_of(subject: Subject, outside: bool = False) -> Form:
    """Make the form of a method; ``outside`` for a box beside an INS."""
    return outside_form(subject) if outside else FORMS[subject.method.kind.carrying](subject)
