"""A specification of ten requirements: typed into the page or written in a file, it is one matrix."""

import csv
import io
from pathlib import Path

import pytest

from navcore.questions.report import ReportQuestion
from navcore.scenario.file import load
from navcore.scenario.model import Scenario
from schuler_bench.cli import main
from schuler_bench.editing.limits import with_detail, with_limit

FILE = Path(__file__).parents[2] / "examples" / "specification.toml"
TYPED = {
    "position_cep50_m": ("1 nmi", {"at_h": "6", "clause": "3.1"}),
    "position_r95_m": ("2.5 nmi", {"at_h": "6 h", "clause": "3.2"}),
    "position_trms_m": ("1 nmi", {"clause": "3.3"}),
    "reset_interval_h": ("1 nmi", {"at_h": "3", "share": "80", "clause": "3.4"}),
    "heading_seclat_rms_arcmin": ("0.1 deg sec L", {"share": "90", "clause": "3.5"}),
    "roll_rms_arcmin": ("0.01 deg", {"share": "90", "clause": "3.6"}),
    "pitch_rms_arcmin": ("0.01 deg", {"share": "90", "clause": "3.7"}),
    "velocity_rms_mps": ("0.4 kn", {"share": "90", "clause": "3.8"}),
    "settling_s": ("1.5 h", {"clause": "3.9"}),
    "worst_tilt": ("90 arcsec", {"clause": "3.10"}),
}
"""What an engineer types: limit, and the further boxes, by quantity."""


def typed(ship: Scenario) -> Scenario:
    """Scenario with the limits as they are typed into the boxes of the tab Requirements."""
    for key, (limit, details) in TYPED.items():
        ship = with_limit(ship, key, limit)
        for field, text in details.items():
            ship = with_detail(ship, key, field, text)
    return ship


@pytest.fixture(scope="module")
def written() -> Scenario:
    return load(str(FILE))


def test_the_page_and_the_file_are_one_scenario(written: Scenario) -> None:
    bare = written.model_copy(update={"requirement": ()})
    assert typed(bare).requirement == written.requirement


def test_from_ten_requirements_to_matrix_and_report(
    written: Scenario, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """One command; each clause has a verdict, its interval, and what it rests on."""
    out, matrix = tmp_path / "report.html", tmp_path / "matrix.csv"
    given = ["--seeds", "60", "--out", str(out), "--matrix", str(matrix), "--quiet"]
    assert main(["report", str(FILE), *given]) == 0
    capsys.readouterr()
    rows = list(csv.DictReader(io.StringIO(matrix.read_text("utf-8"))))
    assert [row["clause"] for row in rows] == [
        clause for k in range(1, 11) for clause in [f"3.{k}"] * len(written.method)
    ]
    assert {row["verdict"] for row in rows} <= {"met", "missed", "open"}
    for row in rows:
        assert row["how_judged"] and row["rests_on"] and row["result"]
        assert (row["low"] != "") == (
            row["quantity"] in ("position_cep50_m", "position_r95_m", "position_trms_m")
        )
        assert float(row["share_low"]) <= float(row["share"]) <= float(row["share_high"])
    page = out.read_text("utf-8")
    assert all(f"3.{k}" in page for k in range(1, 11)) and "Worst case of the log" in page
    asked = ReportQuestion.ask(
        {"scenario": typed(written.model_copy(update={"requirement": ()})), "seeds": 60}
    )
    assert asked.answer().page in page
