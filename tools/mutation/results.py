"""The sample that is drawn, what became of each of its changes, and the scores."""

import hashlib
import json
import random
from pathlib import Path
from typing import Any

from scipy.stats import binomtest

from tools.mutation.equivalent import is_equivalent
from tools.mutation.mutants import Mutant, mutants_of

ROOT = Path(__file__).resolve().parents[2]


def every(room: str) -> list[Mutant]:
    """Every change of a room."""
    return [m for file in sorted((ROOT / "navcore" / room).rglob("*.py")) for m in mutants_of(file, ROOT)]


def sample(room: str, size: int, seed: int) -> list[Mutant]:
    """Draw changes of a room without replacement; a larger sample begins with the smaller one."""
    found = every(room)
    random.Random(f"{seed} {room}").shuffle(found)
    return found[:size]


def key(mutant: Mutant) -> str:
    """Name of a change that another text of its file does not share."""
    source = (ROOT / mutant.file).read_bytes()
    return f"{mutant.name} {hashlib.sha256(source).hexdigest()[:12]}"


class Kept:
    """Outcome of each change, a line each in a folder's ``results.jsonl``."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)

    def results(self) -> dict[str, dict[str, Any]]:
        """By the change's key, what became of it the last time."""
        path = self.folder / "results.jsonl"
        lines = path.read_text("utf-8").splitlines() if path.is_file() else []
        return {found["key"]: found for found in map(json.loads, lines)}

    def add(self, mutant: Mutant, **found: Any) -> None:
        """Append a line."""
        line = {"key": key(mutant), "file": mutant.file, "line": mutant.line, "what": mutant.what, **found}
        with (self.folder / "results.jsonl").open("a", encoding="utf-8") as out:
            out.write(json.dumps(line) + "\n")


def tell_scores(samples: dict[str, list[Mutant]], kept: Kept) -> None:
    """Print how many changes a test noticed, of each room and in all; then the survivors."""
    results = kept.results()
    survivors: list[Mutant] = []
    total = [0, 0, 0]
    for room, drawn in samples.items():
        made = [mutant for mutant in drawn if key(mutant) in results]
        left = [mutant for mutant in made if results[key(mutant)]["fate"] == "survived"]
        equal = sum(map(is_equivalent, left))
        survivors += left
        counts = [len(made) - len(left), equal, len(made)]
        total = [a + b for a, b in zip(total, counts, strict=True)]
        print(_score(f"{room} ({len(every(room))} possible)", *counts))
    print(_score("in all", *total))
    for mutant in survivors:
        state = "equivalent" if is_equivalent(mutant) else "open"
        print(f"{state:10} {mutant.file}:{mutant.line}  {mutant.what}")


def _score(name: str, noticed: int, equal: int, made: int) -> str:
    if made == equal:
        return f"{name}: none made"
    low, high = binomtest(noticed, made - equal).proportion_ci(method="wilson")
    text = f"{name}: noticed {noticed} of {made - equal}, {100.0 * noticed / (made - equal):.1f} %"
    return f"{text}, 95 % interval {100.0 * low:.1f} to {100.0 * high:.1f} %; {equal} equivalent left out"
