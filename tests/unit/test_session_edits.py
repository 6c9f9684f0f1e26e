"""Changes of a scenario: linked parameters, blocks of another kind, methods, events."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any, cast

import pytest

from app.editing import edits
from app.shell.editor import Editor
from navcore.foundation.errors import InputError
from navcore.networks.compass import gains_from_sigma_xi
from navcore.scenario.model import Scenario

NETWORK = ("method", 1, "network")


def network(scenario: Scenario) -> Any:
    return scenario.method[1].network


@pytest.fixture
def scenario() -> Scenario:
    return Scenario.parse(
        {
            "reference": {"kind": "log"},
            "method": [
                {"name": "free"},
                {"damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}},
            ],
        }
    )


def test_gains_follow_from_sigma_and_xi(scenario: Scenario) -> None:
    changed = edits.with_value(scenario, (*NETWORK, "xi"), 0.5)
    values = edits.network_values(changed, 1)
    assert (values["sigma"], values["xi"]) == (0.0088, 0.5)
    assert (values["k1"], values["k2"], values["k3"]) == pytest.approx(
        gains_from_sigma_xi(0.0088, 0.5, scenario.omega_s), rel=1e-12
    )


def test_sigma_and_xi_follow_from_gains_that_belong_to_some(scenario: Scenario) -> None:
    k1, k2, k3 = gains_from_sigma_xi(0.02, 0.9, scenario.omega_s)
    changed = scenario
    for name, value in (("k1", k1), ("k2", k2), ("k3", k3)):
        changed = edits.with_value(changed, (*NETWORK, name), value)
    held = network(changed)
    assert held.sigma is None
    values = edits.network_values(changed, 1)
    assert (values["sigma"], values["xi"]) == pytest.approx((0.02, 0.9), rel=1e-9)


def test_other_gains_have_no_sigma_and_xi_and_the_screen_helps_out(scenario: Scenario) -> None:
    changed = edits.with_value(scenario, (*NETWORK, "k2"), 156.063)
    values = edits.network_values(changed, 1)
    assert "sigma" not in values
    assert values["k1"] == pytest.approx(0.0264)
    back = edits.with_value(changed, (*NETWORK, "xi"), 0.6, lambda: {"sigma": 0.01, "xi": 0.7})
    assert (network(back).sigma, network(back).xi) == (0.01, 0.6)


def test_zeta2_and_alpha_stand_for_each_other(scenario: Scenario) -> None:
    chosen = edits.with_choice(scenario, (*NETWORK, "id"), "unity2")
    before = edits.network_values(chosen, 1)
    assert before["zeta2"] == pytest.approx(0.7, rel=1e-12)
    changed = edits.with_value(chosen, (*NETWORK, "alpha"), before["alpha"])
    assert network(changed).zeta2 is None
    after = edits.network_values(changed, 1)
    assert after["zeta2"] == pytest.approx(0.7, rel=1e-9)
    again = edits.with_value(changed, (*NETWORK, "zeta2"), 0.9)
    assert (network(again).zeta2, network(again).alpha) == (0.9, None)


def test_custom_network_passes_between_roots_and_polynomials(scenario: Scenario) -> None:
    chosen = edits.with_choice(scenario, (*NETWORK, "id"), "custom")
    values = edits.network_values(chosen, 1)
    changed = edits.with_value(chosen, (*NETWORK, "num"), [float(c) for c in values["num"]])
    held = network(changed)
    assert held.zeros is None
    assert held.den == pytest.approx((1.0, 0.018, 8e-5))
    back = edits.with_value(changed, (*NETWORK, "gain"), 2.0)
    assert network(back).num is None
    assert sorted(pole[0] for pole in network(back).poles) == pytest.approx([-0.01, -0.008])


@pytest.mark.parametrize("value", [math.nan, math.inf, -5.0, 0.0, 1e9, "0.7", True])
def test_wrong_values_are_refused_and_nothing_changes(scenario: Scenario, value: object) -> None:
    before = scenario.canonical()
    with pytest.raises(InputError) as caught:
        edits.with_value(scenario, (*NETWORK, "xi"), value)
    assert all(fault.field == "method.1.network.xi" for fault in caught.value.faults)
    assert scenario.canonical() == before


def test_another_network_brings_its_defaults_and_a_new_name(scenario: Scenario) -> None:
    changed = edits.with_choice(scenario, (*NETWORK, "id"), "complementary")
    assert changed.method[1].name == "complementary"
    assert network(changed).zeta == 0.5
    freed = edits.with_value(changed, ("method", 1, "damping"), "free")
    assert freed.method[1].name == "free 2"
    named = edits.with_value(scenario, ("method", 1, "name"), "my way")
    assert edits.with_choice(named, (*NETWORK, "id"), "classic3").method[1].name == "my way"


def test_external_damping_without_a_reference_is_refused(scenario: Scenario) -> None:
    with pytest.raises(InputError, match="needs a reference velocity"):
        edits.with_value(scenario, ("reference", "kind"), "none")


def test_motion_keeps_its_attitude_when_its_kind_changes(scenario: Scenario) -> None:
    tilted = edits.with_value(scenario, ("motion", "heading_deg"), 75.0)
    assert (
        edits.value_at(edits.with_choice(tilted, ("motion", "kind"), "swing"), ("motion", "heading_deg"))
        == 75.0
    )


def test_methods_are_added_copied_and_removed(scenario: Scenario) -> None:
    added, at = edits.with_method(scenario, None)
    assert (at, added.method[2].name, added.method[2].damping) == (2, "classic2", "external")
    copied, at = edits.with_method(scenario, 1)
    assert at == 2
    assert copied.method[2].network == network(scenario)
    assert copied.method[2].name == f"{scenario.method[1].name} 2"
    left = edits.without_method(scenario, 0)
    assert len(left.method) == 1
    with pytest.raises(InputError, match="must be 1 to 12"):
        edits.without_method(left, 0)


def test_events_come_and_go(scenario: Scenario) -> None:
    path = ("reference", "event")
    twice = edits.with_block(edits.with_block(scenario, path), path)
    assert len(twice.reference.event) == 2
    moved = edits.with_value(twice, (*path, 1, "accel_mps2", 0), 0.01)
    assert edits.value_at(moved, (*path, 1, "accel_mps2", 0)) == 0.01
    assert len(edits.without_block(moved, path).reference.event) == 1
    assert edits.without_block(scenario, path) == scenario


def test_a_method_that_averages_is_named_after_its_variant() -> None:
    made = Scenario.parse({"method": [{"damping": "free"}]})
    averaged = edits.with_value(made, ("method", 0, "damping"), "averaging")
    assert averaged.method[0].name == "averaging (schuler)"
    cascade = edits.with_value(averaged, ("method", 0, "averaging", "variant"), "cascade")
    assert cascade.method[0].name == "averaging (cascade)"
    assert edits.with_value(cascade, ("method", 0, "damping"), "free").method[0].name == "free"


def test_leaving_the_strapdown_gives_up_what_only_it_can_do() -> None:
    data = {
        "run": {"fidelity": "strapdown", "vertical": "altimeter", "compensation": False},
        "alignment": {"kind": "compass"},
    }
    left = edits.with_value(Scenario.parse(data), ("run", "fidelity"), "error_model")
    assert (left.run.vertical, left.run.compensation, left.alignment.kind) == ("locked", True, "none")


def test_legs_come_back_after_another_motion(scenario: Scenario) -> None:
    legs = [{"duration_s": 600.0, "speed_mps": 5.0}, {"duration_s": 600.0, "turn_dps": 0.1}]
    data = scenario.canonical() | {"motion": {"kind": "legs", "leg": legs, "heading_deg": 10.0}}
    along = Scenario.parse(data)
    rest = edits.with_choice(along, ("motion", "kind"), "static")
    turned = edits.with_value(rest, ("motion", "heading_deg"), 20.0)
    back = edits.with_choice(turned, ("motion", "kind"), "legs", along.canonical()["motion"])
    assert edits.value_at(back, ("motion", "leg")) == edits.value_at(along, ("motion", "leg"))
    assert edits.value_at(back, ("motion", "heading_deg")) == 20.0
    assert len(edits.value_at(edits.with_choice(turned, ("motion", "kind"), "legs"), ("motion", "leg"))) == 1


def test_the_page_brings_back_the_legs_that_it_left(scenario: Scenario) -> None:
    """legs -> static -> legs, as the chooser of the motion does it."""
    legs = [{"duration_s": 600.0, "speed_mps": 5.0}, {"duration_s": 600.0, "turn_dps": 0.1}]
    session = SimpleNamespace(
        scenario=Scenario.parse(scenario.canonical() | {"motion": {"kind": "legs", "leg": legs}})
    )
    chooser = SimpleNamespace(spec=SimpleNamespace(path=("motion", "kind")))
    editor = Editor(cast(Any, None), cast(Any, session), None, tuple)
    for kind in ("static", "swing", "legs"):
        session.scenario = editor._changed(cast(Any, chooser), kind)
    assert len(edits.value_at(session.scenario, ("motion", "leg"))) == 2
    session.scenario = scenario.model_copy(update={"title": "another scenario"})
    session.scenario = editor._changed(cast(Any, chooser), "legs")
    assert len(edits.value_at(session.scenario, ("motion", "leg"))) == 1
