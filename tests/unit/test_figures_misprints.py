"""The misprint laboratory draws what the physics computed, in readable units."""

import json

import numpy as np
import pytest

from schuler_bench.misprints import Axis, Comparison, Curve, Misprint, Number
from schuler_bench.views.misprints.figure import comparison_plot, words_html
from tests.traces import unpacked

T = np.linspace(0.0, 7200.0, 50)
TILT = Axis("tilt", "rad")


def comparison(printed: np.ndarray, corrected: np.ndarray, y_axis: Axis = TILT) -> Comparison:
    curves = (
        Curve("as printed", "printed", printed),
        Curve("mended", "corrected", corrected),
        Curve("model", "corrected", corrected),
    )
    numbers = (Number("growth", "s", 810.0, None), Number("K2", "", 156.063, 202.52))
    return Comparison(Axis("time", "s"), y_axis, T, curves, numbers, "It <grows>.")


@pytest.mark.parametrize(
    ("shown", "names"),
    [
        ("both", ["as printed", "mended", "model"]),
        ("as printed", ["as printed"]),
        ("corrected", ["mended", "model"]),
    ],
)
def test_the_switch_chooses_the_curves(shown: str, names: list[str]) -> None:
    figure = comparison_plot(comparison(np.sin(T), np.cos(T)), shown)
    assert [trace["name"] for trace in figure["data"]] == names


def test_curves_are_in_the_labelled_units() -> None:
    made = comparison_plot(comparison(1e-4 * np.sin(T), 1e-4 * np.cos(T)))
    assert made["layout"]["xaxis"]["title"]["text"] == "time (min)"
    assert made["layout"]["yaxis"]["title"]["text"] == "tilt (arcsec)"
    np.testing.assert_allclose(unpacked(made["data"][0]["x"]), T / 60.0, rtol=1e-6)
    shown = unpacked(made["data"][1]["y"])
    np.testing.assert_allclose(shown, 1e-4 * np.cos(T) * 180.0 * 3600.0 / np.pi, rtol=1e-5)


def test_a_growing_printed_form_does_not_flatten_the_corrected_one() -> None:
    grows = 1e-4 * np.exp(T / 400.0)
    both = comparison_plot(comparison(grows, 1e-4 * np.cos(T)))
    low, high = both["layout"]["yaxis"]["range"]
    assert high < 100.0 and low < -20.0
    assert "leaves the plot" in both["layout"]["annotations"][0]["text"]
    alone = comparison_plot(comparison(grows, 1e-4 * np.cos(T)), "as printed")
    assert alone["layout"]["annotations"] == []


def test_plotly_accepts_logarithmic_axes_and_gaps() -> None:
    import plotly.graph_objects as go

    y = np.where(T > 100.0, T, np.nan)
    made = comparison_plot(comparison(y, 2.0 * y, Axis("relative error", log=True)))
    assert made["layout"]["yaxis"]["type"] == "log"
    assert len(go.Figure(json.loads(made.to_json())).data) == 3


def test_words_and_numbers_are_shown_as_text() -> None:
    entry = Misprint("x-1", "X 2000", "eq. 1", "a < b", "a > b", "it grows", lambda: comparison(T, T))
    html = words_html(entry, comparison(T, T))
    assert "a &lt; b" in html and "It &lt;grows&gt;." in html
    assert "156.1" in html and "13.5 min" in html and "none" in html
