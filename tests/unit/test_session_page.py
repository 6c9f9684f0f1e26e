"""The session as one HTML page: what it holds, that it is text, that it loads nothing and runs nothing."""

from __future__ import annotations

import re
import tomllib
from datetime import UTC, datetime
from html import unescape
from html.parser import HTMLParser

import pytest

from app.languages.wording import wording
from app.plots.units import rounded
from app.session.display import Display
from app.session.pins import Pins
from app.session.requirements import Requirements
from app.session.shown import Shown
from app.views.appearance.document import Session, command, document
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.scenario.file import load, scenario_hash
from navcore.scenario.model import Scenario
from tests.unit.figures_runs import THREE, UNSTABLE, run_of, static_run

HOSTILE = "<img src=x onerror=alert(1)>"
MADE = datetime(2026, 11, 22, 20, 50, tzinfo=UTC)


class Reader(HTMLParser):
    """Elements with their attributes, and the text of each section by its heading."""

    def __init__(self, html: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.sections: dict[str, str] = {"": ""}
        self._open: list[str] = []
        self._heading = ""
        self.feed(html)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        self._open.append(tag)
        if tag == "h2":
            self._heading = "\n"
            self.sections["\n"] = ""

    def handle_endtag(self, tag: str) -> None:
        while self._open and self._open.pop() != tag:
            pass
        if tag == "h2":
            self._heading = self.sections.pop("\n").strip()
            self.sections[self._heading] = ""

    def handle_data(self, data: str) -> None:
        if "style" not in self._open:
            self.sections[self._heading] += f"{data} "


def session_of(run: Run, pins: Pins | None = None, origin: str = "mine.toml", **choices: object) -> Session:
    kept = () if pins is None else pins.all
    return Session(Shown(run, 1, Display.model_validate(choices)), kept, origin, MADE)


def read(session: Session, pictures: tuple[str, ...] = ("Poles", "Errors: Attitude")) -> Reader:
    return Reader(document(session, pictures))


def test_the_page_holds_numbers_verdicts_pins_warnings_plots_and_scenario() -> None:
    pins = Pins(lambda: None, simulate)
    pins.add(static_run(), "preset", "before the change")
    run = run_of(method=[*THREE, UNSTABLE])
    limits = Requirements(settling_min=200.0, tilt_max_arcsec=1e4)
    page = read(session_of(run, pins, requirements=limits))
    assert list(page.sections) == [
        "",
        "Warnings about the run",
        "Metrics",
        "Requirements",
        "Pins",
        "Plots",
        "Scenario",
    ]
    assert "2026-11-22 20:50 UTC" in page.sections[""] and scenario_hash(run.scenario) in page.sections[""]
    assert "as printed" in page.sections["Warnings about the run"]
    for method in run.scenario.method:
        assert method.name in page.sections["Metrics"] and method.name in page.sections["Requirements"]
    peak = run.methods[1].errors["position_m"]["max_abs"]
    assert rounded(peak) in page.sections["Metrics"] and "arcsec" in page.sections["Metrics"]
    assert "✓ met" in page.sections["Requirements"] and "✗ missed" in page.sections["Requirements"]
    assert "before the change" in page.sections["Pins"]
    places = [attributes.get("data-picture") for tag, attributes in page.elements if tag == "img"]
    assert places == ["0", "1"] and "Errors: Attitude" in page.sections["Plots"]
    text = page.sections["Scenario"]
    assert Scenario.parse(tomllib.loads(text[text.index("schema = ") :])) == run.scenario


def test_what_there_is_none_of_is_said() -> None:
    page = read(session_of(static_run()))
    assert "No requirement is set." in page.sections["Requirements"]
    assert "No run is pinned." in page.sections["Pins"]


@pytest.mark.parametrize(
    ("origin", "changes", "expected"),
    [
        ("zha-fast", [], "schuler run zha-fast"),
        ("zha-fast", ["run.seed=7"], "schuler run scenario.toml"),
        ("mine.toml", [], "schuler run scenario.toml"),
    ],
)
def test_the_command_runs_it_again(origin: str, changes: list[str], expected: str) -> None:
    session = session_of(simulate(load("zha-fast", ["run.duration_h=1", *changes])), origin=origin)
    preset = session_of(simulate(load("zha-fast")), origin=origin) if not changes else session
    assert command(preset) == expected
    assert command(session) == "schuler run scenario.toml"


def test_markup_in_names_is_text() -> None:
    pins = Pins(lambda: None, simulate)
    pins.add(static_run(), "preset", HOSTILE)
    run = run_of(title=HOSTILE, source=HOSTILE, method=[{"name": HOSTILE[:40]}, *THREE[1:]])
    html = document(session_of(run, pins, HOSTILE), [HOSTILE])
    page = Reader(html)
    assert "onerror" not in {name for _, attributes in page.elements for name in attributes}
    assert not {"script", "button", "link", "iframe"} & {tag for tag, _ in page.elements}
    assert HOSTILE in page.sections[""] and HOSTILE in page.sections["Pins"]
    assert re.search(r"<title>Schuler Bench: &lt;img", html)


def test_the_page_loads_and_runs_nothing_and_is_for_a4() -> None:
    html = document(session_of(static_run()), ["Poles"])
    assert re.search(r"https?:|//|url\(|@import|<script|<link|javascript:", html) is None
    policy = next(
        a["content"] for tag, a in Reader(html).elements if a.get("http-equiv") == "Content-Security-Policy"
    )
    assert policy is not None and policy.startswith("default-src 'none'; img-src data:;")
    style = re.search(r"<style>(.*?)</style>", html, re.DOTALL)
    assert style is not None and "size: A4" in style[1] and "@media print" in style[1]
    assert "break-inside: avoid" in style[1] and "color-scheme: light" in style[1]


@pytest.mark.parametrize("count", [1, 3, 4, 10])
def test_no_table_is_wider_than_paper(count: int) -> None:
    methods = [{"name": f"method {i}"} for i in range(count)]
    html = document(
        session_of(run_of(run={"duration_h": 1.0}, method=methods), requirements={"settling_min": 9}), []
    )
    heads = re.findall(r"<thead>(.*?)</thead>", html, re.DOTALL)
    wide = [head for head in heads if "rms" in head or "limit" in head]
    assert all(0 < head.count("method ") <= 3 for head in wide)
    assert sum(head.count("method ") for head in wide) == 2 * count


def test_the_page_is_in_chinese_except_for_names_and_the_scenario() -> None:
    chinese = wording("zh-CN")
    assert chinese is not None
    html = document(session_of(static_run()), ["Poles"], "zh-CN", chinese.text)
    page = Reader(html)
    assert 'lang="zh-CN"' in html and "schuler run scenario.toml" in page.sections[""]
    assert [head for head in page.sections if re.search("[A-Za-z]{3}", head)] == []
    words = re.findall(
        r"[A-Za-z]{4,}", " ".join(text for head, text in page.sections.items() if head != "场景")
    )
    names = {
        "Schuler",
        "Bench",
        "schuler",
        "scenario",
        "toml",
        "mine",
        "free",
        "classic",
        "compass",
        "arcsec",
        "arcmin",
        "none",
    }
    assert {
        word for word in map(unescape, words) if word not in names and not re.fullmatch("[a-f]+", word)
    } == set()
    assert page.sections["场景"].count("[[method]]") == len(THREE)
