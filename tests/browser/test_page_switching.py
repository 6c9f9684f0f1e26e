"""The switching view: every threshold and window moves what it shows; it goes when nothing switches."""

from __future__ import annotations

import time
from typing import Any

import pytest

from app.editing import edits
from app.views.switching.figure import switching_plots
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from tests.browser.driver import Bench

pytestmark = pytest.mark.browser

UNITY = {"id": "unity2", "zeta": 0.5}
POLICIES: list[tuple[str, tuple[str, ...]]] = [
    ("threshold", ("policy.limit_mps",)),
    ("yaw_rate", ("policy.window_s", "policy.limit_deg")),
    ("acceleration", ("policy.limit_mps2", "policy.mean_s")),
    (
        "variation",
        (
            "policy.n_s",
            "policy.t0_s",
            "policy.a",
            "policy.b",
            "policy.c",
            "policy.count",
        ),
    ),
    ("adaptive", ("policy.lowpass_s",)),
    ("schedule", ("policy.duration_s",)),
]


SWITCHINGS: list[tuple[str, tuple[str, ...]]] = [
    ("hard", ()),
    ("keep", ()),
    ("ramp", ("switching.duration_s",)),
    ("step", ("switching.size", "switching.every_s")),
    ("bumpless", ("switching.n_s", "switching.memory_s")),
]


def scenario(policy: dict[str, Any], network: dict[str, Any]) -> Scenario:
    """Three hours with a turn, a change of speed and a step of the log; the second method has the policy."""
    data = load("sikuliaq-like").canonical()
    data["run"] |= {"duration_h": 3.0, "output_step_s": 1.0}
    data["motion"] = {
        "kind": "legs",
        "leg": [
            {"duration_s": 2000.0, "speed_kn": 10.0, "heading_deg": 40.0},
            {"duration_s": 300.0, "heading_deg": 100.0, "turn_dps": 0.5},
            {"duration_s": 60.0, "speed_kn": 4.0, "accel_mps2": 0.06},
            {"duration_s": 20000.0},
        ],
    }
    data["reference"] = {
        "kind": "log",
        "noise_mps": 0.1,
        "event": [{"t_h": 1.0, "duration_s": 30.0, "accel_mps2": [0.03, 0.0]}],
    }
    switched = {"name": "switched", "damping": "external", "network": network, "policy": policy}
    data["method"] = [{"name": "free"}, switched]
    return Scenario.parse(data)


def opened(bench: Bench, made: Scenario) -> None:
    """Begin anew with a scenario; the second method in hand, the switching view in front."""
    bench.put(made, origin=f"test {bench.session.run_number}", selected=1)
    bench.tab("Switching", "Method")


def view(bench: Bench) -> dict[str, Any]:
    """Label and sums of each plot of the switching view, those of the errors left out."""
    bench.settle()
    sums = """() => Object.values(window.__viserTestpoints?.uplots ?? {}).map(({chart}) => [
      chart.axes[1].label,
      chart.data.map(line => line.reduce((sum, v, i) => sum + (v ?? 0) * (1 + (i % 97)), 0)),
    ])"""
    found = bench.page.evaluate(sums)
    assert bench.session.run is not None
    labels = [str(plot.axes()[1]["label"]) for plot in switching_plots(bench.session.run)]
    held = dict(found)
    return {label: held[label] for label in labels}


def view_other_than(bench: Bench, old: dict[str, Any]) -> dict[str, Any]:
    """The switching view as soon as it differs from an old one; after 30 s as it is."""
    end = time.monotonic() + 30.0
    while (found := view(bench)) == old and time.monotonic() < end:
        pass
    return found


_HAS_LABEL = """pattern => Object.values(window.__viserTestpoints?.uplots ?? {})
  .some(entry => new RegExp(pattern).test(entry.chart.axes[1].label))"""


@pytest.mark.parametrize(("id", "sliders"), POLICIES, ids=[id for id, _ in POLICIES])
def test_every_slider_of_a_policy_moves_the_view(bench: Bench, id: str, sliders: tuple[str, ...]) -> None:
    network = {"id": "compass", "sigma": 0.0088, "xi": 0.7} if id == "schedule" else UNITY
    opened(bench, scenario({"id": id}, network))
    bench.page.wait_for_function(_HAS_LABEL, arg="^damped")
    assert {"damped", "ζ (–)"} <= set(view(bench))
    for slider in sliders:
        if id == "schedule":  # it measures nothing: the gains that pass show in the errors
            before = bench.digest
            bench.press(slider)
            assert bench.digest != before
            continue
        before, old = view(bench), bench.value(slider)
        bench.press(slider)
        assert bench.value(slider) > old
        after, label = view_other_than(bench, before), next(iter(before))
        assert after[label] != before[label] or after["damped"] != before["damped"], slider
        threshold = any(word in slider for word in ("threshold", "limit", " a ", " b ", " c "))
        if threshold:  # its line moves
            assert after[label][2:] != before[label][2:], slider
    assert bench.faults == []


def test_every_switching_method_and_its_sliders_move_the_curves(bench: Bench) -> None:
    opened(bench, scenario({"id": "variation"}, UNITY))
    shown = set()
    for id, sliders in SWITCHINGS:
        if id != "hard":
            bench.choose_and_run("switching", id)
        assert bench.session.scenario.method[1].switching.id == id
        shown.add(bench.digest)
        for slider in sliders:
            old = bench.value(slider)
            bench.press(slider)
            assert bench.value(slider) > old
            shown.add(bench.digest)
    assert len(shown) == len(SWITCHINGS) + sum(len(sliders) for _, sliders in SWITCHINGS)
    assert bench.faults == []


def test_the_view_comes_with_the_first_policy_and_goes_with_the_last(bench: Bench) -> None:
    bench.reset("sikuliaq-like", selected=1)
    tab = bench.page.get_by_role("tab", name="Switching", exact=True)
    assert tab.count() == 0
    bench.tab("Method", "Errors")
    bench.choose_and_run("policy", "threshold")
    tab.click()
    bench.page.get_by_text("wanted state", exact=True).wait_for()
    bench.choose("curve above", "Position error")
    bench.page.wait_for_function(_HAS_LABEL, arg="^position")
    bench.choose_and_run("policy", "constant")
    tab.wait_for(state="detached")
    # another tab has come to the front
    bench.page.get_by_role("tab", name="Errors", exact=True, selected=True).wait_for()
    assert bench.faults == []


def test_a_network_that_cannot_be_tuned_is_refused_beside_the_policy(bench: Bench) -> None:
    bench.reset("sikuliaq-like", selected=1)
    bench.tab("Method", "Errors")
    bench.choose("policy", "adaptive")
    bench.notice("policy: not taken over")
    assert any("unity2" in note for note in bench.notes)
    assert bench.box("policy").input_value() == "constant"


def test_a_table_is_edited_as_text(bench: Bench) -> None:
    opened(bench, scenario({"id": "adaptive"}, UNITY))
    row = bench.page.get_by_text("table", exact=True).locator("xpath=ancestor::div[2]").locator("input")
    assert row.input_value().startswith("0: 0.99, 0.1: 0.82")
    before, number = view(bench), bench.run
    row.fill("0: 0.9, 1: 0.3, 3: 0.1")
    bench.wait_for_run(number)
    assert view(bench)["ζ (–)"] != before["ζ (–)"]
    table = edits.value_at(bench.session.scenario, ("method", 1, "policy", "table"))
    assert [tuple(row) for row in table] == [(0.0, 0.9), (1.0, 0.3), (3.0, 0.1)]
