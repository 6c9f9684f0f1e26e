"""Start card with three doors, guided tour, scenarios and networks with pictures (start.js shows them)."""

from functools import lru_cache
from html import escape

from app.editing import edits
from app.shell import notices
from app.shell.view import Frame, Tab, View
from app.views.start.cards import card_path, network_cards
from navcore.networks import NETWORKS
from navcore.scenario.file import load, presets

START, TOUR, SCENARIOS, NETWORK_CARDS = "start", "tour", "scenarios", "networks"
"""Commands that show the card, the tour, and the two galleries."""
_ORDER = 14.5
"""Place in the left column: above the chooser of the scenario's text."""

_DOORS = (
    (
        "door-swing",
        "See an INS swing",
        "A Schuler pendulum and a ship's system side by side, in a lesson of five minutes.",
    ),
    (
        "door-tune",
        "Tune a network",
        "Three damping networks on one ship: move a slider and see every picture follow.",
    ),
    (
        "door-files",
        "Use my recordings",
        "NMEA 0183 or CSV from your ship, or a scenario file. They stay on this server.",
    ),
)
"""Command, title and sentence of each door."""

_STEPS: tuple[dict[str, str], ...] = (
    {
        "label": "scenario",
        "title": "Choose what is simulated",
        "text": "A scenario is a ship's motion, its sensors and a few damping methods. All methods run on "
        "the same truth, sensors and log, so that they can be compared.",
    },
    {
        "tab": "Method",
        "label": "network",
        "title": "Change a method",
        "text": "These controls belong to one method. Move a slider, or type a number: every picture follows "
        "at once. Ctrl+Z takes it back.",
    },
    {
        "tab": "Frequency",
        "find": ".js-plotly-plot",
        "title": "Frequency: what the network lets in",
        "text": "Left the network H. Right how much of an error comes through at each period. What damps "
        "faster lets in more of the log's noise.",
    },
    {
        "tab": "Errors",
        "find": ".sb-legend",
        "title": "Errors over time",
        "text": "One colour a method, in every picture. A click on a name leaves it out of the scale, dims "
        "or hides it.",
    },
    {
        "find": "#sb-stage .sb-bar",
        "title": "The ship in 3D",
        "text": "The dashed track is true, the coloured ones are computed. Press play, or the space bar: "
        "ship, pendulum and plots move together.",
    },
    {
        "tab": "Compare",
        "find": ".sb-no-pins, .sb-pins",
        "title": "Pin, then compare",
        "text": "P pins the present run as a baseline. Change something, then press B to flip between both. "
        "The tab Learn has lessons; Commands (Ctrl+K) finds everything.",
    },
)
"""Steps of the tour: the tab that it brings to the front, the control (by label) or element that it shows."""


class StartView(View):
    """Row of links below the scenario, and what they show."""

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        add, ask = frame.commands.register, frame.commands.ask_page
        add(START, lambda _: ask("start", ""), "Start card: three ways to begin", watcher=True)
        add(TOUR, lambda _: ask("tour", ""), "Guided tour in six steps", watcher=True)
        add(SCENARIOS, lambda _: self._show("Scenarios", _scenarios_html()), "Scenarios with pictures")
        add(
            NETWORK_CARDS,
            lambda _: self._show("Networks", self._networks_html()),
            "Networks with |H| and trade",
        )
        add("network", self._choose_network)
        add("door-swing", lambda _: self._swing())
        add("door-tune", lambda _: self._tune())
        add("door-files", lambda _: ask("tab", "Files"))

    def build(self, tab: Tab) -> None:
        """Make the row of links, and what start.js reads."""
        gui, session = self.frame.gui, self.session
        fresh = not session.restored and session.run is None
        with tab:
            gui.add_html(_LINKS, order=_ORDER)
            doors = "".join(
                f'<button class="sb-door" type="button" data-command="{command}"><b>{escape(title)}</b>'
                f"<span>{escape(text)}</span></button>"
                for command, title, text in _DOORS
            )
            steps = "".join(
                f'<div data-step="{number}" data-tab="{escape(step.get("tab", ""))}" '
                f'title="{escape(step.get("label", ""))}" data-find="{escape(step.get("find", ""))}">'
                f"<h2>{escape(step['title'])}</h2><p>{escape(step['text'])}</p></div>"
                for number, step in enumerate(_STEPS)
            )
            start = f'<div id="sb-start" hidden data-fresh="{int(fresh)}">{doors}{steps}</div>'
            gui.add_html(start, order=3)
            self._gallery = gui.add_html("", order=3)

    def _show(self, title: str, cards: str) -> None:
        """Let the page show a gallery."""
        named = f'data-title="{escape(title)}" title="{escape(title)}"'  # the first stays English
        self._gallery.content = f'<div id="sb-gallery" hidden {named}>{cards}</div>'
        self.frame.commands.ask_page("gallery", title)
        self.frame.client.flush()

    def _networks_html(self) -> str:
        scenario = self.session.scenario
        present = scenario.method[self.session.selected].network.id
        cards = "".join(
            f'<button class="sb-card" data-command="network {card.id}" '
            f'aria-pressed="{"true" if card.id == present else "false"}">'
            f"{card.svg}<b>{escape(card.title)}</b><span>{escape(card.trade)}</span></button>"
            for card in network_cards(scenario.omega_s)
        )
        about = "Each with its default parameters. A click gives it to the method that is edited."
        return f"<p>{about}</p><div class='sb-cards'>{cards}</div>"

    def _choose_network(self, id: str) -> None:
        if id not in NETWORKS:
            return
        session = self.session
        with (
            session.lock,
            notices.told(self.frame.client, "The network was refused", self.frame.refresh),
        ):
            path = ("method", session.selected, "network", "id")
            session.change(edits.with_choice(session.scenario, path, id), None)

    def _swing(self) -> None:
        """Open the first lesson, carry out its first step, and let time run."""
        run = self.frame.commands.run
        run("lesson", "open 0")
        run("lesson", "show")
        self.frame.commands.ask_page("tab", "Learn")
        self.session.after_run(lambda: run("play"))

    def _tune(self) -> None:
        self.frame.opening.choose_scenario("liu-networks")
        self.frame.commands.ask_page("tab", "Method")
        self.frame.commands.ask_page("tour", "1")


@lru_cache(maxsize=1)
def _scenarios_html() -> str:
    cards = ""
    for name in presets():
        path, scenario = card_path(name), load(name)
        picture = path.read_text(encoding="utf-8") if path.exists() else ""
        cards += (
            f'<button class="sb-card" data-command="preset-{name}">{picture}<b>{escape(name)}</b>'
            f"<span>{escape(scenario.title)}.</span></button>"
        )
    about = "The curves are the velocity error of each method in the scenario's own run."
    return f"<p>{about}</p><div class='sb-cards'>{cards}</div>"


_LINKS = (
    '<nav class="sb-links" aria-label="Help">'
    f'<button data-command="{SCENARIOS}" title="All scenarios with pictures">Scenarios</button>'
    f'<button data-command="{NETWORK_CARDS}" title="All networks: |H| and trade">Networks</button>'
    f'<button data-command="{TOUR}" title="The page in six steps">Tour</button>'
    '<button data-command="tab Learn" title="Lessons of five minutes">Learn</button>'
    f'<button data-command="{START}" title="The card that a new visitor sees">Start</button></nav>'
)

VIEW = StartView
