"""Start card with four doors, guided tour, scenarios and networks with pictures (start.js shows them)."""

from functools import lru_cache

from navcore.foundation.text import Text
from navcore.networks import NETWORKS
from navcore.questions.design import DesignQuestion
from navcore.scenario.file import load, presets
from schuler_bench.editing import edits
from schuler_bench.shell import notices
from schuler_bench.shell.view import Frame, Tab, View
from schuler_bench.views.start.cards import card, network_cards
from schuler_bench.views.start.ship import SEND, TITLE, form_html, scenario_for

START, TOUR, SCENARIOS, NETWORK_CARDS = "start", "tour", "scenarios", "networks"
"""Commands that show the card, the tour, and the two galleries."""
_DOORS = (
    (
        "door-swing",
        Text("See an INS swing"),
        Text("A Schuler pendulum and a ship's system side by side, in a lesson of five minutes."),
    ),
    (
        "door-tune",
        Text("Tune a network"),
        Text("Three damping networks on one ship: move a slider and see every picture follow."),
    ),
    (
        "door-files",
        Text("My ship's INS"),
        Text(
            "Drop what your INS and your log recorded, NMEA 0183 or CSV: see what damping would have "
            "changed. Files stay on this server."
        ),
    ),
    (
        "door-limits",
        TITLE,
        Text(
            "Name your sensors and your log, type your limits: see which damping meets them, and how often."
        ),
    ),
)
"""Command, title and sentence of each door."""

_STEPS: tuple[dict[str, str], ...] = (
    {
        "label": "scenario",
        "title": Text("Choose what is simulated"),
        "text": Text(
            "A scenario is a ship's motion, its sensors and a few damping methods. All methods run on "
            "the same truth, sensors and log, so that they can be compared."
        ),
    },
    {
        "tab": Text("Method"),
        "label": "network",
        "title": Text("Change a method"),
        "text": Text(
            "These controls belong to one method. Move a slider, or type a number: every picture follows "
            "at once. Ctrl+Z takes it back."
        ),
    },
    {
        "tab": Text("Frequency"),
        "find": ".js-plotly-plot",
        "title": Text("Frequency: what the network lets in"),
        "text": Text(
            "Left the network H. Right how much of an error comes through at each period. What damps "
            "faster lets in more of the log's noise."
        ),
    },
    {
        "tab": Text("Errors"),
        "find": "#sb-strip",
        "title": Text("Results and errors"),
        "text": Text(
            "A card a method, with its colour in every picture. A click lets the controls edit it; one on "
            "its dot leaves it out of the scale, dims or hides it."
        ),
    },
    {
        "find": "#sb-stage .sb-bar",
        "title": Text("The ship in 3D"),
        "text": Text(
            "The dashed track is true, the coloured ones are computed. Press play, or the space bar: "
            "ship, pendulum and plots move together."
        ),
    },
    {
        "tab": Text("Compare"),
        "find": ".sb-no-pins, .sb-pins",
        "title": Text("Pin, then compare"),
        "text": Text(
            "P pins the present run as a baseline. Change something, then press B to flip between both. "
            "The tab Learn has lessons; Commands (Ctrl+K) finds everything."
        ),
    },
)
"""Steps of the tour: the tab that it brings to the front, the control (by label) or element that it shows."""


class StartView(View):
    """Menu of the top bar, and what it shows."""

    def __init__(self, frame: Frame) -> None:
        super().__init__(frame)
        add, ask = frame.commands.register, frame.commands.ask_page
        add(START, lambda _: ask("start", ""), Text("Start card: four ways to begin"), watcher=True)
        add(TOUR, lambda _: ask("tour", ""), Text("Guided tour in six steps"), watcher=True)
        add(
            SCENARIOS,
            lambda _: self._show(Text("Scenarios"), _scenarios_html()),
            Text("Scenarios with pictures"),
        )
        add(
            NETWORK_CARDS,
            lambda _: self._show(Text("Networks"), self._networks_html()),
            Text("Networks with |H| and trade"),
        )
        add("network", self._choose_network)
        add("door-swing", lambda _: self._swing())
        add("door-tune", lambda _: self._tune())
        add("door-limits", lambda _: self._show(TITLE, form_html()))
        add(SEND, self._find_designs)
        add("door-files", lambda _: ask("tab", Text("Files")))

    def build(self, tab: Tab) -> None:
        """Make the menu of the top bar, and what start.js reads."""
        gui, session = self.frame.gui, self.session
        fresh = not session.restored and session.run is None
        with self.frame.bar:
            gui.add_html(_MENU, order=50)
        with tab:
            doors = Text.joined(
                "",
                (
                    Text(
                        '<button class="sb-door" type="button" '
                        'data-command="{command}"><b>{title:html}</b><span>'
                        "{text:html}</span></button>",
                        command=command,
                        title=title,
                        text=text,
                    )
                    for command, title, text in _DOORS
                ),
            )
            steps = Text.joined(
                "",
                (
                    Text(
                        '<div data-step="{number}" data-tab="{tab:html}" title="{label:html}" '
                        'data-find="{find:html}"><h2>{title:html}</h2><p>{text:html}</p></div>',
                        number=number,
                        tab=step.get("tab", ""),
                        label=step.get("label", ""),
                        find=step.get("find", ""),
                        title=step["title"],
                        text=step["text"],
                    )
                    for number, step in enumerate(_STEPS)
                ),
            )
            start = Text(
                '<div id="sb-start" hidden data-fresh="{fresh}">{doors}{steps}</div>',
                fresh=int(fresh),
                doors=doors,
                steps=steps,
            )
            gui.add_html(start, order=3)
            self._gallery = gui.add_html("", order=3)

    def _show(self, title: str, cards: str) -> None:
        """Let the page show a gallery."""
        self._gallery.content = Text(
            '<div id="sb-gallery" hidden data-title="{title:html}" title="{title:html}">{cards}</div>',
            title=title,
            cards=cards,
        )
        self.frame.commands.ask_page("gallery", title)
        self.frame.client.flush()

    def _networks_html(self) -> str:
        scenario = self.session.scenario
        present = scenario.method[self.session.selected].network.id
        cards = Text.joined(
            "",
            (
                Text(
                    '<button class="sb-card" data-command="network {id}" aria-pressed="{value}">{svg}<b>'
                    "{title:html}</b><span>{trade:html}</span></button>",
                    id=card.id,
                    value="true" if card.id == present else "false",
                    svg=card.svg,
                    title=card.title,
                    trade=card.trade,
                )
                for card in network_cards(scenario.omega_s)
            ),
        )
        about = Text("Each with its default parameters. A click gives it to the method that is edited.")
        return Text("<p>{about}</p><div class='sb-cards'>{cards}</div>", about=about, cards=cards)

    def _choose_network(self, id: str) -> None:
        if id not in NETWORKS:
            return
        session = self.session
        with (
            session.lock,
            notices.told(self.frame.client, Text("The network was refused"), self.frame.refresh),
        ):
            path = ("method", session.selected, "network", "id")
            session.change(edits.with_choice(session.scenario, path, id), None)

    def _swing(self) -> None:
        """Open the first lesson, carry out its first step, and let time run."""
        run = self.frame.commands.run
        run("lesson", "open 0")
        run("lesson", "show")
        self.frame.commands.ask_page("tab", Text("Learn"))
        self.session.after_run(lambda: run("play"))

    def _find_designs(self, text: str) -> None:
        """Open a ship with the entered sensors and limits, and have designs found for them."""
        session = self.session
        with session.lock, notices.told(self.frame.client, TITLE, self.frame.refresh):
            scenario = scenario_for(text, session.scenario)
            session.change(scenario, None, origin=TITLE, selected=0)
            self.frame.show(budget="limits")
            session.searches.asking["design"].begin(DesignQuestion(scenario=scenario))
            self.frame.commands.ask_page("tab", Text("Design"))

    def _tune(self) -> None:
        self.frame.opening.choose_scenario("liu-networks")
        self.frame.commands.ask_page("tab", Text("Method"))
        self.frame.commands.ask_page("tour", "1")


@lru_cache(maxsize=1)
def _scenarios_html() -> str:
    cards = ""
    for name in presets():
        picture, scenario = card(name), load(name)
        cards += Text(
            '<button class="sb-card" data-command="preset-{name}">{picture}<b>{name:html}</b><span>'
            "{title:html}.</span></button>",
            name=name,
            picture=picture,
            title=scenario.title,
        )
    about = Text("The curves are the velocity error of each method in the scenario's own run.")
    return Text("<p>{about}</p><div class='sb-cards'>{cards}</div>", about=about, cards=cards)


_MENU = Text(
    '<div data-sb-part="menu"><button class="sb-do sb-gear" popovertarget="sb-menu" aria-label="Menu" '
    'title="Scenarios, help, settings">☰</button><nav id="sb-menu" class="sb-links" popover '
    'aria-label="Help"><button data-command="{scenarios}" title="All '
    'scenarios with pictures">Scenarios</button><button data-command="{network_cards}" '
    'title="All networks: |H| and trade">Networks</button><button data-command="{tour}" '
    'title="The page in six steps">Tour</button><button data-command="tab Learn" '
    'title="Lessons of five minutes">Learn</button><button data-command="{start}" title="The '
    'card that a new visitor sees">Start</button><hr><button data-command="tab Files" '
    'title="Recordings of your own, and what can be saved">Files</button><button data-command="tab Scenario" '
    'title="The scenario as a file">Scenario file</button><button data-command="tab Misprints" '
    'title="What a paper prints beside what its figures say">Misprints</button><button '
    'data-command="tab Ask" title="Questions to this scenario">Ask</button><hr><button '
    'data-command="tab View" title="Units, bands, export, language, dark page, size">View</button><button '
    'data-command="keys" title="What the keys do">Keys</button><button data-viewer '
    'title="Of the 3D view itself; again to go back">3D settings</button></nav></div>',
    scenarios=SCENARIOS,
    network_cards=NETWORK_CARDS,
    tour=TOUR,
    start=START,
)

VIEW = StartView
