"""Notebooks of examples: each runs in a kernel and is exported with its figures; none is kept with output."""

import base64
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
FIGURES = {"1_first_run": 1, "2_design_a_network": 3, "3_monte_carlo": 1}
PLOTLY = "application/vnd.plotly.v1+json"


@pytest.mark.slow
@pytest.mark.parametrize("name", FIGURES)
def test_an_exported_notebook_holds_its_figures(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """As ``jupyter nbconvert --execute --to html``; plotly's default renderer left every figure out."""
    from nbconvert import HTMLExporter
    from nbconvert.preprocessors import ExecutePreprocessor

    monkeypatch.setenv("PYTHONPATH", str(EXAMPLES.parent))
    exporter, executed = HTMLExporter(), ExecutePreprocessor(timeout=100)
    exporter.register_preprocessor(executed, enabled=True)
    page, _ = exporter.from_filename(str(EXAMPLES / f"{name}.ipynb"))
    figures = [
        output["data"][PLOTLY]["data"]
        for cell in executed.nb.cells
        for output in cell.get("outputs", ())
        if PLOTLY in output.get("data", ())
    ]
    drawn = [_first_value(page, call.end()) for call in re.finditer(r'Plotly\.newPlot\(\s*"[^"]+",\s*', page)]
    assert drawn == figures and len(drawn) == FIGURES[name]
    assert all(any(_points(trace["y"]) >= 100 for trace in figure) for figure in drawn)
    assert "plotly.js v" in page and 'src="https://cdn.plot' not in page


def _first_value(text: str, start: int) -> Any:
    return json.JSONDecoder().raw_decode(text, start)[0]


def _points(values: Any) -> int:
    packed = isinstance(values, dict)
    return np.frombuffer(base64.b64decode(values["bdata"]), values["dtype"]).size if packed else len(values)


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.ipynb")), ids=lambda path: path.stem)
def test_notebook_is_kept_without_output(path: Path) -> None:
    assert path.stem in FIGURES
    code = [c for c in json.loads(path.read_text("utf-8"))["cells"] if c["cell_type"] == "code"]
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code)
