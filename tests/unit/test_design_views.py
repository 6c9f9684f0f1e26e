"""The budget's bars, the fields that a search may move, and the proposal of Tune in words."""

import math
from dataclasses import replace

import pytest

from navcore.design.budget import budget
from navcore.design.default_limits import own_limits
from navcore.design.tune import tune
from navcore.design.vary import tunable_fields
from navcore.engine.simulation import simulate
from navcore.foundation.errors import InputError
from navcore.foundation.units import ARCSEC
from navcore.questions.budget import BudgetQuestion
from navcore.questions.tune import TuneQuestion
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.jobs.asking import Asker
from schuler_bench.jobs.refusals import refusals
from schuler_bench.plots.budgets import steady_budget
from schuler_bench.views.design.figure import NOTHING, budget_figure, parts
from schuler_bench.views.tune.proposal import proposal_html, sentences_about
from tests.limits import limits


@pytest.fixture(scope="module")
def ship() -> Scenario:
    return load("sikuliaq-like")


@pytest.fixture(scope="module")
def compass() -> Scenario:
    network = {"id": "compass", "sigma": 0.0088, "xi": 0.7}
    return Scenario.parse(
        {
            "imu": {"gyro_arw_dpsh": 0.003, "gyro_instability_dph": 0.003, "gyro_tau_s": 3600.0},
            "reference": {"kind": "log", "noise_mps": 0.2},
            "method": [{"name": "<b>compass</b>", "damping": "external", "network": network}],
        }
    )


def test_the_parts_of_a_bar_add_up_to_its_height_and_divide_like_variances(ship):
    method = budget(ship, steady=True).methods[2]
    heights = parts(method, "tilt_rad")
    assert sum(heights.values()) == pytest.approx(method.total.rms.tilt_rad, rel=1e-12)
    known = {name: entry.rms.tilt_rad or 0.0 for name, entry in method.sources.items()}
    variance = sum(size**2 for size in known.values())
    for name, size in known.items():
        assert heights[name] == pytest.approx(sum(heights.values()) * size**2 / variance)


def test_a_method_without_a_steady_state_has_no_bar_and_says_so(ship):
    found = budget(ship, steady=True)
    assert parts(found.methods[0], "tilt_rad") == {}
    texts = [note["text"] for note in budget_figure(found)["layout"]["annotations"]]
    assert texts.count("no steady state") == 2


def test_every_quantity_has_its_bars_its_unit_and_the_floor(ship):
    found = budget(ship)
    made = budget_figure(found, 0.5)
    layout = made["layout"]
    shown = (
        ("tilt_rad", "Tilt", "arcsec", ARCSEC),
        ("velocity_mps", "Velocity", "m/s", 1.0),
        ("heading_rad", "Heading", "arcmin", 60.0 * ARCSEC),
        ("position_m", "Position", "m", 1.0),
    )
    for k, (key, title, unit_name, unit) in enumerate(shown):
        suffix = "" if k == 0 else str(k + 1)
        assert layout[f"xaxis{suffix}"]["title"]["text"] == f"{unit_name}; parts: shares of variance"
        assert f"<b>{title}</b>" in [note["text"] for note in layout["annotations"]]
        bars = [trace for trace in made["data"] if trace["yaxis"] == f"y{suffix}"]
        total = sum(trace["x"][1] for trace in bars)
        # what is below half a per cent of every bar is left out
        assert total == pytest.approx(getattr(found.methods[1].total.rms, key) / unit, rel=0.05)
        lines = [shape for shape in layout["shapes"] if shape["xref"] == f"x{suffix}"]
        assert {line["x0"] for line in lines} == {getattr(found.floor.rms, key) / unit}
        # across the rows of the methods that read the log, which the first, free, does not
        rows = [(line["y0"], line["y1"]) for line in lines]
        assert rows == [(row - 0.5, row + 0.5) for row in range(1, len(found.methods))]


def test_a_growing_whole_system_is_marked_at_its_name(ship):
    """Without a mark before: 1e-5 1/s is e in 1.2 days."""
    found = budget(ship, steady=True)
    made = budget_figure(found, 0.5, growth=[None, 1e-5, -1e-5])
    labels = made["layout"]["yaxis"]["ticktext"]
    assert labels == [found.methods[0].name, f"{found.methods[1].name} ↗1.2 days", found.methods[2].name]
    told = " ".join(note["text"] for note in made["layout"]["annotations"])
    assert "↗ grows by e in this time" in told


def test_a_name_with_markup_is_shown_as_text(compass):
    assert "&lt;b&gt;compass" in budget_figure(budget(compass, steady=True)).to_json()


def test_only_numbers_of_the_network_that_are_given_may_vary(ship, compass):
    assert tunable_fields(ship, 0) == () == tunable_fields(ship, 1)
    assert tunable_fields(ship, 2) == ("method.2.network.zeta", "method.2.network.eta")
    assert tunable_fields(compass, 0) == ("method.0.network.sigma", "method.0.network.xi")


def test_requirements_reach_the_search_in_si():
    asked = limits(settling_s=60.0, damping_ratio=0.4, log_tilt=3.0, position_rms_m=100.0)
    found = {one.name: one.limit for one in own_limits(asked, ())}
    assert found == {
        "settling_s": 3600.0,
        "damping_ratio": 0.4,
        "log_tilt": pytest.approx(3.0 * math.pi / 648000.0),
        "position_rms": 100.0,
    }


def test_a_proposal_names_field_value_floor_and_what_holds_it(compass):
    fields, limits = tunable_fields(compass, 0), ("settling_s<=600",)
    found = tune(compass, "tilt_rms", fields, limits)
    task = TuneQuestion.ask({"scenario": compass, "objective": "tilt_rms", "vary": fields, "require": limits})
    told = " ".join(sentences_about(task, found))
    assert "times the floor" in told and "The requirement settling ≤ 10 min holds the optimum back" in told
    grows = "whole system at latitude 45 deg: the 24 h mode grows, e-folding time 3.1 days"
    assert sentences_about(task, replace(found, warnings=(grows,)))[-1] == grows
    html = proposal_html(task, found)
    assert ">σ<" in html and "arcsec" in html and "0.0088" in html


def test_a_refusal_speaks_the_language_of_the_page(compass):
    """It was "--require = 'settling_s<=60': nothing within these ranges meets ... settling_s comes to"."""
    with pytest.raises(InputError) as refused:
        tune(compass, "tilt_rms", ("method.0.network.xi",), ("settling_s<=60",))
    (words,) = refusals(refused.value, TuneQuestion)
    assert words.startswith("Limit settling ≤ 1 min: nothing within these ranges meets all requirements")
    assert "alone settling comes to" in words and " min; without it steady tilt RMS per axis comes" in words
    assert "--" not in words and "settling_s" not in words and "tilt_rms" not in words


def test_the_start_cards_network_keeps_its_damping():
    """*Tune a network*, *Tune*, *Accept* took zeta from 0.7 to 0.01 and settling from 195 to 5580 min."""
    designer = Asker(lambda: None, TuneQuestion)
    scenario = load("liu-networks", ["run.duration_h=2.0"])
    try:
        vary = tunable_fields(scenario, 2)
        designer.begin(TuneQuestion(scenario=scenario, objective="tilt_rms", vary=vary))
        assert designer.wait_idle(360.0)
        found, task = designer.result, designer.asked
        assert found is not None and task is not None and found.confirmed is not None
        assert found.best["method.2.network.zeta"] > 0.1
        assert (simulate(found.scenario).methods[2].loop.settling_s or math.inf) <= 4.0 * 3600.0
        html = proposal_html(task, found)
        assert "Mean of 32 runs" in html and "settling" in html and "✓ met" in html
        designer.accept(found.scenario)
        assert designer.result is found and designer.accepted is found.scenario
        assert "Accepted for complementary" in proposal_html(task, found, accepted=True)
    finally:
        designer.stop()


def test_the_jobs_give_what_the_library_gives_and_forget_it(compass):
    told: list[int] = []
    designer, budgeter = (Asker(lambda: told.append(1), kind) for kind in (TuneQuestion, BudgetQuestion))
    try:
        task = TuneQuestion(scenario=compass, objective="tilt_rms", vary=("method.0.network.xi",))
        designer.begin(task)
        budgeter.begin(BudgetQuestion(scenario=compass))
        assert designer.wait_idle(60.0) and budgeter.wait_idle(60.0)
        assert designer.result is not None and designer.asked == task
        assert budgeter.beside(BudgetQuestion(scenario=compass)) is not None
        assert budgeter.beside(BudgetQuestion(scenario=load("zha-fast"))) is None
        designer.discard()
        assert designer.result is None and told
    finally:
        designer.stop()
        budgeter.stop()


def test_the_kept_steady_budget_is_that_of_the_whole_scenario(ship):
    kept, whole = steady_budget(ship), budget(ship, steady=True)
    assert kept.document() == whole.document()


def test_the_legend_has_room_for_its_rows_in_a_narrow_window(ship):
    found = budget(ship)
    narrow, wide = (
        budget_figure(found, 0.9, width_px=width)["layout"]["margin"]["b"] for width in (628.0, 948.0)
    )
    # three to a row: seven sources stand in three rows of 20 px below the ticks
    assert narrow >= 30 + 3 * 20 and wide < narrow


@pytest.mark.parametrize(("width", "aspect"), [(467.0, 0.94), (628.0, 0.94), (948.0, 0.43)])
def test_the_note_above_the_panels_is_not_cut(ship, width, aspect):
    layout = budget_figure(steady_budget(ship), aspect, width_px=width)["layout"]
    (note,) = [note["text"] for note in layout["annotations"] if "dashed line" in note["text"]]
    assert 6.0 * len(note) <= width - layout["margin"]["r"]


@pytest.mark.parametrize(("width", "aspect"), [(788.0, 0.41), (628.0, 0.94), (948.0, 0.43)])
def test_eight_methods_have_room_for_their_bars_and_numbers(ship, width, aspect):
    data = ship.canonical()
    data["method"] = [
        data["method"][1 + i % 2] | {"name": f"a method with a long name {i}"} for i in range(8)
    ]
    layout = budget_figure(budget(Scenario.parse(data)), aspect, width_px=width)["layout"]
    margin = layout["margin"]
    inner = width - margin["l"] - margin["r"], aspect * width - margin["t"] - margin["b"]
    for suffix in ("", "2", "3", "4"):
        across, up = layout[f"xaxis{suffix}"], layout[f"yaxis{suffix}"]
        wide, high = (
            size * (axis["domain"][1] - axis["domain"][0])
            for size, axis in zip(inner, (across, up), strict=True)
        )
        assert high >= 8 * 15.0, "a row is as high as its text"
        ends = [
            note for note in layout["annotations"] if note.get("xref") == f"x{suffix}" and "×" in note["text"]
        ]
        assert len(ends) == 8
        for note in ends:
            assert note["x"] / across["range"][1] * wide + 6.4 * len(note["text"]) <= wide + 1.0, note["text"]


@pytest.mark.parametrize("steady", [True, False])
def test_where_no_source_makes_an_error_there_is_a_sentence_and_no_frame(steady):
    data = load("zha-fast").canonical() | {"imu": {}, "reference": {"kind": "log"}}
    data.pop("initial_error", None)
    made = budget_figure(budget(Scenario.parse(data), steady=steady))
    assert [note["text"] for note in made["layout"]["annotations"]] == [NOTHING[steady]]
    assert made["data"] == []
    assert not made["layout"]["xaxis"]["visible"] and not made["layout"]["yaxis"]["visible"]
