"""The page's figures for a notebook, as `plotly.graph_objects.Figure`, and the commands' tables as HTML."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from navcore.design.budget import Budget
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.networks.base import NetworkParameters
from navcore.questions.report import Told
from navcore.questions.run import Ran
from navcore.scenario.model import Scenario
from schuler_bench.plots.plotly_data import Packed, PlotlyFigure
from schuler_bench.plots.saved import time_figure
from schuler_bench.session.display import Display
from schuler_bench.views.design.figure import budget_figure
from schuler_bench.views.errors.figure import GROUPS, error_plots
from schuler_bench.views.frequency.figure import bode, nyquist
from schuler_bench.views.poles.figure import poles
from schuler_bench.views.spectrum.figure import spectrum
from schuler_bench.views.step.figure import step
from schuler_bench.views.switching.figure import switching_plots

if TYPE_CHECKING:
    from matplotlib.figure import Figure as MatplotlibFigure
    from plotly.graph_objects import Figure

Maker = Callable[..., PlotlyFigure]
WIDTH_PX = 940


def _errors(run: Run, group: str = Text("Overview")) -> PlotlyFigure:
    plots = error_plots(run)
    return time_figure([plots[key] for key in GROUPS[group]])


def _switching(run: Run) -> PlotlyFigure:
    plots = switching_plots(run)
    if not plots:
        raise InputError(Fault("", "figure", "switching", Text("no method of this run switches")))
    return time_figure(plots)


OF_NETWORK: dict[str, Maker] = {"bode": bode, "nyquist": nyquist, "poles": poles, "step": step}
OF_RUN: dict[str, Maker] = {
    "errors": _errors,
    "switching": _switching,
    "spectrum": spectrum,
    **OF_NETWORK,
}


def run_figure(run: Run, name: str, **options: Any) -> Figure:
    """Make a figure of a run; see `Run.figure`."""
    return _figure_of(OF_RUN, name, Display().placed(run), options)


def run_paper_figure(
    run: Run, name: str, width_mm: float | None, height_mm: float | None, **options: Any
) -> MatplotlibFigure:
    """Draw a figure of a run by matplotlib; see `Run.paper_figure`."""
    from schuler_bench.plots.printed import printed_figure

    return printed_figure(_made(OF_RUN, name, Display().placed(run), options), width_mm, height_mm)


def run_latex(run: Run) -> str:
    """Write the tables of ``schuler run`` as LaTeX."""
    return Ran(run).latex()


def network_figure(network: NetworkParameters, name: str, lat_deg: float, **options: Any) -> Figure:
    """Make a figure of a network that damps with a log; see `NetworkParameters.figure`."""
    damped = {"damping": "external", "network": network.model_dump(), "name": network.id}
    data = {
        "run": {"duration_h": 0.01},
        "site": {"lat_deg": lat_deg},
        "reference": {"kind": "log"},
        "method": [damped],
    }
    return _figure_of(OF_NETWORK, name, simulate(Scenario.parse(data)), options)


def budget_bars(budget: Budget) -> Figure:
    """Make the bars of an error budget; see `Budget.figure`."""
    return _figure_of({"budget": budget_figure}, "budget", budget, {})


def report_page(told: Told) -> str:
    """Make the page of a report (`navcore.questions.report`)."""
    from schuler_bench.views.requirements.report import page

    return page(told)


def run_tables(run: Run) -> str:
    """Write the tables of ``schuler run`` as HTML."""
    return str(Ran(run).html())


def _figure_of(offered: dict[str, Maker], name: str, subject: Any, options: dict[str, Any]) -> Figure:
    from plotly.graph_objects import Figure

    figure = _made(offered, name, subject, options)
    size = {"width": WIDTH_PX, "height": round(WIDTH_PX * figure.aspect)}
    return Figure(data=[_in_full(trace) for trace in figure["data"]], layout=figure["layout"] | size)


def _made(offered: dict[str, Maker], name: str, subject: Any, options: dict[str, Any]) -> PlotlyFigure:
    if name not in offered:
        raise InputError(Fault("", "figure", name, Text("must be one of {known}", known=", ".join(offered))))
    return offered[name](subject, **options)


def _in_full(trace: dict[str, Any]) -> dict[str, Any]:
    """Give a trace with its packed arrays as numbers."""
    return {key: value.full if isinstance(value, Packed) else value for key, value in trace.items()}
