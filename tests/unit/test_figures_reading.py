"""Envelopes, spectra and files of the plots."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.mechanization.recorder import DV_E
from navcore.scenario.model import Scenario
from schuler_bench.jobs.envelopes import SEEDS, Envelopes, with_seed
from schuler_bench.plots import style
from schuler_bench.plots.envelope import Envelope, envelope
from schuler_bench.plots.plotly_data import enlarged, enlarged_time_plot, figure, packed, values_of
from schuler_bench.plots.saved import plotly_csv, time_csv, time_figure
from schuler_bench.session.display import Display
from schuler_bench.shell.layout import layout_for
from schuler_bench.views.errors.figure import error_plots
from schuler_bench.views.frequency.figure import bode
from schuler_bench.views.spectrum.figure import amplitude_spectrum, spectrum
from schuler_bench.views.switching.figure import switching_plots
from tests.traces import unpacked
from tests.unit.figures_runs import THREE, diverging, run_of, scenario, static_run, texts_of
from tests.unit.test_figures_switching import switching_run

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
    assert (note["y"], note["yshift"], note["font"]["size"]) == (1.0, 19.5, SCALE * style.FONT_SIZE)
    assert (shape["x0"], shape["line"]["width"]) == (1, 1.8)


def test_a_time_plot_grows_likewise():
    plain = next(iter(error_plots(static_run()).values())).kwargs(height=100)
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


# ---------------------------------------------------------------- envelope


@pytest.fixture(scope="module")
def runs() -> list[Run]:
    one = scenario(run={"duration_h": 1.0}, method=[THREE[1]])
    return [simulate(with_seed(one, seed)) for seed in range(1, SEEDS + 1)]


def test_envelope_holds_most_of_the_runs(runs: list[Run]) -> None:
    band = envelope(runs)
    assert "5 to 95 %" in band.label and "20 seeds" in band.label
    low, high = band.low[0][:, DV_E], band.high[0][:, DV_E]
    own = np.array([run.methods[0].plot.values[: 2 * len(low), DV_E].reshape(-1, 2) for run in runs])
    # one of twenty below each edge
    assert 0.85 <= np.mean((own.min(axis=2) >= low) & (own.max(axis=2) <= high)) <= 0.95


def test_envelope_is_a_band_behind_its_own_curve(runs: list[Run]) -> None:
    plots = {scale: Display(scale=scale) for scale in ("linear", "log")}
    plots = {k: error_plots(runs[0], envelope=envelope(runs[:5]), display=d)["dve"] for k, d in plots.items()}
    plot = plots["linear"]
    ((upper, lower, color),) = plot.bands
    assert plot.edges == {upper, lower} and color.startswith(plot.curves[0].color)
    assert (plot.names[0], plot.series[1 + upper]["width"]) == ("classic2", 0.0)
    assert plot.kwargs()["bands"] == ({"series": (upper + 1, lower + 1), "fill": color},)
    for each in plots.values():
        assert np.all(each.curves[upper].values >= each.curves[lower].values)


def test_bins_of_two_points_keep_their_extremes() -> None:
    run = run_of(run={"duration_h": 3.0}, method=[{"name": "free"}])
    plot = run.methods[0].plot
    assert plot.t_s[0] > 0.0
    band = envelope([run])
    pairs = plot.values[: 2 * len(band.t_s), DV_E].reshape(-1, 2)
    np.testing.assert_array_equal(band.low[0][:, DV_E], pairs.min(axis=1))
    np.testing.assert_array_equal(band.high[0][:, DV_E], pairs.max(axis=1))


@pytest.fixture
def asked(runs: list[Run]) -> tuple[Envelopes, list[int], list[str]]:
    """Envelopes over a quick stand-in for the simulation, the seeds it was asked for, and what it told."""
    seeds: list[int] = []
    events: list[str] = []

    def stand_in(of: Scenario, *_: object) -> Run:
        seeds.append(of.run.seed)
        return runs[0]

    further, ended = (lambda word=word: events.append(word) for word in ("further", "ended"))
    return Envelopes(stand_in, further, ended, still_s=0.0), seeds, events


def test_envelope_is_made_over_other_seeds_and_belongs_to_one_scenario(asked, runs: list[Run]) -> None:
    (envelopes, seeds, events), one = asked, runs[0].scenario
    envelopes.follow(one, "seeds")
    assert envelopes.wait_idle(20.0) and events[-1] == "ended"
    assert seeds == [one.run.seed + number for number in range(1, SEEDS + 1)]
    now, earlier = envelopes.beside(one, "seeds"), envelopes.beside(with_seed(one, 99), "seeds")
    assert isinstance(now, Envelope) and not now.old and "earlier" not in now.label
    assert earlier is not None and earlier.old and "of an earlier setting" in earlier.label
    longer = one.model_copy(update={"run": one.run.model_copy(update={"duration_h": 2.0})})
    assert envelopes.beside(longer, "seeds") is None and envelopes.beside(one, "covariance") is None
    envelopes.follow(one, "seeds")
    assert len(seeds) == SEEDS, "made twice"
    envelopes.follow(one, "none")
    assert envelopes.beside(one, "seeds") is None and envelopes.fraction is None


def test_strapdown_scenarios_are_told_that_they_have_none(asked) -> None:
    envelopes, seeds, _ = asked
    envelopes.follow(scenario(run={"duration_h": 1.0, "fidelity": "strapdown"}), "seeds")
    assert "strapdown" in envelopes.words[0] and seeds == []


# ---------------------------------------------------------------- spectrum


@pytest.mark.parametrize("cycles", [5.0, 20.1, 20.125, 20.15])
def test_a_sine_shows_as_a_peak_of_its_amplitude_at_its_period(cycles: float) -> None:
    method = static_run().methods[0]
    t_s = method.t_s[:2048]  # a transform of a power of two is padded least here
    period = float(t_s[-1]) / cycles
    rows = method.rows[: len(t_s)].copy()
    rows[:, DV_E] = 7.0 + 2.5 * np.sin(2.0 * np.pi * t_s / period + 0.4)
    periods, amplitude = amplitude_spectrum(t_s, rows[:, DV_E])
    place = int(np.argmax(amplitude))
    assert amplitude[place] == pytest.approx(2.5, rel=5e-3)
    assert periods[place] == pytest.approx(period, rel=0.03)
    assert np.all(np.diff(periods) < 0.0) and len(periods) <= 1300
    assert amplitude[periods < 0.2 * period].max() < 0.01


def test_undamped_error_peaks_at_the_schuler_period() -> None:
    run = run_of(
        run={"duration_h": 24.0},
        reference={"kind": "none"},
        method=[{"name": "free"}],
        imu={"gyro_bias_dph": [0.0, 0.0, 0.0], "accel_bias_ug": [50.0, 50.0, 0.0]},
    )
    periods, amplitude = amplitude_spectrum(run.methods[0].t_s, run.methods[0].rows[:, DV_E])
    near = (periods > 3600.0) & (periods < 7200.0)
    schuler = 2.0 * np.pi / run.scenario.omega_s
    assert periods[near][np.argmax(amplitude[near])] == pytest.approx(schuler, rel=0.03)
    hours, minutes = (spectrum(run, "dve", display=Display(time=unit)) for unit in ("auto", "min"))
    assert {"Schuler", "24"} <= set(" ".join(texts_of(hours)).split())
    titles = [figure["layout"]["xaxis"]["title"]["text"] for figure in (hours, minutes)]
    assert titles == ["period (h)", "period (min)"]
    assert "m/s" in hours["layout"]["yaxis"]["title"]["text"]


def test_spectrum_of_a_method_that_ended_at_once_is_left_out() -> None:
    assert spectrum(diverging(static_run(), 0, rows=10))["data"][0]["name"] == "classic2"
    short = diverging(static_run(), 0, rows=4).methods[0]
    assert amplitude_spectrum(short.t_s, short.rows[:, DV_E])[0].size == 0


# ---------------------------------------------------------------- files


def read_csv(content: bytes) -> tuple[list[str], list[list[str]]]:
    lines = content.decode().splitlines()
    rows = list(csv.reader(io.StringIO("\n".join(line for line in lines if not line.startswith("#")))))
    return [line for line in lines if line.startswith("#")], rows


def test_csv_of_a_time_plot_holds_the_plotted_numbers_in_full() -> None:
    plot = error_plots(static_run())["dve"]
    comments, rows = read_csv(time_csv([plot], ["scenario_sha256 abc"]))
    assert comments[0] == "# scenario_sha256 abc"
    assert rows[0] == ["time (h)", "free (m/s)", "classic2 (m/s)", "compass (m/s)"]
    assert [float(row[2]) for row in rows[1:]] == plot.data[2].tolist()


def test_csv_has_no_formulas_and_gaps_where_there_is_no_curve() -> None:
    run = diverging(static_run(), 0, rows=800)
    renamed = run.methods[1].method.model_copy(update={"name": "=1+1"})
    named = replace(run, methods=(run.methods[0], replace(run.methods[1], method=renamed)))
    _, rows = read_csv(time_csv([error_plots(named)["dve"]], []))
    assert rows[0][2].startswith("'=1+1")
    assert rows[-1][1] == "" and rows[-1][2] != ""


def test_csv_of_a_plotly_figure_holds_more_than_its_float32() -> None:
    figure = bode(static_run())
    comments, rows = read_csv(plotly_csv(figure, ["about"]))
    assert comments == ["# about"] and rows[0] == ["curve", "x axis", "y axis", "x", "y"]
    mine = [row for row in rows[1:] if row[0] == "classic2" and row[2].startswith("|H|")]
    trace = next(t for t in figure["data"] if t["name"] == "classic2" and t["yaxis"] == "y")
    np.testing.assert_array_equal([float(row[4]) for row in mine], trace["y"].full)
    assert any(float(row[4]) != float(np.float32(row[4])) for row in mine)


def test_packed_numbers_are_remembered_and_infinity_is_a_gap() -> None:
    value = packed(np.array([0.1, -0.2, np.inf]))
    assert values_of(value) == [0.1, -0.2, np.inf] and values_of([1.0, None]) == [1.0, None]
    np.testing.assert_array_equal(unpacked(value), np.float32([0.1, -0.2, np.nan]))


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_time_plots_become_one_figure_with_one_legend(runs: list[Run], scale: str) -> None:
    plots = error_plots(runs[0], envelope=envelope(runs[:3]), display=Display(scale=scale))
    chosen = [plots["dve"], plots["position"]]
    made = time_figure(chosen)
    curves = [trace for trace in made["data"] if "name" in trace]
    names = [method.method.name for method in runs[0].methods]
    assert [trace["name"] for trace in curves if trace["showlegend"]] == names
    for plot, suffix in zip(chosen, ("", "2"), strict=True):
        mine = [trace for trace in curves if trace["yaxis"] == f"y{suffix}"]
        assert [trace["line"]["color"] for trace in mine] == [c.color for c in plot.curves[: len(names)]]
        for trace, values in zip(mine, plot.data[1:], strict=False):
            np.testing.assert_allclose(unpacked(trace["y"]), values, rtol=1e-6)
        axis = made["layout"][f"yaxis{suffix}"]
        assert axis["title"]["text"] == plot.axes()[1]["label"]
        low, high = axis["range"]
        if scale == "linear":
            drawn = np.concatenate(plot.data[1:])
            assert low <= np.nanmin(drawn) and np.nanmax(drawn) <= high <= 1.2 * np.nanmax(drawn)
        else:
            assert axis["type"] == "log" and (low, high) == plot.decades
    titles = [made["layout"][f"xaxis{suffix}"]["title"]["text"] for suffix in ("", "2")]
    assert titles == ["", "time (min)"]
    bands = [trace for trace in made["data"] if "name" not in trace]
    assert len(bands) == 2 * sum(len(plot.bands) for plot in chosen)
    lower, upper = bands[:2]
    assert upper["fill"] == "tonexty" and np.all(unpacked(lower["y"]) <= unpacked(upper["y"]))


def test_a_figure_over_time_shows_what_the_legend_left() -> None:
    shown = Display(legend=(("free", "hidden"), ("classic2", "dimmed")))
    made = time_figure([error_plots(static_run(), display=shown)["dve"]])
    assert [trace["name"] for trace in made["data"]] == ["classic2", "compass"]
    assert made["data"][0]["line"]["color"].startswith("rgba(")


def test_a_name_with_markup_is_a_text_in_a_figure_over_time() -> None:
    plot = error_plots(static_run())["dve"]
    renamed = zip(plot.curves, ("<b>x</b>", "a $b$", "c"), strict=True)
    plot = replace(plot, curves=tuple(replace(curve, name=name) for curve, name in renamed), title="<i>&")
    made = time_figure([plot])
    assert [trace["name"] for trace in made["data"]] == ["&lt;b&gt;x&lt;/b&gt;", "a $b$", "c"]
    assert made["layout"]["annotations"][0]["text"] == "<b>&lt;i&gt;&amp;</b>"


def test_switching_states_keep_their_words() -> None:
    plots = switching_plots(switching_run(), "min")
    made = time_figure(plots)
    words = [
        list(axis.get("ticktext", ())) for name, axis in made["layout"].items() if name.startswith("yaxis")
    ]
    assert [word for _, word in next(plot.ticks for plot in plots if plot.ticks)] in words
    domains = [axis["domain"] for name, axis in made["layout"].items() if name.startswith("yaxis")]
    assert all(lower[1] < upper[0] for upper, lower in zip(domains, domains[1:], strict=False))
    assert domains[0][1] == 1.0 and domains[-1][0] == pytest.approx(0.0)
