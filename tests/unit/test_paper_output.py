"""Figures and tables for a paper: matplotlib at the size of a column, and LaTeX."""

import sys

import numpy as np
import pytest
from matplotlib.figure import Figure

from navcore import budget, load, simulate
from navcore.engine.run import Run
from navcore.foundation.answers import Column, Table
from navcore.foundation.errors import InputError
from schuler_bench.notebook import OF_RUN

MM = 25.4


@pytest.fixture(scope="module")
def run() -> Run:
    """Three methods, one of which switches."""
    override = [
        'method.1.policy={id="threshold", limit_mps=0.3}',
        "run.duration_h=1",
        "reference.noise_mps=0.2",
    ]
    return simulate(load("zha-fast", override))


@pytest.mark.parametrize("name", OF_RUN)
def test_each_figure_of_the_page_is_drawn_for_a_paper(run: Run, name: str) -> None:
    """The same curves, told apart without colour, all within the picture."""
    figure, page = run.paper_figure(name), run.figure(name)
    assert isinstance(figure, Figure)
    width, height = (round(MM * one) for one in figure.get_size_inches())
    beside = {round(axis.domain[0], 1) for axis in page.select_xaxes() if axis.domain}
    assert width == (180 if len(beside) > 1 else 88) and height < 260
    named = {trace.name for trace in page.data if trace.name and trace.showlegend is not False}
    (legend,) = figure.legends
    assert {text.get_text() for text in legend.get_texts()} == named
    curves = [line for axes in figure.axes for line in axes.get_lines() if str(line.get_label())[0] != "_"]
    styles = {line.get_label(): (str(line.get_linestyle()), line._unscaled_dash_pattern) for line in curves}  # pyright: ignore[reportAttributeAccessIssue]
    drawn = [one for one in styles.values() if one[0] != "None"]
    assert len({str(one) for one in drawn}) == len(drawn)


def test_its_numbers_and_ranges_are_those_of_the_page(run: Run) -> None:
    figure, page = run.paper_figure("errors", group="Attitude"), run.figure("errors", group="Attitude")
    free = next(trace for trace in page.data if trace.name == "free")
    line = next(one for one in figure.axes[0].get_lines() if one.get_label() == "free")
    np.testing.assert_array_equal(line.get_xdata(), free.x)
    np.testing.assert_array_equal(line.get_ydata(), free.y)
    assert figure.axes[0].get_ylim() == pytest.approx(page.layout.yaxis.range)
    assert figure.axes[-1].get_xlabel() == "time (min)"
    bode = run.paper_figure("bode").axes[0]
    assert bode.get_xscale() == "log"


def test_its_size_is_chosen_and_a_size_that_is_none_is_refused(run: Run) -> None:
    figure = run.paper_figure("step", 120.0, 60.0)
    assert [round(MM * one) for one in figure.get_size_inches()] == [120, 60]
    with pytest.raises(InputError, match=r"width_mm = 5\.0: must be 40..400 \(mm\)"):
        run.paper_figure("step", 5.0)
    with pytest.raises(InputError, match="must be one of errors"):
        run.paper_figure("nothing")


def test_without_matplotlib_it_says_what_to_install(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(InputError, match="needs matplotlib, which is not installed"):
        run.paper_figure()


def test_tables_are_latex(run: Run) -> None:
    """Of a run, and of every answer; what is special to LaTeX, and Greek letters, are written as it wants."""
    text = run.to_latex()
    assert text.count(r"\begin{tabular}") == text.count(r"\bottomrule") == 4
    assert r"RMS & $\varphi_{\mathrm{E}}$ & $\varphi_{\mathrm{N}}$" in text
    assert text.isascii()
    table = Table((Column("a_b"), Column("50 %", "m/s", left=True)), (("x & y", "{z}"),), "one # of ζ")
    assert table.latex().splitlines() == [
        "% one # of ζ",
        r"\begin{tabular}{ll}",
        r"\toprule",
        r"a\_b & 50 \% \\",
        r" & m/s \\",
        r"\midrule",
        r"x \& y & \{z\} \\",
        r"\bottomrule",
        r"\end{tabular}",
    ]
    assert r"\toprule" in budget(load("sikuliaq-like"), steady=True).latex()
