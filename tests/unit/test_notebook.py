"""Figures in a notebook: those of the page, as plotly's own class, which checks every property."""

from typing import Any

import numpy as np
import plotly.graph_objects as go
import pytest

from app.notebook import OF_NETWORK, OF_RUN
from navcore import InputError, budget, load, parse_network, simulate

RUN = simulate(load("liu-switching", ["run.duration_h=2"]))


def _check(figure: go.Figure) -> dict[str, Any]:
    assert isinstance(figure, go.Figure)
    drawn = figure.to_dict()
    assert drawn["layout"]["width"] > 500 and drawn["layout"]["height"] > 200
    assert any(np.size(trace.get("y", ())) for trace in drawn["data"])
    return drawn


@pytest.mark.parametrize("name", OF_RUN)
def test_a_run_has_the_figures_of_the_page(name: str) -> None:
    _check(RUN.figure(name))


@pytest.mark.parametrize("name", OF_NETWORK)
def test_a_network_has_its_figures(name: str) -> None:
    _check(parse_network('id = "classic2"').figure(name, lat_deg=30.0))


def test_the_curves_are_those_of_the_run() -> None:
    figure = RUN.figure("errors", group="Velocity")
    drawn = _check(figure)
    assert drawn["layout"]["yaxis"]["title"]["text"].endswith("(m/s)")
    (curve,) = (
        t for t in figure.select_traces() if t["name"] == RUN.methods[0].method.name and t["showlegend"]
    )
    assert np.max(np.abs(curve["y"])) == pytest.approx(RUN.methods[0].errors["dve_mps"]["max_abs"], rel=1e-6)


def test_a_budget_is_drawn_as_bars() -> None:
    drawn = _check(budget(load("sikuliaq-like", ["run.duration_h=1"])).figure())
    assert "bar" in {trace["type"] for trace in drawn["data"]}


def test_an_unknown_or_empty_figure_is_refused_by_name() -> None:
    with pytest.raises(InputError, match="figure = 'curves': must be one of errors, switching"):
        RUN.figure("curves")
    with pytest.raises(InputError, match="no method of this run switches"):
        simulate(load("zha-fast", ["run.duration_h=0.1"])).figure("switching")
