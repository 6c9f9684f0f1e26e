"""Metrics of every preset, kept as files that a test compares with: ``tests/acceptance/golden``.

``python -m tools.golden`` writes them anew for all presets, or for those named. Read the difference before
it is committed.
"""

import argparse
import json
from pathlib import Path
from typing import Any

from navcore.engine.measures import metrics
from navcore.engine.simulation import simulate
from navcore.scenario.file import load, presets

FOLDER = Path(__file__).resolve().parents[1] / "tests" / "acceptance" / "golden"


def present(name: str) -> list[dict[str, Any]]:
    """Compute the metrics of a preset that must not change: no times, no versions, no wording."""
    kept = ("name", "status", "loop", "errors")
    return [{key: method[key] for key in kept} for method in metrics(simulate(load(name)))["methods"]]


def main() -> None:
    """Write the golden files of the presets named on the command line, or of all."""
    parser = argparse.ArgumentParser(prog="python -m tools.golden", description=__doc__)
    parser.add_argument("preset", nargs="*", help="preset to compute; all of them when none is named")
    names = parser.parse_args().preset or list(presets())
    if unknown := set(names) - set(presets()):
        parser.error(f"no preset: {', '.join(sorted(unknown))}")
    for name in names:
        (FOLDER / f"{name}.json").write_text(json.dumps(present(name), indent=1) + "\n", "utf-8")


if __name__ == "__main__":
    main()
