"""Every control is explained: what it does, its unit and range, its equation and its source."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from app.editing import form
from app.editing.form import FieldSpec
from app.views.explain.view import (
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
    words = explanation(key)
    assert words is not None and words.source and spec.hint, key
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
    used = {id(explanation(key)) for key in keys}
    assert [pattern for pattern, entry in explanations().items() if id(entry) not in used] == []


def test_equations_are_mathml() -> None:
    for pattern, entry in explanations().items():
        html = formula_html(entry.latex) if entry.latex else "<math"
        assert html.startswith("<math") and "\\" not in html, pattern


COMPASS = {"damping": "external", "network": {"id": "compass"}, "policy": {"id": "variation"}}
SCENARIO = Scenario.parse({"method": [COMPASS], "reference": {"kind": "log"}, "motion": {"kind": "swing"}})


@pytest.mark.parametrize(
    ("path", "key"),
    [
        (("method", 0, "network", "xi"), "network.compass.xi"),
        (("method", 0, "network", "id"), "network.id"),
        (("method", 0, "policy", "a"), "policy.variation.a"),
        (("method", 0, "averaging", "variant"), "averaging.variant"),
        (("motion", "kind"), "motion.kind"),
        (("motion", "pitch", "amplitude_deg"), "motion.swing.pitch.amplitude_deg"),
        (("reference", "event", 0, "t_h"), "reference.event.t_h"),
    ],
)
def test_a_field_is_named_by_the_kind_of_its_block(path: form.Path, key: str) -> None:
    assert key_of(path, SCENARIO) == key


def test_an_explanation_holds_words_equation_and_source() -> None:
    specs = {spec.path[-1]: spec for spec in form.fields(NETWORKS["compass"], ("method", 0, "network"))}
    html = explain_html(specs["sigma"], SCENARIO)
    assert "Must be &gt;= 1e-05 and &lt;= 1 (1/s)" in html and html.count("<math") == 1
    assert "Deng 2019, eq. 2; Zha 2019, eq. 12" in html
    hostile, plain = (told_html(a, b, Explanation(says=c)) for a, b, c in (("<b>", "<i>", "<u>"), "biu"))
    assert hostile.count("<") == plain.count("<")
