"""How the value of a quantity of a method is known to be right, by the ledger of the tests."""

from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES
from navcore.quantities.known import WORDS, Way, known
from navcore.scenario.method import Method


def known_by(key: str, method: Method, fidelity: str) -> Way:
    """Best way in which a quantity is known for this kind of damping and where it is computed.

    Parameters
    ----------
    key : str
        A row of `navcore.quantities.QUANTITIES`.
    method : Method
        Its damping, and what holds its heading, count.
    fidelity : str
        Of the run.
    """
    row = QUANTITIES[key]
    where = "loop" if row.kind is None else "seeds" if row.over else fidelity
    return known(key, ledger_kind(method), where)


def ledger_kind(method: Method) -> str:
    """Kind of a method as `navcore.quantities.known.METHODS` has it.

    Examples
    --------
    >>> ledger_kind(Method(name="free"))
    'free'
    """
    if method.gyrocompass is not None:
        return "gyrocompass"
    return "whole" if method.azimuth.id != "none" else method.damping


def known_words(key: str, method: Method, fidelity: str) -> str:
    """Say how it is known; where not for this kind of damping and fidelity, how it is at best."""
    way = known_by(key, method, fidelity)
    if way != "none":
        return WORDS[way]
    at_best = known(key)
    if at_best == "none":
        return WORDS["none"]
    return Text("{way}, of another method or fidelity", way=WORDS[at_best])
