"""The whole session in one file: a page that loads nothing and fits on A4, and a picture of all plots."""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from pathlib import Path

import pytest

from navcore.scenario.file import load
from tests.browser.driver import Bench

pytestmark = pytest.mark.browser

NAME = "<b>\u963b\u5c3c</b>"
DRAWING_MS = 300_000
"""A dozen plots are drawn one after the other: on a busy machine each takes seconds."""
PAPER_PX = (round(182 / 25.4 * 96), round(269 / 25.4 * 96))
"""A4 within its margins, as a browser counts."""
TOO_LARGE = """([width, height]) => {
  const found = [];
  for (const figure of document.querySelectorAll('figure')) {
    const { breakInside } = getComputedStyle(figure);
    if (figure.offsetHeight > height || breakInside !== 'avoid') found.push(figure.innerText);
  }
  for (const table of document.querySelectorAll('table')) {
    if (table.getBoundingClientRect().right > width) found.push(table.innerText.slice(0, 60));
  }
  return found;
}"""
DRAWN = """() => [...document.images].map(({naturalWidth, alt}) => naturalWidth > 100 ? alt : `no ${alt}`)"""


@pytest.fixture(scope="module")
def named(opened: Bench) -> Iterator[Bench]:
    """The shared page in dark; a method has a name with markup and Chinese letters."""
    scenario = load("zha-fast")
    first, *others = scenario.method
    opened.put(scenario.model_copy(update={"method": (first.model_copy(update={"name": NAME}), *others)}))
    opened.show(theme="dark")
    opened.tab("View")
    yield opened
    opened.show(theme="light")


def saved(bench: Bench, button: str, folder: Path) -> Path:
    """What a button gives, under its name."""
    with bench.page.expect_download(timeout=DRAWING_MS) as download:
        bench.page.get_by_role("button", name=button, exact=True).click()
    path = folder / download.value.suggested_filename
    download.value.save_as(path)
    bench.page.locator("#sb-export").wait_for(state="detached")
    return path


def test_the_session_is_one_page_that_fits_on_a4(named: Bench, tmp_path: Path) -> None:
    path = saved(named, "Save as one page (HTML)", tmp_path)
    assert path.name == "session.html"
    reader = named.page.context.new_page()
    asked: list[str] = []
    reader.on("request", lambda request: asked.append(request.url))
    try:
        reader.goto(path.as_uri())
        reader.wait_for_function("() => [...document.images].every((image) => image.complete)")
        drawn = reader.evaluate(DRAWN)
        titles = (
            "Trajectory in 3D",
            "Frequency",
            "Poles",
            "Errors: Attitude",
            "Errors: Position",
            "Spectrum",
        )
        assert set(titles) <= set(drawn) and not [title for title in drawn if title.startswith("no ")]
        assert reader.get_by_text(NAME, exact=True).count() >= 1
        assert reader.evaluate("() => document.querySelectorAll('script, b b').length") == 0
        assert (
            reader.evaluate("() => getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
        )
        assert [url[:60] for url in asked if not url.startswith(("data:", "file:"))] == []
        reader.emulate_media(media="print")
        reader.set_viewport_size({"width": PAPER_PX[0], "height": PAPER_PX[1]})
        assert reader.evaluate(TOO_LARGE, list(PAPER_PX)) == []
        printed = reader.pdf(prefer_css_page_size=True)
        assert 4 <= len(re.findall(rb"/Type\s*/Page\b", printed)) <= 14
        assert re.search(rb"/MediaBox\s*\[\s*0 0 59[45](\.\d+)? 84[12]", printed)  # points
    finally:
        reader.close()
    assert named.faults == []


def test_all_plots_are_one_picture(named: Bench, tmp_path: Path) -> None:
    path = saved(named, "Save all plots (PNG)", tmp_path)
    content = path.read_bytes()
    width, height = struct.unpack(">II", content[16:24])
    assert path.name == "overview.png" and content.startswith(b"\x89PNG")
    assert width > 1500 and height > 1500 and len(content) > 100_000
    assert named.page.locator(".sb-making").text_content() == ""
    assert named.faults == []
