"""Units, logarithmic axis, cursor and export, as the user sees them."""

import re
from pathlib import Path
from typing import Any

import pytest

from navcore.scenario.file import scenario_hash
from tests.browser.driver import Bench


@pytest.fixture
def reading(bench: Bench) -> Bench:
    """The shared page with three networks, and how they are shown."""
    bench.reset("liu-networks", "Frequency", "Errors", "View", selected=2)
    bench.show(curves="all")
    return bench


def labelled(bench: Bench, label: str) -> dict:
    """Error plot with this label, once it is there."""
    bench.page.wait_for_function("l => look.chart(l) !== undefined", arg=label)
    return next(chart for chart in bench.curves() if chart["label"].startswith(label))


def test_units_of_plots_and_table_follow_the_choice(reading: Bench) -> None:
    run, page = reading.session.run, reading.page
    for label, unit in (("velocities in", "kn"), ("lengths in", "nmi"), ("times in", "min")):
        reading.choose(label, unit)
    peak = run.methods[2].errors["dve_mps"]["max_abs"] * 3600.0 / 1852.0
    chart = labelled(reading, "δVE (kn)")
    assert max(abs(value) for value in chart["data"][3]) == pytest.approx(peak, rel=1e-6)
    assert "nmi" in labelled(reading, "position")["label"]
    page.wait_for_function("() => look.chart('δVE (kn)').series[0].label === 'time (min)'")
    assert max(labelled(reading, "δVE")["data"][0]) == pytest.approx(float(run.t_s[-1]) / 60.0, rel=1e-3)
    reading.tab("Metrics")
    row = page.locator(".sb-table tr", has_text="velocity δVE").first
    row.get_by_text("kn", exact=True).wait_for()
    instruments = page.locator("#sb-stage .sb-readout tr")
    instruments.filter(has_text="position").get_by_text("nmi").wait_for()


def test_logarithmic_axis_shows_magnitudes(reading: Bench) -> None:
    reading.choose("error axis", "log")
    assert min(min(curve) for curve in labelled(reading, "|δVE|")["data"][1:]) > 0.0
    script = "() => { const c = look.chart('|δVE|'); return [c.scales.y.distr, c.axes[1]._values]; }"
    distribution, words = reading.page.evaluate(script)
    assert distribution == 3 and sum(1 for word in words if word) >= 3
    reading.choose("error axis", "linear")
    assert min(labelled(reading, "δVE")["data"][1]) < 0.0


def test_cursor_shows_values_in_all_plots_and_moves_the_ship(reading: Bench) -> None:
    page, mouse = reading.page, reading.page.mouse
    labelled(reading, "δVE")
    plots = page.locator(".uplot .u-over")
    box: Any = plots.first.bounding_box()
    y = box["y"] + 0.5 * box["height"]
    x = box["x"] + 0.4 * box["width"]
    mouse.move(box["x"] + 0.3 * box["width"], y)
    mouse.move(x, y)
    filled = "() => [...document.querySelectorAll('.sb-values')].filter(e => e.textContent).length"
    page.wait_for_function(f"count => ({filled})() === count", arg=plots.count())
    wanted = 0.4 * float(reading.session.run.t_s[-1])
    now = "() => JSON.parse(document.getElementById('sb-playback').dataset.now).time"
    page.wait_for_function(f"t => Math.abs(({now})() - t) < 0.02 * t", arg=wanted)
    values = page.locator(".sb-values").first.inner_text()
    assert "at" in values and len(values.split()) >= 5
    # a click holds the cursor, and the values, where they are; another lets them go
    for count in (plots.count(), 0):
        mouse.click(x, y)
        mouse.move(10, 10)
        reading.settle()
        page.wait_for_function(f"count => ({filled})() === count", arg=count)


def test_a_second_cursor_gives_differences(reading: Bench) -> None:
    page, mouse = reading.page, reading.page.mouse
    chart = labelled(reading, "δVE")
    plot = page.locator(".uplot .u-over").first
    box: Any = plot.bounding_box()
    y = box["y"] + 0.5 * box["height"]
    page.keyboard.down("Shift")
    mouse.click(box["x"] + 0.25 * box["width"], y)
    page.keyboard.up("Shift")
    count = page.locator(".uplot:visible").count()
    assert page.locator(".sb-second").count() == count and chart
    mouse.move(box["x"] + 0.74 * box["width"], y)
    mouse.move(box["x"] + 0.75 * box["width"], y)
    page.wait_for_function("() => document.querySelector('.sb-values')?.textContent.includes('Δ')")
    told = page.evaluate(
        """() => {
          const all = Object.values(window.__viserTestpoints.uplots).map((entry) => entry.chart);
          const chart = all.find(({ over }) => over.matches(':hover'));
          const at = chart.cursor.idx, time = chart.data[0];
          const line = parseFloat(chart.root.querySelector('.sb-second').style.left);
          const other = chart.valToIdx(chart.posToVal(line, 'x'));
          return [chart.data[1][at] - chart.data[1][other], time[at] - time[other],
                  chart.root.querySelector('.sb-values').innerText];
        }"""
    )
    difference, apart, words = told
    numbers = [float(one) for one in re.findall(r"-?[\d.]+(?:e[-+]?\d+)?", words)]
    assert numbers[0] == pytest.approx(difference, rel=1e-2) and numbers[-1] == pytest.approx(apart, rel=1e-2)
    page.keyboard.press("Escape")
    page.wait_for_function("() => document.querySelector('.sb-second') === null")
    assert not page.locator(".sb-values").first.inner_text().startswith("Δ")


@pytest.mark.parametrize(
    ("format", "starts"), [("CSV", "# Schuler Bench: "), ("SVG", "<svg"), ("PNG", "\x89PNG")]
)
def test_plots_are_saved(reading: Bench, tmp_path: Path, format: str, starts: str) -> None:
    for plot in ("Frequency", "Errors: Velocity error east δVE"):
        reading.choose("export plot", plot)
        with reading.page.expect_download() as download:
            reading.page.get_by_text(format, exact=True).click()
        download.value.save_as(tmp_path / "saved")
        content = (tmp_path / "saved").read_bytes()
        assert download.value.suggested_filename.endswith(f".{format.lower()}")
        titled = starts + plot.partition(":")[0] if format == "CSV" else starts
        assert content.decode("latin-1").startswith(titled) and len(content) > 2000
        assert format != "CSV" or scenario_hash(reading.session.scenario) in content.decode()
