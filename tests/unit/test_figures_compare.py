"""Pins over figures, and the numbers beside them."""

from __future__ import annotations

import re

import numpy as np
import pytest

from app.editing import edits
from app.plots.pinned import pinned_methods, restyled, together
from app.session.display import Display
from app.session.pins import Pins
from app.session.shown import laid, titled
from app.views.frequency.figure import bode
from app.views.metrics.table import metrics_html, metrics_rows
from tests.unit.figures_runs import Pinned, of_trace, run_of, static_run


@pytest.fixture(scope="module")
def pin() -> Pinned:
    return Pinned("before <b>", "#C2185B", run_of())


def test_a_pin_whose_run_is_not_known_yet_is_left_out() -> None:
    assert pinned_methods([Pinned("a", "#000000", None)]) == ()
    assert together(static_run(), [Pinned("a", "#000000", None)]) is static_run()


def test_pinned_loop_is_the_pinned_one(pin: Pinned) -> None:
    run = static_run()
    both, alone = restyled(bode(together(run, (pin,))), run, (pin,)), bode(pin.run)
    np.testing.assert_array_equal(of_trace(both, "before &lt;b&gt;: compass"), of_trace(alone, "compass"))


def test_differences_are_those_of_methods_of_the_same_name() -> None:
    run, before = static_run(), run_of(method=[{"name": "free"}])
    rows = metrics_rows(run, Display(delta="rms"), Pinned("a", "#000000", before))
    (row,) = [row for row in rows if row.label == "velocity δVE"]
    assert row.deltas[1:] == ("not in it", "not in it")
    new, old = run.methods[0].errors["dve_mps"]["rms"], before.methods[0].errors["dve_mps"]["rms"]
    change, percent = re.fullmatch(r"(\S+) \((\S+) %\)", row.deltas[0]).groups()
    assert float(change) == pytest.approx(new - old, rel=6e-3)
    assert float(percent) == pytest.approx(100.0 * (new / old - 1.0), abs=0.06)


def test_table_has_a_column_of_differences(pin: Pinned) -> None:
    run = static_run()
    rows = {(row.label, row.unit): row for row in metrics_rows(run, Display(delta="final"), pin)}
    row = rows["velocity δVE", "m/s"]
    assert pin.run is not None
    change = run.methods[1].errors["dve_mps"]["final"] - pin.run.methods[1].errors["dve_mps"]["final"]
    assert float(row.deltas[1].split(" ")[0]) == pytest.approx(change, rel=6e-3)
    assert row.deltas[1].endswith("%)")
    html = metrics_html(run, display=Display(delta="final"), baseline=pin)
    assert "Δ final" in html and html.count("sb-delta") == 9 * 3
    assert "before &lt;b&gt;" in html
    assert "sb-delta" not in metrics_html(run)


def test_unchanged_numbers_say_so() -> None:
    run = static_run()
    (row,) = [r for r in metrics_rows(run, None, Pinned("a", "#000000", run)) if r.label == "heading φU"]
    assert row.deltas == ("0 (0 %)",) * 3


def test_table_shows_the_wanted_units() -> None:
    rows = metrics_rows(static_run(), Display(angle="deg", length="km", speed="kn"))
    units = {row.label: row.unit for row in rows}
    assert units["tilt φE"] == units["heading φU"] == "°"
    assert units["velocity δVE"] == "kn"
    assert [row.unit for row in rows if row.label == "position"] == ["km"]


def test_a_pin_is_called_by_what_differs_and_holds_what_a_picture_needs() -> None:
    run = static_run()
    edited = run.scenario.method[2].name
    pins = Pins(lambda: None, lambda *_: run)
    pins.add(run, "static", method=edited)
    pins.add(run, "static", "mine", method=edited)
    now = edits.with_value(run.scenario, ("method", 2, "network", "xi"), 0.61)
    first, second = laid(pins.all, now)
    old = edits.network_values(run.scenario, 2)["xi"]
    assert (first.name, second.name) == (f"ζ {old:g}", "mine")
    assert first.run is not None and [m.method.name for m in first.run.methods] == [edited]
    assert [pin.name for pin in titled(pins.all, run.scenario)] == ["pin 1", "mine"]
    other = edits.with_value(now, ("method", 1, "name"), "another")
    (both, _) = laid(pins.all, other)
    assert both.run is not None and len(both.run.methods) == 2, "a method that is gone is held too"
    longer = edits.with_value(now, ("run", "duration_h"), 1.5)
    assert titled(pins.all, longer)[0].name.startswith(f"ζ {old:g}, duration h ")
