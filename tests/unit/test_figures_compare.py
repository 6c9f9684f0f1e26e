"""Pins over figures, and the numbers beside them."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import pytest

from app.plots.pinned import pinned_methods, restyled, together
from app.plots.plotly_data import unpacked
from app.session.display import Display
from app.views.errors.figure import error_plots
from app.views.errors.legend import legend_html
from app.views.frequency.figure import bode
from app.views.metrics.table import metrics_html, metrics_rows
from app.views.poles.figure import poles
from app.views.spectrum.figure import spectrum
from app.views.step.figure import step
from navcore.engine.run import Run
from tests.unit.figures_runs import run_of, static_run


@dataclass
class Pinned:
    name: str
    hex: str
    run: Run | None


@pytest.fixture(scope="module")
def pin() -> Pinned:
    return Pinned("before <b>", "#C2185B", run_of())


def test_a_pin_is_drawn_over_every_time_plot_in_its_own_style(pin: Pinned) -> None:
    run = static_run()
    for plot in error_plots(run, pins=(pin,)).values():
        assert plot.names[3:] == ("before <b>: free", "before <b>: classic2", "before <b>: compass")
        own, pinned = plot.curves[:3], plot.curves[3:]
        assert {curve.color for curve in pinned} == {"#C2185B"}
        assert len({curve.dash for curve in pinned} - {()}) == 3
        assert max(curve.width for curve in pinned) < min(curve.width for curve in own)
        hours, curve = plot.data[0], plot.data[4]
        assert np.isnan(curve[hours > 1.1]).all() and np.isfinite(curve[hours < 0.99]).all()
    html = legend_html(run, None, (pin,))
    assert "before &lt;b&gt;: compass" in html and "#C2185B" in html


def test_a_pin_whose_run_is_not_known_yet_is_left_out() -> None:
    assert pinned_methods([Pinned("a", "#000000", None)]) == ()
    assert together(static_run(), [Pinned("a", "#000000", None)]) is static_run()


@pytest.mark.parametrize("figure", [bode, poles, step, spectrum])
def test_a_pin_is_drawn_over_the_plotly_figures(figure, pin: Pinned) -> None:
    run = static_run()
    alone, both = figure(run), restyled(figure(together(run, (pin,))), run, (pin,))
    mine = [t for t in both["data"] if str(t.get("legendgroup", "")) in "012" and t.get("legendgroup")]
    others = [t for t in both["data"] if str(t.get("legendgroup", "")) in ("3", "4", "5")]
    assert others and all("before &lt;b&gt;" in t["name"] for t in others)
    for trace in others:
        style = trace.get("line") or trace["marker"]
        assert style["color"] == "#C2185B"
    # how many settling times are named follows from the room that the legend leaves
    counts = [
        sum(not note["text"].endswith(" min") for note in made["layout"]["annotations"])
        for made in (both, alone)
    ]
    assert counts[0] == counts[1]
    before = [t for t in alone["data"] if str(t.get("legendgroup", "")) in "012" and t.get("legendgroup")]
    assert [t.get("line", t.get("marker")) for t in mine] == [t.get("line", t.get("marker")) for t in before]


def test_pinned_loop_is_the_pinned_one(pin: Pinned) -> None:
    run = static_run()
    made = restyled(bode(together(run, (pin,))), run, (pin,))
    assert pin.run is not None
    alone = bode(pin.run)
    mine = [t for t in made["data"] if t["legendgroup"] == "5" and t["yaxis"] == "y"]
    theirs = [t for t in alone["data"] if t["legendgroup"] == "2" and t["yaxis"] == "y"]
    np.testing.assert_array_equal(unpacked(mine[0]["y"]), unpacked(theirs[0]["y"]))


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
