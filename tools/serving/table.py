"""The table of docs/serving.md, written from what the tests and the soak have recorded: ``make serving``.

    python -m tools.serving.table            # run the tests that rows.toml names, and write the table
    python -m tools.serving.table --new      # run only the tests of which the record has nothing
    python -m tools.serving.table --table    # write the table anew from the record

A test records a figure by pytest's ``record_property``; it comes here in the JUnit report. ``make soak``
leaves its rows in build/soak.json, which is taken if it is there. The record, docs/serving.json, stands
beside the page.
"""

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
import time
import tomllib
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
ROWS, PAGE, RECORD = ROOT / "tools/serving/rows.toml", ROOT / "docs/serving.md", ROOT / "docs/serving.json"
SOAK = ROOT / "build/soak.json"
BEGIN, END = "<!-- written by make serving -->\n", "<!-- until here -->\n"
HEAD = "| # | Attack or fault | Wanted | Ours | Met | Shown by |\n|---|---|---|---|---|---|\n"


@dataclass(frozen=True)
class Entry:
    """One row of the table.

    Attributes
    ----------
    what, wanted : str
        The attack or fault; what is wanted then.
    ours : str
        What ours does; ``{name}`` is a recorded figure.
    test : str
        Id of the test that shows it, without its cases; empty: the soak does.
    soak : tuple of str
        Keys of lines of the soak.
    """

    what: str
    wanted: str
    ours: str
    test: str = ""
    soak: tuple[str, ...] = ()

    def line(self, number: int, record: dict[str, Any]) -> str:
        """The row as Markdown."""
        figures, met, shown = self._of_soak(record) if self.soak else self._of_test(record)
        try:
            ours = self.ours.format_map(figures)
        except KeyError:
            ours, met = "not measured", "-"
        return f"| {number} | {self.what} | {self.wanted} | {ours} | {met} | {shown} |\n"

    def _of_test(self, record: dict[str, Any]) -> tuple[dict[str, float], str, str]:
        result = record["tests"].get(self.test, {"outcome": "not run", "figures": {}})
        met = {"passed": "yes", "failed": "**no**"}.get(result["outcome"], "not run")
        return result["figures"], met, f"`{self.test}`"

    def _of_soak(self, record: dict[str, Any]) -> tuple[dict[str, float], str, str]:
        lines = {line["key"]: line for line in record["soak"]["rows"]}
        met = "yes" if all(lines.get(key, {}).get("met") for key in self.soak) else "**no**"
        shown = "`make soak`: " + ", ".join(f"`{key}`" for key in self.soak)
        return {key: line["measured"] for key, line in lines.items()}, met, shown


def machine() -> str:
    """Cores, load, Python and date."""
    load, day = os.getloadavg()[0], time.strftime("%Y-%m-%d", time.gmtime())
    return f"{os.cpu_count()} cores, load {load:.1f} before, Python {platform.python_version()}, {day}"


def entries() -> list[Entry]:
    """All rows, in order."""
    data = tomllib.loads(ROWS.read_text("utf-8"))
    return [Entry(**(row | {"soak": tuple(row.get("soak", ()))})) for row in data["row"]]


def table(rows: list[Entry], record: dict[str, Any]) -> str:
    """The table, and where and when it was measured."""
    lines = "".join(row.line(number, record) for number, row in enumerate(rows, 1))
    soak = record["soak"]["circumstances"] or "not run yet"
    measured = f"Tests: {record['circumstances']}.\nSoak: {soak}.\n"
    return f"{BEGIN}{HEAD}{lines}\n{measured}{END}"


def with_table(page: str, written: str) -> str:
    """The page with this table in place of its own."""
    before, _, rest = page.partition(BEGIN)
    return before + written + rest.partition(END)[2]


def recorded(report: Path) -> dict[str, dict[str, Any]]:
    """Outcome and figures of each test of a JUnit report, all its cases together."""
    found: dict[str, dict[str, Any]] = {}
    for case in ElementTree.parse(report).getroot().iter("testcase"):
        module, name = case.get("classname", ""), case.get("name", "").partition("[")[0]
        parts = module.split(".")
        at = next(i for i, part in enumerate(parts) if part.startswith("test_")) + 1
        test = "::".join(["/".join(parts[:at]) + ".py", *parts[at:], name])
        mine = found.setdefault(test, {"outcome": "skipped", "figures": {}})
        bad = case.find("failure") is not None or case.find("error") is not None
        if bad or mine["outcome"] == "failed":
            mine["outcome"] = "failed"
        elif case.find("skipped") is None:
            mine["outcome"] = "passed"
        for figure in case.iter("property"):
            name, value = figure.get("name", ""), float(figure.get("value", "nan"))
            mine["figures"][name] = round(max(mine["figures"].get(name, value), value), 4)
    return found


def measure(tests: list[str]) -> dict[str, dict[str, Any]]:
    """Run the tests, each folder in a process of its own, and read what they recorded."""
    found: dict[str, dict[str, Any]] = {}
    for stage in sorted({Path(test).parts[1] for test in tests}):
        with tempfile.TemporaryDirectory() as folder:
            report = Path(folder) / "report.xml"
            mine = [test for test in dict.fromkeys(tests) if Path(test).parts[1] == stage]
            command = [sys.executable, "-m", "pytest", "-q", f"--junitxml={report}", *mine]
            subprocess.run(
                command, cwd=ROOT, env=os.environ | {"SCHULER_NIGHTLY": "1"}, stdin=subprocess.DEVNULL
            )
            found |= recorded(report)
    return found


def main() -> int:
    """Measure, keep the record, write the table; 1 when a row is not met."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--table", action="store_true", help="from the record, without measuring")
    parser.add_argument("--new", action="store_true", help="run only tests that the record does not have")
    parser.add_argument("--soak", type=Path, default=SOAK, help="what make soak has left, if it is there")
    arguments = parser.parse_args()
    rows, record = entries(), json.loads(RECORD.read_text("utf-8"))
    if arguments.soak.exists():
        record["soak"] = json.loads(arguments.soak.read_text("utf-8"))
    named = [row.test for row in rows if row.test]
    if arguments.new:
        known = {test: found for test, found in record["tests"].items() if test in named}
        record["tests"] = known | measure([test for test in named if test not in known])
    elif not arguments.table:
        record["circumstances"] = machine()
        record["tests"] = measure(named)
    RECORD.write_text(json.dumps(record, indent=1, sort_keys=True) + "\n", "utf-8")
    written = table(rows, record)
    PAGE.write_text(with_table(PAGE.read_text("utf-8"), written), "utf-8")
    not_met = [line for line in written.splitlines() if "| **no** |" in line or "| - |" in line]
    print("\n".join([f"{len(rows) - len(not_met)} of {len(rows)} rows are met", *not_met]))
    return int(bool(not_met))


if __name__ == "__main__":
    sys.exit(main())
