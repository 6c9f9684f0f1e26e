"""Every group of controls moves what it should: Bode plot, poles, error curves and the track in 3D."""

from __future__ import annotations

from typing import Any

import pytest

from tests.browser.driver import Bench
from tests.browser.fields import label_of
from tests.browser.scripts import LINE

pytestmark = pytest.mark.browser

BODE, POLES, ERRORS, TRACK = "bode", "poles", "errors", "track"


def snapshot(bench: Bench, *, poles: bool) -> dict[str, Any]:
    """What the page itself holds of all pictures; 3D as the lines of all methods."""
    sums = bench.sums()
    found = {BODE: sums["plotly"], ERRORS: sums["curves"], TRACK: sums["track"]}
    if poles:
        bench.tab("Poles")
        found[POLES] = bench.sums()["plotly"]
        bench.tab("Frequency")
    return found


def changed(before: dict[str, Any], after: dict[str, Any]) -> set[str]:
    return {key for key in before if before[key] != after[key]}


@pytest.fixture
def damped(bench: Bench) -> Bench:
    """The moving preset with the third method in hand, as it comes."""
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Frequency", "Errors", "Method")
    return bench


NETWORKS = [
    ("compass", ["network.sigma", "network.xi", "network.k1", "network.k2", "network.k3"]),
    ("complementary", ["network.zeta", "network.eta"]),
    ("pole2", ["network.xi", "network.n1", "network.n2"]),
    ("unity2", ["network.zeta", "network.r", "network.zeta2", "network.alpha"]),
]


@pytest.mark.parametrize(("network", "labels"), NETWORKS, ids=[name for name, _ in NETWORKS])
def test_network_sliders_move_every_picture(damped: Bench, network: str, labels: list[str]) -> None:
    if network != "complementary":
        damped.choose_and_run("network", network)
    for label in labels:
        # the tab of the poles takes seconds to come and go: it is looked at for the first slider
        poles = label == labels[0]
        before, old = snapshot(damped, poles=poles), damped.value(label)
        damped.press(label)
        assert damped.value(label) > old
        moved = {BODE, ERRORS, TRACK} | ({POLES} if poles else set())
        assert changed(before, snapshot(damped, poles=poles)) == moved, label
    assert damped.faults == []


def test_variant_and_realisation_change_the_loop(damped: Bench) -> None:
    damped.choose_and_run("network", "pole2")
    damped.type("network.xi", "0.08")
    before = snapshot(damped, poles=True)
    damped.choose_and_run("network.variant", "as_printed")
    assert changed(before, snapshot(damped, poles=True)) == {BODE, POLES, ERRORS, TRACK}
    damped.page.wait_for_selector(".sb-note.sb-error")
    assert any("unstable" in note for note in damped.notes)


def test_custom_network_takes_zeros_and_poles_as_text(damped: Bench) -> None:
    damped.choose_and_run("network", "custom")
    row = damped.page.get_by_text(label_of("network.zeros"), exact=True).locator("xpath=ancestor::div[2]")
    before = snapshot(damped, poles=True)
    number = damped.run
    row.locator("input").fill("-0.001, -0.08")
    damped.wait_for_run(number)
    assert changed(before, snapshot(damped, poles=True)) == {BODE, POLES, ERRORS, TRACK}
    number = damped.run
    row.locator("input").fill("-0.001, -0.08+")
    damped.notice("zeros (rad/s): not taken over")
    assert row.locator("input").input_value() == "-0.001, -0.08"
    assert damped.run == number


def test_threshold_decides_when_the_method_is_damped(damped: Bench) -> None:
    damped.choose("policy", "threshold")
    damped.settle()
    before = snapshot(damped, poles=False)
    damped.type("policy.limit_mps", "0.1")
    assert changed(before, snapshot(damped, poles=False)) == {ERRORS, TRACK}
    before = snapshot(damped, poles=False)
    damped.press("policy.limit_mps", "ArrowLeft")
    assert changed(before, snapshot(damped, poles=False)) == {ERRORS, TRACK}


SHARED = [
    ("Sensors", "imu.gyro_bias_dph.1"),
    ("Sensors", "imu.gyro_arw_dpsh"),
    ("Sensors", "imu.accel_bias_ug.0"),
    ("Sensors", "imu.accel_vrw_ugpshz"),
    ("Log", "reference.bias_mps.1"),
    ("Log", "reference.noise_mps"),
    ("Log", "reference.drift_mps"),
    ("Run", "initial_error.attitude_arcmin.2"),
    ("Run", "initial_error.velocity_mps.0"),
]


def test_sensor_log_and_initial_errors_move_curves_and_track_only(damped: Bench) -> None:
    for tab, label in SHARED:
        damped.tab(tab)
        before = snapshot(damped, poles=False)
        damped.press(label)
        assert changed(before, snapshot(damped, poles=False)) == {ERRORS, TRACK}, label


def test_latitude_duration_and_seed(damped: Bench) -> None:
    damped.tab("Run")
    before = snapshot(damped, poles=False)
    damped.press("site.lat_deg", "ArrowLeft")
    assert changed(before, snapshot(damped, poles=False)) == {BODE, ERRORS, TRACK}
    damped.type("run.duration_h", "7.5")
    assert max(damped.curves()[0]["data"][0]) == pytest.approx(7.5)
    before = snapshot(damped, poles=False)
    damped.type("run.seed", "4")
    assert changed(before, snapshot(damped, poles=False)) == {ERRORS, TRACK}


def test_events_and_outages_of_the_log_come_and_go(damped: Bench) -> None:
    damped.tab("Log")
    number = damped.run
    damped.page.get_by_role("button", name="add event", exact=True).click()
    damped.wait_for_run(number)
    before = snapshot(damped, poles=False)
    damped.press("event 1 acceleration of δVr E (m/s²)")
    assert changed(before, snapshot(damped, poles=False)) == {ERRORS, TRACK}
    number = damped.run
    damped.page.get_by_role("button", name="remove event", exact=True).click()
    damped.wait_for_run(number)
    assert damped.page.get_by_text("event 1 begins (h)", exact=True).count() == 0


def test_rarer_errors_are_shown_on_request(damped: Bench) -> None:
    damped.tab("Sensors")
    rare = damped.page.get_by_text(label_of("imu.gyro_misalignment_arcsec.0"), exact=True)
    assert rare.count() == 0
    damped.page.get_by_label("all errors").check()
    damped.press("imu.gyro_misalignment_arcsec.0")
    damped.page.get_by_label("all errors").uncheck()
    assert rare.count() == 1  # it is set now


def test_transfer_is_chosen(damped: Bench) -> None:
    before = snapshot(damped, poles=False)
    number = damped.run
    damped.choose("transfer", "velocity error from log error")
    assert changed(before, snapshot(damped, poles=False)) == {BODE}
    assert damped.run == number


def test_ship_and_exaggeration_move_in_3d(damped: Bench) -> None:
    at_end, number = damped.line("/error/method0"), damped.run
    damped.page.get_by_role("slider", name="time in the run").press("Home")
    vector = f"({LINE})('/error/method0')"
    damped.page.wait_for_function(f"end => String({vector}) !== String(end)", arg=at_end)
    before = damped.line("/track/method0")
    damped.choose("enlarge errors in 3D", "50")
    damped.page.locator("#sb-stage .sb-key [data-is=caption]", has_text="x 50").wait_for()
    damped.page.wait_for_function(f"old => String(({LINE})('/track/method0')) !== String(old)", arg=before)
    damped.choose("enlarge errors in 3D", "as needed")
    assert damped.run == number


def test_the_3d_view_is_drawn_anew_when_the_track_moves(damped: Bench) -> None:
    canvas = damped.page.locator("canvas").first
    before = canvas.screenshot()
    damped.tab("Sensors")
    damped.type("imu.gyro_bias_dph.2", "0.05")
    damped.wait_for_change(canvas.screenshot, before)
