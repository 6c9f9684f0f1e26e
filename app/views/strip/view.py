"""Strip of results below the top bar: a card a method; the legend of all pictures."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

from navcore.engine.measures import measure
from navcore.engine.run import ENDINGS, MethodRun, Run
from navcore.foundation.notation import with_unit
from navcore.foundation.text import Text
from navcore.quantities import QUANTITIES, components
from navcore.scenario.own_ins import AS_RECORDED
from navcore.scenario.stochastic import drawn_as_zero
from schuler_bench.plots import style
from schuler_bench.plots.legend import COMMAND, hint, word
from schuler_bench.plots.units import (
    Unit,
    angle_unit,
    length_unit,
    relative,
    rounded,
    settling,
    speed_unit,
    wanted_unit,
)
from schuler_bench.session.display import Display
from schuler_bench.session.requirements import asked
from schuler_bench.session.shown import Shown, window_of
from schuler_bench.shell.view import Frame, Tab, View

EDIT = "edit-method"
"""Name of the command of a card, with the place of its method."""
_SETTLING = "settling_s"
_SHOWN = {
    "tilt_max_arcsec": (Text("max tilt"), "angle", angle_unit),
    "velocity_max_mps": (Text("max velocity"), "speed", speed_unit),
    "position_max_m": (Text("max position"), "length", length_unit),
    _SETTLING: (Text("settles"), "", None),
}
"""Quantity -> its short name, and the choice of the display and the function that give its unit.

Of all errors the same statistic, the largest length of the run.
"""


class StripView(View):
    """Cards of the methods of the run that is shown; a click lets the controls edit the method."""

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        self._found: Shown | None = None
        self._shown: tuple[Shown | None, int] = (None, 0)
        frame.commands.register(EDIT, self._edit)

    def build(self, tab: Tab) -> None:
        """Make the place of the strip."""
        with tab:
            self._cards = self.frame.gui.add_html(strip_html(None, 0), order=5)

    def _edit(self, place: str) -> None:
        """Let the controls edit a method."""
        if place.isascii() and place.isdecimal() and int(place) < len(self.session.scenario.method):
            self.session.select(int(place), None)
            self.frame.commands.ask_page("front", Text("Method"))

    def follow_scenario(self) -> None:
        """Mark the card of the method that is edited now."""
        found, selected = self._found, self.session.selected
        if found is not self._shown[0] or selected != self._shown[1]:
            self._shown, self._cards.content = (found, selected), strip_html(found, selected)

    def draw(self, found: Shown) -> None:
        """Show the results of a run."""
        self._found = found
        self.follow_scenario()


_UNFOLD = Text(
    '<button class="sb-unfold" data-command="tab Metrics" '
    'title="All numbers of the run: Metrics (tab Errors)" aria-label="All numbers of the run">▾</button>'
)
"""Behind the cards: the table of which they are the first numbers."""


def strip_html(found: Shown | None, selected: int) -> str:
    """HTML of the strip.

    Parameters
    ----------
    found : Shown or None
        What the pictures show; None before the first run.
    selected : int
        Place of the edited method.
    """
    cards = "" if found is None else Text.joined("", (*_cards(found, selected), _UNFOLD))
    return Text(
        '<div id="sb-strip" role="group" aria-label="Results of the methods">{cards}</div>', cards=cards
    )


def _cards(found: Shown, selected: int) -> Iterator[str]:
    run, display = found.run, found.display
    part = window_of(run, display).run
    limits = asked(run, run.scenario.requirement)
    units = _units(part.lines, display)
    recorded = None if part.against is None else part.against.recorded
    if recorded is not None:
        yield _recorded_card(recorded, display, units)
    for place, method in enumerate(part.methods):
        name, state = method.method.name, display.state_of(method.method.name)
        facts = [*_numbers(method, _before(found, name), units)]
        if limits:  # the verdict first: where a card has no room for all, the last ones are left out
            words = [(verdict.words[place], verdict.quantity.label) for verdict in limits]
            facts.insert(0, _met(words, drawn_as_zero(run.scenario)))
        ended = Text.joined(", ", [words for words in (ENDINGS.get(method.status, ""), word(state)) if words])
        said = Text("<i>{words}</i>", words=ended) if ended else ""
        yield Text(
            '<div class="sb-result" data-state="{state}" data-edited="{pressed}" '
            'style="--color:{color}"><button class="sb-tint" '
            'data-command="{legend} {name:html}" title="{hint}" aria-label="{name:html}: {hint}"></button>'
            '<button class="sb-edit" data-sb-drops data-command="{edit} {place}" aria-pressed="{pressed}" '
            'title="Edit {name:html}"><b>{name:html}</b>{said}{facts}</button></div>',
            state=state,
            color=style.method_color(method.place),
            legend=COMMAND,
            hint=hint(state),
            edit=EDIT,
            place=place,
            pressed="true" if place == selected else "false",
            name=name,
            said=said,
            facts=Text.joined("", facts),
        )


def _recorded_card(method: MethodRun, display: Display, units: Mapping[str, Unit]) -> str:
    """Card of an INS as it was recorded: there is nothing of it to edit."""
    state = display.state_of(method.method.name)
    said = Text("<i>{words}</i>", words=word(state)) if word(state) else ""
    return Text(
        '<div class="sb-result" data-state="{state}" data-edited="false" style="--color:{color}">'
        '<button class="sb-tint" data-command="{legend} {name:html}" title="{hint}" '
        'aria-label="{shown:html}: {hint}"></button>'
        '<span class="sb-edit" data-sb-drops><b>{shown:html}</b>{said}{facts}</span></div>',
        state=state,
        color=style.method_color(method.place),
        legend=COMMAND,
        name=method.method.name,
        shown=AS_RECORDED,
        hint=hint(state),
        said=said,
        facts=Text.joined("", _numbers(method, None, units)),
    )


def known(method: MethodRun, key: str) -> bool:
    """Whether a reference tells a method's error, as in every run but one on a ship's own INS."""
    kind = QUANTITIES[key].kind
    names = () if kind is None else components(kind)
    return not any(math.isnan(method.errors[name]["rms"]) for name in names)


def _before(found: Shown, name: str) -> MethodRun | None:
    """Find the method of the same name in the pinned run with which this one is compared."""
    pinned: Run | None = None if found.baseline is None else found.baseline.run
    if pinned is None:
        return None
    methods = window_of(pinned, found.display).run.methods
    return next((method for method in methods if method.method.name == name), None)


def _units(methods: Sequence[MethodRun], display: Display) -> dict[str, Unit]:
    """Unit of each quantity, the same on all cards: what suits the largest finite value."""
    units: dict[str, Unit] = {}
    for key, (_, choice, suitable) in _SHOWN.items():
        if suitable is not None:
            values = (measure(method, key) for method in methods if known(method, key))
            peak = max((value for value in values if math.isfinite(value)), default=0.0)
            units[key] = wanted_unit(getattr(display, choice), peak, suitable)
    return units


def _numbers(method: MethodRun, before: MethodRun | None, units: Mapping[str, Unit]) -> Iterator[str]:
    """Each quantity with its unit, and by how much it differs from the pinned run's."""
    for key, (label, _, suitable) in _SHOWN.items():
        value = measure(method, key)
        if suitable is None:
            text = settling(value) if method.loop.stable else Text("unstable")
        else:
            unit = units[key]
            text = with_unit(rounded(value / unit.si), unit.name) if known(method, key) else "n/a"
        change = _change(value, before, key)
        words = {"label": QUANTITIES[key].label, "what": QUANTITIES[key].help, "change": change}
        title = (
            Text("{label}: {what} {change} since the pin.", **words)
            if change
            else Text("{label}: {what}", **words)
        )
        yield _number(label, title, text, change)


def _change(value: float, before: MethodRun | None, key: str) -> str:
    old = math.nan if before is None else measure(before, key)
    if not (math.isfinite(old) and math.isfinite(value) and old):
        return ""
    return relative(value, old)


def _met(found: list[tuple[str, str]], zero: tuple[str, ...]) -> str:
    missed = [label for word, label in found if word == "missed"]
    unknown = [label for word, label in found if word == "open"]
    met = len(found) - len(missed) - len(unknown)
    words, which = Text("{met} of {count}", met=met, count=len(found)), Text.joined(", ", missed)
    told = Text("misses {which}", which=which) if missed else Text("meets all limits")
    if unknown:
        names = Text.joined(", ", unknown)
        still = Text("open, for seeds judge it: {names}", names=names)
        told = Text("{told}; {still}", told=told, still=still) if missed else still
    if zero:
        told = Text("{told}; drawn as 0 in this run: {fields}", told=told, fields=", ".join(zero))
    look = "sb-missed" if missed else "sb-open" if unknown else "sb-met"
    return _number(
        Text("limits met"), told, Text('<span class="{look}">{words}</span>', look=look, words=words)
    )


def _number(label: str, title: str, text: str, change: str = "") -> str:
    return Text(
        '<span class="sb-fact" title="{title:html}"><small>{label}</small><span>{text}{change}</span></span>',
        title=title,
        label=label,
        text=text,
        change=change and f"<i>{change}</i>",
    )


VIEW = StripView
