"""Seen in pictures of the page: pins, legends, the table of metrics, names, and what stands over the map."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from app.editing import edits
from app.session.requirements import Requirements
from tests.browser.driver import Bench
from tests.browser.fields import label_of
from tests.browser.test_page_compare import _UPLOT_NAMES
from tests.browser.test_page_scene import overlap
from tests.browser.windows.seeing import read, see, speaks

pytestmark = pytest.mark.browser

ZETA = ("method", 2, "network", "zeta")
_RUNS = "() => [...document.querySelectorAll('.sb-pins tbody tr b')].map(b => b.textContent)"
# Numbers of the table of metrics as they are seen, by the place of their decimal points in each column.
_POINTS = """() => {
  const rows = [...document.querySelectorAll('.sb-table tbody tr')].map(row => [...row.cells]);
  const found = {};
  const shown = rows.filter(row => row.length > 6 && row[0].offsetParent !== null);
  for (const cells of shown) for (const [place, cell] of cells.entries()) {
    const text = cell.querySelector('.sb-best')?.firstChild ?? cell.firstChild;
    if (place < 2 || text?.nodeType !== 3 || !/^-?[0-9]+[.][0-9]+$/.test(text.data)) continue;
    const range = document.createRange();
    range.setStart(text, 0);
    range.setEnd(text, text.data.indexOf('.'));
    (found[place] ??= []).push([text.data, range.getBoundingClientRect().right]);
  }
  return Object.values(found);
}"""
# Where the labels of the map's lines stand in the 3D view, px, and the view's size.
_LABELS = """() => {
  const {camera, nodeRefFromName: nodes} = window.__viserMutable;
  const view = document.querySelector('canvas[data-engine]').getBoundingClientRect();
  const pen = document.createElement('canvas').getContext('2d');
  pen.font = '11px sans-serif';
  const found = [];
  for (const [name, {message}] of Object.entries(window.__viserSceneTree.getState())) {
    const text = message?.props.text ?? '', {position} = window.__viserMutable.nodePoseData[name] ?? {};
    if (!name.startsWith('/map/labels') || !text.includes('°') || !position) continue;
    const at = camera.position.clone().set(...position).applyMatrix4(nodes[''].matrixWorld).project(camera);
    const [x, y] = [view.width * (1 + at.x) / 2, view.height * (1 - at.y) / 2];
    const half = pen.measureText(text).width / 2;
    found.push([text, x - half, y, x + half, y + 11]);
  }
  return [found, view.width, view.height];
}"""
# How much of the 3D view's width and height what is drawn in it takes.
_FILLED = """() => {
  const view = document.querySelector('canvas[data-engine]');
  const copy = Object.assign(document.createElement('canvas'), {width: view.width, height: view.height});
  const pen = copy.getContext('2d');
  pen.drawImage(view, 0, 0);
  const seen = new Uint32Array(pen.getImageData(0, 0, view.width, view.height).data.buffer);
  const [across, up] = [new Set(), new Set()];
  for (const [place, color] of seen.entries()) if (color !== seen[0]) {
    across.add(place % view.width);
    up.add(Math.floor(place / view.width));
  }
  return [across.size / view.width, up.size / view.height];
}"""


@pytest.fixture
def pinned(window: Bench) -> Iterator[Bench]:
    """A pin, and the run with another damping ratio."""
    session = window.session
    window.tab("Compare")
    see(window, window.button("Pin this run")).click()
    window.wait_until(lambda: len(session.pins) == 1)
    window.press("network.zeta")
    yield window
    for pin in session.pins.all:
        session.pins.remove(pin.id)
    session.pins._next = 1
    window.show(requirements=Requirements(), pins_by="pinned")


def test_a_pin_is_called_by_what_differs_and_is_of_the_edited_method(pinned: Bench) -> None:
    (pin,) = pinned.session.pins.all
    name = f"ζ {edits.value_at(pin.scenario, ZETA):g}"
    assert name in read(pinned, pinned.page.locator(".sb-pins tbody tr", has_text="ζ"))
    pinned.tab("Errors")
    pinned.page.wait_for_function(
        f"label => ({_UPLOT_NAMES})().every(names => names.length === 4 && names[3] === label)",
        arg=f"{name}: complementary",
    )
    assert read(pinned, pinned.page.locator(".sb-legend .sb-entry", has_text=name))


def test_pins_stand_in_one_table_that_sorts_and_judges(pinned: Bench) -> None:
    page = pinned.page
    pinned.show(requirements=Requirements(settling_min=1.0))
    table = page.locator(".sb-pins table")
    see(pinned, table)
    text = read(pinned, table)
    for heading in ("settles to 2 %", "velocity RMS (m/s)", "largest tilt (arcsec)", "requirements"):
        assert pinned.said(heading) in text
        see(pinned, page.locator(".sb-sort", has_text=pinned.said(heading)))
    assert text.count("✗") == 2 and text.count(" min") >= 2
    before = page.evaluate(_RUNS)
    see(pinned, page.locator(".sb-sort").first).click()
    page.wait_for_function(f"runs => String(({_RUNS})()) !== runs", arg=",".join(before))
    assert sorted(page.evaluate(_RUNS)) == sorted(before)


def test_requirements_judge_pins(pinned: Bench) -> None:
    pinned.show(requirements=Requirements(settling_min=1.0))
    pinned.tab("Requirements")
    read(pinned, pinned.page.locator(".sb-verdicts th", has_text="ζ"))
    read(pinned, pinned.page.locator(".sb-verdicts table"))


def test_a_click_on_the_legend_dims_hides_and_leaves_out(window: Bench) -> None:
    page, name = window.page, "free"
    try:
        for state in ("unscaled", "dimmed", "hidden"):
            see(window, page.locator(".sb-legend .sb-entry", has_text=name)).click()
            page.wait_for_selector(f".sb-legend .sb-entry[data-state={state}]")
            window.catch_up()
            assert window.session.display.state_of(name) == state
            read(window, page.locator(f".sb-legend .sb-entry[data-state={state}]"))
            # in the key of the map too
            key = page.locator(f"#sb-stage .sb-entry[data-state={state}]")
            assert name in read(window, key)
        assert window.line("/track/method0") is None
        shown = "() => Object.values(window.__viserTestpoints.uplots).map(e => e.chart.series[1].show)"
        page.wait_for_function(f"() => ({shown})().every(each => each === false)")
    finally:
        window.show(legend=())


def test_copies_have_names_of_their_own(window: Bench) -> None:
    for _ in range(3):
        number = window.run
        see(window, window.page.get_by_role("button", name=window.said("copy"), exact=True)).click()
        window.wait_for_run(number)
    names = [method.name for method in window.session.scenario.method]
    assert names[2:] == ["complementary", "complementary 2", "complementary 3", "complementary 4"]
    window.settle()
    for name in names:
        see(window, window.page.locator(".sb-legend .sb-entry", has_text=re.compile(f"^{name}")))


def test_the_table_of_metrics_is_whole_rounded_aligned_and_marks_the_best(window: Bench) -> None:
    page = window.page
    window.tab("Metrics")
    read(window, page.locator(".sb-table table"))
    columns = page.evaluate(_POINTS)
    assert len(columns) in (6, 9), "of those methods that fit beside each other"
    for column in columns:
        # the best ones are bold: their digits are a little wider
        assert max(x for _, x in column) - min(x for _, x in column) < 3.0, column
        for text, _ in column:
            assert len(text.replace(".", "").lstrip("-0")) <= 3, text
    # of the settling times, the two tilts, heading, velocities and positions
    assert page.locator(".sb-table .sb-best").count() >= 8
    settles = page.locator(".sb-table tr", has_text=window.said("settles to 2 %")).first
    assert re.search(r"\d min", read(window, settles)) and " h" not in settles.inner_text()


def test_the_page_speaks_in_plain_words(window: Bench) -> None:
    for label in ("scenario", "method", "enlarge errors in 3D"):
        see(window, window.box(label))
        assert read(window, window.page.locator(f"label[for='{window.id(label)}']")) == window.said(label)
    read(window, window.page.locator("#sb-focus"))


def test_the_key_stands_below_the_map_which_fills_its_view(window: Bench) -> None:
    page = window.page
    caption = see(window, page.locator("#sb-stage [data-is=caption]"))
    window.wait_until(lambda: caption.inner_text() != "")
    read(window, caption)
    parts = [".sb-key", ".sb-bar", ".sb-pendulum"]
    boxes = [see(window, page.locator(f"#sb-stage {part}")).bounding_box() for part in parts]
    sides = [(b["x"], b["y"], b["x"] + b["width"], b["y"] + b["height"]) for b in boxes]
    assert not any(overlap(a, b) for i, a in enumerate(sides) for b in sides[i + 1 :])
    for place in range(3):
        read(window, page.locator("#sb-stage .sb-entry").nth(place))
    across, up = page.evaluate(_FILLED)
    assert max(across, up) > 0.45, "the map is as large as the room between instruments and key"


def test_meridians_are_labelled_apart(window: Bench) -> None:
    see(window, window.page.locator("canvas[data-engine]"))
    found, width, height = window.page.evaluate(_LABELS)
    labels = {text: tuple(box) for text, *box in found}
    assert len(labels) >= 6 and sum(text.endswith("W") for text in labels) >= 2
    assert [(a, b) for a in labels for b in labels if a < b and overlap(labels[a], labels[b])] == []
    for text, (left, top, right, bottom) in labels.items():
        assert left >= -1 and right <= width + 1 and top >= 0 and bottom <= height, text


def test_notation_is_one(window: Bench) -> None:
    assert "ζ" in label_of("network.zeta")
    for tab in ("Method", "Sensors", "Log", "Run"):
        window.tab(tab)
        texts = "\n".join(window.page.locator("label:visible").all_inner_texts())
        assert not re.search(r"\b(zeta|xi|deg|ug|omega)\b|deg/|sqrt", texts), texts
        speaks(window, texts)
    window.tab("Sensors")
    assert re.search("°/√h", "\n".join(window.page.locator("label:visible").all_inner_texts()))
