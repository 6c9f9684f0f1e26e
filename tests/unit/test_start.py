"""Pictures of the presets, cards of the networks, and the words of the tour."""

import re

import pytest

from navcore.networks import NETWORKS
from navcore.scenario.file import load, presets
from schuler_bench.editing import edits
from schuler_bench.views.start.cards import card_path, mark, network_cards


@pytest.mark.parametrize("name", presets())
def test_each_preset_has_a_picture_of_its_own_run(name: str) -> None:
    svg = card_path(name).read_text(encoding="utf-8")
    assert f'data-of="{mark(name)}"' in svg, "run python -m schuler_bench.views.start.cards"
    assert svg.count("<polyline") == len(load(name).method)
    assert "<script" not in svg and len(svg) < 20_000


def test_each_network_of_the_registry_has_a_thumbnail_and_its_trade() -> None:
    cards = network_cards(1.24e-3)
    assert [card.id for card in cards] == list(NETWORKS)
    told = {card.id: card.trade for card in cards}
    assert "Does not damp" in told["none"]
    # Zha's fast network settles within a tenth of an hour, and lets the log in for it
    settles = {
        id: float(re.search(r"in ([0-9.]+) min", text)[1]) for id, text in told.items() if id != "none"
    }
    tilts = {
        id: float(re.search(r"by up to ([0-9.]+) arcsec", text)[1])
        for id, text in told.items()
        if id != "none"
    }
    assert min(settles, key=lambda id: settles[id]) == "compass" == max(tilts, key=lambda id: tilts[id])
    assert all(card.svg.count(",") > 100 for card in cards)


def test_a_copy_of_a_copy_counts_on() -> None:
    scenario = load("sikuliaq-like")
    for _ in range(3):
        scenario, at = edits.with_method(scenario, len(scenario.method) - 1)
    assert [method.name for method in scenario.method[2:]] == [
        "complementary", "complementary 2", "complementary 3", "complementary 4",
    ]  # fmt: skip
