"""Nine tabs: where each view stands, and that nothing that once had a tab has been lost."""

import json
import re
from html import unescape
from pathlib import Path

from schuler_bench.shell.reports import view_names, views_element
from schuler_bench.shell.tabs import standings, tabs
from schuler_bench.views import load

KINDS = load()
ONCE = (
    "Method Sensors Log Run Files View Learn Frequency Poles Step Diagram Misprints Scenario "
    "Errors Spectrum Switching Metrics Requirements Design Tune Compare Sweep Study Ask"
).split()
"""Tabs that the page had before views shared one."""
DOCS = Path(__file__).parents[2] / "docs" / "tabs.md"


TABS = {
    "Method": ["Method"],
    "Setup": ["Sensors", "Log", "Run", "Motion"],
    "Learn": ["Learn"],
    "Frequency": ["Bode", "Step", "Diagram"],
    "Poles": ["Poles"],
    "Errors": ["Time", "Spectrum", "Switching", "Metrics", "Compare"],
    "Limits": ["Requirements", "Design"],
    "Search": ["Tune"],
    "Robustness": ["Sweep", "Study"],
}


def test_nine_tabs_hold_all_views_but_those_of_the_menu() -> None:
    found = {tab: [one.mode for one in held] for tab, held in tabs(KINDS).items()}
    assert list(found) == list(TABS) and len(TABS) == 9
    for tab, modes in TABS.items():  # a view that is added stands beside them
        assert [mode for mode in found[tab] if mode in modes] == modes
    menu = [one.title for one in standings(KINDS) if not one.tab]
    assert menu == ["Files", "View", "Ask", "Misprints", "Scenario"]


def test_the_views_of_a_tab_stand_in_one_panel() -> None:
    places = {kind.title: kind.place for kind in KINDS}
    for tab, held in tabs(KINDS).items():
        assert len({places[one.title] for one in held}) == 1, tab
        assert all(one.fold == (places[one.title] == "edit" and one.tab != one.title) for one in held), tab
        assert len({one.mode for one in held}) == len(held), tab


def test_every_old_tab_is_still_opened_by_its_name() -> None:
    titles = [one.title for one in standings(KINDS)]
    assert set(ONCE) <= set(titles) and len(set(titles)) == len(titles)
    names = view_names(KINDS)
    assert (names["bode"], names["errors"], names["step"]) == ("Frequency", "Errors", "Step")


def test_the_page_is_told_where_each_view_stands() -> None:
    told = json.loads(unescape(re.search('data-tabs="([^"]+)"', views_element(KINDS))[1]))
    assert told[[one["title"] for one in told].index("Step")] == {
        "title": "Step", "tab": "Frequency", "mode": "Step", "fold": False,
    }  # fmt: skip


def test_the_docs_say_where_each_tab_went() -> None:
    rows = re.findall(r"^\| (\w+) \| ([^|]+) \|", DOCS.read_text(encoding="utf-8"), re.MULTILINE)
    went = {title: where.strip() for title, where in rows if title in ONCE}
    assert list(went) == ONCE
    for one in standings(KINDS):
        if one.title in went:
            wanted = f"*{one.tab}*" if one.tab else "menu"
            assert went[one.title].startswith(wanted), one.title
            assert one.tab in ("", one.mode) or f"*{one.mode}*" in went[one.title], one.title
