"""The page writes symbols and units as the field does: no Greek letter and no sign is spelled out."""

import re

import pytest

from navcore.foundation.notation import symbol, unit_sign
from navcore.networks import NETWORKS
from schuler_bench.editing import form
from tools.translating.extract import texts

pytestmark = pytest.mark.contract

SPELLED = re.compile(
    r"(?<![\w.\"'])(sigma|xi|zeta2?|eta|rho|omega_?\w*|phi_\w+|dV_\w+|K[1-3]|deg|deg/\w+|ug|sqrt|\w+\^\d)(?![\w(=])"
)
VALUE = re.compile(r"\{[^{}]*\}")
"""A value of a template, whose name the page does not show."""
KEYS = ("must not be given together", "must not be -1 while k3", "must be fields such as")
"""Faults that name fields as the scenario file spells them."""


def test_what_is_spelled_is_found() -> None:
    for text in ("the real part -sigma", "for small xi.", "at 32 deg north", "50 ug", "1 m/s^2", "phi_E"):
        assert SPELLED.search(text), text
    for text in ("method.0.network.xi", "the sigmoid", "the real part -σ", "50 µg"):
        assert not SPELLED.search(text), text


def test_no_text_of_the_page_spells_a_symbol_or_a_unit() -> None:
    prose = (text for text in texts() if text.prose and not text.key.startswith(KEYS))
    spelled = [(text.where, text.key) for text in prose if SPELLED.search(VALUE.sub("", text.key))]
    assert spelled == []


@pytest.mark.parametrize("id", NETWORKS)
def test_labels_of_a_network_carry_the_symbols_of_its_parameters(id: str) -> None:
    for spec in form.fields(NETWORKS[id], ("network",)):
        sign = symbol(str(spec.path[-1]))
        assert not SPELLED.search(spec.label), spec.label
        if not sign.isascii():
            assert sign in spec.label
    assert symbol("xi") == symbol("zeta") == "ζ"


def test_units_are_written_with_signs() -> None:
    written = [unit_sign(unit) for unit in ("deg/sqrt(h)", "ug/sqrt(Hz)", "m/s2", "kn")]
    assert written == ["°/√h", "µg/√Hz", "m/s²", "kn"]
