"""Controls are made from the models: labels, ranges, sliders and texts."""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import BaseModel

from navcore.foundation.with_unit import read_with_unit
from navcore.law.policy import POLICIES
from navcore.law.switching import SWITCHINGS
from navcore.motion import MOTIONS
from navcore.motion.seagoing import Waves
from navcore.networks import NETWORKS
from navcore.scenario.blocks import RunSettings, SiteSettings
from navcore.scenario.initial_error import InitialError
from navcore.sensors.imu import Imu
from navcore.sensors.log_errors.events import LogEvent
from navcore.sensors.reference import Outage, Reference
from schuler_bench.editing import form, typed
from schuler_bench.editing.form import FieldSpec, Slider
from schuler_bench.editing.rounding import significant
from schuler_bench.editing.typed import unit_of

BLOCKS: list[type[BaseModel]] = [
    Imu, Reference, LogEvent, Outage, RunSettings, SiteSettings, InitialError,
    *NETWORKS.values(), *POLICIES.values(), *SWITCHINGS.values(), *MOTIONS.values(),
]  # fmt: skip
FIELDS = {model: form.fields(model, ("x",)) for model in BLOCKS}
SLIDER_FIELDS = [field for fields in FIELDS.values() for field in fields if field.slider is not None]


def spec(model: type[BaseModel], label: str) -> FieldSpec:
    return next(field for field in FIELDS[model] if field.label == label)


@pytest.mark.parametrize("model", BLOCKS, ids=lambda model: model.__name__)
def test_every_field_has_a_label_a_help_and_a_slider_within_its_range(model: type[BaseModel]) -> None:
    fields = FIELDS[model]
    assert all(field.label and field.hint for field in fields)
    assert len({field.label for field in fields}) == len(fields)
    # a discriminator has a chooser of its own; no visitor names a file of the server
    assert not {field.path[-1] for field in fields} & {"id", "kind", "file", "event", "outage", "leg"}
    for slider in (field.slider for field in fields if field.slider is not None):
        low, high = slider.ends
        assert low < high and (slider.whole or slider.step <= (high - low) / 100.0)


def test_label_carries_the_unit_and_hint_the_range() -> None:
    sigma, bias = spec(NETWORKS["compass"], "decay rate σ (1/s)"), spec(Imu, "gyro bias y (°/h)")
    assert (sigma.path, sigma.slider) == (("x", "sigma"), Slider(5e-4, 0.2, True))
    assert sigma.hint.endswith("Must be >= 1e-05 and <= 1 (1/s).")
    assert bias.path == ("x", "gyro_bias_dph", 1) and "<= 100000 (°/h)" in bias.hint
    labels = [field.label for field in FIELDS[Imu]]
    assert labels[:3] == ["gyro bias x (°/h)", "gyro bias y (°/h)", "gyro bias z (°/h)"]


def test_choices_whole_numbers_flags_and_tables_have_controls_of_their_own() -> None:
    variant = spec(NETWORKS["pole2"], "variant")
    assert (variant.kind, variant.choices) == ("choice", ("exact", "as_printed"))
    assert form.choice(Reference, "kind", ("reference",)).choices == ("none", "log", "file")
    count = spec(POLICIES["variation"], "count")
    assert count.kind == "integer" and count.slider is not None and count.slider.step == 1.0
    assert repr(count.slider.value(20.4)) == "20"
    assert spec(RunSettings, "coning and sculling compensation").kind == "flag"
    (table,) = (field for field in FIELDS[POLICIES["adaptive"]] if field.kind == "pairs")
    assert typed.read_pairs(typed.write_pairs(table.default)) == [list(row) for row in table.default]
    assert {field.path[-1] for field in FIELDS[MOTIONS["legs"]]} == {
        "pitch_deg",
        "roll_deg",
        "heading_deg",
        "repeat",
        "repeat_from",
        "every_h",
    }


@pytest.mark.parametrize("slider", dict.fromkeys(field.slider for field in SLIDER_FIELDS), ids=str)
def test_slider_positions_and_values_belong_together(slider: Slider) -> None:
    low, high = slider.ends
    positions = [low + (high - low) * k / 40.0 for k in range(41)]
    values = [slider.value(position) for position in positions]
    assert (values[0], values[-1]) == (slider.low, slider.high)
    assert all(b > a for a, b in pairwise(values))
    assert [slider.position(value) for value in values] == pytest.approx(positions, abs=slider.step, rel=0.0)


def test_values_beyond_a_slider_stand_at_its_end() -> None:
    slider = Slider(1e-3, 1.0, True)
    assert [slider.position(value) for value in (50.0, 0.0, -3.0)] == [0.0, -3.0, -3.0]


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
    position, span = grown.position(value), high - low
    assert low < high and low <= position <= high
    shown = 10.0**position if slider.log else position
    assert math.isclose(shown, value, rel_tol=1e-5 * max(span, 1.0), abs_tol=1e-5 * span)


@pytest.mark.parametrize(
    ("value", "allowed", "ends"),
    [(1.0 + 1e-9, (0.0, 10.0), (0.0, 1.0)), (7.0, (0.0, 9.0), (0.0, 9.0)), (-0.3, (-1.0, 9.0), (-0.5, 1.0))],
)
def test_a_slider_grows_to_a_round_end_or_not_at_all(
    value: float, allowed: tuple[float, float], ends: tuple[float, float]
) -> None:
    assert Slider(0.0, 1.0, False).reaching(value, allowed).ends == ends


@given(st.floats(1e-9, 1e9), st.integers(1, 9))
def test_significant_keeps_the_digits_asked_for(value: float, digits: int) -> None:
    rounded = significant(value, digits)
    assert math.isclose(rounded, value, rel_tol=0.51 * 10.0 ** (1 - digits))
    assert significant(rounded, digits) == rounded


@given(st.lists(st.complex_numbers(max_magnitude=1e3, allow_nan=False), max_size=4))
def test_roots_survive_the_way_through_text(roots: list[complex]) -> None:
    read = typed.read_roots(typed.write_roots(roots))
    back = [complex(*root) if isinstance(root, list) else complex(root) for root in read]
    assert back == pytest.approx(roots, rel=1e-8, abs=1e-300)


@pytest.mark.parametrize(
    ("read", "text"),
    [(typed.read_roots, text) for text in ("abc", "[1, 2", "1+", "[1,2,3]")]
    + [(typed.read_numbers, "1, two"), (typed.read_pairs, "0: 1: 2")],
)
def test_text_that_is_no_number_is_refused(read: Callable[[str], Any], text: str) -> None:
    with pytest.raises(ValueError):
        read(text)


def test_numbers_are_parted_by_commas_or_blanks() -> None:
    assert typed.read_numbers("1, 0.018 8e-5") == [1.0, 0.018, 8e-5]


# ---------------------------------------------------------------- values with a unit


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("30 min", "h", 0.5),
        ("2 kn", "m/s", 2 * 1852 / 3600),
        ("2kn", "kn", 2.0),
        ("0.5 deg", "arcmin", 30.0),
        ("1e-2 deg/h", "deg/h", 0.01),
        ("3″", "arcsec", 3.0),
        ("50 µg", "ug", 50.0),
        ("-7", "m", -7.0),
        ("1.5", "", 1.5),
    ],
)
def test_units_are_understood(text: str, unit: str, value: float) -> None:
    assert read_with_unit(text, unit) == pytest.approx(value, rel=1e-13)


@pytest.mark.parametrize(
    ("text", "unit", "told"),
    [
        ("30 furlongs", "h", "one of s, min, h, d, not in 'furlongs'"),
        ("30 min", "", "a number without a unit"),
        ("2 kn", "deg", "one of rad, mrad, °"),
        ("half", "h", "must be a number"),
        ("", "h", "must be a number"),
        ("1e999", "h", "finite"),
    ],
)
def test_what_does_not_fit_is_refused_in_words(text: str, unit: str, told: str) -> None:
    with pytest.raises(ValueError, match=told):
        read_with_unit(text, unit)


def test_a_name_that_begins_with_its_block_stands_without_it() -> None:
    labels = [field.label for field in form.fields(Waves, ("motion", "waves"), prefix="waves")]
    assert labels[:5] == [
        "waves spectrum",
        "wave height (m)",
        "waves peak period (s)",
        "waves from (°)",
        "waves spread (°)",
    ]


def test_the_unit_stands_in_the_label() -> None:
    assert (unit_of("settling ≤ (min)"), unit_of("gyro bias x (°/h)"), unit_of("r")) == (
        "min",
        "°/h",
        "",
    )
    assert math.isclose(read_with_unit("90 min", unit_of("duration (h)")), 1.5)
