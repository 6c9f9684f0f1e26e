"""Where a Chromium for the browser tests is, and how one is got."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Browser

NAMES = ("chromium", "chromium-browser", "google-chrome-stable", "google-chrome")

# A test machine has no graphics card: the page is painted by the processor, without a detour over an OpenGL
# that would be software too, and WebGL runs on SwiftShader. And no calls home.
FLAGS = (
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    "--no-first-run",
    "--disable-quic",
    "--disable-sync",
    "--disable-background-networking",
    "--disable-component-update",
    # The address bar of each window, which nobody sees, is two pages of its own: a sixth of what it takes to
    # open ours. This takes the place of playwright's list, of which the last two are for pages like ours.
    "--disable-features=WebUIOmniboxPopup,WebUIOmniboxAimPopup,WebUIOmniboxFullPopup,PaintHolding,HttpsUpgrades",
)


def find_chromium() -> Path | None:
    """Return the executable that SCHULER_CHROMIUM names, else the system's, else playwright's own."""
    named = os.environ.get("SCHULER_CHROMIUM")
    if named:
        return Path(named) if Path(named).is_file() else None
    for name in NAMES:
        found = shutil.which(name)
        if found:
            return Path(found)
    return _playwrights_own()


def _playwrights_own() -> Path | None:
    from playwright.sync_api import Error, sync_playwright

    try:
        with sync_playwright() as playwright:
            path = Path(playwright.chromium.executable_path)
    except Error:
        return None
    return path if path.is_file() else None


def provide_chromium() -> tuple[Path | None, str]:
    """Find a Chromium, or install one where that is possible.

    Returns the executable and what was done, or None and why there is none.
    """
    found = find_chromium()
    if found:
        return found, "found"
    if os.geteuid() == 0 and shutil.which("apt-get"):
        how, failed = "apt-get install chromium", apt_install("chromium")
    else:
        how = "playwright install chromium"
        failed = _run([sys.executable, "-m", "playwright", "install", "chromium"])
    found = find_chromium()
    if found:
        return found, f"installed by {how}"
    return None, f"no Chromium, and '{how}' did not bring one: {failed or 'it is not where it is looked for'}"


@contextmanager
def launched() -> Iterator[Browser]:
    """Give a headless browser to a measurement; exit with the reason where none can be had."""
    from playwright.sync_api import sync_playwright

    path, how = provide_chromium()
    if path is None:
        sys.exit(how)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=list(FLAGS))
        yield browser
        browser.close()


def apt_install(*packages: str) -> str:
    """Install packages of Debian as root; return the last line of what failed, or an empty string."""
    quiet = os.environ | {"DEBIAN_FRONTEND": "noninteractive"}
    # An update that fails for one source of several may still have brought what is needed.
    _run(["apt-get", "update", "-q"], quiet)
    return _run(["apt-get", "install", "-q", "-y", "--no-install-recommends", *packages], quiet)


def _run(command: list[str], environment: dict[str, str] | None = None) -> str:
    """Run a command; return its last line of output when it failed, else an empty string."""
    try:
        done = subprocess.run(
            command,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            timeout=900,
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        return str(error)
    if done.returncode == 0:
        return ""
    lines = done.stdout.strip().splitlines()
    return lines[-1] if lines else f"exit {done.returncode}"
