"""Figures in a notebook: those of the page, as plotly's own class, which checks every property."""

from html.parser import HTMLParser
from typing import Any

import numpy as np
import plotly.graph_objects as go
import pytest

from navcore import InputError, budget, load, parse_network, simulate
from navcore.engine.measures import measure
from navcore.questions.run import Ran
from schuler_bench.notebook import OF_NETWORK, OF_RUN

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
    largest = measure(RUN.methods[0], "velocity_max_mps")
    assert np.max(np.abs(curve["y"])) == pytest.approx(largest, rel=1e-6)


def test_a_budget_is_drawn_as_bars() -> None:
    drawn = _check(budget(load("sikuliaq-like", ["run.duration_h=1"])).figure())
    assert "bar" in {trace["type"] for trace in drawn["data"]}


def test_an_unknown_or_empty_figure_is_refused_by_name() -> None:
    with pytest.raises(InputError, match="figure = 'curves': must be one of errors, switching"):
        RUN.figure("curves")
    with pytest.raises(InputError, match="no method of this run switches"):
        simulate(load("zha-fast", ["run.duration_h=0.1"])).figure("switching")


class Text(HTMLParser):
    """Text that a browser shows of some HTML."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.shown = ""
        self.feed(html)

    def handle_data(self, data: str) -> None:
        self.shown += data


def test_a_run_as_a_cell_s_last_line_is_the_tables_of_the_command() -> None:
    run = simulate(load("liu-switching", ["run.duration_h=0.1", "title=a<b> & c"]))
    shown = Text(run._repr_html_()).shown
    assert "".join(shown.split()) == "".join("".join(Ran(run).lines()).split())
    assert repr(run).startswith("<Run 'a<b> & c', error_model, 0.1 h; ") and len(repr(run)) < 300
    assert all(f"{method.method.name!r}: ok" in repr(run) for method in run.methods)
    assert len(repr(run.methods)) < 300


@pytest.mark.parametrize("steady", [False, True])
def test_a_budget_as_a_cell_s_last_line_is_the_tables_of_the_command(steady: bool) -> None:
    result = budget(load("sikuliaq-like", ["run.duration_h=1"]), steady)
    shown = Text(result._repr_html_()).shown
    assert "".join(shown.split()) == "".join("".join(result.lines()).split())
    assert all(repr(method.name) in repr(result) for method in result.methods)
    assert len(repr(result)) < 300 and len(repr(result.methods)) < 300
