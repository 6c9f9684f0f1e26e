"""The figure of the whole system, and the line that names the 24 h mode."""

from __future__ import annotations

import numpy as np
import pytest

from app.plots.earth_mode import earth_mode_text
from app.plots.plotly_data import unpacked
from app.views.method.view import loop_text
from app.views.poles.whole import LATITUDES, whole_system_figure
from navcore.analysis.whole_system import EARTH_MODE, NETWORK_MODE, SCHULER_MODE, whole_system
from navcore.foundation.units import DEG
from tests.unit.figures_runs import THREE, run_of


def test_every_method_has_its_modes_and_its_curve_of_growth() -> None:
    run = run_of(method=THREE)
    made = whole_system_figure(run)
    traces = {trace["name"]: trace for trace in made["data"]}
    for method in run.methods:
        name = method.method.name
        for kind, suffix in ((EARTH_MODE, f" {EARTH_MODE}"), (SCHULER_MODE, ""), (NETWORK_MODE, " network")):
            assert len(traces[f"{name}{suffix}"]["text"]) == len(method.whole.named(kind))
        assert len(unpacked(traces[f"{name} growth"]["x"])) == len(LATITUDES)
        assert traces[f"{name} at the site"]["y"] == [method.whole.earth_growth * 86400.0]


@pytest.mark.parametrize(
    ("growth", "text"),
    [
        (1.0 / (3.09 * 86400.0), "grows, e-folding 3.1 days"),
        (-1.0 / (20.0 * 3600.0), "decays, e-folding 20 h"),
        (0.0, "neither grows nor decays"),
    ],
)
def test_the_24_h_mode_in_words(growth: float, text: str) -> None:
    assert earth_mode_text(growth) == text


def test_the_line_below_the_network_says_both() -> None:
    run = run_of(method=THREE)
    text = loop_text(run.methods[1], run.scenario.site.lat_deg)
    here = whole_system(
        run.methods[1].network, "external", run.scenario.site.lat_deg * DEG, run.scenario.earth
    )
    assert np.isclose(run.methods[1].whole.earth_growth, here.earth_growth)
    assert text.startswith("One channel: least damping ratio 0.699, settles to 2 % in 53")
    assert f"Whole system: 24 h mode {earth_mode_text(here.earth_growth)}" in text
