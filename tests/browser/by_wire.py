"""A page without a browser: what a visitor is sent over the websocket, its controls and its pictures."""

import json
import re
import time
from collections import Counter
from contextlib import suppress
from typing import Any

from navcore.scenario.model import Scenario
from schuler_bench.bench.visitor import decoded
from schuler_bench.editing.typed import write_number
from schuler_bench.shell.page import Page
from schuler_bench.shell.reports import PAGE_STATE
from tests.attack.conftest import eventually
from tests.attack.wire import Visitor
from tests.browser.conftest import Served
from tests.browser.fields import box_labels, slider_labels, words_of

WIDE = "1920x1080|Method|Frequency|Errors"


def is_run(message: dict[str, Any]) -> bool:
    content = (message.get("updates") or {}).get("content")
    return isinstance(content, str) and content.startswith('<div id="sb-run"')


def runs(visitor: Visitor, seconds: float) -> list[dict[str, Any]]:
    """All runs that come within a time."""
    until = time.monotonic() + seconds
    with suppress(TimeoutError):
        while (left := until - time.monotonic()) > 0.0:
            visitor.received += decoded(visitor.socket.recv(timeout=left))
    return [message for message in visitor.received if is_run(message)]


def number(message: dict[str, Any]) -> int:
    return int(re.search(r'data-run="(\d+)"', message["updates"]["content"])[1])


def ready(visitor: Visitor, state: str = WIDE) -> None:
    visitor.set(visitor.control(PAGE_STATE), state)
    visitor.wait_for(is_run, 60.0)


def named(dashboard: Served, id: str) -> str:
    """Let there be a session of that name: a websocket alone cannot choose one."""
    dashboard[1].sessions.get(id)
    return id


def open_pages(served: Any, session_id: str) -> list[Page]:
    """Open pages of a session: one is listed once it is built, just after its first run is sent."""
    return [page for page in list(served._pages.values()) if page.session.id == session_id]


FIGURE, CURVES, TRACK = "_plotly_json_str", "data", "points"
"""What holds a plotly figure, a plot over time and a line in 3D in viser's messages."""
ALL = {FIGURE, CURVES, TRACK}


class Wire:
    """A page without a browser, on a scenario of its own: its controls, and which pictures it is sent."""

    def __init__(self, visitor: Visitor, page: Page) -> None:
        self.visitor, self.page, self.session = visitor, page, page.session
        self.controls: dict[str, dict[str, Any]] = {}
        self.moved: Counter[str] = Counter()
        self.texts: dict[Any, str] = {}
        self._held: dict[str, Any] = {}
        self._values: dict[str, Any] = {}
        self._run = self._mark = 0

    def put(self, scenario: Scenario, *, selected: int = 0, front: str = WIDE) -> None:
        """Begin anew with a scenario, and these tabs in front."""
        self.visitor.set(self.page._reports.window_id, front)
        with self.session.lock:
            self.session.change(scenario, None, selected=selected)
            self.session.select(selected, None)
        self.catch_up()

    def catch_up(self) -> None:
        """Wait for all that the server sends of the present run: a mark that is sent last has come."""
        assert self.session.wait_idle(60.0)
        if (wanted := self.session.run_number) != self._run:
            self.visitor.wait_for(lambda message: is_run(message) and number(message) == wanted, 60.0)
        self._run, self._mark = wanted, self._mark + 1
        self.page.gui.add_html(f"mark {self._mark}", order=1000)
        self.page.client.flush()
        self.visitor.wait_for(lambda m: (m.get("props") or {}).get("content") == f"mark {self._mark}", 60.0)
        self.moved.clear()
        for message in self.visitor.received:
            self._take(message)
        self.visitor.received.clear()

    def _take(self, message: dict[str, Any]) -> None:
        about = message.get("props") or message.get("updates") or {}
        key = message.get("uuid") or message.get("name")
        self._values[key] = (message.get("updates") or message).get("value", self._values.get(key))
        self.texts[key] = str(about.get("content"))
        if "label" in about and "uuid" in message:
            self.controls[about["label"]] = message
        if message["type"] == "GuiRemoveMessage":
            self.controls = {label: made for label, made in self.controls.items() if made["uuid"] != key}
        # Of the curves those that have not changed are left out, and lines in 3D are not sent at all.
        self.moved[CURVES] += any(curve is not None for curve in about.get(CURVES, ())[1:])
        self.moved[TRACK] += TRACK in about and str(key).startswith("/track/method")
        if FIGURE in about:
            figure = json.loads(about[FIGURE])
            figure["layout"].pop("meta", None)  # the number of the run
            self.moved[FIGURE] += self._held.get(key) != figure
            self._held[key] = figure

    def named(self, labels: list[str]) -> str:
        """The label of a control under which the page has it."""
        eventually(lambda: self.catch_up() or set(labels) & self.controls.keys(), 60.0)
        return next(label for label in labels if label in self.controls)

    def set(self, name: str, value: Any, *, exact: bool = True) -> Counter[str]:
        """Set a control of a field; return how many pictures of each kind changed."""
        label = self.named(box_labels(name) if exact else slider_labels(name))
        number, uuid = self.session.run_number, self.controls[label]["uuid"]
        number_box = exact and isinstance(value, int | float) and not isinstance(value, bool)
        self._values[uuid] = write_number(value) if number_box else words_of(name, value)
        self.visitor.set(uuid, self._values[uuid])
        eventually(lambda: self.session.run_number > number, 60.0)
        self.catch_up()
        return +self.moved

    def slide(self, name: str) -> Counter[str]:
        """Move the slider of a field by a step, as a key does."""
        label = self.named(slider_labels(name))
        control = self.controls[label]
        value, step = self._values[control["uuid"]], control["props"]["step"]
        up = value + step <= control["props"]["max"]
        return self.set(name, value + step if up else value - step, exact=False)
