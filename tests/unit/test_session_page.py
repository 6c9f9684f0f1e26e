"""The session as one HTML page: what it holds, that it is text, that it loads nothing and runs nothing."""

import re
import tomllib
from datetime import UTC, datetime
from html import unescape

import pytest

from navcore.design.dominance import why
from navcore.engine.run import Run
from navcore.engine.simulation import simulate
from navcore.quantities import POSITION
from navcore.scenario.file import load, scenario_hash
from navcore.scenario.model import Scenario
from schuler_bench.languages.wording import wording
from schuler_bench.plots.units import rounded
from schuler_bench.session.display import Display
from schuler_bench.session.pins import Pins
from schuler_bench.session.shown import Shown
from schuler_bench.views.appearance.document import Session, command, document
from schuler_bench.views.metrics.view import cause_text
from tests.limits import under
from tests.unit.figures_runs import THREE, UNSTABLE, run_of, static_run

HOSTILE = "<img src=x onerror=alert(1)>"
MADE = datetime(2026, 11, 22, 20, 50, tzinfo=UTC)
PICTURES = ("Poles", "Errors: Attitude")


def session_of(run: Run, pin: str = "", origin: str = "mine.toml", **choices: object) -> Session:
    """Session with a pin of this name, if it is given one."""
    pins = Pins(lambda: None, simulate)
    if pin:
        pins.add(static_run(), "preset", pin)
    return Session(Shown(run, 1, Display.model_validate(choices)), pins.all, origin, MADE)


def sections(html: str) -> dict[str, str]:
    """Text of each section by its heading."""
    parts = [unescape(re.sub("<[^>]*>", " ", part)) for part in re.split("</?h2[^>]*>", STYLE.sub("", html))]
    return dict(zip(["", *map(str.strip, parts[1::2])], parts[::2], strict=True))


STYLE = re.compile(r"<style>(.*?)</style>", re.DOTALL)


def test_the_page_holds_numbers_verdicts_pins_warnings_plots_and_scenario() -> None:
    run = under(run_of(method=[*THREE, UNSTABLE]), settling_s=200.0, tilt_max_arcsec=1e4)
    html = document(session_of(run, "before the change"), PICTURES)
    text = sections(html)
    names = [method.name for method in run.scenario.method]
    expected = {
        "": ["2026-11-22 20:50 UTC", scenario_hash(run.scenario)],
        "Warnings about the run": ["as printed"],
        "Metrics": [*names, rounded(run.methods[1].errors["position_m"]["max_abs"]), "arcsec"],
        "Requirements": [*names, "✓ met", "✗ missed"],
        "Pins": ["before the change"],
        "Plots": ["Errors: Attitude"],
        "Scenario": ["schema = "],
    }
    assert list(text) == list(expected)
    assert [word for name, words in expected.items() for word in words if word not in text[name]] == []
    assert re.findall(r'<img[^>]* data-picture="(.*?)"', html) == ["0", "1"]
    scenario = text["Scenario"]
    assert Scenario.parse(tomllib.loads(scenario[scenario.index("schema = ") :])) == run.scenario


def test_each_pin_says_what_dominates_it() -> None:
    text = sections(document(session_of(run_of(method=THREE), "before the change"), ()))["Pins"]
    for name, run in (("present run", run_of(method=THREE)), ("before the change", static_run())):
        result = why(run)
        words = [cause_text(cause, result) for cause in result.methods[0][1] if cause.quantity is POSITION]
        assert words and re.search(rf"{name}\s*: {re.escape(words[0])}", text), (name, words, text)


def test_what_there_is_none_of_is_said() -> None:
    text = sections(document(session_of(static_run()), PICTURES))
    assert "No requirement is set." in text["Requirements"] and "No run is pinned." in text["Pins"]


@pytest.mark.parametrize(
    ("origin", "changes", "expected"),
    [
        ("zha-fast", [], "schuler run zha-fast"),
        ("zha-fast", ["run.seed=7", "run.duration_h=1"], "schuler run scenario.toml"),
        ("mine.toml", [], "schuler run scenario.toml"),
    ],
)
def test_the_command_runs_it_again(origin: str, changes: list[str], expected: str) -> None:
    assert command(session_of(simulate(load("zha-fast", changes)), origin=origin)) == expected


def test_markup_in_names_is_text() -> None:
    run = run_of(title=HOSTILE, source=HOSTILE, method=[{"name": HOSTILE[:40]}, *THREE[1:]])
    html = document(session_of(run, HOSTILE, HOSTILE), [HOSTILE])
    assert HOSTILE in sections(html)[""] and HOSTILE in sections(html)["Pins"]
    assert HOSTILE not in html and "<title>Schuler Bench: &lt;img" in html
    assert re.findall("<img(?! [^>]*data-picture)|<(?:script|button|link|iframe)", html) == []


def test_the_page_loads_and_runs_nothing_and_is_for_a4() -> None:
    html = document(session_of(static_run()), ["Poles"])
    assert re.search(r"https?:|//|url\(|@import|<script|<link|javascript:", html) is None
    assert 'http-equiv="Content-Security-Policy" content="default-src \'none\'; img-src data:;' in html
    (style,) = STYLE.findall(html)
    wanted = ("size: A4", "@media print", "break-inside: avoid", "color-scheme: light")
    assert [rule for rule in wanted if rule not in style] == []


@pytest.mark.parametrize("count", [1, 3, 4, 10])
def test_no_table_is_wider_than_paper(count: int) -> None:
    run = run_of(run={"duration_h": 1.0}, method=[{"name": f"method {i}"} for i in range(count)])
    html = document(session_of(under(run, settling_s=9.0)), [])
    heads = re.findall(r"<thead>(.*?)</thead>", html, re.DOTALL)
    widths = [head.count("method ") for head in heads if "rms" in head or "limit" in head]
    assert 0 < min(widths) <= max(widths) <= 3 and sum(widths) == 2 * count


def test_the_page_is_in_chinese_except_for_names_and_the_scenario() -> None:
    chinese = wording("zh-CN")
    assert chinese is not None
    html = document(session_of(static_run()), ["Poles"], "zh-CN", chinese.text)
    text = sections(html)
    assert 'lang="zh-CN"' in html and "schuler run scenario.toml" in text[""]
    assert text.pop("场景").count("[[method]]") == len(THREE)
    names = "Schuler Bench schuler scenario toml mine free classic compass arcsec arcmin none".split()
    english = set(re.findall("[A-Za-z]{4,}", " ".join([*text, *text.values()]))) - set(names)
    assert [word for word in english if not re.fullmatch("[a-f]+", word)] == []
    assert [heading for heading in text if re.search("[A-Za-z]{3}", heading)] == []
