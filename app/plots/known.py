"""The mark beside a number that says how it is known to be right."""

from navcore.engine.known_by import known_by, known_words
from navcore.engine.run import Run
from navcore.foundation.text import Text
from navcore.quantities.known import MARKS, sources
from navcore.scenario.method import Method
from schuler_bench.plots.table import cell


def known_mark(key: str, method: Method, fidelity: str) -> str:
    """Mark of a quantity of a method, with the words and the oracles beneath the pointer."""
    way = known_by(key, method, fidelity)
    words = known_words(key, method, fidelity)
    hint = Text("How it is known: {words}", words=words)
    if way == "oracle":
        hint = Text("{hint} ({sources})", hint=hint, sources=Text.joined("; ", sources(key)))
    return cell(MARKS[way], "sb-known", tag="span", title=hint)


def known_marks(key: str, run: Run) -> str:
    """Marks of a quantity of all methods of a run, one where they are alike."""
    fidelity = run.scenario.run.fidelity
    marks = [known_mark(key, one.method, fidelity) for one in run.methods]
    return Text.joined("", dict.fromkeys(marks))
