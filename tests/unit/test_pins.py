"""Pinned runs: how many, what they keep, how they come back from a file."""

import json
from typing import Any

import numpy as np
import pytest

from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from schuler_bench.jobs.rows import MOST_ROWS, few_rows
from schuler_bench.session.pins import COLORS, LONGEST_NAME, MOST_PINS, Pins
from schuler_bench.session.shown import difference, laid
from tests.unit.figures_runs import run_of, static_run


@pytest.fixture
def changes() -> list[str]:
    return []


@pytest.fixture
def pins(changes: list[str]) -> Pins:
    return Pins(lambda: changes.append("changed"), simulate)


def test_pins_get_names_and_colours_of_their_own(pins: Pins, changes: list[str]) -> None:
    first, second = (pins.add(static_run(), "preset", name) for name in ("", "  best\n so far "))
    assert (first.name, second.name) == ("pin 1", "best so far")
    assert first.color != second.color and pins.shown == (first, second)
    assert [pins.baseline(id) for id in (None, 2, 99)] == [first, second, first]
    assert len(changes) == 2


def test_more_than_the_most_are_refused_and_an_id_is_never_used_again(pins: Pins) -> None:
    colors = {pins.add(static_run(), "").color for _ in range(MOST_PINS)}
    assert len(colors) == len(COLORS) == MOST_PINS
    with pytest.raises(InputError, match=f"at most {MOST_PINS}"):
        pins.add(static_run(), "")
    pins.remove(3)
    assert (pins.add(static_run(), "").id, pins.get(3)) == (MOST_PINS + 1, None)


@pytest.mark.parametrize(
    ("id", "change", "now"),
    [
        (1, {"name": "x" * 100}, {"name": "x" * LONGEST_NAME}),
        (1, {"name": ""}, {}),
        (1, {"note": " good "}, {"note": "good"}),
        (1, {"color": "moss"}, {"color": "moss", "hex": COLORS["moss"]}),
        (1, {"shown": False}, {"shown": False}),
        (1, {"name": "pin 1"}, {}),
        (99, {"name": "nobody"}, {}),
    ],
)
def test_a_pin_is_renamed_hidden_recoloured_and_annotated(
    pins: Pins, changes: list[str], id: int, change: dict[str, Any], now: dict[str, Any]
) -> None:
    before = pins.add(static_run(), "")
    pins.change(id, **change)
    (pin,) = pins.all
    assert {name: getattr(pin, name) for name in now} == now and (pin == before) is (not now)
    assert pins.shown == ((pin,) if pin.shown else ())
    pins.remove(99)
    assert len(changes) == 1 + bool(now)


def test_a_colour_that_is_not_offered_is_refused(pins: Pins) -> None:
    with pytest.raises(InputError, match="color"):
        pins.change(1, color="red")


def test_a_pinned_run_keeps_its_curves_and_numbers_but_few_rows() -> None:
    run, few = static_run(), few_rows(static_run())
    assert len(few.t_s) <= MOST_ROWS + 1 <= len(run.t_s)
    assert (few.t_s[0], few.t_s[-1]) == (run.t_s[0], run.t_s[-1])
    assert len(few.truth) == len(few.t_s) == len(few.methods[0].rows) == len(few.methods[0].law_series)
    for whole, thin in zip(run.methods, few.methods, strict=True):
        assert thin.plot is whole.plot and thin.errors == whole.errors
        np.testing.assert_array_equal(thin.rows[-1], whole.rows[-1])
    assert few_rows(few) is few


def test_pins_come_back_from_a_file_and_are_computed_again(pins: Pins, changes: list[str]) -> None:
    run = run_of()
    pins.add(run, "preset", "old")
    pins.change(1, note="why", shown=False)
    again = Pins(lambda: changes.append("again"), simulate)
    again.from_json(json.loads(json.dumps(pins.to_json())))
    assert again.wait_idle(20.0)
    pin = again.all[0]
    assert (pin.name, pin.note, pin.shown, pin.origin) == ("old", "why", False, "preset")
    assert pin.scenario == run.scenario and pin.run is not None
    np.testing.assert_array_equal(pin.run.methods[0].plot.values, run.methods[0].plot.values)
    assert "again" in changes and again.add(run, "").id == 2


@pytest.mark.parametrize("wrong", [5, [{}], [{"name": "a"}], [5], None])
def test_what_is_no_list_of_pins_is_refused_and_changes_nothing(pins: Pins, wrong: object) -> None:
    pin = pins.add(static_run(), "")
    with pytest.raises((ValueError, TypeError, KeyError)):
        pins.from_json(wrong)
    assert pins.all == (pin,)


def test_a_pin_of_another_scenario_is_not_drawn_over_its_curves(pins: Pins) -> None:
    pin, scenario = pins.add(static_run(), "preset"), static_run().scenario
    assert [each.id for each in laid(pins.all, scenario)] == [pin.id]
    assert laid(pins.all, scenario.model_copy(update={"title": "another"})) == ()


def test_a_pin_is_named_in_words_with_units(pins: Pins) -> None:
    """A pin was called "bias mps [0.0, 0.0]"."""
    pin, scenario = pins.add(static_run(), "preset"), static_run().scenario
    other = scenario.model_copy(
        update={"reference": scenario.reference.model_copy(update={"bias_mps": (0.0, 0.0)})}
    )
    assert difference(pin, other) == "log bias 0.3, 0.1 m/s"
