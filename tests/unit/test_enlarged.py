"""Presentation size: plots keep their numbers and proportions, and what counts pixels grows."""

from __future__ import annotations

import numpy as np
import pytest

from app.plots import style
from app.plots.enlarged import enlarged, enlarged_time_plot
from app.plots.plotly_data import figure, packed
from app.shell.layout import layout_for
from app.views.errors.figure import error_plots
from tests.unit.figures_runs import static_run

SCALE = 1.5


def test_type_lines_and_margins_grow_and_the_numbers_stay():
    x = packed(np.arange(3.0))
    line = {"type": "scatter", "x": x, "y": [1, 2, 3], "line": {"width": 2.0, "dash": "dot"}}
    line["marker"] = {"size": [4, 6], "line": {"width": 1}}
    axis = style.axis("time", range=[0, 4])
    layout = style.layout(margin={"l": 60, "t": 30}, meta={"aspect": 0.5}, xaxis=axis)
    layout["annotations"] = [style.panel_title("Tilt")]
    layout["shapes"] = [{"type": "line", "x0": 1, "x1": 1, "line": {"width": 1.2}}]
    made = enlarged(figure([line], layout), SCALE)
    drawn, laid = made["data"][0], made["layout"]
    assert drawn["x"] is x
    assert drawn["y"] == [1, 2, 3]
    assert drawn["line"] == {"width": 3.0, "dash": "dot"}
    assert drawn["marker"] == {"size": [6.0, 9.0], "line": {"width": 1.5}}
    assert laid["margin"] == {"l": 90.0, "t": 45.0}
    assert laid["font"]["size"] == SCALE * style.FONT_SIZE
    assert laid["xaxis"]["tickfont"]["size"] == SCALE * style.FONT_SIZE
    assert laid["xaxis"]["range"] == [0, 4]
    note = laid["annotations"][0]
    assert (note["y"], note["yshift"], note["font"]["size"]) == (1.0, 19.5, SCALE * style.TITLE_SIZE)
    assert (laid["shapes"][0]["x0"], laid["shapes"][0]["line"]["width"]) == (1, 1.8)
    assert made.aspect == 0.5


def test_a_time_plot_grows_likewise():
    plot = next(iter(error_plots(static_run()).values()))
    plain = plot.kwargs(height=100)
    made = enlarged_time_plot(plain, SCALE)
    assert made["height"] == 150
    assert made["data"] is plain["data"]
    assert made["scales"] == plain["scales"]
    for before, after in zip(plain["axes"], made["axes"], strict=True):
        assert after["size"] == SCALE * before["size"]
        assert after["font"].startswith(f"{SCALE * style.FONT_SIZE:g}px ")
    assert [s["width"] for s in made["series"][1:]] == [SCALE * s["width"] for s in plain["series"][1:]]


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
    assert style.fitting(titles, 500.0) == titles[0]
    assert style.fitting(titles, 200.0) == titles[1]
    assert style.fitting(titles, 20.0) == titles[1]
