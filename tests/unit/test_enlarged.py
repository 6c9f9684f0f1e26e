"""Presentation size: plots keep their numbers and proportions, and what counts pixels grows."""

from __future__ import annotations

import numpy as np
import pytest

from app.plots import style
from app.plots.plotly_data import enlarged, enlarged_time_plot, figure, packed
from app.shell.layout import layout_for
from app.views.errors.figure import error_plots
from tests.unit.figures_runs import static_run

SCALE = 1.5


def test_type_lines_and_margins_grow_and_the_numbers_stay():
    x = packed(np.arange(3.0))
    line = {"type": "scatter", "x": x, "y": [1, 2, 3], "line": {"width": 2.0, "dash": "dot"}}
    marker = {"marker": {"size": [4, 6], "line": {"width": 1}}}
    layout = style.layout(
        margin={"l": 60, "t": 30},
        meta={"aspect": 0.5},
        xaxis=style.axis("time", range=[0, 4]),
        annotations=[style.panel_title("Tilt")],
        shapes=[{"type": "line", "x0": 1, "x1": 1, "line": {"width": 1.2}}],
    )
    larger = enlarged(figure([line | marker], layout), SCALE)
    drawn, laid = larger["data"][0], larger["layout"]
    assert drawn == line | {
        "line": {"width": 3.0, "dash": "dot"},
        "marker": {"size": [6.0, 9.0], "line": {"width": 1.5}},
    }
    assert (drawn["x"] is x, larger.aspect, laid["margin"]) == (True, 0.5, {"l": 90.0, "t": 45.0})
    sizes = laid["font"]["size"], laid["xaxis"]["tickfont"]["size"]
    assert sizes == (SCALE * style.FONT_SIZE,) * 2 and laid["xaxis"]["range"] == [0, 4]
    (note,), (shape,) = laid["annotations"], laid["shapes"]
    assert (note["y"], note["yshift"], note["font"]["size"]) == (1.0, 19.5, SCALE * style.TITLE_SIZE)
    assert (shape["x0"], shape["line"]["width"]) == (1, 1.8)


def test_a_time_plot_grows_likewise():
    plot = next(iter(error_plots(static_run()).values()))
    plain = plot.kwargs(height=100)
    larger = enlarged_time_plot(plain, SCALE)
    assert larger["height"] == 150 and larger["data"] is plain["data"]
    assert larger["scales"] == plain["scales"]
    for before, after in zip(plain["axes"], larger["axes"], strict=True):
        assert after["size"] == SCALE * before["size"]
        assert after["font"].startswith(f"{SCALE * style.FONT_SIZE:g}px ")
    assert [s["width"] for s in larger["series"][1:]] == [SCALE * s["width"] for s in plain["series"][1:]]


def test_the_normal_size_changes_nothing():
    plain = figure([], style.layout())
    assert enlarged(plain, 1.0) is plain
    assert enlarged_time_plot(kwargs := {"height": 3}, 1.0) is kwargs


@pytest.mark.parametrize("size", [(1280, 720), (1366, 768), (1920, 1080), (3840, 2160)])
def test_the_columns_of_an_enlarged_page_fill_the_window(size: tuple[int, int]):
    width, height = size
    layout = layout_for(width, height, presentation=True)
    columns = layout.left_px + layout.view_px[0] + layout.right_px
    assert columns * layout.scale == pytest.approx(width, abs=2 * layout.scale)
    assert layout.scale * style.FONT_SIZE >= height / 45.0
    assert layout_for(width, height).scale == 1.0


def test_a_title_is_as_long_as_its_panel_allows():
    titles = ("Velocity error after a log step of 1 m/s", "Velocity error, log step")
    assert [titles.index(style.fitting(titles, room_px)) for room_px in (500.0, 200.0, 20.0)] == [0, 1, 1]
