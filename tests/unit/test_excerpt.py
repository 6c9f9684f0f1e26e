"""A method, or the log's events, as TOML text: copied, pasted, and what is wrong with a pasted text."""

from __future__ import annotations

import pytest

from app.editing import edits
from app.editing.excerpt import WHERE, disturbances_toml, method_toml, paste
from navcore.foundation.errors import InputError
from navcore.scenario.file import load
from navcore.scenario.model import Scenario

PRESETS = ("sikuliaq-like", "zha-fast")


@pytest.fixture(params=PRESETS)
def scenario(request: pytest.FixtureRequest) -> Scenario:
    return load(request.param)


def test_each_method_pasted_elsewhere_is_the_same_but_for_its_name(scenario: Scenario) -> None:
    other = load("zha-fast")
    for index, method in enumerate(scenario.method):
        pasted = paste(other, 0, method_toml(scenario, index))
        assert pasted.selected == 1 and len(pasted.scenario.method) == len(other.method) + 1
        made = pasted.scenario.method[1]
        assert made.model_copy(update={"name": method.name}) == method
        assert len({m.name for m in pasted.scenario.method}) == len(pasted.scenario.method)
        assert pasted.words == f"method {made.name}"


def test_several_methods_are_added_in_order_behind_the_selected_one() -> None:
    scenario = load("zha-fast")
    pasted = paste(scenario, 1, method_toml(scenario, 2) + method_toml(scenario, 2))
    assert pasted.selected == 3 and len(pasted.scenario.method) == len(scenario.method) + 2
    assert [m.network for m in pasted.scenario.method[2:4]] == [scenario.method[2].network] * 2


def test_events_and_outages_take_the_place_of_those_there() -> None:
    plain = load("sikuliaq-like")
    with_two = edits.with_block(edits.with_block(plain, ("reference", "event")), ("reference", "outage"))
    text = disturbances_toml(with_two)
    assert "[[reference.event]]" in text and "[[reference.outage]]" in text
    pasted = paste(
        edits.with_block(edits.with_block(plain, ("reference", "event")), ("reference", "event")), 0, text
    )
    assert pasted.scenario.reference == with_two.reference
    assert pasted.words == "log events: 1, log outages: 1"
    assert paste(with_two, 0, disturbances_toml(plain)).scenario == plain


@pytest.mark.parametrize(
    ("text", "field", "allowed"),
    [
        ("[[method]", "", "is not valid TOML"),
        ("", "", "must be [[method]], [[reference.event]] or [[reference.outage]]"),
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
        paste(load("zha-fast"), 0, text)
    fault = refused.value.faults[0]
    assert fault.where == WHERE
    assert fault.field == field and allowed in fault.allowed
