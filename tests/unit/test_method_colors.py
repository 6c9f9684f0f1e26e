"""Colours of methods: by name, from scenario to scenario, in every picture."""

import re
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from navcore.engine.simulation import simulate
from navcore.scenario.file import load, presets
from navcore.scenario.model import Scenario
from schuler_bench.http.ids import SessionIds
from schuler_bench.notebook import run_figure
from schuler_bench.plots.style import METHOD_COLORS, method_color, places
from schuler_bench.session.session import Session
from schuler_bench.session.sessions import Sessions
from schuler_bench.session.shown import shown
from schuler_bench.views.frequency.figure import bode
from schuler_bench.views.method.chips import chips_html
from schuler_bench.views.strip.view import strip_html

SHIP = load("sikuliaq-like", ["run.duration_h=1"])


def scenario_of(*names: str) -> Scenario:
    return SHIP.model_copy(
        update={"method": tuple(SHIP.method[1].model_copy(update={"name": n}) for n in names)}
    )


@pytest.fixture
def session(tmp_path: Path) -> Iterator[Session]:
    session = Session("c" * 24, SHIP, "sikuliaq-like", tmp_path)
    yield session
    session.close()


def colors(session: Session) -> dict[str, str]:
    """Colours of the chips; those of the strip and of the Bode plot must be the same ones."""
    names = session.display.colored(session.scenario)
    chips = re.findall(
        r'background:(#\w+)"></i><span>(.*?)</span>',
        chips_html(names, 0, [False] * len(names), arranging=True),
    )
    found = {name: color for color, name in chips}
    session.redo_run()
    assert session.wait_idle(60.0)
    now = shown(session)
    assert now is not None
    cards = re.findall(r"--color:(#\w+)\".*?<b>(.*?)</b>", strip_html(now, 0))
    curves = {trace["name"]: trace["line"]["color"] for trace in bode(now.run)["data"] if "line" in trace}
    assert {name: color for color, name in cards} == found == curves
    return found


def test_a_name_has_one_colour_in_all_presets_and_a_preset_no_colour_twice() -> None:
    known: dict[str, set[int]] = {}
    for preset in presets():
        found = places(method.name for method in load(preset).method)
        assert len(set(found.values())) == len(found) and max(found.values()) < len(METHOD_COLORS)
        for name, place in found.items():
            known.setdefault(name, set()).add(place)
    assert {name: own for name, own in known.items() if len(own) > 1} == {}
    assert known["free"] == known["undamped"] == {0}


def test_more_methods_than_colours_have_places_of_their_own() -> None:
    names = [f"m{i}" for i in range(2 * len(METHOD_COLORS))]
    assert [*places(names).values()] == [*range(len(names))]
    assert len(set(places(names, [("m20", 3), ("m5", 3), ("m9", 40)]).values())) == len(names)


def test_another_preset_and_the_first_one_again_keep_the_colours(session: Session) -> None:
    first = colors(session)
    session.change(scenario_of("complementary", "mine", "free"), None, origin="uploaded")
    second = colors(session)
    assert second["complementary"] == first["complementary"] and second["free"] == first["free"]
    session.change(scenario_of("x", "y", "mine"), None, origin="uploaded")
    assert colors(session)["mine"] == second["mine"]
    session.change(SHIP, None, origin="sikuliaq-like")
    assert colors(session) == first


def test_methods_that_come_go_and_move_leave_the_others_their_colours(session: Session) -> None:
    session.change(scenario_of("a", "b", "c", "d"), None)
    before = colors(session)
    for names in (("c", "d"), ("d", "e", "c"), ("b", "d", "e", "c"), ("c", "B", "d"), ("f", "c", "d", "g")):
        session.change(scenario_of(*names), None)
        now = colors(session)
        assert (now["c"], now["d"]) == (before["c"], before["d"]) and len(set(now.values())) == len(names)
    session.change(scenario_of("a", "b", "c", "d"), None)
    assert {name: color for name, color in colors(session).items() if name in "cd"} == {
        "c": before["c"],
        "d": before["d"],
    }


def test_undo_and_a_link_have_the_same_colours() -> None:
    with closing(Sessions(lambda: (SHIP, "sikuliaq-like"))) as visitors:
        session = visitors.get("d" * 24)
        session.change(scenario_of("a", "b", "c"), None)
        session.change(scenario_of("c", "d"), None)
        assert session.display.colored(session.scenario) == {"c": 2, "d": 1}
        copy = visitors.get(SessionIds().new_copy(session.share()))
        assert copy.display.colored(copy.scenario) == {"c": 2, "d": 1}
        session.undo()
        assert session.display.colored(session.scenario) == {"a": 0, "b": 1, "c": 2}


def test_a_notebook_gives_a_name_its_colour() -> None:
    figure = run_figure(simulate(scenario_of("classic2")), "bode")
    assert figure.to_dict()["data"][0]["line"]["color"] == method_color(1)
