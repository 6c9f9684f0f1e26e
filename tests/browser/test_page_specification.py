"""From a specification to its verdicts, as an engineer goes: ten requirements, the matrix, the report."""

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from navcore.scenario.file import load
from schuler_bench.editing.limits import detail_label, label_of
from schuler_bench.views.requirements.report_button import REPORT
from tests.browser.driver import Bench
from tests.browser.windows.test_results import ask, cells
from tests.unit.test_ten_requirements import FILE, TYPED


@pytest.mark.slow
def test_ten_requirements_typed_into_the_page_become_a_matrix_and_a_report(
    bench: Bench, browser: Browser, tmp_path: Path
) -> None:
    """A browser test may take 400 s: less than half of the fifteen minutes that an engineer has."""
    written = load(str(FILE))
    bench.put(written.model_copy(update={"requirement": ()}), "Requirements", origin="a specification")
    for key, (limit, details) in TYPED.items():
        ask(bench, label_of(key), limit)
        for field, text in details.items():
            ask(bench, detail_label(key, field), text)
    session, page = bench.session, bench.page
    assert session.scenario.requirement == written.requirement
    # a verdict of each limit and method, the share of its seeds and their interval
    judge = session.searches.judge
    bench.wait_until(
        lambda: None not in [judge.odds(session.scenario, one) for one in session.scenario.method], 120.0
    )
    bench.catch_up()
    methods = len(written.method)
    for key in TYPED:
        assert len(cells(bench, key)) == methods
        row = page.locator(".sb-verdicts tr").filter(has=page.locator(f"[data-limit='{key}']"))
        assert row.locator(".sb-share").count() >= methods
        assert page.locator(f"[data-measure='{key}'][data-passed]:not([data-passed=''])").count() == methods
    with page.expect_download(timeout=240_000) as download:
        bench.button(REPORT).click()
    file = tmp_path / download.value.suggested_filename
    download.value.save_as(file)
    context = browser.new_context(offline=True)
    try:
        report = context.new_page()
        report.goto(file.as_uri())
        matrix = report.locator("table").filter(has_text="3.10").first
        rows = matrix.locator("tbody tr").all_inner_texts()
        told = "\n".join(rows)
        assert len(rows) == methods * len(TYPED)
        assert all(f"3.{k}" in told for k in range(1, 11))
        assert all(any(word in row for word in ("met", "missed", "open")) for row in rows)
        text = report.locator("body").inner_text()
        assert "Worst case of the log" in text and "95 %" in text
    finally:
        context.close()
