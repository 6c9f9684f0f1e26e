"""What a slider does not move stays as it is, and what it moves is drawn as if it were drawn anew."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from app.editing import edits
from tests.browser.driver import Bench

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = pytest.mark.browser

_PLOT = "[...document.querySelectorAll('.js-plotly-plot')].find(p => p.offsetParent !== null)"
# How often plotly has laid a figure out since, what is drawn, and what a drawing anew makes of it.
_COUNT = f"() => {{ window.laidOut = 0; {_PLOT}.on('plotly_afterplot', () => {{ window.laidOut += 1; }}); }}"
_PATHS = f"""() => [...{_PLOT}.querySelectorAll('.scatterlayer path.js-line')]
  .map(line => line.getAttribute('d').match(/-?[0-9.]+/g).map(Number))"""
_ANEW = f"() => Plotly.redraw({_PLOT})"
_AXES = f"() => ['xaxis', 'yaxis', 'yaxis2', 'yaxis3', 'yaxis4'].map(name => {_PLOT}._fullLayout[name].range)"
_MAP_AXES = f"() => ['xaxis', 'yaxis', 'xaxis2', 'yaxis2'].map(name => {_PLOT}._fullLayout[name].range)"

# Titles and widths (px) of the figures, in the order in which they are drawn.
_DRAWN = """window.drawn = [];
addEventListener('drawn', ({target: {_fullLayout: {meta, width}}}) => drawn.push([meta.view, width]));"""


def test_only_what_is_in_sight_is_drawn(browser: Browser, dashboard: Any) -> None:
    context = browser.new_context(viewport={"width": 1920, "height": 1080})
    try:
        context.add_init_script(_DRAWN)
        opened = Bench(context.new_page(), dashboard[0].url, dashboard[1].sessions).open()
        opened.settle()
        opened.heard()
        opened.plotly()
        drawn = opened.page.evaluate("window.drawn")
        assert {title for title, _ in drawn} == {"Frequency"}
        assert len({width for _, width in drawn}) == 1, "no figure is drawn before its width is known"
        opened.tab("Poles")
        opened.plotly()
        assert {title for title, _ in opened.page.evaluate("window.drawn")} == {"Frequency", "Poles"}
        assert opened.faults == []
    finally:
        context.close()


def test_a_slider_step_moves_the_curves_without_a_layout(bench: Bench) -> None:
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Frequency", "Errors", "Method")
    bench.press("network.zeta")
    bench.plotly()
    page = bench.page
    page.evaluate(_COUNT)
    before = page.evaluate(_PATHS)
    in_place = 0
    for _ in range(4):
        was = page.evaluate("window.laidOut")
        bench.press("network.zeta")
        bench.plotly()
        in_place += page.evaluate("window.laidOut") == was
    assert in_place >= 2, "an axis may be laid out anew now and then, not at each step"
    moved = page.evaluate(_PATHS)
    assert moved != before
    held = bench.plotly()
    page.evaluate(_ANEW)
    for line, anew in zip(moved, page.evaluate(_PATHS), strict=True):
        assert line == pytest.approx(anew, abs=0.02), "as plotly draws it"
    assert bench.plotly() == held, "plotly holds the numbers that are drawn"
    assert bench.faults == []


_LABELS = f"""() => [...{_PLOT}.querySelectorAll('.ytick text')]
  .map(label => [label.textContent, label.getAttribute('y')]).sort()"""
_HOMES = f"""() => ['yaxis', 'yaxis2'].map(name => {_PLOT}._fullLayout[name])
  .map(axis => [axis._rangeInitial0, axis._rangeInitial1])"""
# plotly keeps its points unless it lays out the whole figure
_KEEP = f"() => {{ {_PLOT}.calcdata.kept = true; }}"
_KEPT = f"() => {_PLOT}.calcdata.kept === true"


def test_an_axis_that_a_slider_step_changes_is_laid_out_alone(bench: Bench) -> None:
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Frequency", "Errors", "Method")
    bench.type("network.zeta", "0.6")
    bench.plotly()
    page = bench.page
    before = page.evaluate(_AXES)
    page.evaluate(_KEEP)
    for zeta in ("0.9", "1.6"):
        bench.type("network.zeta", zeta)
        bench.plotly()
    axes = page.evaluate(_AXES)
    assert axes[1] != before[1], "otherwise nothing is shown here"
    assert page.evaluate(_KEPT)
    assert page.evaluate(_HOMES) == axes[1:3], "to which a double click goes back"
    labels, lines = page.evaluate(_LABELS), page.evaluate(_PATHS)
    assert len(labels) > 3
    page.evaluate(_ANEW)
    assert not page.evaluate(_KEPT)
    assert page.evaluate(_AXES) == axes
    assert page.evaluate(_LABELS) == labels
    for line, anew in zip(lines, page.evaluate(_PATHS), strict=True):
        assert line == pytest.approx(anew, abs=0.02), "as plotly draws it"
    assert bench.faults == []


def test_a_zoom_outlives_a_slider_step(bench: Bench) -> None:
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Frequency", "Errors", "Method")
    bench.press("network.zeta")
    bench.plotly()
    page = bench.page
    box = page.locator(".js-plotly-plot:visible .nsewdrag").first.bounding_box()
    whole = page.evaluate(_AXES)
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.3 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.7 * box["width"], box["y"] + 0.7 * box["height"], steps=5)
    page.mouse.up()
    zoomed = bench.wait_for_change(lambda: page.evaluate(_AXES), whole)
    for _ in range(3):
        bench.press("network.zeta")
        bench.plotly()
    assert page.evaluate(_AXES)[0] == pytest.approx(zoomed[0])
    x_axis = page.evaluate(_AXES)[0]

    def is_whole() -> bool:
        # a busy page may take the second click too late for a double click
        page.mouse.dblclick(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
        bench.settle()
        return page.evaluate(_AXES)[0] != x_axis

    bench.wait_until(is_whole)
    assert bench.faults == []


def test_a_double_click_goes_back_to_the_ranges_of_the_figure_that_is_shown(bench: Bench) -> None:
    """Both of a view's figures are drawn in one place: the first one's ranges would come back otherwise."""
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Frequency")
    bench.show(poles="whole")
    bench.tab("Poles")
    bench.plotly()
    bench.show(poles="channel")
    bench.plotly()
    page = bench.page
    box = page.locator(".js-plotly-plot:visible .nsewdrag").first.bounding_box()
    home = page.evaluate(_MAP_AXES)
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.3 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.7 * box["width"], box["y"] + 0.7 * box["height"], steps=5)
    page.mouse.up()
    zoomed = bench.wait_for_change(lambda: page.evaluate(_MAP_AXES), home)

    def is_back() -> bool:
        # a busy page may take the second click too late for a double click
        page.mouse.dblclick(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
        bench.settle()
        return page.evaluate(_MAP_AXES) == home

    assert zoomed != home
    bench.wait_until(is_back)
    # one more leaves it there: all that is drawn, the ends of the rays with it, would be a point
    page.mouse.dblclick(box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"])
    bench.settle()
    assert page.evaluate(_MAP_AXES) == home
    assert bench.faults == []


def test_of_two_hundred_steps_none_is_lost_and_everything_follows_at_rest(bench: Bench) -> None:
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Frequency", "Errors", "Method")
    bench.settle()
    start, thumb = bench.value("network.zeta"), bench.slider("network.zeta")
    thumb.press("ArrowRight")
    bench.settle()
    step = bench.value("network.zeta") - start
    for key, count in (("ArrowRight", 119), ("ArrowLeft", 80)):
        for _ in range(count):
            thumb.press(key)
    bench.settle()
    assert bench.value("network.zeta") == pytest.approx(start + 40 * step)
    session = bench.session
    assert edits.network_values(session.scenario, 2)["zeta"] == pytest.approx(start + 40 * step)
    assert bench.run == session.run_number
    assert {trace["name"] for trace in bench.plotly()}
    assert "moves" not in bench.status


# The page's thread has no time for three seconds; then come three steps before what the server has sent
# meanwhile, and three after it.
_BUSY = """async id => {
  const thumb = document.getElementById(id).querySelector('[role=slider]');
  const press = kind => thumb.dispatchEvent(
    new KeyboardEvent(kind, {key: 'ArrowRight', code: 'ArrowRight', bubbles: true, cancelable: true}));
  for (const end = performance.now() + 3000; performance.now() < end; );
  for (let step = 1; step <= 6; step++) {
    ['keydown', 'keyup'].forEach(press);
    for (let turn = 0; turn < 100; turn++) await null; // React has taken it
    if (step === 3) await new Promise(go => setTimeout(go, 300));
  }
}"""


def test_steps_that_a_busy_page_takes_late_are_not_lost(bench: Bench) -> None:
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Frequency", "Errors", "Method")
    bench.settle()
    start = bench.value("network.zeta")
    bench.press("network.zeta")
    step = bench.value("network.zeta") - start
    bench.page.evaluate(_BUSY, bench.id("network.zeta"))
    bench.settle()
    assert bench.value("network.zeta") == pytest.approx(start + 7 * step)
    assert edits.network_values(bench.session.scenario, 2)["zeta"] == pytest.approx(start + 7 * step)


_INK = """width => {
  const wrap = Object.assign(document.createElement('div'), {className: 'u-wrap'});
  const plain = document.createElement('div');
  document.body.append(wrap, plain);
  const ink = [wrap, plain].map(parent => {
    const canvas = Object.assign(document.createElement('canvas'), {width: 300, height: 120});
    parent.append(canvas);
    const context = canvas.getContext('2d'), curve = new Path2D();
    for (let x = 0; x <= 300; x++) curve.lineTo(x, 60 + 45 * Math.sin(x / 18));
    [context.lineWidth, context.strokeStyle] = [width, '#1a6fb5'];
    context.stroke(curve);
    const shades = context.getImageData(0, 0, 300, 120).data.filter((_, place) => place % 4 === 3);
    return [shades.reduce((sum, shade) => sum + shade, 0), context.lineWidth, shades.join()];
  });
  wrap.remove();
  plain.remove();
  const [[hairlines, left, one], [line, , other]] = ink;
  return {ratio: hairlines / line, left, same: one === other};
}"""


def test_a_curve_of_hairlines_is_as_wide_as_its_line(bench: Bench) -> None:
    for width in (1.5, 2.0):
        found = bench.page.evaluate(_INK, width)
        assert found["left"] == width, "for the next curve"
        assert not found["same"] and 0.8 < found["ratio"] < 1.1
    for width in (1.0, 3.0):
        assert bench.page.evaluate(_INK, width)["same"], "drawn as it is"


_STILL = """() => {
  const wrap = Object.assign(document.createElement('div'), {className: 'u-wrap'});
  const canvas = Object.assign(document.createElement('canvas'), {width: 300, height: 120});
  wrap.append(canvas);
  document.body.append(wrap);
  const context = canvas.getContext('2d'), curve = new Path2D();
  for (let x = 0; x <= 300; x++) curve.lineTo(x, 60 + 45 * Math.sin(x / 18));
  context.lineWidth = 2;
  const shades = color => {
    context.resetTransform();
    context.fillStyle = '#fff';
    context.fillRect(0, 0, 300, 120);
    context.strokeStyle = color;
    context.setTransform(1, 0, 0, 1, 0.5, 0.5);
    context.stroke(curve);
    const {e, f} = context.getTransform();
    return {left: [e, f], pixels: [...context.getImageData(0, 0, 300, 120).data]};
  };
  const drawn = ['#1a6fb5', '#1a6fb5', '#1a6fb5', '#b51a1a'].map(shades);
  wrap.remove();
  const [{pixels: first}] = drawn;
  const most = pixels => pixels.reduce((worst, pixel, at) => Math.max(worst, Math.abs(pixel - first[at])), 0);
  return {apart: drawn.map(({pixels}) => most(pixels)), left: drawn.map(({left}) => left)};
}"""


def test_the_picture_of_a_curve_that_stands_still_is_the_curve(bench: Bench) -> None:
    found = bench.page.evaluate(_STILL)
    first, second, third, red = found["apart"]
    assert first == 0
    assert max(second, third) <= 8, "of 255: but for rounding where the hairlines overlap"
    assert red > 100, "another color is another picture"
    assert found["left"] == [[0.5, 0.5]] * 4, "for the next curve"


# The buttons above the panel with their texts, marked.
_BUTTONS = "[...document.querySelectorAll('.sb-row[role=toolbar]:not(.sb-lecture) button')]"
_NODES = f"{_BUTTONS}.flatMap(button => [button, ...button.childNodes])"
_MARK = f"() => {_NODES}.forEach(node => {{ node.made = true; }})"
_MARKED = f"() => {_NODES}.map(node => node.made === true)"


def test_of_a_block_of_html_only_what_differs_is_made_anew(bench: Bench) -> None:
    bench.reset("sikuliaq-like", selected=2)
    bench.tab("Frequency", "Errors", "Method")
    bench.press("network.zeta")
    bench.settle()
    page, undo = bench.page, bench.page.locator("[data-command=undo]")
    page.evaluate(_MARK)
    marked, title = page.evaluate(_MARKED), undo.get_attribute("title")
    assert len(marked) > 8 and all(marked)
    bench.press("network.zeta")
    bench.wait_for_change(lambda: undo.get_attribute("title"), title)
    assert page.evaluate(_MARKED) == marked


_FILL = """() => {
  const box = document.createElement('div');
  document.body.append(box);
  const seen = [];
  const fill = html => {
    schuler.fill(box, html);
    seen.push(box.innerHTML);
  };
  fill('<p title="a" lang="en">one <b>1</b></p><i>two</i>');
  const [p, b, i] = ['p', 'b', 'i'].map(name => box.querySelector(name));
  fill('<p title="b">one <b>2</b></p><i>two</i>');
  const stays = [p, b, i].every(node => box.contains(node));
  i.textContent = 'zwei'; // as a script of ours may have put it
  fill('<p title="b">one <b>3</b></p><i>two</i>');
  fill('<p title="b">one</p><u>two</u><i>two</i>');
  fill('<p title="b">one</p><s>two</s><i>three</i>');
  fill('<button data-command="undo">four</button>');
  const button = box.firstChild;
  fill('<button data-command="redo">four</button>');
  const pressed = box.contains(button);
  const other = document.createElement('div'); // nothing is known of what it had
  schuler.fill(other, '<i>four</i>');
  box.remove();
  return {seen, stays, pressed, other: other.innerHTML};
}"""


def test_html_that_is_put_into_the_page_in_pieces_is_the_whole(bench: Bench) -> None:
    found = bench.page.evaluate(_FILL)
    assert found["stays"]
    assert found["seen"] == [
        '<p title="a" lang="en">one <b>1</b></p><i>two</i>',
        '<p title="b">one <b>2</b></p><i>two</i>',
        '<p title="b">one <b>3</b></p><i>zwei</i>',
        '<p title="b">one</p><u>two</u><i>two</i>',
        '<p title="b">one</p><s>two</s><i>three</i>',
        '<button data-command="undo">four</button>',
        '<button data-command="redo">four</button>',
    ]
    assert not found["pressed"], "what does something else is another button"
    assert found["other"] == "<i>four</i>"
