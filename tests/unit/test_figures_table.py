import re
from dataclasses import replace
from html import escape

import numpy as np
import pytest

from navcore.engine.run import Run
from navcore.engine.verification import Difference, Verification
from navcore.foundation.units import ARCMIN, ARCSEC, NAUTICAL_MILE
from navcore.mechanization.recorder import NAMES
from schuler_bench.editing import edits
from schuler_bench.plots import style
from schuler_bench.plots.legend import severity, warnings_for
from schuler_bench.plots.pinned import pinned_methods, restyled, together
from schuler_bench.plots.units import angle_unit, length_unit, rounded, settling, speed_unit, time_unit
from schuler_bench.session.display import Display
from schuler_bench.session.pins import Pins
from schuler_bench.session.shown import laid, titled
from schuler_bench.views.frequency.figure import bode
from schuler_bench.views.metrics.table import (
    STATISTICS,
    difference_rows,
    metrics_html,
    metrics_rows,
    system_html,
    verdict,
)
from schuler_bench.views.metrics.view import warnings_html
from tests.unit.figures_runs import THREE, UNSTABLE, Pinned, diverging, of_trace, run_of, static_run


@pytest.fixture(scope="module")
def pin() -> Pinned:
    return Pinned("before <b>", "#C2185B", run_of())


def test_a_pin_whose_run_is_not_known_yet_is_left_out() -> None:
    assert pinned_methods([Pinned("a", "#000000", None)]) == ()
    assert together(static_run(), [Pinned("a", "#000000", None)]) is static_run()


def test_pinned_loop_is_the_pinned_one(pin: Pinned) -> None:
    run = static_run()
    both, alone = restyled(bode(together(run, (pin,))), (pin,)), bode(pin.run)
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


def test_the_edited_method_is_compared_with_what_it_was_under_another_name() -> None:
    run, before = static_run(), run_of(method=[THREE[0] | {"name": "earlier"}])
    pin = Pinned("a", "#000000", before)

    def changes(edited: tuple[int, str] | None) -> tuple[str, ...]:
        rows = metrics_rows(run, Display(delta="rms"), pin, edited)
        return next(row.deltas for row in rows if row.label == "velocity δVE")

    assert changes(None) == ("not in it",) * 3
    change, *others = changes((0, "earlier"))
    new, old = (each.methods[0].errors["dve_mps"]["rms"] for each in (run, before))
    assert float(change.split(" ")[0]) == pytest.approx(new - old, rel=6e-3) and others == ["not in it"] * 2
    html = metrics_html(run, display=Display(), baseline=pin, edited=(0, "earlier"))
    assert f"{run.methods[0].method.name} is compared with earlier" in html
    # a method that still is there under its name is not compared with another one
    pin = Pinned("a", "#000000", run_of(method=[THREE[1]]))
    assert changes((0, run.methods[1].method.name))[0] == "not in it"


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
    (both, _) = laid(pins.all, edits.with_value(now, ("method", 1, "name"), "another"))
    assert both.run is not None and len(both.run.methods) == 2, "a method that is gone is held too"
    longer = edits.with_value(now, ("run", "duration_h"), 1.5)
    assert titled(pins.all, longer)[0].name.startswith(f"ζ {old:g}, duration ")


FACTORS = {"arcsec": ARCSEC, "arcmin": ARCMIN, "m/s": 1.0, "m": 1.0, "nmi": NAUTICAL_MILE}
QUANTITIES = {
    "tilt φE": "phi_e_rad",
    "tilt φN": "phi_n_rad",
    "heading φU": "phi_u_rad",
    "velocity δVE": "dve_mps",
    "velocity δVN": "dvn_mps",
    "latitude": "dlat_m",
    "longitude": "dlon_m",
    "position": "position_m",
}
QUIET = {"name": "complementary", "damping": "external", "network": {"id": "complementary"}}


def test_every_number_is_the_runs_to_three_digits() -> None:
    run = static_run()
    rows = [row for row in metrics_rows(run) if row.unit]
    assert {row.label for row in rows} == set(QUANTITIES)
    assert {row.unit for row in rows if row.label == "position"} == {"m", "nmi"}
    for row in rows:
        for cell, method in zip(row.cells, run.methods, strict=True):
            for text, statistic in zip(cell, STATISTICS, strict=True):
                value = method.errors[QUANTITIES[row.label]][statistic] / FACTORS[row.unit]
                assert float(text) == pytest.approx(value, rel=5.1e-3)
                digits = re.sub(r"e.*|[^0-9]", "", text).lstrip("0")
                assert len(digits if "." in text else digits.rstrip("0")) <= 3


def loop_rows(run: Run) -> dict[str, list[str]]:
    return {row.label: [cell[0] for cell in row.cells] for row in metrics_rows(run)}


def test_loop_figures() -> None:
    loops = [method.loop for method in static_run().methods]
    rows = loop_rows(static_run())
    assert rows["damping ratio"] == ["0", rounded(loops[1].damping_ratio), "0.700"]
    assert rows["settling"] == ["never", *(settling(loop.settling_s) for loop in loops[1:])]
    assert rows["settling"][2].endswith(" min") and rows["H(0)"][:2] == ["1", "1"]
    ended = loop_rows(diverging(run_of(method=[THREE[1], UNSTABLE]), 1, rows=200))
    assert (ended["run"], ended["settling"][1], rows.get("run")) == (
        ["ok", "diverged"],
        "unstable",
        None,
    )


def test_a_row_says_what_it_is() -> None:
    html = metrics_html(static_run())
    settles = "Last time at which the tilt after an initial tilt exceeds 2 % of it."
    for label, hint in (("settling", settles), ("tilt φE", "Tilt about east φE")):
        assert re.search(rf'<tr title="{re.escape(hint)}"><td>{label}<', html), label


def test_the_best_of_each_row_is_marked_and_points_stand_below_each_other() -> None:
    run = static_run()
    rows = {row.label: row for row in metrics_rows(run)}
    peaks = [method.errors["phi_e_rad"]["max_abs"] for method in run.methods]
    assert [marks[1] for marks in rows["tilt φE"].best] == [peak == min(peaks) for peak in peaks]
    assert not any(marks[2] for marks in rows["tilt φE"].best), (
        "an error passes through 0: final marks no best"
    )
    assert not rows["settling"].best[0][0]
    alone = metrics_rows(run_of(method=[THREE[1]]))
    assert not any(mark for row in alone for marks in row.best for mark in marks)
    shown = re.sub(r"</?span[^>]*>", "", metrics_html(run))
    decimals = {len(text.partition(".")[2]) for text in re.findall(r"sb-n\">(-?[0-9.]+)</td>", shown)}
    assert len(decimals) == 1, "unseen figures fill every number up to the same decimals"


def test_the_tables_hold_every_text_of_their_rows_and_names_are_no_markup() -> None:
    run = run_of(method=[*THREE, {"name": "a|b<script>"}])
    html, system = metrics_html(run), system_html(run)
    for row in metrics_rows(run):
        assert row.label in html and all(f">{text}<" in html for cell in row.cells for text in cell)
    assert all(style.method_color(i) in html for i in range(4))
    assert system.count("<tr") == 1 + len(run.methods) and "times the floor" in system
    assert all(f">{escape(m.method.name)}</td>" in system for m in run.methods)
    assert "<script>" not in html + system and "a|b&lt;script&gt;" in html


def test_warnings_name_their_method_and_keep_their_words() -> None:
    run = run_of(method=[*THREE, UNSTABLE, QUIET])
    warnings = warnings_for(run)
    assert len(warnings[1]) == 1 and "24 h mode grows" in warnings[1][0] and "unstable" in warnings[3][0]
    assert warnings[2] == list(run.methods[2].warnings) and "H(0)" in warnings[2][0]
    assert (severity(run, 4), severity(run, 1), severity(run, 3)) == (None, "warning", "error")


def test_reason_of_an_early_end_comes_first_and_once() -> None:
    run = diverging(static_run(), 2, rows=100)
    reason = run.methods[2].reason
    method = replace(run.methods[2], warnings=(*run.methods[2].warnings, reason))
    run = replace(run, methods=(*run.methods[:2], method))
    assert warnings_for(run)[2][0] == reason and warnings_for(run)[2].count(reason) == 1
    assert warnings_html(replace(run, warnings=("a", "a", "b"))).count("a<br>b") == 1


@pytest.mark.parametrize(
    ("unit", "name"),
    [
        (angle_unit(0.0), "arcsec"),
        (angle_unit(5e-4 * ARCSEC), "mas"),
        (angle_unit(30.0 * ARCSEC), "arcsec"),
        (angle_unit(5.0 * ARCMIN), "arcmin"),
        (angle_unit(np.deg2rad(20.0)), "°"),
        (speed_unit(0.5), "m/s"),
        (speed_unit(0.006), "mm/s"),
        (length_unit(900.0), "m"),
        (length_unit(9000.0), "km"),
        (length_unit(50000.0), "nmi"),
        (length_unit(float("nan")), "m"),
        (time_unit(10799.0), "min"),
        (time_unit(10800.0), "h"),
    ],
)
def test_units_follow_the_size(unit, name: str) -> None:
    assert unit.name == name


def verification() -> Verification:
    run = static_run()
    differences = tuple(
        {name: Difference(ARCSEC * (1 + place), 0.01 * (1 + place)) for name in NAMES} for place in range(3)
    )
    return Verification(run, run, differences, ("the tilt is large",), True)


def test_differences_stand_below_the_errors_and_are_marked_when_old() -> None:
    both = verification()
    rows = difference_rows(both)
    assert len(rows) == 8 and rows[0].cells == (("1 (1 %)",), ("2 (2 %)",), ("3 (3 %)",))
    fresh, old = (metrics_html(static_run(), None, both, old=old) for old in (False, True))
    assert "Full strapdown minus linear model" in fresh and "of an earlier scenario" not in fresh
    assert "of an earlier scenario" in old and old.count("sb-old") == 9
    second = metrics_html(static_run(), [1], both)
    assert "2 (2 %)" in second and "3 (3 %)" not in second


def test_verdict_names_the_worst() -> None:
    assert verdict(verification()) == "Largest difference: 3 % of the peak (velocity δVN, compass)."
    nothing = replace(verification(), differences=({}, {}, {}))
    assert "could not be compared" in verdict(nothing)
    assert {row.cells for row in difference_rows(nothing)} == {(("not known",),) * 3}
