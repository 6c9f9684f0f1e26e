"""The page in Firefox, with settings that people have there."""

from pathlib import Path
from typing import Any

import pytest

from schuler_bench.dashboard import Dashboard
from schuler_bench.http.server import DashboardServer
from tests.browser.firefox import FIREFOX, Firefox

RIGHT = "\ue014"
"""The right arrow, in WebDriver's code of keys."""
SETTINGS: dict[str, dict[str, Any]] = {
    "as installed": {},
    "no cookies": {"network.cookie.cookieBehavior": 2},
    "resisting fingerprinting": {"privacy.resistFingerprinting": True},
    "a dark system": {"ui.systemUsesDarkTheme": 1},
    "a least size": {"font.minimum-size.x-western": 16},
}


needs_firefox = pytest.mark.skipif(FIREFOX is None, reason="needs Firefox (apt-get install firefox-esr)")


@needs_firefox
def test_a_page_connects_whatever_follows_the_hash_of_its_address(
    dashboard: tuple[DashboardServer, Dashboard], tmp_path: Path
) -> None:
    with Firefox(tmp_path, 1366, 768) as firefox:
        firefox.open(f"{dashboard[0].url}#anything")
        firefox.wait_for("location.pathname.includes('/s/') && location.hash === '#anything'")
        firefox.wait_for("Number(document.querySelector('#sb-run')?.dataset.run ?? 0)")
        assert firefox.faults == []


@needs_firefox
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.nightly if own else ()) for name, own in SETTINGS.items()]
)
def test_a_slider_moves_the_picture_in_firefox(
    dashboard: tuple[DashboardServer, Dashboard], tmp_path: Path, name: str
) -> None:
    with Firefox(tmp_path, 1366, 768, SETTINGS[name]) as firefox:
        firefox.open(f"{dashboard[0].url}?start=no&fixedDpr=1&tab=Poles")
        run = "Number(document.querySelector('#sb-run')?.dataset.run ?? 0)"
        before = firefox.wait_for(run)
        firefox.wait_for("document.querySelector('.uplot canvas') !== null")
        firefox.wait_for("[...document.querySelectorAll('[role=tab][aria-selected=true]')]"
                         ".some(tab => tab.textContent === 'Poles')")  # fmt: skip
        firefox.wait_for("document.querySelector('.js-plotly-plot .trace') !== null")
        # the map, in 3D or flat
        firefox.wait_for("!window.schuler.without3d || document.querySelector('.sb-flat text') !== null")
        metrics = firefox.evaluate("document.querySelector('#sb-run').textContent")
        firefox.evaluate("document.querySelector('[role=slider]').focus()")
        firefox.press(RIGHT)
        firefox.wait_for(f"{run} > {before}")
        assert firefox.evaluate("document.querySelector('#sb-run').textContent") != metrics
        firefox.screenshot(tmp_path / "firefox.png")
        assert firefox.faults == []
