"""Compiled choice between the functions of a registry, made from the registry itself."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from navcore.foundation.compiled import inlined


class Choice(NamedTuple):
    """One entry of a registry as the compiled law knows it.

    Attributes
    ----------
    number : int
        Place in the registry.
    id : str
        Name in the registry, and of its own records.
    function : compiled function
        ``function(own, memory, law, *inputs)`` with its own parameters and state.
    """

    number: int
    id: str
    function: Any


def dispatch(part: str, choices: Sequence[Choice], otherwise: Any) -> Any:
    """Compile ``call(number, law, *inputs)``, which calls the function of that number.

    Parameters
    ----------
    part : str
        Field of parameters and state that holds the entries' own records.
    choices : sequence of Choice
        The functions.
    otherwise
        What the call gives where no choice has that number.
    """
    if not choices:

        @inlined
        def none_left(number, law, *inputs):
            return otherwise

        return none_left
    mine, name, function = choices[0]
    rest = dispatch(part, choices[1:], otherwise)

    @inlined
    def call(number, law, *inputs):
        if number == mine:
            return function(law.p[part][name], law.s[part][name], law, *inputs)
        return rest(number, law, *inputs)

    return call
