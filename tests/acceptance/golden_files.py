"""The metrics that every preset had when they were last looked at.

``python -m tests.acceptance.golden_files`` writes them anew for all presets, or for those named. Read the
difference before keeping it.
"""

import json
import sys
from pathlib import Path
from typing import Any

from navcore.engine.measures import metrics
from navcore.engine.simulation import simulate
from navcore.scenario.file import load, presets

FOLDER = Path(__file__).resolve().parent / "golden"


def present(name: str) -> list[dict[str, Any]]:
    """Compute the metrics of a preset that must not change: no times, no versions, no wording."""
    kept = ("name", "status", "loop", "errors")
    return [{key: method[key] for key in kept} for method in metrics(simulate(load(name)))["methods"]]


def write(names: list[str]) -> None:
    """Write the golden files."""
    FOLDER.mkdir(exist_ok=True)
    for name in names or list(presets()):
        (FOLDER / f"{name}.json").write_text(json.dumps(present(name), indent=1) + "\n", "utf-8")


if __name__ == "__main__":
    write(sys.argv[1:])
