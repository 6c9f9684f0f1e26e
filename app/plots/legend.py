"""Legend entries that a click dims, hides or leaves out of the scale, and warnings about each method."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from navcore.foundation.text import Text

if TYPE_CHECKING:
    from navcore.engine.run import Run

Severity = Literal["error", "warning"]


def warnings_for(run: Run) -> dict[int, list[str]]:
    """Warnings of each method that has any: place in the scenario -> texts, an early end first."""
    texts = ((method.reason, *method.warnings) for method in run.methods)
    lists = (list(dict.fromkeys(text for text in own if text)) for own in texts)
    return {index: own for index, own in enumerate(lists) if own}


def severity(run: Run, index: int) -> Severity | None:
    """How serious a method's warnings are: an unstable or diverged one is an error; None without warnings."""
    method = run.methods[index]
    if not method.loop.stable or method.status == "diverged":
        return "error"
    return "warning" if method.warnings or method.reason else None


State = Literal["shown", "unscaled", "dimmed", "hidden"]
STATES: tuple[State, ...] = ("shown", "unscaled", "dimmed", "hidden")
"""In the order in which clicks go through them."""
COMMAND = "legend"
"""Name of the command that a click asks for, with the entry's key."""
_WORDS: dict[State, str] = {
    "shown": "",
    "unscaled": Text("off scale"),
    "dimmed": "dimmed",
    "hidden": "hidden",
}
_NEXT_WORDS: dict[State, str] = {
    "shown": Text("show it again"),
    "unscaled": Text("leave it out of the scale"),
    "dimmed": Text("dim it"),
    "hidden": Text("hide it"),
}
FAINT = "59"
"""Opacity of what is dimmed, as colours carry it."""


def after(state: State) -> State:
    """State to which a click leads."""
    return STATES[(STATES.index(state) + 1) % len(STATES)]


def counts(state: State) -> bool:
    """Whether scales and units are chosen with a curve in mind."""
    return state in ("shown", "dimmed")


def word(state: State) -> str:
    """Word of the legend for a state; empty for "shown"."""
    return _WORDS[state]


def hint(state: State) -> str:
    """Say what a click does."""
    return Text("Click: {next_words}", next_words=_NEXT_WORDS[after(state)])


def entry(key: str, name: str, bar: str, state: State) -> str:
    """HTML of an entry: a bar, the name, and what was done to it; a button.

    Parameters
    ----------
    key : str
        Of the curve, in `schuler_bench.session.display.Display.legend`.
    name : str
        As written.
    bar : str
        Style of the bar before it.
    state : State
        Of the curve.
    """
    said = Text('<small class="sb-said">{words}</small>', words=_WORDS[state]) if state != "shown" else ""
    return Text(
        '<button class="sb-entry" data-command="{command} {key:html}" data-state="{state}" '
        'title="{hint}"><span class="sb-line" style="{bar}"></span><span>{name:html}</span>'
        "{said}</button>",
        command=COMMAND,
        key=key,
        state=state,
        hint=hint(state),
        bar=bar,
        name=name,
        said=said,
    )
