"""Controls are made from the models: labels, ranges, sliders and texts."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel

from app.editing import form, typed
from app.editing.form import FieldSpec, Slider
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.motion import MOTIONS
from navcore.networks import NETWORKS
from navcore.scenario.model import InitialError, RunSettings, SiteSettings
from navcore.sensors.imu import Imu
from navcore.sensors.log_errors.events import LogEvent
from navcore.sensors.reference import Outage, Reference

BLOCKS: list[type[BaseModel]] = [
    Imu,
    Reference,
    LogEvent,
    Outage,
    RunSettings,
    SiteSettings,
    InitialError,
    *NETWORKS.values(),
    *POLICIES.values(),
    *SWITCHINGS.values(),
    *MOTIONS.values(),
]


def spec(model: type[BaseModel], label: str) -> FieldSpec:
    return next(found for found in form.fields(model, ("x",)) if found.label == label)


@pytest.mark.parametrize("model", BLOCKS, ids=lambda model: model.__name__)
def test_every_field_has_a_label_a_help_and_a_slider_within_its_range(model: type[BaseModel]) -> None:
    found = form.fields(model, ("x",))
    labels = [field.label for field in found]
    assert len(set(labels)) == len(labels)
    for field in found:
        assert field.label, field
        assert field.hint, f"{model.__name__}.{field.path[-1]} has no help"
        if field.slider is not None:
            low, high = field.slider.ends
            assert low < high
            assert field.slider.whole or field.slider.step <= (high - low) / 100.0


def test_label_carries_the_unit_and_hint_the_range() -> None:
    sigma = spec(NETWORKS["compass"], "decay rate σ (1/s)")
    assert sigma.path == ("x", "sigma")
    assert sigma.hint.endswith("Must be >= 1e-05 and <= 1 (1/s).")
    assert sigma.slider == Slider(5e-4, 0.2, True)


def test_vector_becomes_one_control_an_element() -> None:
    labels = [field.label for field in form.fields(Imu, ("imu",))]
    assert labels[:3] == ["gyro bias x (°/h)", "gyro bias y (°/h)", "gyro bias z (°/h)"]
    bias = spec(Imu, "gyro bias y (°/h)")
    assert bias.path == ("x", "gyro_bias_dph", 1)
    assert "<= 100000 (°/h)" in bias.hint


def test_literal_becomes_a_choice_and_discriminators_are_left_out() -> None:
    variant = spec(NETWORKS["pole2"], "variant")
    assert (variant.kind, variant.choices) == ("choice", ("exact", "as_printed"))
    assert not any(f.path[-1] in ("id", "kind") for model in BLOCKS for f in form.fields(model, ("x",)))
    assert form.choice(Reference, "kind", ("reference",)).choices == ("none", "log", "file")


def test_whole_numbers_flags_and_tables_have_controls_of_their_own() -> None:
    count = spec(POLICIES["variation"], "count")
    assert count.kind == "integer" and count.slider is not None
    assert (count.slider.step, count.slider.value(20.4)) == (1.0, 20)
    assert isinstance(count.slider.value(20.4), int)
    assert spec(RunSettings, "coning and sculling compensation").kind == "flag"
    table = next(field for field in form.fields(POLICIES["adaptive"], ("x",)) if field.kind == "pairs")
    assert typed.read_pairs(typed.write_pairs(table.default)) == [list(row) for row in table.default]
    with pytest.raises(ValueError):
        typed.read_pairs("0: 1: 2")


def test_no_control_takes_the_name_of_a_file() -> None:
    assert not any(field.path[-1] == "file" for model in BLOCKS for field in form.fields(model, ("x",)))


def test_files_lists_and_nested_blocks_are_no_controls() -> None:
    paths = {field.path[-1] for field in form.fields(Reference, ("reference",))}
    assert not paths & {"file", "event", "outage"}
    assert {field.path[-1] for field in form.fields(MOTIONS["legs"], ("motion",))} == {
        "pitch_deg",
        "roll_deg",
        "heading_deg",
    }


def order(slider: Slider) -> tuple[bool, float, float]:
    return slider.log, slider.low, slider.high


SLIDERS = {f.slider for model in BLOCKS for f in form.fields(model, ("x",)) if f.slider is not None}


@pytest.mark.parametrize("slider", sorted(SLIDERS, key=order), ids=str)
def test_slider_positions_and_values_belong_together(slider: Slider) -> None:
    low, high = slider.ends
    positions = [low + (high - low) * k / 40.0 for k in range(41)]
    values = [slider.value(position) for position in positions]
    assert values[0] == slider.low
    assert values[-1] == slider.high
    assert all(b > a for a, b in pairwise(values))
    for position, value in zip(positions, values, strict=True):
        assert abs(slider.position(value) - position) <= slider.step


def test_values_beyond_a_slider_stand_at_its_end() -> None:
    slider = Slider(1e-3, 1.0, True)
    assert slider.position(50.0) == slider.position(1.0)
    assert slider.position(0.0) == slider.position(-3.0) == slider.position(1e-3)


SLIDER_FIELDS = [f for model in BLOCKS for f in form.fields(model, ("x",)) if f.slider is not None]


@given(st.sampled_from(SLIDER_FIELDS), st.data())
def test_a_slider_grows_to_hold_every_allowed_value_and_no_farther_than_allowed(
    field: form.FieldSpec, data: st.DataObject
) -> None:
    slider, (least, most) = field.slider, field.allowed
    assert slider is not None and least <= slider.low < slider.high <= most
    value = data.draw(st.floats(max(least, -1e12), min(most, 1e12)))
    grown = slider.reaching(value, field.allowed)
    assert least <= grown.low <= slider.low and slider.high <= grown.high <= most
    if (slider.log and value <= 0.0) or 0.0 < abs(value) < 1e-100:
        assert grown == slider
        return
    low, high = grown.ends
    assert low < high and low <= grown.position(value) <= high
    span = high - low
    shown = 10.0 ** grown.position(value) if slider.log else grown.position(value)
    assert math.isclose(shown, value, rel_tol=1e-5 * max(span, 1.0), abs_tol=1e-5 * span)


def test_a_slider_stays_as_it_is_for_values_inside() -> None:
    slider = Slider(0.0, 1.0, False)
    assert slider.reaching(1.0 + 1e-9, (0.0, 10.0)) is slider
    assert slider.reaching(7.0, (0.0, 9.0)).high == 9.0
    assert slider.reaching(-0.3, (-1.0, 9.0)).low == -0.5


@given(st.floats(1e-9, 1e9), st.integers(1, 9))
def test_significant_keeps_the_digits_asked_for(value: float, digits: int) -> None:
    rounded = form.significant(value, digits)
    assert math.isclose(rounded, value, rel_tol=0.51 * 10.0 ** (1 - digits))
    assert form.significant(rounded, digits) == rounded


@given(st.lists(st.complex_numbers(max_magnitude=1e3, allow_nan=False), max_size=4))
def test_roots_survive_the_way_through_text(roots: list[complex]) -> None:
    text = typed.write_roots(roots)
    back = [complex(*r) if isinstance(r, list) else complex(r) for r in typed.read_roots(text)]
    assert len(back) == len(roots)
    for given_root, read_root in zip(roots, back, strict=True):
        assert abs(given_root - read_root) <= 1e-8 * abs(given_root) + 1e-300


def test_text_that_is_no_number_is_refused() -> None:
    for text in ("abc", "[1, 2", "1+", "[1,2,3]"):
        with pytest.raises(ValueError):
            typed.read_roots(text)
    with pytest.raises(ValueError):
        typed.read_numbers("1, two")
    assert typed.read_numbers("1, 0.018 8e-5") == [1.0, 0.018, 8e-5]
