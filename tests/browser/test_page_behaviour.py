"""What the page does with wrong values, linked ones, faults, long runs, files and presets."""

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from navcore.networks.compass import gains_from_sigma_xi
from navcore.scenario.file import load, presets, to_toml
from schuler_bench.editing import edits
from schuler_bench.editing.choices import choice_words
from schuler_bench.session.session import Session
from schuler_bench.views.scene.track import HALF_WIDTH
from tests.browser.driver import Bench
from tests.browser.fields import label_of
from tests.recordings import ship

GAINS = ("network.k1", "network.k2", "network.k3")


def test_gains_are_linked_both_ways_with_sigma_and_xi(fresh: Bench, session: Session) -> None:
    omega_s, note = session.scenario.omega_s, "no (σ, ζ) gives these K"

    def shown(*labels: str) -> list[float]:
        fresh.settle()
        return [fresh.value(label) for label in labels]

    fresh.type("network.sigma", "0.01")
    exact = gains_from_sigma_xi(0.01, 0.7, omega_s)
    assert shown(*GAINS) == [float(f"{value:.6g}") for value in exact], "six digits are shown of what follows"
    for label, value in zip(GAINS, gains_from_sigma_xi(0.02, 0.9, omega_s), strict=True):
        assert note not in fresh.notes or label != GAINS[0]
        fresh.type(label, f"{value:.12g}")
    assert shown("network.sigma", "network.xi") == pytest.approx([0.02, 0.9], rel=1e-6)
    assert note not in fresh.notes
    # Zha's second set (theory.md 3.1)
    for label, text in zip(GAINS, ("0.00768", "6.68", "0.00768"), strict=True):
        fresh.type(label, text)
    assert note in fresh.notes
    assert fresh.metrics["methods"][2]["loop"]["h0"] == pytest.approx(1.0)
    fresh.type("network.xi", "0.5")
    assert note not in fresh.notes
    assert edits.value_at(session.scenario, ("method", 2, "network", "xi")) == 0.5


@pytest.mark.slow
def test_a_wrong_value_is_restored_and_the_reason_said(fresh: Bench, session: Session) -> None:
    number, before = fresh.run, session.scenario
    for text in ("7", "-5"):
        fresh.box("network.sigma").fill(text)
        notice = fresh.notice(f"{label_of('network.sigma')}: rejected")
        assert "must be >= 1e-05 and <= 1 (1/s)" in notice
        assert fresh.value("network.sigma") == 0.0088
        assert any("was refused" in note for note in fresh.notes)
        fresh.close_notices()
    fresh.tab("Log")
    fresh.choose("reference", "none")
    told = fresh.notice("reference: rejected")
    assert "none does not go with method.1.damping = external: needs a reference velocity" in told
    assert fresh.box("reference").input_value() == "log"
    assert (fresh.run, session.scenario) == (number, before)
    fresh.tab("Method")
    fresh.choose_and_run("network", "pole2")
    fresh.box("network.n1").fill("10")
    assert "(n₁-n₂)² + 4 - 4(n₁+n₂) >= 0" in fresh.notice("n₁: rejected")
    assert fresh.value("network.n1") == 14.0
    fresh.reset("sikuliaq-like", "Method", selected=1)
    fresh.choose("policy", "adaptive")
    fresh.notice("policy: rejected")
    assert any("unity2" in note for note in fresh.notes)
    assert fresh.box("policy").input_value() == choice_words("constant")


def test_a_number_may_be_typed_letter_by_letter_through_wrong_ones(fresh: Bench) -> None:
    box = fresh.box("network.sigma")
    box.fill("")
    with fresh.next_run():
        box.press_sequentially("0.008", delay=100)
    assert (box.input_value(), fresh.value("network.k1")) == ("0.008", pytest.approx(0.024))
    assert fresh.page.locator(".mantine-Notification-root").count() == 0


def test_warnings_stand_beside_the_network(fresh: Bench) -> None:
    assert any("H(0)" in note for note in fresh.notes)
    fresh.edit("free")
    fresh.page.get_by_text("undamped", exact=True).first.wait_for()
    assert not any("H(0)" in note for note in fresh.notes)


def test_of_two_sliders_moved_at_once_no_step_is_lost(fresh: Bench, session: Session) -> None:
    labels = ("network.sigma", "network.xi")

    def positions() -> np.ndarray:
        return np.array([float(fresh.slider(label).get_attribute("aria-valuenow")) for label in labels])

    start = positions()
    for label in labels:
        fresh.press(label)
    once = positions()
    with fresh.next_run():  # within the 30 ms in which a control's values are gathered
        fresh.page.evaluate("look.moved", [fresh.id(label) for label in labels])
    held: Any = session.scenario.method[2].network
    assert [fresh.value(label) for label in labels] == [held.sigma, held.xi]
    shown = positions()
    assert shown == pytest.approx(once + 6 * (once - start), abs=1e-3)
    assert 10.0 ** shown[0] == pytest.approx(held.sigma, rel=0.02)
    assert shown[1] == pytest.approx(held.xi, abs=1e-9)


def test_methods_are_added_copied_renamed_and_removed(fresh: Bench, session: Session) -> None:
    names = ["free", "classic2", "fast (compass)", "classic2 2", "classic2 3"]
    buttons = lambda: fresh.button("Add a method"), lambda: fresh.menu("copy"), lambda: fresh.menu("remove")
    for button, count in zip(buttons, (4, 5, 4), strict=True):
        with fresh.next_run():
            button().click()
        assert [method["name"] for method in fresh.metrics["methods"]] == names[:count]
        assert fresh.page.locator("details.sb-menu").get_attribute("open") is None
    assert fresh.line("/track/method3") is not None
    fresh.choose_and_run("network", "classic3")
    assert session.scenario.method[session.selected].name == fresh.edited == "classic3"
    fresh.menu("copy")  # opens it
    box = fresh.page.locator(".sb-rename")
    box.fill("nobody's")
    box.press("Escape")
    assert box.input_value() == "classic3" and not box.is_visible()
    fresh.menu("copy")
    with fresh.next_run():
        box.fill("by hand")
        box.press("Enter")
    assert session.scenario.method[session.selected].name == fresh.edited == box.input_value() == "by hand"
    fresh.menu("copy")
    box.fill("n" * 61)
    box.press("Enter")
    assert "method.3.name" in fresh.notice("Not possible")
    assert fresh.edited == "by hand"


def test_chips_choose_a_method_and_hide_its_curves(fresh: Bench, session: Session) -> None:
    page = fresh.page
    for key in ("Enter", "Space"):  # a chip that is pressed keeps the focus
        fresh.chip("free" if key == "Enter" else "classic2").press(key)
        fresh.settle()
        assert page.evaluate("() => document.activeElement.innerText") == fresh.edited
    assert (fresh.edited, session.selected) == ("classic2", 1)
    for eye, seen in (("Hide classic2", False), ("Show classic2", True)):
        fresh.button(eye).click()
        fresh.wait_until(lambda seen=seen: (fresh.line("/track/method1") is not None) == seen)
        fresh.settle()
        assert ("classic2" in page.evaluate("look.drawnNames")) == seen
        assert session.display.state_of("classic2") == ("shown" if seen else "hidden")


def test_numbers_are_those_of_the_command_line(fresh: Bench, tmp_path: Path, repo_root: Path) -> None:
    fresh.type("network.xi", "0.6")
    fresh.tab("Sensors")
    fresh.type("imu.gyro_arw_dpsh", "0.01")
    fresh.tab("Files")
    for name in ("scenario.toml", "metrics.json"):
        with fresh.page.expect_download() as download:
            fresh.button(f"Download {name}").click()
        download.value.save_as(tmp_path / name)
        assert download.value.suggested_filename == name
    command = [
        sys.executable,
        "-m",
        "schuler_bench",
        "run",
        str(tmp_path / "scenario.toml"),
        "--json",
        "--quiet",
    ]
    done = subprocess.run(command, cwd=repo_root, capture_output=True, text=True, check=True, timeout=250)
    expected = json.loads(done.stdout)
    shown, downloaded = fresh.metrics, json.loads((tmp_path / "metrics.json").read_text("utf-8"))
    for document in (shown, downloaded, expected):
        document.pop("elapsed_s")
    assert shown == expected and downloaded == expected
    fresh.tab("Metrics")
    rms = np.degrees(expected["methods"][0]["errors"]["phi_e_rad"]["rms"]) * 3600.0
    fresh.page.locator(".sb-table").filter(has_text=f"{rms:.3g}").first.wait_for()


def test_a_long_run_marks_the_old_picture_and_is_stopped(
    fresh: Bench, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = session._simulate

    def slowly(scenario: Any, progress: Any, cancelled: Any) -> Any:
        # However long the page takes until the button is pressed.
        while not cancelled():
            progress(0.25)
            time.sleep(0.05)
        return real(scenario, progress, cancelled)

    fresh.tab("Run")
    fresh.type("run.output_step_s", "3600")
    monkeypatch.setattr(session, "_simulate", slowly)
    number, digest, stop = fresh.run, fresh.digest, fresh.button("Stop the run")
    fresh.box("run.duration_h").fill("800")
    stop.wait_for()
    assert f"pictures still show run {number}" in fresh.status
    assert fresh.page.evaluate("look.opacity") < 1.0
    stop.click()
    fresh.button("Run again").wait_for()
    assert "Stopped" in fresh.status
    assert (fresh.run, fresh.digest) == (number, digest)
    monkeypatch.undo()
    fresh.box("run.duration_h").fill("4")
    fresh.box("run.duration_h").press("Enter")
    fresh.wait_for_run(number)
    fresh.settle()
    assert session.run.scenario.run.duration_h == 4.0
    fresh.page.wait_for_function("() => document.querySelector('#sb-status').textContent.startsWith('Run')")
    assert fresh.page.evaluate("look.opacity") == 1.0


def test_a_fault_of_ours_is_told_and_the_last_picture_stays(
    fresh: Bench, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = fresh.run, fresh.digest

    def broken(*_: Any) -> Any:
        raise RuntimeError("kernel on strike")

    with monkeypatch.context() as patch:
        patch.setattr(session, "_simulate", broken)
        fresh.slider("network.xi").press("ArrowRight")
        assert "kernel on strike" in fresh.notice("Something went wrong")
        assert (fresh.run, fresh.digest) == before
        assert fresh.plotly()
    fresh.press("network.xi")


def test_text_of_a_user_is_text_everywhere(fresh: Bench) -> None:
    fresh.menu("copy")
    with fresh.next_run():
        fresh.page.locator(".sb-rename").fill("<img src=x onerror=alert(1)></script>")
        fresh.page.locator(".sb-rename").press("Enter")
    fresh.tab("Metrics", "Scenario", "Poles", "Step", "Frequency", "Errors")
    assert fresh.page.locator("img[src=x]").count() == 0


def test_a_ships_recording_is_uploaded_and_run(fresh: Bench, session: Session) -> None:
    fresh.tab("Files")
    files, remove = ship(), fresh.button("Remove the files")
    kind = "NMEA 0183 log" if files.raw else "CSV table"
    with fresh.next_run():
        fresh.upload(files.log)
        fresh.notice(f"{Path(files.log).name}: {kind}")
    for file in files.track:
        fresh.upload(file)
        fresh.notice(f"{Path(file).name}: {kind}")
    assert "714 s that all uploaded streams share" in fresh.notice("714 s")
    fresh.settle()
    assert (session.scenario.motion.kind, session.scenario.reference.kind) == ("track", "file")
    assert fresh.box("scenario").input_value() == "uploaded"
    assert session.run.t_s[-1] == 714.0
    assert [method["status"] for method in fresh.metrics["methods"]] == ["ok"] * 3
    drawn = np.reshape(fresh.line("/track/method0") or [], (-1, 3))
    assert np.max(np.ptp(drawn, axis=0)) > HALF_WIDTH  # the recorded way fills the map

    # a wrong file: nothing is lost
    before = session.scenario
    fresh.close_notices()
    fresh.upload({"name": "junk.txt", "mimeType": "text/plain", "buffer": bytes(range(256)) * 9})
    assert "junk.txt" in fresh.notice("The file cannot be used; nothing was changed")
    assert session.scenario == before
    assert list(session.uploads.files) == [Path(file).name for file in (files.log, *files.track)]

    # the files stay while they are in use, and go afterwards
    remove.click()
    fresh.notice("The files were kept")
    fresh.choose_and_run("scenario", "zha-fast")
    remove.click()
    remove.wait_for(state="hidden")
    assert not session.uploads.folder.exists()


def test_a_scenario_file_is_opened(fresh: Bench, session: Session) -> None:
    fresh.tab("Files")
    text = to_toml(load("sun-step")).encode()
    with fresh.next_run():
        fresh.upload({"name": "mine.toml", "mimeType": "application/toml", "buffer": text})
    assert fresh.box("scenario").input_value() == "mine.toml"
    assert session.scenario == load("sun-step")
    # it opens where its block "view" says
    fresh.wait_for_front("Step")
    fresh.upload({"name": "bad.toml", "mimeType": "application/toml", "buffer": b"[run]\nduration_h = -1\n"})
    assert "bad.toml: run.duration_h = -1" in fresh.notice("The file cannot be used")
    assert session.scenario == load("sun-step")


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.nightly if name != "liu-switching" else ()) for name in presets()],
)
def test_a_preset_opens(bench: Bench, name: str) -> None:
    bench.reset("zha-fast" if name != "zha-fast" else "sun-step")
    bench.choose_and_run("scenario", name)
    names = [method.name for method in load(name).method]
    assert bench.session.run.scenario == load(name)
    assert [method["name"] for method in bench.metrics["methods"]] == names
    bench.tab("Errors")
    bench.page.wait_for_selector(".uplot canvas")
    bench.tab("Metrics")
    table = bench.page.locator(".sb-table:visible")
    for each in names:
        table.filter(has_text=each).first.wait_for()


@pytest.mark.slow
def test_a_slider_plays_to_its_end_and_stops_at_a_key(moving: Bench) -> None:
    page = moving.page
    row = page.locator('[data-sb-kind="slider"]', has=moving.slider("network.zeta"))
    row.hover()
    button = page.locator(".sb-animate")
    assert button.get_attribute("aria-label").startswith("Play: ")
    before, run = moving.value("network.zeta"), moving.run
    button.click()
    page.wait_for_function("run => Number(document.getElementById('sb-run').dataset.run) >= run + 3", arg=run)
    page.keyboard.press("Escape")
    moving.settle()
    assert before < moving.value("network.zeta") < 2.0
    assert button.get_attribute("aria-label").startswith("Play: ")
    button.click()
    moving.wait_until(lambda: moving.value("network.zeta") == 2.0, seconds=30.0)
    page.wait_for_function("() => document.querySelector('.sb-animate').ariaLabel.startsWith('Play')")
    assert moving.session.undo()
