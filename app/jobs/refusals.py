"""Why a search has no proposal: boxes and names of the page in place of options and keys."""

from collections.abc import Mapping

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from navcore.questions.base import Question, flag_of
from schuler_bench.jobs.words import for_a_page
from schuler_bench.plots.limits import amount, limit_words


def refusals(error: InputError, question: type[Question]) -> tuple[str, ...]:
    """One sentence a fault; a field of the question is named as the box in which the page shows it."""
    boxes = {flag_of(one.name): one.label for one in question.options()}
    return tuple(_sentence(fault, boxes) for fault in for_a_page(error).faults)


def _sentence(fault: Fault, boxes: Mapping[str, str]) -> str:
    reason = spoken(fault.allowed)
    if isinstance(fault.value, Text) and "limited" in fault.value.values:
        return Text("Limit {limit}: {reason}.", limit=spoken(fault.value), reason=reason)
    box = boxes.get(fault.field)
    return str(fault) if box is None else Text("Box “{box}”: {reason}.", box=box, reason=reason)


def spoken(text: str) -> str:
    """Replace the keys of quantities in a text by their names on the page, and their values by its units.

    Examples
    --------
    >>> spoken(Text("{name} comes to", name="settling_s"))
    'settling comes to'
    """
    if not isinstance(text, Text):
        return QUANTITIES[text].label if text in QUANTITIES else text
    values = text.values
    if "limited" in values:
        return limit_words(values["limited"], values["si"])
    if "quantity" in values and "si" in values:
        return amount(values["quantity"], values["si"])
    said = {name: spoken(value) if isinstance(value, str) else value for name, value in values.items()}
    return Text(*text.forms, **said)
