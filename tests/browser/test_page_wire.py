"""The page seen from the wire: what a websocket gets, without a browser; what each control moves."""

import json
import re
from collections import Counter
from collections.abc import Iterator
from html import unescape
from typing import Any

import pytest

from navcore.scenario.file import load as load_preset
from navcore.scenario.file import scenario_hash
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits
from schuler_bench.shell.plotly_view import PlotlyView
from schuler_bench.views import load
from schuler_bench.views.study.view import StudyView
from schuler_bench.views.tune.view import TuneView
from tests.attack.conftest import eventually
from tests.attack.wire import visit
from tests.browser.by_wire import (
    ALL,
    CURVES,
    TRACK,
    WIDE,
    Wire,
    is_run,
    named,
    number,
    open_pages,
    ready,
    runs,
)
from tests.browser.conftest import Served
from tests.browser.fields import label_of


def test_a_visitor_without_our_script_gets_all_figures(dashboard: Served) -> None:
    server, _ = dashboard
    with visit(server.port, named(dashboard, "no-script-here")) as visitor:
        visitor.wait_for(is_run, 60.0)
        kinds = [message["type"] for message in visitor.received]
        # Tune and Study have a figure once they have found something.
        empty = (TuneView, StudyView)
        plotly = [k for k in load() if k.always and k not in empty and issubclass(k, PlotlyView)]
        assert kinds.count("GuiPlotlyMessage") == len(plotly) >= 4
        assert kinds.count("GuiUplotMessage") == 4


def test_figures_out_of_sight_are_not_sent_until_their_tab_comes(dashboard: Served) -> None:
    server, _ = dashboard
    with visit(server.port, named(dashboard, "front-tabs-only")) as visitor:
        ready(visitor)
        runs(visitor, 0.5)
        assert [m["type"] for m in visitor.received].count("GuiPlotlyMessage") == 1
        visitor.received.clear()
        visitor.set(next(iter(_ids(dashboard, "front-tabs-only"))), WIDE.replace("Frequency", "Poles"))
        visitor.wait_for(lambda message: message["type"] == "GuiPlotlyMessage", 10.0)


def test_a_page_that_opens_has_the_pictures_in_front_before_all_else(dashboard: Served) -> None:
    server, _ = dashboard
    with visit(server.port, named(dashboard, "front-comes-first")) as visitor:
        ready(visitor, "1920x1080")  # the tabs are not there yet
        kinds = [message["type"] for message in visitor.received]
        assert (kinds.count("GuiPlotlyMessage"), kinds.count("GuiUplotMessage")) == (1, 4)
        assert kinds.index("GuiUplotMessage") < kinds.index("MeshMessage"), "the 3D view"


def _ids(dashboard: Served, session_id: str) -> list[str]:
    eventually(lambda: bool(open_pages(dashboard[1], session_id)))
    return [page._reports.window_id for page in open_pages(dashboard[1], session_id)]


def test_a_flood_of_slider_moves_becomes_a_few_runs_and_the_last_wins(dashboard: Served) -> None:
    server, served = dashboard
    with visit(server.port, named(dashboard, "flood-of-moves")) as visitor:
        ready(visitor)
        zeta = visitor.control(label_of("network.zeta"))
        visitor.received.clear()
        for step in range(200):
            visitor.set(zeta, 0.5 + 0.005 * step)
        session = served.sessions.get("flood-of-moves")
        eventually(lambda: edits.network_values(session.scenario, session.selected)["zeta"] == 1.495, 60.0)
        eventually(lambda: session.run is not None and session.run.scenario == session.scenario, 60.0)
        assert session.wait_idle(20.0)
        visitor.wait_for(lambda message: is_run(message) and number(message) == session.run_number, 30.0)
        shown = [message for message in visitor.received if is_run(message)]
        assert 1 <= len(shown) <= 60
        document = json.loads(unescape(re.sub(r"<[^>]*>", "", shown[-1]["updates"]["content"])))
        assert document["scenario_sha256"] == scenario_hash(session.run.scenario)


def test_one_visitor_cannot_move_the_controls_of_another(dashboard: Served) -> None:
    server, served = dashboard
    with (
        visit(server.port, named(dashboard, "the-owner-of-it")) as owner,
        visit(server.port, named(dashboard, "someone-curious")) as other,
    ):
        ready(owner)
        ready(other)
        before = served.sessions.get("the-owner-of-it").scenario
        other.set(owner.control(label_of("network.zeta")), 1.5)
        assert runs(other, 0.8)[-1] is not None
        assert served.sessions.get("the-owner-of-it").scenario == before
        assert served.sessions.get("someone-curious").scenario == before


@pytest.mark.parametrize("text", ["", "x", "1e9x3", "-5x3", "99999x99999", "1920x1080|" * 300])
def test_a_strange_report_of_the_page_does_no_harm(dashboard: Served, text: str) -> None:
    server, served = dashboard
    with visit(server.port, named(dashboard, "strange-reports")) as visitor:
        ready(visitor, text)
        eventually(lambda: bool(open_pages(served, "strange-reports")))
        assert 640 <= open_pages(served, "strange-reports")[0]._window[0] <= 7680


def test_writing_to_a_visitor_who_has_just_gone_is_no_fault(dashboard: Served) -> None:
    server, served = dashboard
    with visit(server.port, named(dashboard, "gone-in-a-moment")) as visitor:
        ready(visitor)
        eventually(lambda: bool(open_pages(served, "gone-in-a-moment")), 60.0)
        page = open_pages(served, "gone-in-a-moment")[0]
    eventually(lambda: page._closed, 60.0)
    # The test run turns every warning into an error.
    page.header.show_stopped(1)
    page.gui.add_html("to nobody")
    assert page.session.open_pages == 0
    assert page not in served._pages.values()


# ------------------------------------------------------------ what each control moves


@pytest.fixture
def wire(dashboard: Served) -> Iterator[Wire]:
    """A page of its own, on a ship under way; the third of its methods is selected."""
    server, served = dashboard
    with visit(server.port, named(dashboard, "controls-by-wire")) as visitor:
        ready(visitor)
        eventually(lambda: bool(open_pages(served, "controls-by-wire")), 60.0)
        wire = Wire(visitor, open_pages(served, "controls-by-wire")[0])
        wire.put(load_preset("sikuliaq-like"), selected=2)
        yield wire


NETWORKS = {
    "complementary": ("zeta", "eta"),
    "compass": ("sigma", "xi", "k1", "k2", "k3"),
    "pole2": ("xi", "n1", "n2"),
    "unity2": ("zeta", "r", "zeta2", "alpha"),
}


@pytest.mark.parametrize("network", NETWORKS)
def test_network_sliders_move_every_picture(wire: Wire, network: str) -> None:
    wire.slide("imu.gyro_bias_dph.1")
    for tab in ("Frequency", "Poles"):
        wire.put(load_preset("sikuliaq-like"), selected=2, front=WIDE.replace("Frequency", tab))
        if network != "complementary":
            wire.set("network", network)
        for name in NETWORKS[network]:
            assert set(wire.slide(f"network.{name}")) == ALL, (tab, name)


def test_variant_zeros_and_poles_change_the_loop(wire: Wire) -> None:
    wire.set("network", "pole2")
    wire.set("network.xi", 0.08)
    assert set(wire.set("network.variant", "as_printed")) == ALL
    assert any("unstable" in text for text in wire.texts.values())
    wire.set("network", "custom")
    assert set(wire.set("network.zeros", "-0.001, -0.08")) == ALL
    before = wire.session.scenario
    label = label_of("network.zeros")
    wire.visitor.set(wire.controls[label]["uuid"], "-0.001, -0.08+")
    assert wire.visitor.notice()
    assert wire.session.scenario == before


@pytest.mark.parametrize(
    ("changes", "moved"),
    [
        *[
            ({name: None}, {CURVES, TRACK})
            for name in (
                "imu.gyro_bias_dph.1",
                "imu.gyro_arw_dpsh",
                "imu.accel_bias_ug.0",
                "imu.accel_vrw_ugpshz",
                "reference.bias_mps.1",
                "reference.noise_mps",
                "reference.drift_mps",
                "initial_error.attitude_arcmin.2",
                "initial_error.velocity_mps.0",
            )
        ],
        ({"site.lat_deg": None}, ALL),
        ({"run.seed": 4}, {CURVES, TRACK}),
        ({"run.duration_h": 7.5}, {CURVES, TRACK}),
        ({"policy": "threshold", "policy.limit_mps": 0.1}, {CURVES, TRACK}),
    ],
    ids=lambda value: next(reversed(value)) if isinstance(value, dict) else "",
)
def test_a_control_moves_what_it_should(wire: Wire, changes: dict[str, Any], moved: set[str]) -> None:
    found: Counter[str] = Counter()
    for name, value in changes.items():
        found = wire.slide(name) if value is None else wire.set(name, value)
    assert set(found) == moved


def test_events_of_the_log_and_rarer_errors_come_and_go(wire: Wire) -> None:
    acceleration, rare = "event 1 acceleration of δVr E (m/s²)", label_of("imu.gyro_misalignment_arcsec.0")
    wire.set("events", "add event")
    assert set(wire.slide(acceleration)) == {CURVES, TRACK}
    wire.set("events", "remove event")
    assert acceleration not in wire.controls and rare not in wire.controls
    wire.visitor.set(wire.controls["all errors"]["uuid"], True)
    assert set(wire.slide(rare)) == {CURVES, TRACK}
    wire.visitor.set(wire.controls["all errors"]["uuid"], False)
    wire.catch_up()
    assert rare in wire.controls, "it is set now"


UNITY = {"id": "unity2", "zeta": 0.5}
COMPASS = {"id": "compass", "sigma": 0.0088, "xi": 0.7}
POLICIES = {
    "threshold": ("limit_mps",),
    "yaw_rate": ("window_s", "limit_deg"),
    "acceleration": ("limit_mps2", "mean_s"),
    "variation": ("n_s", "t0_s", "a", "b", "c", "count"),
    "adaptive": ("lowpass_s",),
    "schedule": ("duration_s",),
    "mobility": ("high_mps2",),
    "states": (),  # the state stays where a slider crosses nothing
}
SWITCHINGS = {
    "hard": (),
    "keep": (),
    "ramp": ("duration_s",),
    "step": ("size", "every_s"),
    "bumpless": ("n_s", "memory_s"),
}


def scenario(policy: dict[str, Any], network: dict[str, Any]) -> Scenario:
    """Three hours with a turn, a change of speed and a step of the log; the second method has the policy."""
    data = load_preset("sikuliaq-like").canonical()
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


@pytest.mark.parametrize("id", POLICIES)
def test_every_slider_of_a_policy_moves_the_view(wire: Wire, id: str) -> None:
    front = WIDE.replace("Errors", "Switching")
    wire.put(
        scenario({"id": id}, COMPASS if id in ("schedule", "mobility") else UNITY), selected=1, front=front
    )
    for name in POLICIES[id]:
        assert wire.slide(f"policy.{name}")[CURVES], name


def test_every_switching_method_and_its_sliders_move_the_curves(wire: Wire) -> None:
    wire.put(scenario({"id": "variation"}, UNITY), selected=1)
    for id, sliders in SWITCHINGS.items():
        if id != "hard":
            assert wire.set("switching", id)[CURVES], id
        assert wire.session.scenario.method[1].switching.id == id
        for name in sliders:
            assert wire.slide(f"switching.{name}")[CURVES], (id, name)


def test_a_table_is_edited_as_text(wire: Wire) -> None:
    wire.put(scenario({"id": "adaptive"}, UNITY), selected=1, front=WIDE.replace("Errors", "Switching"))
    assert wire.set("policy.table", "0: 0.9, 1: 0.3, 3: 0.1")[CURVES] >= 2
    table = edits.value_at(wire.session.scenario, ("method", 1, "policy", "table"))
    assert [tuple(row) for row in table] == [(0.0, 0.9), (1.0, 0.3), (3.0, 0.1)]
