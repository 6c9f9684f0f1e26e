"""Units, logarithmic axis, envelope, cursor and export, as the user sees them."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest

from app.views.appearance.view import BANDS
from tests.browser.driver import Bench

pytestmark = pytest.mark.browser

_CHART = """label => Object.values(window.__viserTestpoints.uplots).map(e => e.chart)
  .find(c => c.axes[1].label.startsWith(label))"""
_LEGEND = "() => document.body.innerText.match(/band: .*/)?.[0] ?? ''"
_DEFAULT = {
    "angle": "auto",
    "length": "auto",
    "speed": "auto",
    "time": "auto",
    "scale": "linear",
    "envelope": "none",
}


@pytest.fixture
def reading(bench: Bench) -> Iterator[Bench]:
    bench.reset("liu-networks", selected=2)
    bench.tab("Frequency", "Errors", "View")
    yield bench
    bench.show(**_DEFAULT)
    bench.tab("Errors")
    bench.page.wait_for_function(f"() => ({_CHART})('δVE (m/s)') !== undefined")


def labelled(bench: Bench, label: str) -> dict:
    """Error plot with this label, once it is there."""
    bench.page.wait_for_function(f"l => ({_CHART})(l) !== undefined", arg=label)
    return next(chart for chart in bench.curves() if chart["label"].startswith(label))


def test_units_of_plots_and_table_follow_the_choice(reading: Bench) -> None:
    run = reading.session.run
    assert run is not None
    reading.choose("velocities in", "kn")
    reading.choose("lengths in", "nmi")
    reading.choose("times in", "min")
    peak = run.methods[2].errors["dve_mps"]["max_abs"] * 3600.0 / 1852.0
    chart = labelled(reading, "δVE (kn)")
    assert max(abs(value) for value in chart["data"][3]) == pytest.approx(peak, rel=1e-6)
    assert "nmi" in labelled(reading, "position")["label"]
    reading.page.wait_for_function(f"() => ({_CHART})('δVE (kn)').series[0].label === 'time (min)'")
    assert max(labelled(reading, "δVE")["data"][0]) == pytest.approx(float(run.t_s[-1]) / 60.0, rel=1e-3)
    reading.tab("Metrics")
    row = reading.page.locator(".sb-table tr", has_text="velocity δVE").first
    row.get_by_text("kn", exact=True).wait_for()
    instruments = reading.page.locator("#sb-stage .sb-readout tr")
    instruments.filter(has_text="position").get_by_text("nmi").wait_for()
    assert reading.faults == []


def test_logarithmic_axis_shows_magnitudes(reading: Bench) -> None:
    reading.choose("error axis", "log")
    chart = labelled(reading, "|δVE|")
    assert min(min(curve) for curve in chart["data"][1:]) > 0.0
    script = f"() => {{ const c = ({_CHART})('|δVE|'); return [c.scales.y.distr, c.axes[1]._values]; }}"
    distribution, words = reading.page.evaluate(script)
    assert distribution == 3
    assert sum(1 for word in words if word) >= 3
    reading.choose("error axis", "linear")
    assert min(labelled(reading, "δVE")["data"][1]) < 0.0


def test_envelope_of_twenty_seeds_is_drawn_and_goes_with_the_scenario(reading: Bench) -> None:
    reading.choose(BANDS, "20 seeds, 5 to 95 %")
    bands = f"() => ({_CHART})('δVE')?.bands?.length ?? 0"
    reading.page.wait_for_function(f"() => ({bands})() === 3", timeout=120_000)
    assert "5 to 95 % of 20 seeds" in reading.page.locator("body").inner_text()
    reading.tab("Method")
    reading.press("network.zeta")
    reading.settle()
    session = reading.session
    assert session.run is not None
    # the band of the earlier scenario stays, marked, until that of the new one is there
    reading.page.wait_for_function(f"() => !({_LEGEND})().includes('earlier')", timeout=120_000)
    assert reading.page.evaluate(f"() => ({bands})()") == 3
    found = session.envelopes.beside(session.run.scenario, "seeds")
    assert found is not None and not found.old
    assert reading.faults == []


def test_cursor_shows_values_in_all_plots_and_moves_the_ship(reading: Bench) -> None:
    page = reading.page
    reading.tab("Errors")
    labelled(reading, "δVE")
    box = page.locator(".uplot .u-over").first.bounding_box()
    assert box is not None
    reading.settle()
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 0.5 * box["height"])
    filled = "() => [...document.querySelectorAll('.sb-values')].filter(e => e.textContent).length"
    count = page.locator(".uplot .u-over").count()
    page.wait_for_function(f"() => ({filled})() === {count}")
    run = reading.session.run
    assert run is not None
    wanted = 0.4 * float(run.t_s[-1])
    now = "() => JSON.parse(document.getElementById('sb-playback').dataset.now).time"
    page.wait_for_function(f"t => Math.abs(({now})() - t) < 0.02 * t", arg=wanted)
    values = page.locator(".sb-values").first.inner_text()
    assert "at" in values and len(values.split()) >= 5
    # a click holds the cursor, and the values, where they are
    page.mouse.click(box["x"] + 0.4 * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.move(10, 10)
    reading.settle()
    assert page.evaluate(filled) == count
    page.mouse.click(box["x"] + 0.4 * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.move(10, 10)
    page.wait_for_function(f"() => ({filled})() === 0")


@pytest.mark.parametrize(
    ("plot", "format", "starts"),
    [
        ("Frequency", "CSV", "# Schuler Bench: Frequency"),
        ("Frequency", "SVG", "<svg"),
        ("Frequency", "PNG", "\x89PNG"),
        ("Errors: Velocity error east δVE", "CSV", "# Schuler Bench: Errors"),
        ("Errors: Velocity error east δVE", "SVG", "<svg"),
        ("Errors: Velocity error east δVE", "PNG", "\x89PNG"),
    ],
)
def test_a_plot_is_saved(reading: Bench, tmp_path: Path, plot: str, format: str, starts: str) -> None:
    reading.choose("export plot", plot)
    with reading.page.expect_download() as download:
        reading.page.get_by_text(format, exact=True).click()
    download.value.save_as(tmp_path / "saved")
    content = (tmp_path / "saved").read_bytes()
    assert download.value.suggested_filename.endswith(f".{format.lower()}")
    assert content.decode("latin-1").startswith(starts)
    assert len(content) > 2000
    if format == "CSV":
        from navcore.scenario.file import scenario_hash

        assert scenario_hash(reading.session.scenario) in content.decode()
    assert reading.faults == []


def test_a_plot_that_is_not_in_front_is_saved(reading: Bench) -> None:
    assert reading.page.get_by_role("tab", name="Poles", exact=True).get_attribute("aria-selected") == "false"
    reading.choose("export plot", "Poles")
    with reading.page.expect_download() as download:
        reading.page.get_by_text("SVG", exact=True).click()
    assert download.value.suggested_filename == "poles.svg"
    made = ElementTree.fromstring(download.value.path().read_bytes())
    text = "".join(made.itertext())
    assert "Near the Schuler frequency" in text
    assert all(method.name in text for method in reading.session.scenario.method)
    assert reading.faults == []


def test_a_click_on_the_legend_takes_a_method_out_of_the_scale_and_hides_it(reading: Bench) -> None:
    page, run = reading.page, reading.session.run
    assert run is not None
    peaks = [method.errors["position_m"]["max_abs"] for method in run.methods]
    place = peaks.index(max(peaks))
    name = run.methods[place].method.name
    top = f"""() => Object.values(window.__viserTestpoints.uplots).map(e => e.chart)
      .filter(c => c.axes[1].label.startsWith('position'))
      .map(c => [c.scales.y.max, c.series[{1 + place}].show])[0]"""
    drawn = page.evaluate(top)
    try:
        for state in ("unscaled", "dimmed", "hidden"):
            page.locator(".sb-legend").get_by_role("button", name=name).click()
            page.wait_for_selector(f".sb-legend button[data-state={state}]")
            reading.catch_up()
            page.wait_for_function(f"state => ({top})()?.[1] === (state !== 'hidden')", arg=state)
            assert reading.session.display.state_of(name) == state
            if state == "dimmed":
                page.wait_for_function(f"top => ({top})()?.[0] === top", arg=drawn[0])
            else:
                page.wait_for_function(f"top => ({top})()?.[0] < top", arg=drawn[0])
    finally:
        reading.show(legend=())
    assert reading.faults == []
