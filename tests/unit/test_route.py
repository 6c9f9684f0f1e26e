"""The route by hand: legs and points are shown in a table, edited, added and removed."""

from typing import Any

import pytest

from navcore.foundation.errors import InputError
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits
from schuler_bench.views.motion.route import (
    count_of,
    fields_of,
    list_of,
    route_html,
    with_one_more,
    without_one,
)

LEGS = Scenario.parse(
    {
        "motion": {
            "kind": "legs",
            "leg": [
                {"duration_s": 3600.0, "speed_mps": 6.0, "heading_deg": 40.0},
                {"duration_s": 1800.0, "heading_deg": 130.0},
            ],
        }
    }
)
POINTS = Scenario.parse(
    {
        "motion": {
            "kind": "profile",
            "point": [{"t_s": 0.0, "speed_mps": 5.0}, {"t_s": 600.0, "speed_mps": 8.0}],
        }
    }
)


def test_the_table_holds_what_the_legs_give() -> None:
    html = route_html(LEGS, 1)
    assert html.count("<tr") == 3 and "<b>2</b>" in html
    assert "duration" in html and "heading" in html and "turn rate" not in html
    assert "3600" in html and "130" in html
    assert route_html(load("zha-fast", ["motion={kind='static'}"]), 0) == ""


@pytest.mark.parametrize(("scenario", "name"), [(LEGS, "leg"), (POINTS, "point")])
def test_one_more_stands_behind_the_edited_one(scenario: Scenario, name: str) -> None:
    assert list_of(scenario) == name and count_of(scenario) == 2
    more = with_one_more(scenario, 0)
    blocks, before = getattr(more.motion, name), getattr(scenario.motion, name)
    assert len(blocks) == 3 and blocks[0] == before[0] and blocks[2] == before[1]
    assert blocks[1].speed_mps == before[0].speed_mps
    assert without_one(more, 1) == scenario


def blocks_of(scenario: Scenario) -> Any:
    """Legs or points of a scenario."""
    return getattr(scenario.motion, list_of(scenario))


def test_a_point_is_put_half_way_to_the_next() -> None:
    assert [point.t_s for point in blocks_of(with_one_more(POINTS, 0))] == [0.0, 300.0, 600.0]
    assert blocks_of(with_one_more(POINTS, 1))[-1].t_s > 600.0


def test_a_leg_is_edited_by_its_own_controls() -> None:
    specs = {spec.path[-1]: spec for spec in fields_of(LEGS, 1)}
    assert specs["heading_deg"].label.startswith("leg 2")
    changed = edits.with_value(LEGS, specs["heading_deg"].path, 200.0)
    assert blocks_of(changed)[1].heading_deg == 200.0 and blocks_of(changed)[0] == blocks_of(LEGS)[0]
    assert fields_of(LEGS, 2) == [] and fields_of(load("zha-fast"), 9) == []


def test_the_last_one_cannot_be_removed() -> None:
    alone = without_one(LEGS, 1)
    with pytest.raises(InputError, match="at least one"):
        without_one(alone, 0)
