"""Firefox as Debian has it, driven over WebDriver BiDi: playwright drives none but its own."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import time
from base64 import b64decode
from collections.abc import Mapping
from itertools import count
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from websockets.sync.client import connect

from tests.browser.patience import PATIENCE_MS

FIREFOX = shutil.which("firefox-esr") or shutil.which("firefox")
"""The installed Firefox; None where there is none."""
_LISTENS = re.compile(r"WebDriver BiDi listening on (\S+)\n")
_KEEP_FAULTS = """() => {
  const faults = window.faults = [];
  addEventListener("error", ({message}) => message && faults.push(message));
  addEventListener("unhandledrejection", event => setTimeout(
    () => event.defaultPrevented || faults.push(String(event.reason))));
}"""
NO_WEBGL = "A WebGL context could not be created"
"""What viser's page says of a machine without it; the page comes without its 3D view."""


class Firefox:
    """A headless Firefox with one page.

    Parameters
    ----------
    folder : Path
        Empty, for the profile.
    width, height : int
        Of the window, px.
    settings : mapping of str to bool, int or str, optional
        Of about:config.
    """

    def __init__(
        self, folder: Path, width: int, height: int, settings: Mapping[str, Any] | None = None
    ) -> None:
        lines = (f"user_pref({json.dumps(k)}, {json.dumps(v)});\n" for k, v in (settings or {}).items())
        (folder / "user.js").write_text("".join(lines))
        command = [FIREFOX or "firefox", "--headless", "--no-remote", "--remote-debugging-port=0"]
        log = folder / "log"
        with log.open("w") as out:
            self._process = subprocess.Popen(
                [*command, "--profile", str(folder)], stdout=subprocess.DEVNULL, stderr=out
            )
        self._console: list[str] = []
        self._numbers = count(1)
        try:
            until = time.monotonic() + PATIENCE_MS / 1e3
            while not (found := _LISTENS.search(log.read_text())):
                assert time.monotonic() < until and self._process.poll() is None, log.read_text()
                time.sleep(0.05)
            address = found[1]
            self._socket = connect(f"{address}/session", max_size=None)
            self.send("session.new", capabilities={})
            self.send("session.subscribe", events=["log.entryAdded"])
            self.send("script.addPreloadScript", functionDeclaration=_KEEP_FAULTS)
            self._page = self.send("browsingContext.getTree")["contexts"][0]["context"]
            viewport = {"width": width, "height": height}
            self.send("browsingContext.setViewport", context=self._page, viewport=viewport)
        except BaseException:
            self._process.kill()
            self._process.wait()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._socket.close()
        self._process.kill()
        self._process.wait()

    def send(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Carry out a command of WebDriver BiDi; return its result."""
        number = next(self._numbers)
        self._socket.send(json.dumps({"id": number, "method": method, "params": parameters}))
        while True:
            told = json.loads(self._socket.recv(PATIENCE_MS / 1e3))
            if told.get("id") == number:
                assert told["type"] == "success", told
                return told["result"]
            # What a script throws is told too where the page deals with it.
            entry = told.get("params", {})
            if (entry.get("type"), entry.get("level")) == ("console", "error"):
                self._console.append(entry["text"])

    @property
    def faults(self) -> list[str]:
        """What the page's scripts have thrown, and what its console complains of."""
        said = self.evaluate("window.faults")
        return [fault for fault in self._console + said if NO_WEBGL not in fault]

    def open(self, url: str) -> None:
        """Load a page."""
        self.send("browsingContext.navigate", context=self._page, url=url, wait="interactive")

    def evaluate(self, expression: str) -> Any:
        """Return what an expression of the page is, which JSON can hold."""
        script = f"JSON.stringify({{is: {expression}}})"
        told = self.send(
            "script.evaluate", expression=script, target={"context": self._page}, awaitPromise=True
        )
        assert told["type"] == "success", told["exceptionDetails"]["text"]
        return json.loads(told["result"]["value"]).get("is")

    def wait_for(self, expression: str) -> Any:
        """Wait until an expression holds; return what it is then."""
        until = time.monotonic() + PATIENCE_MS / 1e3
        while not (value := self.evaluate(expression)):
            assert time.monotonic() < until, f"{expression} does not hold; {self.faults}"
            time.sleep(0.05)
        return value

    def press(self, key: str, *held: str) -> None:
        """Press a key while others are held: letters, or private codes of WebDriver."""
        order = [("keyDown", each) for each in (*held, key)] + [("keyUp", each) for each in (key, *held)]
        keys = [{"type": kind, "value": each} for kind, each in order]
        actions = [{"type": "key", "id": "keyboard", "actions": keys}]
        self.send("input.performActions", context=self._page, actions=actions)

    def screenshot(self, path: Path) -> None:
        """Take a picture of the window."""
        path.write_bytes(
            b64decode(self.send("browsingContext.captureScreenshot", context=self._page)["data"])
        )
