"""Pinned runs: how many, what they keep, how they come back from a file."""

from __future__ import annotations

import json

import numpy as np
import pytest

from app.jobs.rows import MOST_ROWS, few_rows
from app.session.pins import COLORS, LONGEST_NAME, MOST_PINS, Pins
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from tests.unit.figures_runs import run_of, static_run


@pytest.fixture
def told() -> list[str]:
    return []


@pytest.fixture
def pins(told: list[str]) -> Pins:
    return Pins(lambda: told.append("changed"), simulate)


def test_pins_get_names_and_colours_of_their_own(pins: Pins, told: list[str]) -> None:
    first, second = pins.add(static_run(), "preset"), pins.add(static_run(), "preset", "  best\n so far ")
    assert (first.name, second.name) == ("pin 1", "best so far")
    assert first.color != second.color and first.shown
    assert pins.shown == (first, second)
    assert pins.baseline(None) is first and pins.baseline(2) is second and pins.baseline(99) is first
    assert len(told) == 2


def test_more_than_the_most_are_refused_and_an_id_is_never_used_again(pins: Pins) -> None:
    for _ in range(MOST_PINS):
        pins.add(static_run(), "")
    assert len({pin.color for pin in pins.all}) == len(COLORS) == MOST_PINS
    with pytest.raises(InputError, match=f"at most {MOST_PINS}"):
        pins.add(static_run(), "")
    pins.remove(3)
    assert pins.add(static_run(), "").id == MOST_PINS + 1
    assert pins.get(3) is None


def test_a_pin_is_renamed_hidden_recoloured_and_annotated(pins: Pins, told: list[str]) -> None:
    pins.add(static_run(), "")
    pins.change(1, name="x" * 100, note=" good ", color="moss", shown=False)
    pin = pins.get(1)
    assert pin is not None and (len(pin.name), pin.note, pin.hex) == (LONGEST_NAME, "good", COLORS["moss"])
    assert pins.shown == ()
    pins.change(1, name="")
    assert pins.all[0].name == "pin 1"
    with pytest.raises(InputError, match="color"):
        pins.change(1, color="red")
    count = len(told)
    pins.change(1, name="pin 1")
    pins.change(99, name="nobody")
    pins.remove(99)
    assert len(told) == count


def test_a_pinned_run_keeps_its_curves_and_numbers_but_few_rows() -> None:
    run = static_run()
    assert len(run.t_s) > MOST_ROWS
    few = few_rows(run)
    assert len(few.t_s) <= MOST_ROWS + 1
    assert (few.t_s[0], few.t_s[-1]) == (run.t_s[0], run.t_s[-1])
    assert len(few.truth) == len(few.t_s) == len(few.methods[0].rows) == len(few.methods[0].law_series)
    for whole, thin in zip(run.methods, few.methods, strict=True):
        assert thin.plot is whole.plot and thin.errors == whole.errors
        np.testing.assert_array_equal(thin.rows[-1], whole.rows[-1])
    assert few_rows(few) is few


def test_pins_come_back_from_a_file_and_are_computed_again(pins: Pins, told: list[str]) -> None:
    run = run_of()
    pins.add(run, "preset", "old")
    pins.change(1, note="why", shown=False)
    kept = json.loads(json.dumps(pins.to_json()))
    again = Pins(lambda: told.append("again"), simulate)
    again.from_json(kept)
    assert again.wait_idle(20.0)
    pin = again.all[0]
    assert (pin.name, pin.note, pin.shown, pin.origin) == ("old", "why", False, "preset")
    assert pin.scenario == run.scenario and pin.run is not None
    np.testing.assert_array_equal(pin.run.methods[0].plot.values, run.methods[0].plot.values)
    assert "again" in told
    assert again.add(run, "").id == 2


@pytest.mark.parametrize("wrong", [5, [{}], [{"name": "a"}], [5], None])
def test_what_is_no_list_of_pins_is_refused_and_changes_nothing(pins: Pins, wrong: object) -> None:
    pins.add(static_run(), "")
    with pytest.raises((ValueError, TypeError, KeyError)):
        pins.from_json(wrong)
    assert len(pins) == 1
