"""The strip of results: one statistic and one unit for each quantity, and changes that can be read."""

import re

from schuler_bench.plots.units import relative
from schuler_bench.session.display import Display
from schuler_bench.session.shown import Shown
from schuler_bench.views.strip.view import strip_html
from tests.unit.figures_runs import THREE, run_of


def facts(html: str) -> dict[str, list[str]]:
    """Texts of each fact, by its label, one a card."""
    found: dict[str, list[str]] = {}
    for label, text in re.findall(r"<small>(.*?)</small><span>(.*?)</span>", html):
        found.setdefault(label, []).append(text)
    return found


def test_a_quantity_has_one_unit_and_one_statistic_on_all_cards() -> None:
    """5.75 mm/s stood beside 0.319 m/s, and "velocity" was an RMS, "tilt" a maximum."""
    run = run_of(
        run={"duration_h": 8.0}, imu={"gyro_bias_dph": [0.0, 0.05, 0.0]},
        method=[{"name": "free"}, THREE[1]], reference={"kind": "log"},
    )  # fmt: skip
    found = facts(strip_html(Shown(run, 1, Display()), 0))
    assert list(found) == ["max tilt", "max velocity", "max position", "settles"]
    for label in ("max tilt", "max velocity", "max position"):
        assert len(found[label]) == 2
        assert len({text.partition(" ")[2] for text in found[label]}) == 1, found[label]


def test_a_large_change_is_a_factor() -> None:
    assert relative(973.24, 1.0) == "× 973" and relative(1.5, 1.0) == "+50 %"
