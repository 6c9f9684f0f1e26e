"""The audit says plainly what it found, and that nothing was looked up when nothing was."""

from __future__ import annotations

import json

import pytest

from tests.supply import UNREACHABLE, VULNERABLE, judged


def report(*flaws: dict[str, object]) -> str:
    kept = {"name": "sound", "version": "1.0", "vulns": []}
    return json.dumps({"dependencies": [kept, {"name": "weak", "version": "2.1", "vulns": list(flaws)}]})


def test_nothing_vulnerable():
    assert judged(report(), "") == (0, ["2 packages looked up, none is known to be vulnerable"])


def test_a_vulnerable_package_is_named_with_its_mend():
    code, (line,) = judged(report({"id": "PYSEC-1", "fix_versions": ["2.2"]}), "")
    assert code == VULNERABLE and line == "weak 2.1: PYSEC-1, mended in 2.2"


@pytest.mark.parametrize("said", ["", "not json", "[]", '{"dependencies"'])
def test_no_report_is_no_clean_bill(said: str):
    code, lines = judged(said, "Traceback\nConnectionError: no route\n\n")
    assert code == UNREACHABLE
    assert lines[0].startswith("Nothing was looked up") and lines[1] == "ConnectionError: no route"
