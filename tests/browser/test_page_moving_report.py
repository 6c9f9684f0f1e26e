"""The report that still moves: opened as a file, without a server, its sliders give what the engine gives."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser

from navcore.engine.simulation import simulate
from navcore.quantities import COMPONENTS
from navcore.questions.report import ReportQuestion
from navcore.scenario.model import Scenario
from schuler_bench.editing import edits
from schuler_bench.views.requirements.moving import moving_of
from tests.unit.test_moving import SHIP


@pytest.mark.slow
def test_a_report_moves_without_a_server(browser: Browser, tmp_path: Path) -> None:
    limit = {"quantity": "tilt_max_arcsec", "at_most": 400.0}
    scenario = Scenario.parse({**SHIP, "requirement": [limit]})
    asked = ReportQuestion.ask({"scenario": scenario, "seeds": 2})
    file = tmp_path / "report.html"
    file.write_text(asked.texts(asked.answer())["report.html"], "utf-8")
    assert file.stat().st_size < 1_500_000
    moving = moving_of(scenario)
    context = browser.new_context(viewport={"width": 390, "height": 844}, offline=True)
    page = context.new_page()
    faults: list[str] = []
    page.on("console", lambda message: faults.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: faults.append(str(error)))
    try:
        page.goto(file.as_uri())
        page.locator("#sb-moving canvas").first.wait_for()
        as_in_report = require_rows(page, moving.scenario, 1)
        place = [one["name"] for one in moving.header["methods"]].index("gains")
        method = moving.header["methods"][place]
        slide(page, method["field"], len(method["values"]) - 1)
        path = ("method", place, "network", method["field"].rpartition(".")[2])
        changed = edits.with_value(moving.scenario, path, method["values"][-1])
        require_rows(page, changed, place)
        slide(page, "reference.bias_mps.1", -1.5)
        changed = edits.with_value(changed, ("reference", "bias_mps", 1), -1.5)
        for one in range(len(changed.method)):
            require_rows(page, changed, one)
        page.get_by_role("button", name="As in the report").click()
        assert np.array_equal(require_rows(page, moving.scenario, 1), as_in_report)
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
        assert faults == []
    finally:
        context.close()


def slide(page: Any, field: str, value: float) -> None:
    """Move a slider of the page."""
    script = "(input, value) => { input.value = value; input.dispatchEvent(new Event('input')); }"
    page.locator(f"input[data-field='{field}']").evaluate(script, value)


def require_rows(page: Any, scenario: Scenario, place: int) -> np.ndarray:
    """Rows of a method on the page, which are those of the engine's run."""
    rows = page.evaluate("place => document.getElementById('sb-moving').moving.rows(place)", place)
    found = np.array(rows).reshape(-1, len(COMPONENTS))
    expected = simulate(scenario).methods[place].rows[:, : len(COMPONENTS)]
    assert found.shape == expected.shape
    assert np.all(np.abs(found - expected) <= 1e-9 * np.max(np.abs(expected), axis=0))
    return found
