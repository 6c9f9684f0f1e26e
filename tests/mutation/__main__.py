"""Mutation run (`make mutation`): draw changes of a room at random, and see which no test notices.

What became of each change is appended to ``build/mutation/results.jsonl``; a change that stands there is not
made again unless ``--again`` asks for the survivors. Not part of `make test`: a change takes 5 to 60 s.

    python -m tests.mutation --sample 40 --seed 1 analysis law
"""

from __future__ import annotations

import os

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"

import argparse  # noqa: E402
import hashlib  # noqa: E402
import json  # noqa: E402
import math  # noqa: E402
import random  # noqa: E402
import shutil  # noqa: E402
import sys  # noqa: E402
import tempfile  # noqa: E402
import time  # noqa: E402
from collections import Counter  # noqa: E402
from pathlib import Path  # noqa: E402
from typing import Any  # noqa: E402

import numba  # noqa: E402, F401
import numpy as np  # noqa: E402, F401
import pydantic  # noqa: E402, F401
import scipy.linalg  # noqa: E402, F401
import scipy.signal  # noqa: E402, F401

from tests.mutation.child import in_fork, run_tests  # noqa: E402
from tests.mutation.kernels import Closures  # noqa: E402
from tests.mutation.mutants import Mutant, changed, mutants_of  # noqa: E402
from tests.mutation.rooms import INTERPRETED, LEFT_OUT, ROOMS  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
KEPT = ROOT / "build" / "mutation"
_TEST_S, _RUN_S = 1.5, 300.0
"""A slower test on the unchanged tree is left out; a slower run on a change is "timeout"."""


def main() -> None:
    """Draw the samples, run them, print a line a change and the score of each room."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("rooms", nargs="*", default=list(ROOMS))
    parser.add_argument("--sample", type=int, default=40, help="changes a room")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=math.inf, help="begin no change after so long")
    parser.add_argument("--again", action="store_true", help="make those again that survived")
    parser.add_argument("--score", action="store_true", help="make none; tell the score of those made")
    given = parser.parse_args()
    end = time.monotonic() + 60.0 * given.minutes
    KEPT.mkdir(parents=True, exist_ok=True)
    for room in given.rooms:
        sample = _sample(room, given.sample, given.seed)
        if not given.score:
            with tempfile.TemporaryDirectory() as folder:
                _Room(room, Path(folder) / "tree").run(sample, given.again, end)
        _tell_score(room, sample)


def _sample(room: str, size: int, seed: int) -> list[Mutant]:
    every = [m for file in sorted((ROOT / "navcore" / room).rglob("*.py")) for m in mutants_of(file, ROOT)]
    return random.Random(seed).sample(every, min(size, len(every)))


def _results() -> dict[str, dict[str, Any]]:
    """What became of each change, the last time it was made."""
    path = KEPT / "results.jsonl"
    lines = path.read_text("utf-8").splitlines() if path.is_file() else []
    return {found["key"]: found for found in map(json.loads, lines)}


def _key(mutant: Mutant) -> str:
    source = (ROOT / mutant.file).read_bytes()
    return f"{mutant.name} {hashlib.sha256(source).hexdigest()[:12]}"


class _Room:
    """A copy of the tree, and the tests of a room that pass on it."""

    def __init__(self, room: str, tree: Path) -> None:
        self.room, self.tree = room, tree
        ignored = shutil.ignore_patterns(".git", ".venv", "__pycache__", "*.webp", "build")
        shutil.copytree(ROOT, tree, ignore=ignored)
        first, others = ([f for word in words for f in _test_files(tree, word)] for words in ROOMS[room])
        self.tiers = (first, [file for file in dict.fromkeys(others) if file not in first])
        self.kept = json.loads(in_fork(lambda out: json.dump(_kernels(tree), out), 300.0))
        everything = [*first, *others]
        in_fork(
            lambda out: run_tests(tree, everything, None, self.kept, False, 60.0, collect_only=True), 300.0
        )
        by = (found["by"] for found in _results().values() if found["room"] == room and "::" in found["by"])
        self.killers = Counter(name.partition("[")[0] for name in by)
        self.baselines: dict[bool, dict[str, float]] = {}

    def run(self, sample: list[Mutant], again: bool, end: float) -> None:
        """Make each change that was not made yet, and keep what became of it."""
        before = _results()
        for mutant in sample:
            old = before.get(_key(mutant))
            if time.monotonic() > end:
                return
            if old and not (again and old["fate"] == "survived"):
                continue
            begin = time.monotonic()
            fate, by = self._fate(mutant)
            found = {"key": _key(mutant), "room": self.room, "line": mutant.line, "what": mutant.what}
            found |= {"fate": fate, "by": by, "seconds": round(time.monotonic() - begin, 1)}
            with (KEPT / "results.jsonl").open("a", encoding="utf-8") as out:
                out.write(json.dumps(found) + "\n")
            print(
                f"{fate:9} {found['seconds']:6.1f} s  {mutant.file}:{mutant.line}  {mutant.what}  {by}",
                flush=True,
            )

    def _fate(self, mutant: Mutant) -> tuple[str, str]:
        path = self.tree / mutant.file
        before = path.read_text("utf-8")
        interpret = mutant.file.startswith(INTERPRETED)
        seconds = self._baseline(interpret)
        order = self._order(seconds)
        fate, by = "survived", ""
        try:
            path.write_text(changed(before, mutant.place), "utf-8")
            for files in self.tiers:
                fate, by = self._judge(files, [n for n in order if n.partition("::")[0] in files], interpret)
                if fate != "survived":
                    break
        finally:
            path.write_text(before, "utf-8")
        return fate, by

    def _judge(self, files: list[str], order: list[str], interpret: bool) -> tuple[str, str]:
        """Run the tests of these files until one fails; fate of the change, and the test that noticed it."""

        def work(out: Any) -> None:
            code, recorder = run_tests(self.tree, files, order, self.kept, interpret, 10.0 * _TEST_S)
            json.dump([code, recorder.bad], out)

        answer = in_fork(work, _RUN_S)
        if answer in ("timeout", ""):
            return ("timeout" if answer else "killed"), answer or "crash"
        code, bad = json.loads(answer)
        for name in bad:
            self.killers[name.partition("[")[0]] += 1
        return ("survived", "") if code == 0 else ("killed", bad[0] if bad else "import or collection")

    def _order(self, seconds: dict[str, float]) -> list[str]:
        """Tests that noticed a change before, a first case of each test, the rest; the quick ones first."""
        cases: Counter[str] = Counter()
        rank: dict[str, tuple[int, bool, float]] = {}
        for name in sorted(seconds, key=seconds.__getitem__):
            test = name.partition("[")[0]
            rank[name] = (-self.killers[test], cases[test] > 0, seconds[name])
            cases[test] += 1
        return sorted(rank, key=rank.__getitem__)

    def _baseline(self, interpret: bool) -> dict[str, float]:
        """Seconds of each test that passes in time on the unchanged tree."""
        if interpret not in self.baselines:
            path = KEPT / f"{self.room}-{'interpreted' if interpret else 'compiled'}.json"
            if not path.is_file():
                digest, closures = self.kept
                # interpreted: as if every kernel that the law takes part in had changed
                law = {
                    n: ("" if interpret and _uses(modules) else d, modules)
                    for n, (d, modules) in closures.items()
                }

                def work(out: Any) -> None:
                    files = [file for tier in self.tiers for file in tier]
                    _, recorder = run_tests(self.tree, files, None, (digest, law), interpret, 10.0 * _TEST_S)
                    bad = set(recorder.bad)
                    json.dump(
                        {n: s for n, s in recorder.seconds.items() if n not in bad and s <= _TEST_S}, out
                    )

                path.write_text(in_fork(work, 3000.0), "utf-8")
            found = json.loads(path.read_text("utf-8"))
            self.baselines[interpret] = {name: s for name, s in found.items() if s <= _TEST_S}
            total = sum(self.baselines[interpret].values())
            print(f"{self.room}: {len(self.baselines[interpret])} tests, {total:.0f} s", flush=True)
        return self.baselines[interpret]


def _uses(modules: list[str]) -> bool:
    return any(f"{name.replace('.', '/')}/".startswith(INTERPRETED) for name in modules)


def _test_files(tree: Path, pattern: str) -> list[str]:
    found = [
        p
        for folder in ("unit", "acceptance")
        for p in sorted((tree / "tests" / folder).glob(f"{pattern}.py"))
    ]
    return [str(path.relative_to(tree)) for path in found if not any(word in path.name for word in LEFT_OUT)]


def _kernels(tree: Path) -> tuple[str, Closures]:
    os.chdir(tree)
    sys.path[:0] = [str(tree)]
    from navcore.foundation.kernel_cache import kernel_hash
    from tests.mutation.kernels import kernel_closures

    return kernel_hash(), kernel_closures()


def _tell_score(room: str, sample: list[Mutant]) -> None:
    """Print the share of changes that a test noticed, with its 95 % interval (Wilson)."""
    made = [found for mutant in sample if (found := _results().get(_key(mutant)))]
    n = len(made)
    if not n:
        return
    p, z = sum(found["fate"] != "survived" for found in made) / n, 1.96
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    print(f"{room}: {100 * p:.1f} % of {n} noticed, 95 % interval {100 * (middle - half):.0f} to ", end="")
    print(f"{100 * (middle + half):.0f} %", flush=True)


if __name__ == "__main__":
    main()
