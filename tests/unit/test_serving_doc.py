"""docs/serving.md: its table is the one of the record, and every row names a test or a line of the soak."""

import ast
import json
import re
from pathlib import Path

import pytest

from tools.serving.table import PAGE, RECORD, Entry, entries, recorded, table, with_table

OF_THE_SPECIFICATION = 23
"""Rows of the specification of a server for a group; some are two or three of ours."""


def names(path: Path) -> set[str]:
    """Functions of a module, those of a class as ``Class::function``."""
    found = set()
    for node in ast.parse(path.read_text("utf-8")).body:
        if isinstance(node, ast.FunctionDef):
            found.add(node.name)
        elif isinstance(node, ast.ClassDef):
            found |= {f"{node.name}::{part.name}" for part in node.body if isinstance(part, ast.FunctionDef)}
    return found


def keys_of_the_soak(path: Path) -> re.Pattern[str]:
    """First arguments of ``Row`` and ``counted``: what is put into them at run time is a word or two."""
    keys = re.findall(r'\b(?:Row|counted)\(\s*f?"([^"]+)"', path.read_text("utf-8"))
    return re.compile("|".join(re.sub(r"\{[^}]*\}", "[a-z0-9_]+", key) for key in keys))


def test_every_row_has_its_test_or_line(repo_root: Path) -> None:
    rows = entries()
    assert len(rows) > OF_THE_SPECIFICATION
    keys = keys_of_the_soak(repo_root / "tools" / "serving" / "soak.py")
    assert keys.fullmatch("lecture_p95") and keys.fullmatch("drag_cpu") and not keys.fullmatch("drag")
    for row in rows:
        assert bool(row.test) != bool(row.soak), row.what
        assert all(map(keys.fullmatch, row.soak)), row.what
        if row.test:
            file, _, name = row.test.partition("::")
            assert name in names(repo_root / file), row.test


def test_the_page_holds_the_table_of_the_record() -> None:
    page, record = PAGE.read_text("utf-8"), json.loads(RECORD.read_text("utf-8"))
    assert with_table(page, table(entries(), record)) == page, "python -m tools.serving.table --table"
    assert {row.test for row in entries() if row.test} == set(record["tests"]), "make serving"


REPORT = """<testsuites><testsuite>
<testcase classname="tests.attack.test_a.TestB" name="test_c[x[1]]"><properties>
<property name="told_s" value="0.5"/></properties></testcase>
<testcase classname="tests.attack.test_a.TestB" name="test_c[y]"><properties>
<property name="told_s" value="0.75"/></properties></testcase>
<testcase classname="tests.unit.test_d" name="test_e"><failure/></testcase>
<testcase classname="tests.unit.test_d" name="test_f"><skipped/></testcase>
</testsuite></testsuites>"""


@pytest.mark.parametrize(
    ("row", "line"),
    [
        (Entry("a", "b", "{told_s:.2f} s", "tests/attack/test_a.py::TestB::test_c"), "b | 0.75 s | yes |"),
        (Entry("a", "b", "{nothing} s", "tests/attack/test_a.py::TestB::test_c"), "b | not measured | - |"),
        (Entry("a", "b", "c", "tests/unit/test_d.py::test_e"), "b | c | **no** |"),
        (Entry("a", "b", "c", "tests/unit/test_d.py::test_f"), "b | c | not run |"),
        (Entry("a", "b", "{fast:.0f} ms", soak=("fast",)), "b | 3 ms | yes |"),
        (Entry("a", "b", "{slow:.0f} ms", soak=("fast", "slow")), "b | 9 ms | **no** |"),
        (Entry("a", "b", "{gone:.0f} ms", soak=("gone",)), "b | not measured | - |"),
    ],
)
def test_a_row_tells_what_was_recorded(row: Entry, line: str, tmp_path: Path) -> None:
    (tmp_path / "report.xml").write_text(REPORT)
    soak = [{"key": "fast", "measured": 3.0, "met": True}, {"key": "slow", "measured": 9.0, "met": False}]
    assert line in row.line(1, {"tests": recorded(tmp_path / "report.xml"), "soak": {"rows": soak}})
