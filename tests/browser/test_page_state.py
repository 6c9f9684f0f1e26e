"""Undo, reset, palette, keys, links to a state, a presenter, and what outlives the server."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from app.editing import edits
from navcore.scenario.file import load
from tests.browser.driver import Bench
from tests.browser.fields import label_of

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator

    from app.http.server import DashboardServer
    from app.serve import Dashboard
    from app.session.session import Session

pytestmark = pytest.mark.browser

XI = "network.xi"
SIZE = {"width": 800, "height": 600}
"""Of further pages: small ones are drawn faster."""


@pytest.fixture
def fresh(bench: Bench) -> Bench:
    """A still ship; the compass network in hand, xi = 0.7."""
    bench.reset("zha-fast", selected=2)
    bench.tab("Frequency", "Errors", "Method")
    return bench


@pytest.fixture
def another(
    browser: Browser, dashboard: tuple[DashboardServer, Dashboard]
) -> Iterator[Callable[[str], Bench]]:
    """Opens further pages, each as on another computer."""
    contexts = []

    def opened(path: str) -> Bench:
        contexts.append(browser.new_context(viewport=SIZE))
        page = contexts[-1].new_page()
        return Bench(page, dashboard[0].url, dashboard[1].sessions).open(path)

    yield opened
    for context in contexts:
        context.close()


def xi_of(session: Session) -> Any:
    return edits.value_at(session.scenario, ("method", 2, "network", "xi"))


def button(bench: Bench, name: str) -> Locator:
    return bench.button(name)


def wait_for_value(bench: Bench, name: str, value: float) -> None:
    bench.page.wait_for_function(
        "([id, value]) => Number(document.getElementById(id)?.value) === value",
        arg=[bench.box_id(name), value],
    )


def away_from_text(bench: Bench) -> None:
    """Take the focus out of any text box."""
    bench.page.evaluate("() => document.activeElement.blur()")


def palette(bench: Bench, words: str) -> None:
    """Open the palette by its key, look for words, and take what stands first."""
    page, words = bench.page, bench.said(words)
    away_from_text(bench)
    page.keyboard.press("Control+k")
    search = page.get_by_placeholder(bench.said("Search commands..."))
    search.wait_for()
    search.fill(words)
    first = page.locator(".mantine-Spotlight-action").first
    first.filter(has_text=words).wait_for()
    page.keyboard.press("Enter")
    search.wait_for(state="hidden")


# ------------------------------------------------------------ undo and reset


def test_a_drag_is_undone_at_once_and_redone_by_a_key(
    fresh: Bench, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(session.history, "_clock", lambda: 0.0)  # a drag on however slow a machine
    digest = fresh.digest
    slider = fresh.slider("network.xi")
    for _ in range(4):
        slider.press("ArrowRight")
    fresh.settle()
    dragged = fresh.value(XI)
    assert dragged == pytest.approx(0.72)  # each of the four steps counts
    assert f"ζ of fast (compass): 0.7 → {dragged:g}" in (button(fresh, "Undo").get_attribute("title") or "")
    button(fresh, "Undo").click()
    wait_for_value(fresh, XI, 0.7)
    fresh.settle()
    assert (fresh.digest, session.scenario) == (digest, load("zha-fast"))
    assert float(slider.get_attribute("aria-valuenow")) == pytest.approx(0.7)
    # the button that was pressed has been made anew: the focus has not been lost
    fresh.page.wait_for_function("() => document.activeElement.getAttribute('aria-label') === 'Undo'")
    away_from_text(fresh)
    fresh.page.keyboard.press("Control+Shift+z")
    wait_for_value(fresh, XI, dragged)
    fresh.page.keyboard.press("Control+z")
    wait_for_value(fresh, XI, 0.7)
    fresh.page.keyboard.press("Control+y")
    wait_for_value(fresh, XI, dragged)
    fresh.settle()
    assert fresh.digest != digest
    # in a text box the key is the browser's own
    fresh.box(XI).click()
    fresh.page.keyboard.press("Control+z")
    fresh.settle()
    assert xi_of(session) == dragged


def test_undo_brings_the_scenario_and_the_method_in_hand_back(fresh: Bench, session: Session) -> None:
    fresh.choose_and_run("scenario", "sun-step")
    assert fresh.box("method").input_value() != "fast (compass)"
    away_from_text(fresh)
    fresh.page.keyboard.press("Control+z")
    fresh.page.wait_for_function(
        "id => document.getElementById(id)?.value === 'zha-fast'", arg=fresh.id("scenario")
    )
    fresh.settle()
    assert (session.origin, session.selected, session.scenario) == ("zha-fast", 2, load("zha-fast"))
    assert fresh.box("method").input_value() == "fast (compass)"
    assert [method["name"] for method in fresh.metrics["methods"]] == [
        m.name for m in session.scenario.method
    ]


def test_one_field_is_reset_and_all_of_them(fresh: Bench, session: Session) -> None:
    fresh.type("network.sigma", "0.02")
    fresh.type(XI, "0.5")
    changed = fresh.page.locator(".sb-changed")
    changed.get_by_text(f"{label_of('network.xi')} was 0.7").wait_for()
    button(fresh, "Reset").click()
    wait_for_value(fresh, XI, 0.7)
    assert fresh.value("network.sigma") == 0.02
    fresh.settle()
    palette(fresh, f"Reset {label_of('network.sigma')} to 0.0088")
    wait_for_value(fresh, "network.sigma", 0.0088)
    changed.get_by_text("Unchanged since zha-fast was opened").wait_for()
    assert button(fresh, "Reset all").get_attribute("aria-disabled") == "true"
    fresh.type(XI, "0.4")
    fresh.choose_and_run("method.damping", "free")
    button(fresh, "Reset all").click()
    wait_for_value(fresh, XI, 0.7)
    fresh.settle()
    assert session.scenario == load("zha-fast")
    button(fresh, "Undo").click()
    fresh.page.get_by_text("undamped", exact=True).first.wait_for()
    assert session.scenario.method[2].damping == "free"


# ------------------------------------------------------------ palette and keys


def test_commands_are_found_filtered_and_carried_out(fresh: Bench, session: Session) -> None:
    page = fresh.page
    button(fresh, "Commands").click()
    dialog = page.get_by_role("dialog")
    dialog.wait_for()
    search = page.get_by_placeholder("Search commands...")
    page.wait_for_function("() => document.activeElement?.placeholder === 'Search commands...'")
    offered = page.locator(".mantine-Spotlight-action")
    assert offered.count() > 30
    search.fill("sun-step")
    page.wait_for_function("() => document.querySelectorAll('.mantine-Spotlight-action').length < 10")
    for _ in range(3):  # the focus does not leave the dialog
        page.keyboard.press("Tab")
    assert page.evaluate("() => document.activeElement.closest('[role=dialog]') !== null")
    page.keyboard.press("Escape")
    dialog.wait_for(state="hidden")
    number = fresh.run
    palette(fresh, "Open sun-step")
    fresh.wait_for_run(number)
    assert session.scenario == load("sun-step")
    palette(fresh, "Show Metrics")
    page.get_by_role("tab", name="Metrics", exact=True, selected=True).wait_for()
    palette(fresh, "Show Sensors")
    page.get_by_role("tab", name="Sensors", exact=True, selected=True).wait_for()
    away_from_text(fresh)
    with page.expect_download() as download:
        page.keyboard.press("Control+s")
    assert download.value.suggested_filename == "scenario.toml"
    with page.expect_file_chooser():
        page.keyboard.press("Control+o")
    page.get_by_role("tab", name="Files", exact=True, selected=True).wait_for()
    fresh.tab("Errors", "Method")


def test_the_keys_are_listed_and_escape_closes_the_list(fresh: Bench) -> None:
    page = fresh.page
    away_from_text(fresh)
    page.keyboard.press("?")
    dialog = page.get_by_role("dialog", name="Keys")
    dialog.wait_for()
    rows = dict(zip(*[dialog.locator(part).all_inner_texts() for part in ("th", "td")], strict=True))
    assert rows["Ctrl+Z"] == "Undo"
    assert rows["Ctrl+Shift+Z or Ctrl+Y"] == "Redo"
    assert page.evaluate("() => document.activeElement.closest('dialog') !== null")
    page.keyboard.press("Escape")
    dialog.wait_for(state="hidden")


def test_the_page_may_ask_faster_than_viser_sends(fresh: Bench, session: Session) -> None:
    for xi in ("0.6", "0.5", "0.4", "0.3"):
        fresh.type(XI, xi)
        fresh.page.wait_for_timeout(1100)  # longer than what counts as one drag
    away_from_text(fresh)
    fresh.page.evaluate(
        """() => {
          for (let i = 0; i < 4; i++) schuler.command("undo");
          schuler.command("redo");
          schuler.command("no-such-command", "<img src=x>");
        }"""
    )
    wait_for_value(fresh, XI, 0.6)
    fresh.settle()
    assert session.history.redo_name == "ζ of fast (compass): 0.6 → 0.5"
    assert fresh.faults == []


# ------------------------------------------------------------ others


@pytest.mark.timeout(600)
def test_a_link_opens_the_state_as_it_was_shared_for_everyone(
    fresh: Bench, session: Session, another: Callable[[str], Bench]
) -> None:
    fresh.type(XI, "0.55")
    fresh.settle()
    fresh.show(scale="log")
    button(fresh, "Share").click()
    dialog = fresh.page.get_by_role("dialog", name="Share this state")
    link = dialog.get_by_label("Link to this state").input_value()
    assert link.startswith(fresh.url)
    button(fresh, "Copy the link").click()
    dialog.get_by_text("Copied.").wait_for()
    fresh.page.keyboard.press("Escape")
    digest = fresh.digest
    fresh.type(XI, "0.65")
    fresh.show(scale="linear")
    first = another(link.removeprefix(fresh.url))
    assert first.session_id not in (fresh.session_id, link.rstrip("/").rpartition("/")[2])
    assert (first.digest, first.value(XI)) == (digest, 0.55)
    assert first.session.display.scale == "log"
    first.type(XI, "0.9")
    first.settle()
    assert xi_of(session) == 0.65
    second = another(link.removeprefix(fresh.url))
    assert (second.digest, second.value(XI)) == (digest, 0.55)
    assert second.session_id != first.session_id
    assert fresh.faults == first.faults == second.faults == []


@pytest.mark.timeout(600)
def test_one_presents_and_the_others_watch(
    fresh: Bench, session: Session, another: Callable[[str], Bench]
) -> None:
    other = another(f"s/{fresh.session_id}/")
    other.tab("Method")
    button(fresh, "Present").click()
    other.page.get_by_text("Another page presents: you watch").wait_for()
    fresh.page.get_by_text("You present: 1 watches").wait_for()
    assert other.box(XI).is_disabled()
    fresh.tab("Poles", "Spectrum")
    front = """names => names.every(name => [...document.querySelectorAll('[role=tab]')]
      .some(tab => tab.textContent === name && tab.getAttribute('aria-selected') === 'true'))"""
    other.page.wait_for_function(front, arg=["Spectrum"])
    fresh.tab("Frequency", "Errors")
    other.page.wait_for_function(front, arg=["Errors"])
    # what the presenter does is seen; what the watcher does is not even if the page lets it
    fresh.type(XI, "0.5")
    wait_for_value(other, XI, 0.5)
    before, shown = session.scenario, session.display
    other.page.evaluate("() => { schuler.command('undo'); schuler.command('theme'); }")
    other.page.keyboard.press("Control+z")
    other.page.evaluate(
        """id => {
          const box = document.getElementById(id);
          box.disabled = false;
          Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, 'value').set.call(box, '0.3');
          box.dispatchEvent(new Event('input', {bubbles: true}));
        }""",
        other.box_id(XI),
    )
    other.settle()
    assert (session.scenario, session.display) == (before, shown)
    other.tab("Run", "Method")  # free; controls that are made while one watches are locked too
    fresh.choose_and_run("network", "classic3")
    other.page.wait_for_function(
        "() => [...document.querySelectorAll('label')].some(l => l.textContent === 'T1 (s), exact')"
        " || document.querySelectorAll('.mantine-Slider-root').length > 0"
    )
    other.settle()
    enabled = other.page.locator("[role=tabpanel] input[type=text]:visible:not([disabled])")
    other.page.wait_for_function(
        "() => [...document.querySelectorAll('input')].every(i => i.offsetParent === null || i.disabled"
        " || i.closest('.js-plotly-plot, #sb-stage'))",
    )
    assert enabled.count() == 0
    fresh.page.keyboard.press("Escape")
    button(fresh, "Present").click()
    other.page.get_by_text("Another page presents: you watch").wait_for(state="hidden")
    away_from_text(other)
    other.page.keyboard.press("Control+z")
    fresh.page.wait_for_function(
        "id => document.getElementById(id)?.value === 'compass'", arg=fresh.id("network")
    )
    # a presenter who leaves frees the others
    button(other, "Present").click()
    fresh.page.get_by_text("Another page presents: you watch").wait_for()
    other.page.close()
    fresh.page.get_by_text("Another page presents: you watch").wait_for(state="hidden")
    fresh.type("network.xi", "0.44")
    assert fresh.faults == []


# ------------------------------------------------------------ restart


def serve(port: int, state: Path, repo_root: Path) -> subprocess.Popen[bytes]:
    words = [sys.executable, "-m", "app", "serve", "--port", str(port)]
    environment = os.environ | {"XDG_STATE_HOME": str(state)}
    quiet = subprocess.DEVNULL
    process = subprocess.Popen(words, cwd=repo_root, env=environment, stdout=quiet, stderr=quiet)
    for _ in range(600):
        try:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/healthz", timeout=5).close()
            return process
        except OSError:
            assert process.poll() is None, "the server has ended"
            time.sleep(0.05)
    process.kill()
    raise TimeoutError


@pytest.mark.timeout(600)  # three servers and pages
def test_the_work_survives_the_death_of_the_server(browser: Browser, tmp_path: Path, repo_root: Path) -> None:
    from app.bench.process import free_port

    port = free_port()
    context = browser.new_context(viewport=SIZE)
    process = serve(port, tmp_path, repo_root)
    try:
        page = context.new_page()
        mine = Bench(page, f"http://127.0.0.1:{port}/", None)
        mine.open()
        mine.choose_and_run("scenario", "zha-fast")
        mine.tab("Method")
        mine.choose("method", "fast (compass)")
        mine.type(XI, "0.6")
        digest, path = mine.digest, f"s/{mine.session_id}/"
        kept = tmp_path / "schuler-bench" / "sessions" / f"{mine.session_id}.json"
        for _ in range(1200):
            if kept.exists() and b'"xi":0.6' in kept.read_bytes():
                break
            time.sleep(0.05)
        process.kill()  # no chance to write anything
        process.wait(60.0)
        process = serve(port, tmp_path, repo_root)
        mine.open(path)
        assert (mine.digest, mine.value(XI)) == (digest, 0.6)
        assert mine.box("method").input_value() == "fast (compass)"
        mine.type(XI, "0.65")
        process.send_signal(signal.SIGTERM)  # at once: what waits is written
        process.wait(60.0)
        process = serve(port, tmp_path, repo_root)
        mine.open(path)
        assert mine.value(XI) == 0.65
        button(mine, "Undo").click()
        wait_for_value(mine, XI, 0.6)
    finally:
        context.close()
        process.kill()
        process.wait(60.0)
