"""Searches of the report: what they say is varied, and how they judge."""

from itertools import combinations, product

import numpy as np
import pytest

from navcore.scenario.model import Scenario
from tools.papers import search_deng, search_liu, search_zha, sun_ship
from tools.papers.runs import Runs, scenario_of
from tools.papers.search import Axis, IdleAxis, Search, outcome, verdict
from tools.papers.write import papers

SEARCHES = [
    pytest.param(exhibit, id=exhibit.name)
    for paper in papers()
    for exhibit in paper.exhibits
    if exhibit.search is not None
]


def made_up(*rows: tuple[float, ...]) -> Search:
    """Search along one axis, a row of numbers a value."""
    axis = Axis("setting", {str(k): k for k in range(1, len(rows) + 1)})
    return Search(
        (axis,), tuple(range(1, len(rows[0]) + 1)), lambda runs, setting: rows[setting["setting"] - 1]
    )


def searched(*rows: tuple[float, ...]) -> str:
    """Verdict of a search for numbers within 1 to 2, a row a setting."""
    return verdict(outcome(made_up(*rows), [(1.0, 2.0)] * len(rows[0]), Runs()))


def test_a_setting_that_meets_all_claims_is_named():
    assert searched((0.0, 1.0), (1.5, 1.5), (2.0, 1.0)) == (
        "Possible with setting 2 (2 of 3 settings tried): claims 1 and 2 are met."
    )


def test_claims_that_exclude_each_other_are_named_and_which_of_them_stands_alone():
    told = searched((1.5, 1.5, 0.0), (0.0, 0.0, 1.5), (1.5, 0.0, 0.0))
    assert "No setting of 3 tried meets claims 1 and 3, nor 2 and 3 together." in told
    assert "Claim 3 stands alone against the others, which are met by setting 1 (1 of 3" in told


def test_a_claim_that_no_setting_meets_stands_alone():
    told = searched((1.5, 3.0), (0.0, 5.0), (float("nan"), float("nan")))
    assert told == (
        "No setting of 3 tried meets claim 2 (ours from 3.00 to 5.00). It stands alone: claim 1 is met by "
        "setting 1 (1 of 3 settings tried)."
    )


def test_where_none_stands_alone_the_most_is_told():
    told = searched((1.5, 0.0, 0.0), (0.0, 1.5, 0.0), (0.0, 0.0, 1.5))
    assert "meets claims 1 and 2, nor 1 and 3, nor 2 and 3 together" in told
    assert told.endswith("At most claim 1 is met by one setting: setting 1.")


def test_a_setting_is_judged_by_the_interval_over_its_seeds():
    """Means of 1.5 and 1.9; the interval of the second one reaches beyond 2."""
    rows = {"sure": np.array([1.49, 1.5, 1.51]), "unsure": np.array([1.7, 1.9, 2.1])}
    search = Search((Axis("noise", rows),), (1,), lambda runs, setting: (setting["noise"],), 3)
    found = outcome(search, [(1.0, 2.0)], Runs())
    assert found.possible == ("noise sure",)
    assert found.position.tolist() == [[1], [0]]


def test_a_setting_with_other_seeds_than_the_search_states_is_refused():
    search = Search((Axis("x", {"1": 1, "2": 2}),), (1,), lambda runs, s: (np.array([s["x"], 3.0]),), 20)
    with pytest.raises(ValueError, match="2"):
        outcome(search, [(0.0, 9.0)], Runs())


def test_an_axis_that_moves_no_number_is_refused():
    """It is named in the text, but it is held."""
    axes = (Axis("sigma", {"0.03": 0.03, "0.13": 0.13}), Axis("rate", {"1": 1.0, "2": 2.0}))
    held = Search(axes, (1,), lambda runs, setting: (setting["rate"],))
    with pytest.raises(IdleAxis, match="sigma"):
        outcome(held, [(0.0, 9.0)], Runs())


def test_it_is_told_on_what_a_claim_does_not_depend():
    axes = (Axis("sigma", {"0.03": 0.03, "0.13": 0.13}), Axis("rate", {"1": 1.0, "2": 2.0}))
    search = Search(axes, (4, 13), lambda runs, s: (s["sigma"], s["rate"]))
    told = verdict(outcome(search, [(0.0, 9.0)] * 2, Runs()))
    assert told.endswith("Claim 4 does not depend on rate. Claim 13 does not depend on sigma.")


@pytest.mark.parametrize("exhibit", SEARCHES)
def test_the_text_of_a_search_names_every_value_of_its_grid(exhibit):
    search = exhibit.search
    for axis in search.axes:
        assert len(axis.values) > 1, f"{axis.name} is named, but not varied"
        assert axis.text in search.varied
    assert len(search.settings()) == np.prod([len(axis.values) for axis in search.axes])
    assert set(search.claims) <= set(range(1, len(exhibit.claims) + 1))


def content(scenario: Scenario) -> str:
    return repr(scenario.canonical())


ORDINARY = {
    "deng alignment": (
        search_deng.ALIGNMENT_AXES,
        lambda s: scenario_of("deng-static", search_deng.alignment_overrides(s)),
    ),
    "zha drives": (
        search_zha.DRIVE_AXES,
        lambda s: scenario_of("zha-drive", search_zha.zha_drive_overrides("zha-drive", s)),
    ),
    "sun ship": (
        sun_ship.SHIP_AXES[:3],
        lambda s: sun_ship.ship_scenario(1, *(s[axis.name] for axis in sun_ship.SHIP_AXES[:3])),
    ),
    "liu tables": (
        search_liu.TABLES_AXES[:3],
        lambda s: search_liu.at_sea_scenario(1, *(s[axis.name] for axis in search_liu.TABLES_AXES[:3])),
    ),
}


@pytest.mark.parametrize("name", ORDINARY)
def test_each_value_of_an_axis_is_another_scenario(name):
    axes, made = ORDINARY[name]
    first = {axis.name: next(iter(axis.values.values())) for axis in axes}
    for axis in axes:
        contents = [content(made({**first, axis.name: value})) for value in axis.values.values()]
        assert all(one != other for one, other in combinations(contents, 2)), axis.name


def test_deng_every_sigma_has_its_corrected_and_its_printed_form():
    """Claim 13 is a ratio of two forms: with one sigma for all settings it would be held."""
    methods = {method["name"]: method.get("network", {}) for method in search_deng.drive_methods()}
    sigmas = [axis for axis in search_deng.DRIVE_AXES if axis.name == search_deng.SIGMA][0].values.values()
    found = {(block.get("sigma"), block.get("realisation", "")) for block in methods.values()}
    assert set(product(sigmas, ("", "as_printed"))) <= found


def test_sun_the_search_varies_the_law_and_the_network():
    scenario = sun_ship.ship_scenario(1, 0.0, 0.01, 0.006)
    methods = scenario.canonical()["method"][2:]
    laws = {(one["policy"].get("law", "table"), one["network"]["id"]) for one in methods}
    assert laws == set(product(("as_printed", "quadratic", "table"), ("pole2", "unity2")))


def test_every_exhibit_of_a_paper_with_a_claim_that_differs_was_searched():
    """Our own claims say nothing about a paper."""
    for exhibit in (exhibit for paper in papers() for exhibit in paper.exhibits):
        differs = [stated for stated in exhibit.claims if stated.why and stated.kind != "own"]
        assert not differs or exhibit.search is not None, exhibit.name
