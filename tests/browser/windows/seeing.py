"""Looks at the page as a person does: what is there, whole and uncovered, and in which language it speaks."""

import re
from collections.abc import Iterable
from functools import lru_cache

from playwright.sync_api import Locator

from navcore.foundation.parameters import Parameters
from navcore.scenario.file import load, presets
from schuler_bench.editing import form
from schuler_bench.editing.choices import choice_words
from schuler_bench.views.learn.lessons import lessons
from tests.browser.driver import Bench

CHINESE = re.compile("[\u4e00-\u9fff]")
PATIENCE_S = 20.0
WORD = re.compile(r"[A-Za-z]{3,}")
KEY = re.compile(r"\b[a-z]+(?:[._][a-z0-9]+)+\b|\b[a-z_]+ = (?:\"[a-z0-9_]+\"|[0-9.]+)")
"""A field of the scenario file, alone or with its value, a column, a file."""
NODE = re.compile(r"(?<!\S)/\w+")
"""A node of the scene, as viser's own panel names it."""
SYMBOLS = frozenset(
    "Schuler Bench CSV SVG PNG TOML JSON HTML LaTeX NMEA Parquet MAT PSINS arcsec arcmin min nmi MiB sin per "
    "log linear exact Deng Liu Zhao Sun Zha Sikuliaq fig eq theory md RMS GPS LQG IMU WGS ENE ESE SSE SSW "
    "WSW WNW NNW NNE Ctrl Shift Enter Esc English Viser WorldAxes light map metrics scenario toml json "
    "page state painted command serve host mas rms and pole2 imu reference npz".split()
)
"""Product, formats, symbols, units, keys, citations, the scene's nodes, the page's own hidden controls."""


@lru_cache(maxsize=1)
def as_written() -> frozenset[str]:
    """Words of a scenario file, which stay as they are: fields, choices, names and units."""
    words = set(SYMBOLS)
    scenarios = [load(name) for name in presets()]
    scenarios += [lesson.scenario_of(step) for lesson in lessons() for step in range(len(lesson.steps))]
    for name in presets():
        words |= set(re.findall(r"[A-Za-z]+", name))
    for scenario in scenarios:
        for method in scenario.method:
            words |= set(re.findall(r"[A-Za-z]+", method.name))
    for kind in models(Parameters):
        for info in kind.model_fields.values():
            words |= {
                part for one in form.choices_of(info) for part in re.findall("[A-Za-z]+", choice_words(one))
            }
            words |= set(re.findall("[A-Za-z]+", str((info.json_schema_extra or {}).get("unit", ""))))
    return frozenset(words)


def models(base: type) -> list[type]:
    return [kind for inner in base.__subclasses__() for kind in (inner, *models(inner))]


def left_out(seen: Iterable[str]) -> list[str]:
    """Texts with a word of English in them, be the rest translated or not."""
    known = as_written()
    bare = {text: NODE.sub("", KEY.sub("", text)) for text in seen}
    return sorted(text for text in seen if any(word not in known for word in WORD.findall(bare[text])))


def see(bench: Bench, found: Locator) -> Locator:
    """Wait until what is found first can be seen: in the window, not cut, not covered; return it."""
    first, why = found.first, "nothing is there"
    for _ in range(round(PATIENCE_S / 0.05)):
        why = first.evaluate("look.hidden") if first.count() else why
        if not why:
            return first
        bench.page.wait_for_timeout(50)
    raise AssertionError(f"{found}: {why}")


def read(bench: Bench, found: Locator) -> str:
    """Text of what is found first, once it can be seen; in the language of the page."""
    text = see(bench, found).inner_text()
    speaks(bench, text)
    return text


def speaks(bench: Bench, text: str) -> None:
    """Let a text be in the language of the page; names, fields and symbols stay as they are written."""
    if bench.language == "en":
        assert not CHINESE.search(text), text
        return
    english = left_out(line.strip() for line in re.split(r"[\n\t]", text))
    assert not english, english
