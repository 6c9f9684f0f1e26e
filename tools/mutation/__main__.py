"""Mutation run (`make mutation`): draw changes of each room at random, and see which no test notices.

What became of each change is appended to ``FOLDER/results.jsonl``; a change that stands there is not made
again unless ``--again`` asks for the survivors. A room's changes are made in a random order that the seed
fixes, so that those made are a random sample at any time, and a larger sample holds the smaller one. Not part
of `make test`: a change takes 5 to 200 s of CPU time.

    python -m tools.mutation --sample 60 --seed 1 analysis law
    python -m tools.mutation --planted     # those of `planted.toml`, which survived once
"""

import os

for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"

import argparse  # noqa: E402
import json  # noqa: E402
import math  # noqa: E402
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

from tools.mutation.child import Recorder, in_fork, run_tests  # noqa: E402
from tools.mutation.kernels import Closures  # noqa: E402
from tools.mutation.mutants import Mutant  # noqa: E402
from tools.mutation.planted import planted  # noqa: E402
from tools.mutation.results import ROOT, Kept, key, sample, tell_scores  # noqa: E402
from tools.mutation.rooms import INTERPRETED, LEFT_OUT, ROOMS  # noqa: E402

_TEST_S, _INTERPRETED_S, _SLOWER = 3.0, 1.0, 10.0
"""A test of more CPU time on the unchanged tree takes no part (compiled; with kernels run as Python); on a
change a test may take so many times this."""
_RUN_S = 1800.0
"""CPU time of all tests of a change, compiling included; a change that takes longer counts as noticed."""


def main() -> None:
    """Draw the samples, run them, print a line a change and the scores."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("rooms", nargs="*", default=list(ROOMS))
    parser.add_argument("--sample", type=int, default=60, help="changes a room")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "mutation", help="keeps the results")
    parser.add_argument("--minutes", type=float, default=math.inf, help="begin no change after so long")
    parser.add_argument("--interpreted", action="store_true", help="compile no changed kernel (quick, lower)")
    parser.add_argument("--again", action="store_true", help="make those again that survived")
    parser.add_argument("--score", action="store_true", help="make none; tell the score of those made")
    parser.add_argument("--planted", action="store_true", help="make those of `planted.toml`; draw none")
    given = parser.parse_args()
    end = time.monotonic() + 60.0 * given.minutes
    kept = Kept(given.folder)
    samples: dict[str, list[Mutant]] = {
        room: [one for one in planted() if one.room == room]
        if given.planted
        else sample(room, given.sample, given.seed)
        for room in given.rooms
    }
    for room, drawn in samples.items():
        if drawn and not given.score:
            with tempfile.TemporaryDirectory() as folder:
                _Room(room, Path(folder) / "tree", kept, not given.interpreted).run(drawn, given.again, end)
    tell_scores(samples, kept)


class _Room:
    """A copy of the tree, and the tests of a room that pass on it."""

    def __init__(self, room: str, tree: Path, kept: Kept, compiles: bool) -> None:
        self.room, self.tree, self.kept, self.compiles = room, tree, kept, compiles
        ignored = shutil.ignore_patterns(".git", ".venv", "__pycache__", "*.webp", "build")
        shutil.copytree(ROOT, tree, symlinks=True, ignore=ignored)
        first, others = ([f for word in words for f in _test_files(tree, word)] for words in ROOMS[room])
        self.tiers = (first, [file for file in dict.fromkeys(others) if file not in first])
        self.interpreted = [f for word in INTERPRETED.get(room, ()) for f in _test_files(tree, word)]
        self.digest, self.closures = self._kernels()
        everything = [*first, *others]
        in_fork(lambda out: self._tests(everything, None, False, collect_only=True), 300.0)
        self.killers = Counter(
            found["by"].partition("[")[0] for found in kept.results().values() if found["room"] == room
        )
        self.baselines: dict[bool, dict[str, float]] = {}

    def _kernels(self) -> tuple[str, Closures]:
        """Digest and closures of the tree's kernels as they are; none of one that cannot be read."""
        answer = in_fork(lambda out: json.dump(_kernels(self.tree), out), 300.0)
        digest, closures = json.loads(answer) if answer else ("", {})
        return digest, {name: (of, modules) for name, (of, modules) in closures.items()}

    def run(self, drawn: list[Mutant], again: bool, end: float) -> None:
        """Make each change that was not made yet, and keep what became of it."""
        before = self.kept.results()
        for interpret in (False, True):  # on the unchanged tree
            self._baseline(interpret)
        for mutant in drawn:
            old = before.get(key(mutant))
            if time.monotonic() > end:
                return
            if old and not (again and old["fate"] == "survived"):
                continue
            begin = time.monotonic()
            fate, by = self._fate(mutant)
            seconds = round(time.monotonic() - begin, 1)
            self.kept.add(mutant, room=self.room, fate=fate, by=by, seconds=seconds)
            print(f"{fate:9} {seconds:6.1f} s  {mutant.file}:{mutant.line}  {mutant.what}  {by}", flush=True)

    def _fate(self, mutant: Mutant) -> tuple[str, str]:
        """Change the tree and run the tests; a kernel is first judged as Python, which needs no compiler."""
        path = self.tree / mutant.file
        before = path.read_text("utf-8")
        fate, by = "survived", ""
        try:
            path.write_text(mutant.applied(before), "utf-8")
            stages = [(files, False) for files in self.tiers]
            if self._kernels()[1] != self.closures:
                stages = [(self.interpreted, True), *(stages if self.compiles else [])]
            for files, interpret in stages:
                fate, by = self._judge(files, interpret)
                if fate != "survived":
                    break
        finally:
            path.write_text(before, "utf-8")
        return fate, by

    def _judge(self, files: list[str], interpret: bool) -> tuple[str, str]:
        """Run the tests of these files until one fails; fate of the change, and the test that noticed it."""
        order = [name for name in self._order(self.baselines[interpret]) if name.partition("::")[0] in files]
        if not order:
            return "survived", ""

        def work(out: Any) -> None:
            code, recorder = self._tests(files, order, interpret)
            json.dump([code, recorder.bad], out)

        answer = in_fork(work, _RUN_S)
        if answer in ("timeout", ""):
            return ("timeout" if answer else "killed"), answer or "crash"
        code, bad = json.loads(answer)
        for name in bad:
            self.killers[name.partition("[")[0]] += 1
        return ("survived", "") if code == 0 else ("killed", bad[0] if bad else "import or collection")

    def _tests(
        self, files: list[str], order: list[str] | None, interpret: bool, *, collect_only: bool = False
    ) -> tuple[int, Recorder]:
        closures = self.closures
        if interpret and order is None:  # as if every kernel that this room takes part in had changed
            room = f"navcore.{self.room}."
            closures = {
                name: ("" if any(f"{module}.".startswith(room) for module in modules) else digest, modules)
                for name, (digest, modules) in closures.items()
            }
        kept = self.digest, closures
        limit = _limit(interpret) * (1.0 if order is None else _SLOWER)
        return run_tests(self.tree, files, order, kept, interpret, limit, collect_only=collect_only)

    def _order(self, seconds: dict[str, float]) -> list[str]:
        """Tests that noticed a change before, a first case of each test, the rest; the quick ones first."""
        cases: Counter[str] = Counter()
        rank: dict[str, tuple[int, bool, float]] = {}
        for name in sorted(seconds, key=seconds.__getitem__):
            test = name.partition("[")[0]
            rank[name] = (-self.killers[test], cases[test] > 0, seconds[name])
            cases[test] += 1
        return sorted(rank, key=rank.__getitem__)

    def _baseline(self, interpret: bool) -> None:
        """Measure the CPU seconds of each test that passes in time on the tree as it is."""
        if interpret not in self.baselines:
            path = self.kept.folder / f"{self.room}-{'interpreted' if interpret else 'compiled'}.json"
            if not path.is_file():
                files = self.interpreted if interpret else [file for tier in self.tiers for file in tier]

                def work(out: Any) -> None:
                    _, recorder = self._tests(files, None, interpret)
                    bad = set(recorder.bad)
                    json.dump({n: s for n, s in recorder.seconds.items() if n not in bad}, out)

                path.write_text(in_fork(work, 3600.0) if files else "{}", "utf-8")
            every = json.loads(path.read_text("utf-8"))
            found = {name: seconds for name, seconds in every.items() if seconds <= _limit(interpret)}
            self.baselines[interpret] = found
            print(f"{path.stem}: {len(found)} tests, {sum(found.values()):.0f} s", flush=True)


def _limit(interpret: bool) -> float:
    return _INTERPRETED_S if interpret else _TEST_S


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
    from tools.mutation.kernels import kernel_closures

    return kernel_hash(), kernel_closures()


if __name__ == "__main__":
    main()
