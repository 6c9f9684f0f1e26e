"""Undo, reset, palette, keys, typed and pasted values, links to a state, a presenter."""

from typing import Any

import pytest

from navcore.scenario.file import load
from schuler_bench.editing import edits
from schuler_bench.session.session import Session
from tests.browser.conftest import Another
from tests.browser.driver import Bench
from tests.browser.fields import label_of
from tests.limits import require

XI, SIGMA = "network.xi", "network.sigma"


def xi_of(session: Session) -> Any:
    return edits.value_at(session.scenario, ("method", 2, "network", "xi"))


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


def test_a_drag_is_undone_at_once_and_redone_by_a_key(
    fresh: Bench, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(session.history, "_clock", lambda: 0.0)  # a drag on however slow a machine
    page, digest, slider = fresh.page, fresh.digest, fresh.slider(XI)
    for _ in range(4):
        slider.press("ArrowRight")
    fresh.settle()
    dragged = fresh.value(XI)
    assert dragged == pytest.approx(0.72)  # each of the four steps counts
    undo = fresh.button("Undo")
    assert f"ζ of fast (compass): 0.7 → {dragged:g}" in (undo.get_attribute("title") or "")
    undo.click()
    wait_for_value(fresh, XI, 0.7)
    fresh.settle()
    assert (fresh.digest, session.scenario) == (digest, load("zha-fast"))
    assert float(slider.get_attribute("aria-valuenow")) == pytest.approx(0.7)
    # the button that was pressed has been made anew: the focus has not been lost
    page.wait_for_function("() => document.activeElement.getAttribute('aria-label') === 'Undo'")
    away_from_text(fresh)
    for key, value in (("Control+Shift+z", dragged), ("Control+z", 0.7), ("Control+y", dragged)):
        page.keyboard.press(key)
        wait_for_value(fresh, XI, value)
    fresh.settle()
    assert fresh.digest != digest
    # in a text box the key is the browser's own
    fresh.box(XI).click()
    page.keyboard.press("Control+z")
    fresh.settle()
    assert xi_of(session) == dragged


def test_undo_brings_the_scenario_and_the_selected_method_back(fresh: Bench, session: Session) -> None:
    fresh.choose_and_run("scenario", "sun-step")
    assert fresh.edited != "fast (compass)"
    away_from_text(fresh)
    fresh.page.keyboard.press("Control+z")
    shown = "id => document.getElementById(id)?.value === 'zha-fast'"
    fresh.page.wait_for_function(shown, arg=fresh.id("scenario"))
    fresh.settle()
    assert (session.origin, session.selected, session.scenario) == ("zha-fast", 2, load("zha-fast"))
    assert fresh.edited == "fast (compass)"
    shown_methods = [method["name"] for method in fresh.metrics["methods"]]
    assert shown_methods == [method.name for method in session.scenario.method]


def test_one_field_is_reset_and_all_of_them(fresh: Bench, session: Session) -> None:
    fresh.type(SIGMA, "0.02")
    fresh.type(XI, "0.5")
    changed = fresh.page.locator(".sb-changed")
    changed.get_by_text(f"{label_of(XI)} was 0.7").wait_for()
    fresh.button("Reset").click()
    wait_for_value(fresh, XI, 0.7)
    assert fresh.value(SIGMA) == 0.02
    fresh.settle()
    palette(fresh, f"Reset {label_of(SIGMA)} to 0.0088")
    wait_for_value(fresh, SIGMA, 0.0088)
    changed.get_by_title("Unchanged since zha-fast was opened").wait_for()
    assert fresh.button("Reset all").get_attribute("aria-disabled") == "true"
    fresh.type(XI, "0.4")
    fresh.choose_and_run("method.damping", "free")
    fresh.button("Reset all").click()
    wait_for_value(fresh, XI, 0.7)
    fresh.settle()
    assert session.scenario == load("zha-fast")
    fresh.button("Undo").click()
    fresh.page.get_by_text("undamped", exact=True).first.wait_for()
    assert session.scenario.method[2].damping == "free"


def test_a_value_is_taken_in_one_piece_after_a_key_that_types_nothing(fresh: Bench, session: Session) -> None:
    fresh.type(XI, "0.45")
    fresh.box(XI).press("Escape")
    with fresh.next_run():
        session.undo()
    fresh.type(XI, "0.45")
    assert session.scenario.method[2].network.model_dump()["xi"] == 0.45


def test_commands_are_found_filtered_and_carried_out(fresh: Bench, session: Session) -> None:
    page = fresh.page
    page.locator("[data-palette]").click()
    dialog, search = page.get_by_role("dialog"), page.get_by_placeholder("Search commands...")
    dialog.wait_for()
    page.wait_for_function("() => document.activeElement?.placeholder === 'Search commands...'")
    assert page.locator(".mantine-Spotlight-action").count() > 30
    search.fill("sun-step")
    page.wait_for_function("() => document.querySelectorAll('.mantine-Spotlight-action').length < 10")
    for _ in range(3):  # the focus does not leave the dialog
        page.keyboard.press("Tab")
    assert page.evaluate("() => document.activeElement.closest('[role=dialog]') !== null")
    page.keyboard.press("Escape")
    dialog.wait_for(state="hidden")
    with fresh.next_run():
        palette(fresh, "Open sun-step")
    assert session.scenario == load("sun-step")
    for tab in ("Metrics", "Sensors"):
        palette(fresh, f"Show {tab}")
        fresh.wait_for_front(tab)
    away_from_text(fresh)
    with page.expect_download() as download:
        page.keyboard.press("Control+s")
    assert download.value.suggested_filename == "scenario.toml"
    with page.expect_file_chooser():
        page.keyboard.press("Control+o")
    fresh.wait_for_front("Files")


def test_the_keys_are_listed_and_escape_closes_the_list(fresh: Bench) -> None:
    fresh.page.keyboard.press("?")
    dialog = fresh.page.get_by_role("dialog", name="Keys")
    dialog.wait_for()
    rows = dict(zip(*[dialog.locator(part).all_inner_texts() for part in ("th", "td")], strict=True))
    assert (rows["Ctrl+Z"], rows["Ctrl+Shift+Z / Ctrl+Y"]) == ("Undo", "Redo")
    assert fresh.page.evaluate("() => document.activeElement.closest('dialog') !== null")
    fresh.page.keyboard.press("Escape")
    dialog.wait_for(state="hidden")


@pytest.mark.slow
def test_the_page_may_ask_faster_than_viser_sends(fresh: Bench, session: Session) -> None:
    for xi in ("0.6", "0.5", "0.4", "0.3"):
        fresh.type(XI, xi)
        fresh.page.wait_for_timeout(1100)  # longer than what counts as one drag
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


@pytest.mark.timeout(600)
def test_a_link_opens_the_state_as_it_was_shared_for_everyone(
    fresh: Bench, session: Session, another: Another
) -> None:
    fresh.type(XI, "0.55")
    fresh.show(scale="log")
    fresh.button("Share").click()
    dialog = fresh.page.get_by_role("dialog", name="Share this state")
    link = dialog.get_by_label("Link to this state").input_value()
    assert link.startswith(fresh.url)
    fresh.button("Copy the link").click()
    dialog.get_by_text("Copied.").wait_for()
    fresh.page.keyboard.press("Escape")
    digest = fresh.digest
    fresh.type(XI, "0.65")
    fresh.show(scale="linear")
    first = another().open(link.removeprefix(fresh.url))
    assert first.session_id not in (fresh.session_id, link.rstrip("/").rpartition("/")[2])
    assert (first.digest, first.value(XI), first.session.display.scale) == (digest, 0.55, "log")
    first.type(XI, "0.9")
    assert xi_of(session) == 0.65
    second = another().open(link.removeprefix(fresh.url))
    assert (second.digest, second.value(XI)) == (digest, 0.55)
    assert second.session_id != first.session_id


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_one_presents_and_the_others_watch(fresh: Bench, session: Session, another: Another) -> None:
    other = another().open(f"s/{fresh.session_id}/")
    other.tab("Method")
    watches = "Another page presents: you watch"
    fresh.button("Present").click()
    other.page.get_by_text(watches).wait_for()
    fresh.page.get_by_text("You present: 1 watches").wait_for()
    assert other.box(XI).is_disabled()
    # what the presenter does is seen; what the watcher does is not even if the page lets it
    fresh.type(XI, "0.5")
    wait_for_value(other, XI, 0.5)
    before = session.scenario, session.display
    other.page.evaluate("() => { schuler.command('undo'); schuler.command('theme'); }")
    other.page.keyboard.press("Control+z")
    other.page.evaluate("look.unlocked", other.box_id(XI))
    other.settle()
    assert (session.scenario, session.display) == before
    other.tab("Run", "Method")  # free; controls that are made while one watches are locked too
    fresh.choose_and_run("network", "classic3")
    other.settle()
    other.page.wait_for_function("look.allLocked")
    fresh.button("Present").click()
    other.page.get_by_text(watches).wait_for(state="hidden")
    away_from_text(other)
    other.page.keyboard.press("Control+z")
    shown = "id => document.getElementById(id)?.value === 'compass'"
    fresh.page.wait_for_function(shown, arg=fresh.id("network"))
    # a presenter who leaves frees the others
    other.button("Present").click()
    fresh.page.get_by_text(watches).wait_for()
    other.page.close()
    fresh.page.get_by_text(watches).wait_for(state="hidden")
    fresh.type(XI, "0.44")


def test_a_reload_keeps_the_work_and_another_visitor_has_none_of_it(
    fresh: Bench, session: Session, another: Another
) -> None:
    fresh.type(SIGMA, "0.0123")
    fresh.show(theme="dark")
    require(fresh, tilt_overshoot=36.0)
    assert fresh.sessions.get("somebody-else").scenario != session.scenario
    # the same address in another window, as after a reload
    other = another(1280, 720).open(f"s/{fresh.session_id}/")
    assert (other.digest, other.value(SIGMA)) == (fresh.digest, 0.0123)
    other.page.wait_for_selector("#sb-theme[data-theme=dark]", state="attached")
    other.tab("Requirements")
    assert other.page.get_by_label("tilt overshoot ≤ (%)", exact=True).input_value() == "36"
    # rows without a limit are folded away
    folded = other.page.get_by_label("damping ratio ≥", exact=True)
    assert folded.is_hidden()
    other.button("add a limit").click()
    folded.wait_for()
    # a change in one window is seen in the other
    fresh.settle()
    fresh.type(XI, "0.55")
    shown = "d => document.querySelector('#sb-run').dataset.digest === d"
    other.page.wait_for_function(shown, arg=fresh.digest)
    other.tab("Method")
    assert other.value(XI) == 0.55


@pytest.mark.parametrize(
    ("sought", "label"), [("gyro bias", "gyro bias x (°/h)"), ("log scale", "scale error (ppm)")]
)
def test_the_palette_finds_a_field_and_takes_one_there(moving: Bench, sought: str, label: str) -> None:
    """The gyro bias was not found; the log's scale is not even shown until all its errors are asked for."""
    palette(moving, sought)
    row = "document.activeElement.closest('.mantine-Flex-root')?.querySelector('label')?.textContent"
    moving.page.wait_for_function(f"label => {row}?.startsWith(label)", arg=label, timeout=9e3)
    assert moving.page.evaluate("() => document.activeElement.matches('input[data-sb-number]')")


def test_the_palette_finds_a_method(moving: Bench) -> None:
    moving.tab("Sensors")
    palette(moving, "Edit classic2")
    moving.wait_until(lambda: moving.session.selected == 1)
    moving.wait_for_front("Method")
