"""Every control is explained: what it does, its unit and range, its equation and its source."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from app.editing import form
from app.editing.form import FieldSpec
from app.views.explain.text import (
    Explanation,
    explain_html,
    explanation,
    explanations,
    formula_html,
    key_of,
    told_html,
)
from app.views.log.view import _KINDS
from navcore.averaging.parameters import Averaging
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.motion import MOTIONS
from navcore.motion.swing import Oscillation
from navcore.networks import NETWORKS
from navcore.scenario.model import Alignment, InitialError, Method, RunSettings, Scenario, SiteSettings
from navcore.sensors.imu import Imu
from navcore.sensors.reference import Reference


def all_fields() -> Iterator[tuple[str, FieldSpec]]:
    """Every field that the page can show, with its name in ``assets/explain.toml``."""
    plain = {
        "imu": Imu,
        "reference": Reference,
        "run": RunSettings,
        "site": SiteSettings,
        "initial_error": InitialError,
        "alignment": Alignment,
        "method": Method,
        "averaging": Averaging,
    }
    plain |= {f"reference.{name}": model for name, model in _KINDS.items()}
    plain |= {"motion.swing.pitch": Oscillation}
    for part, members in (
        ("network", NETWORKS),
        ("policy", POLICIES),
        ("switching", SWITCHINGS),
        ("motion", MOTIONS),
    ):
        plain |= {f"{part}.{id}": model for id, model in members.items()}
    for name, model in plain.items():
        for spec in form.fields(model, tuple(name.split("."))):
            yield ".".join(str(step) for step in spec.path if not isinstance(step, int)), spec


FIELDS = list(all_fields())


@pytest.mark.parametrize(("key", "spec"), FIELDS, ids=[f"{key}-{spec.label}" for key, spec in FIELDS])
def test_every_control_is_explained_and_every_slider_with_unit_and_range(key: str, spec: FieldSpec) -> None:
    told = explanation(key)
    assert told is not None, key
    assert told.source
    assert spec.hint
    if spec.slider is not None:
        assert re.search(r"Must be (>|<)", spec.hint), spec.hint
        unit = re.search(r"\(([^()]+(\([^()]*\))?[^()]*)\)$", spec.label)
        assert (f"({unit.group(1)})" if unit else "(no unit)") in spec.hint


def test_no_explanation_is_left_over() -> None:
    keys = [key for key, _ in FIELDS] + [
        "network.id",
        "policy.id",
        "switching.id",
        "motion.kind",
        "reference.kind",
    ]
    used = set()
    for key in keys:
        fits = (pattern for pattern in explanations() if explanation(key) is explanations()[pattern])
        used.add(next(fits, None))
    assert set(explanations()) - used == set()


def test_equations_are_mathml() -> None:
    for pattern, told in explanations().items():
        html = formula_html(told.latex) if told.latex else "<math"
        assert html.startswith("<math"), pattern
        assert "\\" not in html, pattern


def test_a_field_is_named_by_the_kind_of_its_block() -> None:
    scenario = Scenario.parse(
        {
            "method": [{"damping": "external", "network": {"id": "compass"}, "policy": {"id": "variation"}}],
            "reference": {"kind": "log"},
            "motion": {"kind": "swing"},
        }
    )
    assert key_of(("method", 0, "network", "xi"), scenario) == "network.compass.xi"
    assert key_of(("method", 0, "network", "id"), scenario) == "network.id"
    assert key_of(("method", 0, "policy", "a"), scenario) == "policy.variation.a"
    assert key_of(("method", 0, "averaging", "variant"), scenario) == "averaging.variant"
    assert key_of(("motion", "kind"), scenario) == "motion.kind"
    assert key_of(("motion", "pitch", "amplitude_deg"), scenario) == "motion.swing.pitch.amplitude_deg"
    assert key_of(("reference", "event", 0, "t_h"), scenario) == "reference.event.t_h"


def test_an_explanation_holds_words_equation_and_source() -> None:
    scenario = Scenario.parse(
        {"method": [{"damping": "external", "network": {"id": "compass"}}], "reference": {"kind": "log"}}
    )
    specs = {spec.path[-1]: spec for spec in form.fields(NETWORKS["compass"], ("method", 0, "network"))}
    html = explain_html(specs["sigma"], scenario)
    assert "Must be &gt;= 1e-05 and &lt;= 1 (1/s)" in html
    assert html.count("<math") == 1
    assert "Deng 2019, eq. 2; Zha 2019, eq. 12" in html
    assert told_html("<b>", "<i>", Explanation(says="<u>")).count("<") == told_html(
        "b", "i", Explanation(says="u")
    ).count("<")
