"""Clicks on a legend, and pins as they are called beside a run."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import ValidationError

from app.editing import edits
from app.plots.legend import STATES, after
from app.session.display import Display
from app.session.laid import laid, titled
from app.session.pins import Pins
from app.views.errors.figure import error_plots
from tests.unit.figures_runs import static_run


def test_clicks_go_through_all_states_and_come_back() -> None:
    display = Display()
    seen = []
    for _ in STATES:
        display = display.with_(legend=display.clicked("free"))
        seen.append(display.state_of("free"))
    assert seen == [*STATES[1:], "shown"] and display == Display()
    assert after("shown") == "unscaled"
    with pytest.raises(ValidationError):
        Display().with_(legend=[("free", "gone")])


def test_what_is_off_the_scale_decides_no_unit_and_no_decade() -> None:
    run = static_run()
    whole = error_plots(run)["position"]
    largest = int(np.argmax([np.nanmax(np.abs(curve)) for curve in whole.data[1:]]))
    name = whole.names[largest]
    for state in ("unscaled", "hidden"):
        display = Display(legend=((name, state),), scale="log")
        plot = error_plots(run, display=display)["position"]
        others = [i for i in range(len(plot.names)) if i != largest]
        peak = max(float(np.nanmax(plot.data[1 + i])) for i in others)
        assert plot.decades is not None and 10.0 ** plot.decades[1] < 10.0 * peak
        series = plot.series[1 + largest]
        assert series["auto"] is False and (series.get("show", True) is (state == "unscaled"))
        assert plot.config_key() != error_plots(run, display=Display(scale="log"))["position"].config_key()
    dimmed = error_plots(run, display=Display(legend=((name, "dimmed"),)))["position"]
    assert dimmed.series[1 + largest]["stroke"] == whole.curves[largest].color + "59"
    assert dimmed.unit == whole.unit


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
