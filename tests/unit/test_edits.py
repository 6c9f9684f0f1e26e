"""Changes of a scenario: linked parameters, kinds, methods, events; as text; a field as it was opened."""

import math
from types import SimpleNamespace
from typing import Any, cast

import pytest

from navcore.damping.gyrocompass import Gyrocompass
from navcore.foundation.errors import InputError
from navcore.networks import NETWORKS
from navcore.networks.compass import gains_from_sigma_xi
from navcore.scenario.blocks import RunSettings
from navcore.scenario.file import load
from navcore.scenario.method import Method
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits, form
from schuler_bench.editing.pasting import WHERE, disturbances_toml, method_toml, paste
from schuler_bench.shell.editor import Editor
from schuler_bench.shell.reset import opened_value
from schuler_bench.views.method.view import azimuth_fields

NETWORK = ("method", 1, "network")
HEADING = ("motion", "heading_deg")
LEGS = [{"duration_s": 600.0, "speed_mps": 5.0}, {"duration_s": 600.0, "turn_dps": 0.1}]
OPENED, LIKE = load("zha-fast"), load("sikuliaq-like")


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


def with_network(scenario: Scenario, **values: Any) -> Scenario:
    """Scenario after its network's parameters were set one by one."""
    for name, value in values.items():
        scenario = edits.with_value(scenario, (*NETWORK, name), value)
    return scenario


def network(scenario: Scenario) -> dict[str, Any]:
    """Parameters that the scenario gives to its network."""
    return scenario.method[1].network.model_dump()


# ------------------------------------------------------------ linked parameters


def test_gains_follow_from_sigma_and_xi(scenario: Scenario) -> None:
    values = edits.network_values(with_network(scenario, xi=0.5), 1)
    k1, k2, k3 = gains_from_sigma_xi(0.0088, 0.5, scenario.omega_s)
    expected = {"sigma": 0.0088, "xi": 0.5, "k1": k1, "k2": k2, "k3": k3}
    assert {name: values[name] for name in expected} == pytest.approx(expected, rel=1e-12)


def test_sigma_and_xi_follow_from_gains_that_belong_to_some(scenario: Scenario) -> None:
    k1, k2, k3 = gains_from_sigma_xi(0.02, 0.9, scenario.omega_s)
    changed = with_network(scenario, k1=k1, k2=k2, k3=k3)
    assert network(changed)["sigma"] is None
    values = edits.network_values(changed, 1)
    assert (values["sigma"], values["xi"]) == pytest.approx((0.02, 0.9), rel=1e-9)


def test_other_gains_have_no_sigma_and_xi_and_the_screen_helps_out(scenario: Scenario) -> None:
    changed = with_network(scenario, k2=156.063)
    values = edits.network_values(changed, 1)
    assert "sigma" not in values and values["k1"] == pytest.approx(0.0264)
    back = edits.with_value(changed, (*NETWORK, "xi"), 0.6, lambda: {"sigma": 0.01, "xi": 0.7})
    assert (network(back)["sigma"], network(back)["xi"]) == (0.01, 0.6)


def test_zeta2_and_alpha_stand_for_each_other(scenario: Scenario) -> None:
    chosen = edits.with_choice(scenario, (*NETWORK, "id"), "unity2")
    before = edits.network_values(chosen, 1)
    changed = with_network(chosen, alpha=before["alpha"])
    after = edits.network_values(changed, 1)
    assert (before["zeta2"], after["zeta2"]) == (pytest.approx(0.7, rel=1e-12), pytest.approx(0.7, rel=1e-9))
    assert network(changed)["zeta2"] is None
    again = network(with_network(changed, zeta2=0.9))
    assert (again["zeta2"], again["alpha"]) == (0.9, None)


def test_custom_network_passes_between_roots_and_polynomials(scenario: Scenario) -> None:
    chosen = edits.with_choice(scenario, (*NETWORK, "id"), "custom")
    changed = with_network(chosen, num=[float(c) for c in edits.network_values(chosen, 1)["num"]])
    assert network(changed)["zeros"] is None
    assert network(changed)["den"] == pytest.approx((1.0, 0.018, 8e-5))
    back = network(with_network(changed, gain=2.0))
    assert back["num"] is None
    assert sorted(pole[0] for pole in back["poles"]) == pytest.approx([-0.01, -0.008])


@pytest.mark.parametrize("value", [math.nan, math.inf, -5.0, 0.0, 1e9, "0.7", True])
def test_wrong_values_are_refused_and_nothing_changes(scenario: Scenario, value: object) -> None:
    before = scenario.canonical()
    with pytest.raises(InputError) as caught:
        with_network(scenario, xi=value)
    assert {fault.field for fault in caught.value.faults} == {"method.1.network.xi"}
    assert scenario.canonical() == before


# ------------------------------------------------------------ kinds, methods, events


def test_another_network_brings_its_defaults_and_a_new_name(scenario: Scenario) -> None:
    changed = edits.with_choice(scenario, (*NETWORK, "id"), "complementary")
    assert (changed.method[1].name, network(changed)["zeta"]) == ("complementary", 0.5)
    assert edits.with_value(changed, ("method", 1, "damping"), "free").method[1].name == "free 2"
    named = edits.with_value(scenario, ("method", 1, "name"), "my way")
    assert edits.with_choice(named, (*NETWORK, "id"), "classic3").method[1].name == "my way"


def test_external_damping_without_a_reference_is_refused(scenario: Scenario) -> None:
    with pytest.raises(InputError, match="needs a reference velocity"):
        edits.with_value(scenario, ("reference", "kind"), "none")


def test_methods_are_added_copied_and_removed(scenario: Scenario) -> None:
    added, at = edits.with_method(scenario, None)
    assert (at, added.method[2].name, added.method[2].damping) == (2, "classic2", "external")
    copied, at = edits.with_method(scenario, 1)
    original, copy = copied.method[1:]
    assert (at, copy.network, copy.name) == (2, original.network, f"{original.name} 2")
    left = edits.without_method(scenario, 0)
    assert len(left.method) == 1
    with pytest.raises(InputError, match="must be 1 to 12"):
        edits.without_method(left, 0)


def test_events_come_and_go(scenario: Scenario) -> None:
    path = ("reference", "event")
    twice = edits.with_block(edits.with_block(scenario, path), path)
    moved = edits.with_value(twice, (*path, 1, "accel_mps2", 0), 0.01)
    assert [event.accel_mps2[0] for event in moved.reference.event] == [0.0, 0.01]
    assert edits.value_at(moved, (*path, 1, "accel_mps2", 0)) == 0.01
    assert len(edits.without_block(moved, path).reference.event) == 1
    assert edits.without_block(scenario, path) == scenario


def test_a_gyrocompass_comes_and_goes_and_takes_the_place_of_an_azimuth_network(scenario: Scenario) -> None:
    path = ("method", 1, "gyrocompass")
    whole = edits.with_choice(scenario, ("method", 1, "azimuth", "id"), "unity2")
    shown = [spec.path[-2:] for spec in azimuth_fields(whole, 1)]
    assert shown[:2] == [(1, "gyrocompass"), ("azimuth", "id")] and ("azimuth", "zeta") in shown
    north = edits.with_value(whole, path, True)
    compass = north.method[1]
    assert (compass.azimuth.id, compass.gyrocompass) == ("none", Gyrocompass())
    shown = [spec.path[-1] for spec in azimuth_fields(north, 1)]
    assert shown == ["gyrocompass", "sigma", "xi", "k1", "k2", "k3", "k4"]
    slower = edits.with_value(edits.with_value(whole, path, True), (*path, "sigma"), 0.001)
    assert slower.method[1].gyrocompass == Gyrocompass(sigma=0.001)
    assert edits.with_value(slower, path, False).method[1].gyrocompass is None
    inner = edits.with_value(whole, ("method", 1, "damping"), "internal")
    assert azimuth_fields(inner, 1)[0].path[-1] == "id"


def test_a_method_that_averages_is_named_after_its_variant() -> None:
    scenario = Scenario.parse({"method": [{"damping": "free"}]})
    for field, value, name in (
        (("damping",), "averaging", "averaging (schuler)"),
        (("averaging", "variant"), "cascade", "averaging (cascade)"),
        (("damping",), "free", "free"),
    ):
        scenario = edits.with_value(scenario, ("method", 0, *field), value)
        assert scenario.method[0].name == name


def test_leaving_the_strapdown_gives_up_what_only_it_can_do() -> None:
    data = {
        "run": {"fidelity": "strapdown", "vertical": "altimeter", "compensation": False},
        "alignment": {"kind": "compass"},
    }
    left = edits.with_value(Scenario.parse(data), ("run", "fidelity"), "error_model")
    assert (left.run.vertical, left.run.compensation, left.alignment.kind) == ("locked", True, "none")


def test_legs_and_attitude_come_back_after_another_motion(scenario: Scenario) -> None:
    """legs -> static -> swing -> legs, as the chooser of the motion does it."""
    session = SimpleNamespace(
        scenario=Scenario.parse(scenario.canonical() | {"motion": {"kind": "legs", "leg": LEGS}})
    )
    first, chooser = session.scenario.motion, SimpleNamespace(spec=SimpleNamespace(path=("motion", "kind")))
    editor = Editor(cast(Any, None), cast(Any, session), None, tuple)
    for kind in ("static", "swing", "legs"):
        session.scenario = edits.with_value(editor._changed(cast(Any, chooser), kind), HEADING, 20.0)
    assert session.scenario.motion == first.model_copy(update={"heading_deg": 20.0})
    session.scenario = edits.with_value(scenario, HEADING, 75.0).model_copy(update={"title": "another"})
    session.scenario = editor._changed(cast(Any, chooser), "legs")
    assert len(edits.value_at(session.scenario, ("motion", "leg"))) == 1
    assert edits.value_at(session.scenario, HEADING) == 75.0


# ------------------------------------------------------------ one field as it was opened


@pytest.mark.parametrize(
    ("model", "path", "value"),
    [
        (NETWORKS["compass"], ("method", 2, "network", "xi"), 0.7),
        (RunSettings, ("run", "duration_h"), 4.0),
        (Method, ("method", 2, "damping"), "external"),
        # a value that follows from others goes back to what followed then
        (NETWORKS["compass"], ("method", 2, "network", "k1"), pytest.approx(3 * 0.0088)),
        # nothing like it was opened: to its default
        (Method, ("method", 3, "damping"), Method().damping),
    ],
)
def test_a_field_goes_back_to_what_was_opened(model: Any, path: tuple[Any, ...], value: Any) -> None:
    more, _ = edits.with_method(edits.with_value(OPENED, ("method", 2, "network", "xi"), 0.4), None)
    (spec,) = (spec for spec in form.fields(model, path[:-1]) if spec.path == path)
    assert opened_value(OPENED, more, spec) == value


def test_a_field_of_another_kind_goes_back_to_its_default() -> None:
    other = edits.with_choice(OPENED, ("method", 2, "network", "id"), "pole2")
    for spec in form.fields(NETWORKS["pole2"], ("method", 2, "network")):
        assert opened_value(OPENED, other, spec) == spec.default


# ------------------------------------------------------------ as text


@pytest.mark.parametrize("scenario", [LIKE, OPENED], ids=["sikuliaq-like", "zha-fast"])
def test_each_method_pasted_elsewhere_is_the_same_but_for_its_name(scenario: Scenario) -> None:
    for index, method in enumerate(scenario.method):
        pasted = paste(OPENED, 0, method_toml(scenario, index))
        names = {m.name for m in pasted.scenario.method}
        assert pasted.selected == 1
        assert len(names) == len(pasted.scenario.method) == len(OPENED.method) + 1
        made = pasted.scenario.method[1]
        assert made.model_copy(update={"name": method.name}) == method
        assert pasted.words == f"method {made.name}"


def test_several_methods_are_added_in_order_behind_the_selected_one() -> None:
    pasted, old = paste(OPENED, 1, 2 * method_toml(OPENED, 2)), [m.network for m in OPENED.method]
    assert pasted.selected == 3
    assert [m.network for m in pasted.scenario.method] == [*old[:2], old[2], old[2], *old[2:]]


def test_events_and_outages_take_the_place_of_those_there() -> None:
    event, outage = ("reference", "event"), ("reference", "outage")
    with_one = edits.with_block(LIKE, event)
    with_two = edits.with_block(with_one, outage)
    text = disturbances_toml(with_two)
    assert "[[reference.event]]" in text and "[[reference.outage]]" in text
    pasted = paste(edits.with_block(with_one, event), 0, text)
    assert pasted.scenario.reference == with_two.reference
    assert pasted.words == "log events: 1, log outages: 1"
    assert paste(with_two, 0, disturbances_toml(LIKE)).scenario == LIKE


@pytest.mark.parametrize(
    ("text", "field", "allowed"),
    [
        ("[[method]", "", "is not valid TOML"),
        ("", "", "must be [[method]], [[reference.event]], [[reference.outage]] or [[reference.current]]"),
        ("method = 3", "", "must be [[method]]"),
        ("[imu]\ngrade = 1", "imu", "open a whole scenario as a file"),
        ("[reference]\nwhite = 1.0", "reference.white", "must be [[method]]"),
        (
            '[[method]]\ndamping = "external"\n[method.network]\nid = "compass"\nsigma = 7.0\nxi = 0.7',
            "method.1.network.sigma",
            "must be >= 1e-05 and <= 1",
        ),
        ("[[method]]\ncolour = 3", "method.1.colour", ""),
        ("method = [3]", "method.1", ""),
        ("[[method]]\nnetwork = 3", "method.1.network", ""),
        ("[[reference.event]]\nt_h = -5.0", "reference.event.0.t_h", "must be >= 0"),
        ("[[method]]\n" * 40, "method", "must be at most 9 blocks"),
    ],
)
def test_a_wrong_text_names_the_field_the_value_and_what_is_allowed(
    text: str, field: str, allowed: str
) -> None:
    with pytest.raises(InputError) as refused:
        paste(OPENED, 0, text)
    fault = refused.value.faults[0]
    assert (fault.where, fault.field) == (WHERE, field) and allowed in fault.allowed
