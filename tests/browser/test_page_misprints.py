"""The misprint laboratory: each form can be switched on and off, at every window size."""

from __future__ import annotations

import re
from typing import Any

import pytest

from app.misprints import MISPRINTS
from tests.browser.driver import Bench
from tests.browser.test_page_layout import _TEXT_OUTSIDE

pytestmark = pytest.mark.browser

_DRAWN = """([id, shown]) => {
  const plots = [...document.querySelectorAll('.js-plotly-plot')].filter(p => p.offsetParent !== null);
  const plot = plots.find(p => p._fullLayout?.meta?.misprint === id && p._fullLayout.meta.shown === shown);
  return plot ? plot._fullData.map(t => [t.name, t.line.dash, t.y.length]) : null;
}"""


def drawn(bench: Bench, id: str, shown: str) -> list[Any]:
    bench.page.wait_for_function(_DRAWN, arg=[id, shown])
    return bench.page.evaluate(_DRAWN, [id, shown])


def option(id: str) -> str:
    found = MISPRINTS[id]
    return f"{found.paper}, {found.where}: {found.consequence}"


def test_a_misprint_is_shown_as_printed_corrected_and_both(bench: Bench) -> None:
    bench.reset("sikuliaq-like")
    bench.tab("Misprints")
    first = next(iter(MISPRINTS))
    bench.choose("misprint", option(first))
    bench.choose("form shown", "both")
    assert len(drawn(bench, first, "both")) >= 2
    bench.choose("misprint", option("zha-4.1"))
    both = drawn(bench, "zha-4.1", "both")
    assert [name for name, *_ in both] == ["K₂ = 156.063 (printed)", "K₂ = 202.52"]
    assert both[0][1] != "solid" and both[1][1] == "solid"
    bench.choose("form shown", "as printed")
    assert drawn(bench, "zha-4.1", "as printed") == both[:1]
    bench.choose("form shown", "corrected")
    assert drawn(bench, "zha-4.1", "corrected") == both[1:]
    words = bench.page.locator(".sb-misprint").inner_text()
    assert "K₂ = 156.063 for σ = 0.0088" in words and "as printed" in words
    number = bench.run
    bench.tab("Method", "Frequency")
    assert bench.run == number
    assert bench.faults == []


def test_every_misprint_is_readable(bench: Bench) -> None:
    bench.reset("sikuliaq-like")
    bench.tab("Misprints")
    bench.choose("form shown", "both")
    for id in MISPRINTS:
        bench.choose("misprint", option(id))
        drawn(bench, id, "both")
        assert bench.page.evaluate(_TEXT_OUTSIDE) == [], id
        words = bench.page.locator(".sb-misprint").inner_text()
        assert re.search(r"\b\w_\w|\de[+-]\d", words) is None, words
    assert bench.faults == []
