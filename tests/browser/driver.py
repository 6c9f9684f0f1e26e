"""Drives the dashboard's page as a user would, and reads what the page itself holds."""

import json
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import Any, Self, TypeVar
from weakref import WeakKeyDictionary

from playwright.sync_api import Error as PlaywrightError
from playwright.sync_api import Locator, Page

from navcore.foundation.text import Text
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.bridge.mends import pool_of
from schuler_bench.languages.wording import wording
from schuler_bench.session.display import Display
from schuler_bench.session.names import GivenNames
from schuler_bench.session.session import Session
from schuler_bench.session.sessions import Sessions
from schuler_bench.shell.layout import layout_for
from schuler_bench.shell.page import Page as OpenPage
from tests.browser.cases import SIZES
from tests.browser.choosing import Choosing
from tests.browser.fields import box_labels, slider_labels, words_of
from tests.browser.patience import GONE, PATIENCE_MS, SLOW, THROTTLE_MS

T = TypeVar("T")
_LABEL = re.compile(r"(.+?)( [≤≥])? \(([^()]*)\)")


def _has_callbacks(view: OpenPage) -> bool:
    """Whether something that a page has sent is still to be dealt with."""
    pool: Any = pool_of(view.client._viser_server)
    visitor = view.client.client_id
    return visitor in pool._waiting or visitor in pool._running


class Bench(Choosing):
    """The page of one visitor.

    Parameters
    ----------
    page : playwright Page
        Not yet opened.
    url : str
        Of the dashboard.
    sessions : Sessions or None
        Of the dashboard; None when it does not run in this process.

    Attributes
    ----------
    faults : list of str
        What the page's console complains of.
    size : tuple of int
        Window to which `clean` goes back.
    """

    def __init__(self, page: Page, url: str, sessions: Sessions | None) -> None:
        self.page = page
        self.url = url
        self.sessions = sessions
        self.faults: list[str] = []
        self.language, self.size = "en", SIZES[0]
        self._marks: WeakKeyDictionary[Any, Any] = WeakKeyDictionary()
        self._mark_numbers = count(1)
        page.set_default_timeout(PATIENCE_MS)
        page.add_init_script(path=Path(__file__).with_name("look.js"))
        if SLOW > 1.0:
            tools = page.context.new_cdp_session(page)
            tools.send("Emulation.setCPUThrottlingRate", {"rate": SLOW})
        page.on("pageerror", lambda error: self._note(str(error)))
        page.on("console", lambda m: self._note(m.text) if m.type == "error" else None)

    def _note(self, text: str) -> None:
        if not any(gone in text for gone in GONE):
            self.faults.append(text)

    def open(self, path: str = "", query: str = "?fixedDpr=0.25&start=no") -> Self:
        """Open the page (a new session without a path) without its start card, and wait for its first run."""
        self.page.goto(f"{self.url}{path}{query}")
        self.page.wait_for_selector("#sb-run[data-run]", state="attached")
        self.page.wait_for_selector(".uplot canvas, .js-plotly-plot .trace", state="attached")
        self.language = self.page.evaluate("() => schuler.language")
        self.close_notices()
        return self

    @property
    def session_id(self) -> str:
        """Id of the session, from the page's address."""
        return re.search(r"/s/([^/?]+)/", self.page.url)[1]

    @property
    def session(self) -> Session:
        """What the server keeps of this visitor."""
        assert self.sessions is not None
        return self.sessions.get(self.session_id)

    # ------------------------------------------------------------ acting

    # Tests name what is on the page in English, whatever its language is.

    def said(self, text: str) -> str:
        """What an English text of the page is called in the page's language; a label may end in a unit."""
        language = wording(self.language)
        if language is None:
            return text
        names = frozenset[str]() if self.sessions is None else GivenNames(self.session)()
        whole, parts = language.text(text, names), _LABEL.fullmatch(text)
        if isinstance(text, Text) or whole != text or parts is None:
            return whole
        label, sign, unit = parts.groups("")
        if sign:
            return f"{self.said(label)}{sign} ({unit})"
        return language.text(Text("{label} ({unit})", label=label, unit=unit), names)

    def button(self, name: str) -> Locator:
        """The button of this name."""
        return self.page.get_by_role("button", name=self.said(name), exact=True)

    def dialog(self, name: str) -> Locator:
        """The dialog of this title."""
        return self.page.get_by_role("dialog", name=self.said(name))

    # A control is named by its field's key in the scenario file, such as "network.xi" (tests.browser.fields);
    # one that stands for no field by its label.

    def id(self, name: str) -> str:
        """Id of a field's slider, or of its only control."""
        return self._id_of(slider_labels(name))

    def box_id(self, name: str) -> str:
        """Id of a field's box: that of the exact value beside a slider."""
        return self._id_of(box_labels(name))

    def _id_of(self, labels: list[str]) -> str:
        # a tab behind others may have a field of the same name
        script = """labels => [...document.querySelectorAll('label')]
          .filter(label => labels.includes(label.textContent))
          .sort((one, other) => (one.offsetParent === null) - (other.offsetParent === null))[0]
          ?.htmlFor ?? null"""
        labels = [self.said(label) for label in labels]
        self.page.wait_for_function(f"labels => ({script})(labels) !== null", arg=labels)
        return self.page.evaluate(script, labels)

    def slider(self, name: str) -> Locator:
        return self.page.locator(f"[id='{self.id(name)}'] [role=slider]")

    def box(self, name: str) -> Locator:
        return self.page.locator(f"input[id='{self.box_id(name)}']")

    def value(self, name: str) -> float:
        """Number in a field's box."""
        return float(self.box(name).input_value())

    def press(self, name: str, key: str = "ArrowRight") -> None:
        """Move a slider by a key and wait for the run that follows."""
        with self.next_run():
            self.slider(name).press(key)

    def type(self, name: str, text: str) -> None:
        """Type into a field's box and wait for the run that follows."""
        with self.next_run():
            self.box(name).fill(text)

    def choose(self, name: str, option: str) -> None:
        """Choose in a dropdown and wait until what follows is shown; a run need not follow."""
        self.box(name).click()
        words = self.said(words_of(name, option))
        self.page.get_by_role("option", name=words, exact=True).click()
        self.settle()

    def choose_and_run(self, name: str, option: str) -> None:
        with self.next_run():
            self.choose(name, option)

    def upload(self, file: Any) -> None:
        """Upload a path, or a mapping of name, mimeType and buffer."""
        self.page.locator("input[type=file]").set_input_files(file)

    def close_notices(self) -> None:
        # Not by the mouse: notices move while others close, which lets others come that waited for room.
        self.page.wait_for_function("look.noNotices", polling=THROTTLE_MS)

    # ------------------------------------------------------------ waiting and reading

    @property
    def run(self) -> int:
        """Number of the run that is shown."""
        return int(self.page.locator("#sb-run").get_attribute("data-run"))

    def wait_for_run(self, after: int) -> None:
        """Wait until a later run is shown."""
        later = "n => Number(document.querySelector('#sb-run').dataset.run) > n"
        self.page.wait_for_function(later, arg=after)
        self.page.evaluate("look.nextFrame")

    @contextmanager
    def next_run(self) -> Iterator[None]:
        """Wait until the run that follows what is done meanwhile is shown, and all that came with it."""
        number = self.run
        yield
        self.wait_for_run(number)
        self.settle()

    def wait_for_change(self, look: Callable[[], T], *before: T) -> T:
        """Wait until something stands still and differs from all that it was; return it."""
        last: list[T] = []

        def is_new() -> bool:
            last[:] = [*last[-1:], look()]
            return len(last) == 2 and last[0] == last[1] and last[0] not in before

        self.wait_until(is_new)
        return last[0]

    def wait_until(self, holds: Callable[[], bool], seconds: float = 60.0) -> None:
        """Wait, letting the page go on, until something holds on the server."""
        for _ in range(round(50 * seconds)):
            if holds():
                return
            self.page.wait_for_timeout(20)
        raise AssertionError(f"not within {seconds:g} s; {self.status!r}; {self.faults}")

    def reset(self, preset: str, *tabs: str, selected: int = 0) -> None:
        """Begin the visitor's session anew with a preset, tabs in front, without a click; wait for it."""
        self.put(load(preset), *tabs, origin=preset, selected=selected)

    def put(self, scenario: Scenario, *tabs: str, origin: str | None = None, selected: int = 0) -> None:
        """Give the visitor's session a scenario, without a click; wait until the page shows it."""
        session = self.session
        with session.lock:
            session.change(scenario, None, origin=origin, selected=selected)
            session.select(selected, None)
        self.catch_up()
        self.page.wait_for_function("look.opened")
        self.heard()
        self.close_notices()
        self.tab(*tabs)

    def show(self, **choices: object) -> None:
        """Change how the session's pictures are shown, without a click; wait until the page shows it."""
        self.session.show(None, **choices)
        self.catch_up()

    def select(self, index: int) -> None:
        """Take a edited method, without a click; wait until the page shows it."""
        self.session.select(index, None)
        self.catch_up()

    def clean(self) -> None:
        """Take back what an earlier test has left: files, dialogs, lessons, pins, choices, the window."""
        session = self.session
        session.uploads.clear()
        self.page.keyboard.press("Escape")
        session.present(None)
        session.verifier.cancel()
        session.verifier.forget()
        for pin in session.pins.all:
            session.pins.remove(pin.id)
        session.pins._next = 1
        if session.display != (plain := Display(places=session.display.places)):
            self.show(**dict(plain))
        if self.page.viewport_size != dict(zip(("width", "height"), self.size, strict=True)):
            self.resize(self.size)
        self.page.evaluate("look.clean")
        self.close_notices()
        self.faults.clear()

    def resize(self, size: tuple[int, int]) -> None:
        """Give the window another size and wait until the page is laid out anew."""
        width, height = size
        self.page.set_viewport_size({"width": width, "height": height})
        layout = layout_for(width, height)
        self.page.wait_for_function("look.laidOut", arg=[1 + layout.two, layout.right_px])
        self.heard()

    def settle(self) -> None:
        """Wait until what was done on the page has been sent, run and shown."""
        self.sent()
        if self.sessions is not None:  # else the server is in another process
            self.catch_up()

    def sent(self) -> None:
        """Wait until the server has dealt with what was done on the page: a command after it is answered."""
        # One that every page knows from the beginning, also one that has just come back: it resets no field.
        number = self.page.evaluate("() => { schuler.command('reset-named', ''); return schuler.asked(); }")
        self.page.wait_for_function("number => schuler.heard() >= number", arg=number)
        self.wait_until(lambda: not any(_has_callbacks(view) for view in self._pages))

    def catch_up(self) -> None:
        """Wait until the page shows the last run, and all that the server has sent.

        The page takes messages in their order, changes of widgets at the end of a frame: once it shows a mark
        that was sent last, by a change, it shows what was sent before.
        """
        assert self.session.wait_idle(60.0)
        shown = "n => Number(document.querySelector('#sb-run').dataset.run) === n"
        self.page.wait_for_function(shown, arg=self.session.run_number)
        self._receive()

    def heard(self) -> None:
        """Wait until the server knows window and front tabs, and the page holds what it sent for them."""
        self.page.wait_for_function("look.heard")
        if self.sessions is None:  # a server in another process
            return
        views = [view for view in self._pages if view._front]
        self.wait_until(
            lambda: all(
                view._layout == view.wanted_layout() and not view.column.stale(view._front) for view in views
            )
        )
        self._receive()

    @property
    def _pages(self) -> list[OpenPage]:
        """The server's side of all open pages of the session; none when it is in another process."""
        if self.sessions is None:
            return []
        return [view for view in self.session.pages.all if isinstance(view, OpenPage)]

    def _receive(self) -> None:
        number, session = f"{id(self)} {next(self._mark_numbers)}", self.session
        with session.lock:
            for view in self._pages:
                if view not in self._marks:
                    self._marks[view] = view.gui.add_html("", order=1000)
                self._marks[view].content = f'<div hidden data-mark="{number}"></div>'
                view.client.flush()
        self.page.wait_for_selector(f'[data-mark="{number}"]', state="attached")
        self.page.evaluate("look.nextFrame")

    def account(self) -> str:
        """What page and server hold, in lines: for the report of a failed test."""
        try:
            told = {"address": self.page.url, **self.page.evaluate("look.account")}
        except PlaywrightError as error:
            told = {"page": str(error).strip()}
        told["faults in the console"] = self.faults
        if self.sessions is not None and "/s/" in self.page.url:
            session, plain = self.session, Display()
            chosen = {name: value for name, value in session.display if value != getattr(plain, name)}
            told |= {
                "server: scenario": f"{session.origin}, methods {[m.name for m in session.scenario.method]}",
                "server: edited method": session.selected,
                "server: runs made": f"{session.run_number}{', one under way' * session.outdated}",
                "server: display": chosen,
            }
        return "\n".join(f"{name}: {value}" for name, value in told.items())

    @property
    def metrics(self) -> dict[str, Any]:
        """The numbers that the page carries."""
        return json.loads(self.page.locator("#sb-run").text_content())

    @property
    def digest(self) -> str | None:
        return self.page.locator("#sb-run").get_attribute("data-digest")

    @property
    def status(self) -> str:
        """The line about the run."""
        return self.page.locator("#sb-status").text_content() or ""

    @property
    def notes(self) -> list[str]:
        """Notes beside controls that are in view."""
        return [note.inner_text() for note in self.page.locator(".sb-note:visible").all()]

    def notice(self, text: str) -> str:
        """Wait for a notice with this text; return all of it."""
        found = self.page.locator(".mantine-Notification-root").filter(has_text=self.said(text)).first
        found.wait_for()
        return found.inner_text()

    def plotly(self) -> list[dict[str, Any]]:
        """Traces of the plotly figures in view, as plotly holds them, once they are those of the run."""
        self.page.wait_for_function("look.upToDate")
        return self.page.evaluate("look.plotly")

    def curves(self) -> list[dict[str, Any]]:
        """Error curves, as uPlot holds them."""
        return self.page.evaluate("look.uplot")

    def line(self, name: str) -> list[float] | None:
        """Points of a line in the 3D scene, as the page's scene tree holds them."""
        return self.page.evaluate("look.line", name)
