"""What the page does with wrong values, linked ones, faults, long runs, files, reloads and other visitors."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from app.editing import edits
from app.views.scene.track import HALF_WIDTH
from navcore.networks.compass import gains_from_sigma_xi
from navcore.scenario.file import load
from tests.browser.driver import Bench
from tests.browser.fields import label_of
from tests.recordings import ship

if TYPE_CHECKING:
    from playwright.sync_api import Browser

    from app.http.server import DashboardServer
    from app.serve import Dashboard
    from app.session.session import Session

pytestmark = pytest.mark.browser

GAINS = ("network.k1", "network.k2", "network.k3")


# ------------------------------------------------------------ values


def test_gains_are_linked_both_ways_with_sigma_and_xi(fresh: Bench, session: Session) -> None:
    omega_s = session.scenario.omega_s

    def shown(*labels: str) -> list[float]:
        fresh.settle()
        return [fresh.value(label) for label in labels]

    fresh.type("network.sigma", "0.01")
    assert shown(*GAINS) == pytest.approx(gains_from_sigma_xi(0.01, 0.7, omega_s), rel=1e-8)
    note = "no (σ, ζ) gives these K"
    assert note not in fresh.notes
    for label, value in zip(GAINS, gains_from_sigma_xi(0.02, 0.9, omega_s), strict=True):
        fresh.type(label, f"{value:.12g}")
    assert shown("network.sigma", "network.xi") == pytest.approx([0.02, 0.9], rel=1e-8)
    assert note not in fresh.notes
    # Zha's second set (theory.md 3.1)
    for label, text in zip(GAINS, ("0.00768", "6.68", "0.00768"), strict=True):
        fresh.type(label, text)
    fresh.settle()
    assert note in fresh.notes
    loop = fresh.metrics["methods"][2]["loop"]
    assert loop["h0"] == pytest.approx(1.0)
    fresh.type("network.xi", "0.5")
    fresh.settle()
    assert note not in fresh.notes
    assert edits.value_at(session.scenario, ("method", 2, "network", "xi")) == 0.5


@pytest.mark.parametrize("text", ["7", "0", "-5", "1000000000"])
def test_a_wrong_number_is_restored_and_said(fresh: Bench, session: Session, text: str) -> None:
    number, before = fresh.run, session.scenario
    fresh.box("network.sigma").fill(text)
    notice = fresh.notice(f"{label_of('network.sigma')}: not taken over")
    assert "must be >= 1e-05 and <= 1 (1/s)" in notice
    assert fresh.value("network.sigma") == 0.0088
    assert any("was not taken over" in note for note in fresh.notes)
    assert (fresh.run, session.scenario) == (number, before)


def test_a_number_may_be_typed_letter_by_letter_through_wrong_ones(fresh: Bench) -> None:
    box = fresh.box("network.sigma")
    box.fill("")
    number = fresh.run
    box.press_sequentially("0.008", delay=100)
    fresh.wait_for_run(number)
    fresh.settle()
    assert box.input_value() == "0.008"
    assert fresh.value("network.k1") == pytest.approx(0.024)
    assert fresh.page.locator(".mantine-Notification-root").count() == 0


def test_a_refused_combination_names_the_reason_beside_the_control(fresh: Bench) -> None:
    fresh.choose_and_run("network", "pole2")
    fresh.box("network.n1").fill("10")
    assert "(n₁-n₂)² + 4 - 4(n₁+n₂) >= 0" in fresh.notice("n₁: not taken over")
    assert fresh.value("network.n1") == 14.0


def test_external_damping_without_reference_is_refused(fresh: Bench) -> None:
    fresh.tab("Log")
    fresh.choose("reference", "none")
    told = fresh.notice("reference: not taken over")
    assert "none does not go with method.1.damping = external: needs a reference velocity" in told
    assert fresh.box("reference").input_value() == "log"


def test_warnings_stand_beside_the_network(fresh: Bench) -> None:
    assert any("H(0)" in note for note in fresh.notes)
    fresh.choose("method", "free")
    fresh.page.get_by_text("undamped", exact=True).first.wait_for()
    assert not any("H(0)" in note for note in fresh.notes)


def test_of_two_sliders_moved_at_once_no_step_is_lost(fresh: Bench, session: Session) -> None:
    labels = ("network.sigma", "network.xi")

    def positions() -> np.ndarray:
        return np.array([float(fresh.slider(label).get_attribute("aria-valuenow")) for label in labels])

    start = positions()
    for label in labels:
        fresh.press(label)
    once, number = positions(), fresh.run
    ids = [fresh.id(label) for label in labels]
    # Within the 30 ms in which a control's values are gathered.
    fresh.page.evaluate(
        """async ids => {
          const thumbs = ids.map(id => document.querySelector(`[id='${id}'] [role=slider]`));
          const key = () => new KeyboardEvent('keydown', {key: 'ArrowRight', bubbles: true});
          for (let i = 0; i < 6; i++) for (const thumb of thumbs) {
            thumb.dispatchEvent(key());
            for (let turn = 0; turn < 100; turn++) await null; // React has taken it
          }
        }""",
        ids,
    )
    fresh.wait_for_run(number)
    fresh.settle()
    held: Any = session.scenario.method[2].network
    assert [fresh.value(label) for label in labels] == [held.sigma, held.xi]
    shown = positions()
    assert shown == pytest.approx(once + 6 * (once - start), abs=1e-3)
    assert 10.0 ** shown[0] == pytest.approx(held.sigma, rel=0.02)
    assert shown[1] == pytest.approx(held.xi, abs=1e-9)


# ------------------------------------------------------------ methods


def test_methods_are_added_copied_renamed_and_removed(fresh: Bench, session: Session) -> None:
    for button, names in (
        ("add", ["free", "classic2", "fast (compass)", "classic2 2"]),
        ("copy", ["free", "classic2", "fast (compass)", "classic2 2", "classic2 3"]),
        ("remove", ["free", "classic2", "fast (compass)", "classic2 2"]),
    ):
        number = fresh.run
        fresh.page.get_by_role("button", name=button, exact=True).click()
        fresh.wait_for_run(number)
        assert [method["name"] for method in fresh.metrics["methods"]] == names
    assert fresh.line("/track/method3") is not None
    fresh.choose_and_run("network", "classic3")
    assert session.scenario.method[session.selected].name == "classic3"


# ------------------------------------------------------------ runs


def test_numbers_are_those_of_the_command_line(fresh: Bench, tmp_path: Path, repo_root: Path) -> None:
    fresh.type("network.xi", "0.6")
    fresh.tab("Sensors")
    fresh.type("imu.gyro_arw_dpsh", "0.01")
    fresh.settle()
    fresh.tab("Files")
    with fresh.page.expect_download() as download:
        fresh.page.get_by_role("button", name="Download scenario.toml").click()
    scenario = tmp_path / download.value.suggested_filename
    download.value.save_as(scenario)
    with fresh.page.expect_download() as download:
        fresh.page.get_by_role("button", name="Download metrics.json").click()
    downloaded = json.loads(Path(download.value.path()).read_text())
    command = [sys.executable, "-m", "app", "run", str(scenario), "--json", "--quiet"]
    done = subprocess.run(command, cwd=repo_root, capture_output=True, text=True, check=True, timeout=250)
    expected = json.loads(done.stdout)
    for document in (fresh.metrics, downloaded, expected):
        document.pop("elapsed_s")
    assert fresh.metrics | {"elapsed_s": 0} == expected | {"elapsed_s": 0}
    assert downloaded == expected
    fresh.tab("Metrics")
    rms = expected["methods"][0]["errors"]["phi_e_rad"]["rms"] * 180.0 / 3.141592653589793 * 3600.0
    # the tab is drawn once it is in front
    fresh.page.locator(".sb-table").filter(has_text=f"{rms:.3g}").first.wait_for()
    fresh.tab("Errors")


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
    number, digest = fresh.run, fresh.digest
    fresh.box("run.duration_h").fill("800")
    stop = fresh.page.get_by_role("button", name="Stop the run")
    stop.wait_for()
    assert f"pictures still show run {number}" in fresh.status
    opacity = "() => getComputedStyle(document.querySelector('.js-plotly-plot')).opacity"
    assert float(fresh.page.evaluate(opacity)) < 1.0
    stop.click()
    fresh.page.get_by_role("button", name="Run again").wait_for()
    assert "Stopped" in fresh.status
    assert (fresh.run, fresh.digest) == (number, digest)
    monkeypatch.undo()
    fresh.box("run.duration_h").fill("4")
    fresh.wait_for_run(number)
    fresh.page.wait_for_function("() => document.querySelector('#sb-status').textContent.startsWith('Run')")
    assert float(fresh.page.evaluate(opacity)) == 1.0


def test_a_fault_of_ours_is_told_and_the_last_picture_stays(
    fresh: Bench, session: Session, monkeypatch: pytest.MonkeyPatch
) -> None:
    number, digest = fresh.run, fresh.digest

    def broken(*_: Any) -> Any:
        raise RuntimeError("kernel on strike")

    whole = session._simulate
    monkeypatch.setattr(session, "_simulate", broken)
    fresh.slider("network.xi").press("ArrowRight")
    assert "kernel on strike" in fresh.notice("Something went wrong")
    assert (fresh.run, fresh.digest) == (number, digest)
    assert fresh.plotly()
    monkeypatch.setattr(session, "_simulate", whole)
    fresh.press("network.xi")


def test_text_of_a_user_is_text_everywhere(fresh: Bench) -> None:
    name = "<img src=x onerror=alert(1)></script>"
    row = fresh.page.get_by_text("name", exact=True).locator("xpath=ancestor::div[2]")
    number = fresh.run
    row.locator("input").fill(name)
    fresh.wait_for_run(number)
    fresh.settle()
    for tab in ("Metrics", "Scenario", "Poles", "Step", "Frequency", "Errors"):
        fresh.tab(tab)
    assert fresh.page.locator("img[src=x]").count() == 0
    assert not [fault for fault in fresh.faults if "alert" in fault]


# ------------------------------------------------------------ files


def test_a_ships_recording_is_uploaded_and_run(fresh: Bench, session: Session) -> None:
    fresh.tab("Files")
    files = ship()
    kind = "NMEA 0183 log" if files.raw else "CSV table"
    number = fresh.run
    fresh.upload(files.log)
    fresh.notice(f"{Path(files.log).name}: {kind}")
    fresh.wait_for_run(number)
    for file in files.track:
        fresh.upload(file)
        fresh.notice(f"{Path(file).name}: {kind}")
    assert "714 s that all uploaded streams share" in fresh.notice("714 s")
    fresh.settle()
    assert (session.scenario.motion.kind, session.scenario.reference.kind) == ("track", "file")
    assert fresh.box("scenario").input_value() == "uploaded"
    assert session.run is not None
    assert session.run.t_s[-1] == 714.0
    statuses = [method["status"] for method in fresh.metrics["methods"]]
    assert statuses == ["ok"] * 3
    drawn = np.reshape(fresh.line("/track/method0") or [], (-1, 3))
    assert np.max(np.ptp(drawn, axis=0)) > HALF_WIDTH  # the recorded way fills the map

    # a wrong file: said with its faults, nothing lost
    before = session.scenario
    fresh.close_notices()
    fresh.upload({"name": "junk.txt", "mimeType": "text/plain", "buffer": bytes(range(256)) * 9})
    assert "junk.txt" in fresh.notice("The file cannot be used; nothing was changed")
    assert session.scenario == before
    assert list(session.uploads.files) == [Path(file).name for file in (files.log, *files.track)]

    # the files stay while they are in use, and go afterwards
    fresh.page.get_by_role("button", name="Remove the files").click()
    fresh.notice("The files were kept")
    fresh.choose_and_run("scenario", "zha-fast")
    fresh.page.get_by_role("button", name="Remove the files").click()
    fresh.page.get_by_role("button", name="Remove the files").wait_for(state="hidden")
    assert not session.uploads.folder.exists()


def test_a_scenario_file_is_opened(fresh: Bench, session: Session) -> None:
    from navcore.scenario.file import to_toml

    fresh.tab("Files")
    number = fresh.run
    text = to_toml(load("sun-step")).encode()
    fresh.upload({"name": "mine.toml", "mimeType": "application/toml", "buffer": text})
    fresh.wait_for_run(number)
    assert fresh.box("scenario").input_value() == "mine.toml"
    assert session.scenario == load("sun-step")
    # it opens where its block "view" says
    front = fresh.page.get_by_role("tab", name="Step", exact=True, selected=True)
    front.wait_for()
    fresh.upload({"name": "bad.toml", "mimeType": "application/toml", "buffer": b"[run]\nduration_h = -1\n"})
    assert "bad.toml: run.duration_h = -1" in fresh.notice("The file cannot be used")
    assert session.scenario == load("sun-step")


# ------------------------------------------------------------ visitors


def test_a_reload_keeps_the_work_and_another_visitor_has_none_of_it(
    fresh: Bench, session: Session, browser: Browser, dashboard: tuple[DashboardServer, Dashboard]
) -> None:
    fresh.type("network.sigma", "0.0123")
    fresh.settle()
    digest, scenario = fresh.digest, session.scenario
    sessions = dashboard[1].sessions
    assert sessions.get("somebody-else").scenario != scenario
    # the same address in another window, as after a reload
    context = browser.new_context(viewport={"width": 1280, "height": 720})
    page = context.new_page()
    other = Bench(page, fresh.url, sessions).open(f"s/{fresh.session_id}/")
    assert other.digest == digest
    assert other.value("network.sigma") == 0.0123
    # a change in one window is seen in the other
    fresh.type("network.xi", "0.55")
    fresh.settle()
    page.wait_for_function("d => document.querySelector('#sb-run').dataset.digest === d", arg=fresh.digest)
    assert other.value("network.xi") == 0.55
    assert other.faults == []
    context.close()
    assert fresh.faults == []
