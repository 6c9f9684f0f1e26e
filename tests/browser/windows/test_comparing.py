"""Seen in pictures of the page: pins, legends, the table of metrics, names, and what stands over the map."""

import re
from itertools import combinations

import pytest

from schuler_bench.editing import edits
from schuler_bench.http.ids import SessionIds
from schuler_bench.session.pins import MOST_PINS
from schuler_bench.shell.layout import layout_for
from tests.browser.driver import SIZES, Bench
from tests.browser.fields import label_of
from tests.browser.test_page_layout import wait_until_it_fits
from tests.browser.test_page_scene import overlap
from tests.browser.windows.seeing import read, see, speaks
from tests.limits import require

ZETA = ("method", 2, "network", "zeta")


@pytest.fixture
def pinned(window: Bench) -> Bench:
    """A pin, and the run with another damping ratio."""
    window.tab("Compare")
    see(window, window.button("Pin this run")).click()
    window.wait_until(lambda: len(window.session.pins.all) == 1)
    for _ in range(4):
        window.press("network.zeta")
    return window


def name_of_pin(window: Bench) -> str:
    """What the pin is called: by what differs."""
    return f"ζ {edits.value_at(window.session.pins.all[0].scenario, ZETA):g}"


def wait_for_names(window: Bench, condition: str) -> None:
    """Wait until the names of every plot's curves fulfil a condition."""
    window.page.wait_for_function(f"() => look.uplotNames().every(names => {condition})")


def test_a_pin_is_called_by_what_differs_and_is_of_the_edited_method(pinned: Bench) -> None:
    name = name_of_pin(pinned)
    assert name in read(pinned, pinned.page.locator(".sb-pins tbody tr", has_text="ζ"))
    pinned.tab("Errors")
    # only the method that was edited is laid over: the others are as they were
    wait_for_names(pinned, f"names.length === 4 && names[3] === '{name}: complementary'")
    assert read(pinned, pinned.page.locator(".sb-legend .sb-entry", has_text=name))
    data = next(chart["data"] for chart in pinned.curves() if chart["label"].startswith("|δV|"))
    assert len(data) == 5 and data[3] != pytest.approx(data[4], rel=1e-3)
    line = pinned.line("/track/pinned0")
    assert line and line != pytest.approx(pinned.line("/track/method2"), abs=1e-3), "on the map too"
    assert pinned.line("/track/pinned1") is None
    for tab in ("Frequency", "Poles", "Step", "Spectrum"):
        pinned.tab(tab)
        assert f"{name}: complementary" in {trace["name"] for trace in pinned.plotly()}, tab


def test_the_table_says_what_has_changed_since_the_pin(pinned: Bench) -> None:
    (pin,) = pinned.session.pins.all
    new, old = (run.methods[2].errors["phi_e_rad"]["rms"] for run in (pinned.session.run, pin.run))
    pinned.tab("Metrics")
    row = pinned.page.locator(".sb-table tr", has_text="φE").filter(has=pinned.page.locator(".sb-delta"))
    row.first.wait_for()
    percent = f"({100.0 * (new / old - 1.0):+.1f} %)"
    assert any(percent in text for text in row.locator(".sb-delta").all_inner_texts())
    pinned.page.locator(".sb-table", has_text=re.compile("Δ.*ζ")).first.wait_for()
    pinned.tab("Compare")
    pinned.choose("Δ of", "final")
    pinned.tab("Metrics")
    pinned.page.get_by_text(pinned.said("Δ final")).first.wait_for()


def test_b_flips_between_the_present_run_and_the_pin(pinned: Bench) -> None:
    pinned.tab("Errors")
    page, (pin,) = pinned.page, pinned.session.pins.all
    wait_for_names(pinned, "names[3]?.startsWith('ζ')")
    before = pinned.curves()
    page.evaluate("() => document.activeElement.blur()")
    page.keyboard.press("b")
    page.wait_for_selector("#sb-flip", state="attached")
    assert "ζ" in page.evaluate("look.banner")
    wait_for_names(pinned, "!names.some(n => n.startsWith('ζ'))")
    data = next(chart for chart in pinned.curves() if chart["label"].startswith(pinned.said("position")))
    peak = max(value for value in data["data"][3] if value is not None)
    ratio = peak / pin.run.methods[2].errors["position_m"]["max_abs"]
    assert min(abs(ratio * metres - 1.0) for metres in (1.0, 1000.0, 1852.0)) < 1e-6
    assert page.evaluate("() => getComputedStyle(document.querySelector('.uplot')).outlineStyle") == "solid"
    page.keyboard.press("b")
    page.wait_for_selector("#sb-flip", state="detached")
    wait_for_names(pinned, "names[3]?.startsWith('ζ')")
    assert page.evaluate("look.banner") in ("none", "normal") and pinned.curves() == before


def test_a_pin_is_renamed_hidden_gone_back_to_and_removed(pinned: Bench) -> None:
    page, (pin,) = pinned.page, pinned.session.pins.all
    for label, text in (("pin name", '<b>"old"</b>'), ("pin note", "as delivered")):
        row = "xpath=ancestor::*[contains(@class, 'mantine-Flex-root')][1]//input"  # viser gives it no id
        page.locator(f'label:text-is("{pinned.said(label)}")').locator(row).fill(text)
        page.locator(".sb-pins", has_text=text).wait_for()
    pinned.tab("Errors")
    wait_for_names(pinned, "names.some(n => n.includes('\"old\"'))")
    pinned.tab("Compare")
    pinned.box("pin shown").click()
    pinned.wait_until(lambda: pinned.session.pins.shown == ())
    page.locator(".sb-pins", has_text=pinned.said("hidden")).wait_for()
    with pinned.next_run():
        see(pinned, pinned.button("Go back to this pin")).click()
    assert pinned.session.scenario == pin.scenario
    see(pinned, pinned.button("Remove this pin")).click()
    page.locator(".sb-no-pins").wait_for()
    assert len(pinned.session.pins.all) == 0


def test_the_pins_of_a_link_are_taken_and_given_back(pinned: Bench) -> None:
    page, session, (pin,) = pinned.page, pinned.session, pinned.session.pins.all
    assert pinned.sessions is not None and session.run is not None
    theirs = pinned.sessions.get(SessionIds().new_copy(session.share()))
    theirs.pins.change(theirs.pins.add(session.run, "").id, note="calmer at sea")
    row = "xpath=ancestor::*[contains(@class, 'mantine-Flex-root')][1]//input"
    link = page.locator(f'label:text-is("{pinned.said("link with pins")}")').locator(row)
    for text, told in (("elsewhere", "No pin was taken"), (f"/s/{theirs.share()}/", "Pins from a link")):
        link.fill(text)
        see(pinned, pinned.button("Take the pins from a link")).click()
        pinned.notice(told)
    see(pinned, page.locator(".sb-pins tbody tr", has_text="calmer at sea"))
    assert session.pins.all[0] == pin and len(session.pins.all) == 2
    session.undo()
    page.locator(".sb-pins", has_text="calmer at sea").wait_for(state="detached")
    assert session.pins.all == (pin,)


def test_pins_stand_in_one_table_that_sorts_and_judges(pinned: Bench) -> None:
    page, session = pinned.page, pinned.session
    require(pinned, settling_s=1.0)
    table = see(pinned, page.locator(".sb-pins table"))
    text = read(pinned, table)
    measured = (
        "settling (min)",
        "velocity RMS per axis of this run (m/s)",
        "largest tilt of this run (arcsec)",
    )
    for heading in (*measured, "requirements"):
        assert pinned.said(heading) in text
        see(pinned, page.locator(".sb-sort", has_text=pinned.said(heading)))
    assert text.count("✗") == 2
    settles = [run.methods[2].loop.settling_s for run in (session.run, session.pins.all[0].run)]
    names = page.evaluate("look.runs")
    order = sorted(names, key=lambda name: settles["ζ" in name] or 0.0)
    for wanted in (order, order[::-1]):
        see(pinned, page.locator(".sb-sort", has_text=pinned.said("settling (min)"))).click()
        page.wait_for_function("runs => String(look.runs()) === String(runs)", arg=wanted)


def test_requirements_judge_pins(pinned: Bench) -> None:
    require(pinned, settling_s=1.0)
    pinned.tab("Requirements")
    read(pinned, pinned.page.locator(".sb-verdicts th", has_text="ζ"))
    read(pinned, pinned.page.locator(".sb-verdicts table"))


def test_many_pins_fit_and_more_than_the_most_are_refused(pinned: Bench) -> None:
    session = pinned.session
    session.pins.add(session.run, "sikuliaq-like", "a second one")
    for tab in ("Compare", "Errors", "Spectrum"):
        pinned.tab(tab)
        wait_until_it_fits(pinned, tab, scrolls=tab == "Compare")
    pinned.tab("Compare")
    while len(session.pins.all) < MOST_PINS:
        session.pins.add(session.run, "sikuliaq-like")
    see(pinned, pinned.button("Pin this run")).click()
    pinned.notice("Not pinned")
    read(pinned, pinned.page.locator(".mantine-Notification-root"))
    assert len(session.pins.all) == MOST_PINS


def test_a_click_on_the_legend_dims_hides_and_leaves_out(window: Bench) -> None:
    page, run = window.page, window.session.run
    names = [method.method.name for method in run.methods]
    peaks = [method.errors["position_m"]["max_abs"] for method in run.methods]
    place = peaks.index(max(peaks))
    cards = page.locator("#sb-strip .sb-result")
    assert cards.locator("b").all_inner_texts() == names
    top = f"""() => Object.values(window.__viserTestpoints.uplots).map(e => e.chart)
      .filter(c => c.axes[1].label.startsWith({window.said("position")!r}))
      .map(c => [c.scales.y.max, c.series[{1 + place}].show])[0]"""
    drawn = page.evaluate(top)[0]
    for state in ("unscaled", "dimmed", "hidden"):
        see(window, cards.nth(place).locator(".sb-tint")).click()
        page.wait_for_selector(f".sb-result[data-state={state}]")
        window.catch_up()
        assert window.session.display.state_of(names[place]) == state
        assert names[place] in read(window, page.locator(f".sb-result[data-state={state}]"))
        scale = "===" if state == "dimmed" else "<"
        condition = f"{scale} top && show === (state !== 'hidden')"
        page.wait_for_function(
            f"([top, state]) => (([now, show]) => now {condition})(({top})() ?? [])", arg=[drawn, state]
        )
    assert window.line(f"/track/method{place}") is None and window.line(f"/track/method{place - 1}")
    cards.nth(place).locator(".sb-tint").click()  # once more, and it is shown again
    window.wait_until(lambda: window.line(f"/track/method{place}") is not None)


def test_copies_have_names_of_their_own(window: Bench) -> None:
    for _ in range(3):
        with window.next_run():
            see(window, window.menu("copy")).click()
    names = [method.name for method in window.session.scenario.method]
    assert names[2:] == ["complementary", "complementary 2", "complementary 3", "complementary 4"]
    for name in names:
        card = window.page.locator(".sb-result", has_text=re.compile(f"^{name}"))
        card.first.scroll_into_view_if_needed()
        see(window, card)


def test_the_table_of_metrics_is_whole_rounded_aligned_and_marks_the_best(window: Bench) -> None:
    page = window.page
    window.tab("Metrics")
    read(window, page.locator(".sb-table table"))
    columns = page.evaluate("look.points")
    assert len(columns) in (6, 9), "of those methods that fit beside each other"
    for column in columns:
        # the best ones are bold: their digits are a little wider
        assert max(x for _, x in column) - min(x for _, x in column) < 3.0, column
        for text, _ in column:
            assert len(text.replace(".", "").lstrip("-0")) <= 3, text
    # of the settling times, the two tilts, heading, velocities and positions
    assert page.locator(".sb-table .sb-best").count() >= 8
    settles = page.locator(".sb-table tr", has_text=window.said("settling")).first
    assert re.search(r"\d min", read(window, settles)) and " h" not in settles.inner_text()


def test_the_page_speaks_in_plain_words(window: Bench) -> None:
    for tab, label in (("Method", "network"), ("View", "enlarge errors in 3D")):
        window.tab(tab)
        see(window, window.box(label))
        assert read(window, window.page.locator(f"label[for='{window.id(label)}']")) == window.said(label)
    see(window, window.box("scenario"))
    see(window, window.button("About the scenario")).click()
    read(window, window.page.locator("#sb-focus"))
    window.page.keyboard.press("Escape")


def test_the_key_stands_below_the_map_which_fills_its_view(window: Bench) -> None:
    page, (width, _), layout = window.page, window.size, layout_for(*window.size)
    caption = see(window, page.locator("#sb-stage [data-is=caption]"))
    window.wait_until(lambda: caption.inner_text() != "")
    read(window, caption)
    place = [layout.left_px, width - layout.left_px - layout.right_px]
    view, boxes = page.wait_for_function("look.placed", arg=place).json_value()
    shown = {name: box for name, box in boxes.items() if box[2] > box[0]}
    shown["key"] = page.locator("#sb-stage .sb-key").evaluate(
        "key => (({left, top, right, bottom}) => [left, top, right, bottom])(key.getBoundingClientRect())"
    )
    assert {".sb-bar", ".sb-pendulum"} <= set(shown)
    assert [pair for pair in combinations(shown, 2) if overlap(*map(shown.get, pair))] == []
    for name, (left, up, right, down) in shown.items():
        assert left >= view[0] - 1 and right <= view[2] + 1, (name, shown, view)
        assert up >= view[1] - 1 and down <= view[3] + 1, (name, shown, view)
    assert shown[".sb-bar"][3] - shown[".sb-bar"][1] < 110
    pressed = page.locator("#sb-stage [data-shows][aria-pressed=true]").count()
    assert pressed == (2 if window.size == SIZES[0] else 1), "a small view has room for one instrument"
    across, up = page.evaluate("look.viewFilled")
    assert max(across, up) > 0.45, "the map is as large as the room between instruments and key"


def test_meridians_are_labelled_apart(window: Bench) -> None:
    see(window, window.page.locator("canvas[data-engine]"))
    found, width, height = window.page.evaluate("look.meridians")
    labels = {text: tuple(box) for text, *box in found}
    assert len(labels) >= 6 and sum(text.endswith("W") for text in labels) >= 2
    assert [(a, b) for a in labels for b in labels if a < b and overlap(labels[a], labels[b])] == []
    for text, (left, top, right, bottom) in labels.items():
        assert left >= -1 and right <= width + 1 and top >= 0 and bottom <= height, text


def test_notation_is_one(window: Bench) -> None:
    assert "ζ" in label_of("network.zeta")
    for tab in ("Method", "Sensors", "Log", "Run", "Motion"):
        window.tab(tab)
        texts = "\n".join(window.page.locator("label:visible").all_inner_texts())
        assert not re.search(r"\b(zeta|xi|deg|ug|omega)\b|deg/|sqrt", texts), texts
        speaks(window, texts)
    window.tab("Sensors")
    assert re.search("°/√h", "\n".join(window.page.locator("label:visible").all_inner_texts()))
