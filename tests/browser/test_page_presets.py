"""Every preset opens from the chooser: its run is shown, its plots are drawn, nothing fails."""

from __future__ import annotations

import pytest

from navcore.scenario.file import load, presets
from tests.browser.driver import Bench


@pytest.mark.parametrize("name", presets())
def test_a_preset_opens(bench: Bench, name: str) -> None:
    bench.reset("zha-fast" if name != "zha-fast" else "sun-step")
    bench.choose_and_run("scenario", name)
    run = bench.session.run
    assert run is not None
    assert run.scenario == load(name)
    shown = bench.metrics["methods"]
    assert [method["name"] for method in shown] == [method.name for method in load(name).method]
    bench.tab("Errors")
    bench.page.wait_for_selector(".uplot canvas")
    bench.tab("Metrics")
    table = "names => names.every(name => document.querySelector('.sb-table')?.innerText.includes(name))"
    bench.page.wait_for_function(table, arg=[method.method.name for method in run.methods])
    assert bench.faults == []
