"""The folder of a study: parts as they come, one file at the end; what is there is never run again."""

from __future__ import annotations

import json
import os
import re
import stat
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from navcore.foundation.inputs import read_bytes
from navcore.foundation.kernel_digest import source_digest
from navcore.foundation.out import HIDDEN, PathLike, refused, require_folder, utf8, whole, writing
from navcore.foundation.text import Text
from navcore.foundation.version import __version__
from navcore.scenario.file import names_files, scenario_hash
from navcore.study.file import to_toml
from navcore.study.model import series_column
from navcore.study.plan import Plan
from navcore.study.running import Row

if TYPE_CHECKING:
    import pyarrow as pa

STUDY_FILE, RUNS_FILE, SUMMARY_FILE, PARTS = "study.toml", "runs.parquet", "summary.json", "parts"
OUR_FILES = (STUDY_FILE, RUNS_FILE, SUMMARY_FILE)
_PART = re.compile(r"(\d{12})-(\d{12})\.parquet")
_LARGEST_STUDY_BYTES = 1 << 24
_GROUP_ROWS = 65_536


class Folder:
    """Results of a study on disk.

    Where results are there already, those of a new study lie with its parts, with a ``study.toml`` of their
    own, and take the place of the earlier ones when they are complete.

    Parameters
    ----------
    path : path
        Of the folder.
    plan : Plan
        The study.
    reads : iterable of path
        Files that the command reads, which are never replaced.
    """

    def __init__(self, path: Path, plan: Plan, reads: Iterable[PathLike] = ()) -> None:
        self.path, self._plan, self._reads = path, plan, tuple(reads)
        self._parts = path / PARTS
        self._schema = schema(plan)

    @contextmanager
    def opened(self, resume: bool) -> Iterator[None]:
        """Make the folder, or go on with or replace the results in it; keep other studies from it meanwhile.

        Files of other names are left alone.

        Parameters
        ----------
        resume : bool
            Go on with what is there.

        Raises
        ------
        InputError
            See `navcore.foundation.out.require_folder`; or the folder holds results of another study,
            unfinished results that are not to be resumed, something else in the place of the parts, or is
            in use; or it cannot be written (disk full, read-only).
        """
        require_folder(self.path, OUR_FILES)
        with self._held():
            with writing(self.path):
                self._claim(resume)
            yield

    @property
    def _beside(self) -> bool:
        """Whether earlier results stay until those of the parts are complete."""
        return (self._parts / STUDY_FILE).exists()

    @property
    def _place(self) -> Path:
        """Folder of the results that the parts belong to."""
        return self._parts if self._beside else self.path

    @contextmanager
    def _held(self) -> Iterator[None]:
        """Make the folder, and hold it against other commands."""
        with writing(self.path):
            self.path.mkdir(parents=True, exist_ok=True)
            held = os.open(self.path, os.O_RDONLY)
        try:
            self._lock(held)
            yield
        finally:
            os.close(held)

    def _lock(self, held: int) -> None:
        import fcntl

        try:
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise refused(self.path, Text("is in use by another command")) from None
        except OSError:  # a file system that knows no locks
            return

    def _claim(self, resume: bool) -> None:
        self._require_own_parts()
        text, study = _identity(self._plan), self._place / STUDY_FILE
        if self.summary() is not None:
            self._remove_parts()  # a kill has left some of them
        if resume and study.exists():
            before = read_bytes(study, _LARGEST_STUDY_BYTES).decode("utf-8", errors="replace")
            if before != text:
                allowed = Text(
                    "holds results of another study ({difference}): give the changed one a folder of its "
                    "own, or leave --resume out to replace them",
                    difference=_difference(before, text),
                )
                raise refused(self.path, allowed)
            require_folder(self.path, (RUNS_FILE, SUMMARY_FILE), self._reads)
            if self.summary() is not None:
                return
        elif self.done():
            allowed = Text("holds unfinished results: --resume goes on; or remove {parts}", parts=self._parts)
            raise refused(self.path, allowed)
        else:
            require_folder(self.path, OUR_FILES, self._reads)
            self._remove_parts()
            self._parts.mkdir(exist_ok=True)
            earlier = any((self.path / name).exists() for name in (RUNS_FILE, SUMMARY_FILE))
            with self._placing(self._parts if earlier else self.path, STUDY_FILE) as file:
                file.write(utf8(text))
        self._parts.mkdir(exist_ok=True)
        self._remove_half_written()

    def _require_own_parts(self) -> None:
        """Refuse a folder of parts in which something else lies, for parts are removed from it."""
        if not os.path.lexists(self._parts):
            return
        if not stat.S_ISDIR(os.lstat(self._parts).st_mode):
            raise refused(self._parts, Text("is not a folder"))
        entries = (entry.name for entry in self._parts.iterdir() if not entry.name.startswith("."))
        foreign = sorted(name for name in entries if not (_PART.fullmatch(name) or name in OUR_FILES))
        if foreign:
            raise refused(
                self._parts, Text("holds what no study wrote: {named}", named=", ".join(foreign[:3]))
            )

    def _remove_parts(self) -> None:
        """Remove the parts, and their folder unless it holds anything else."""
        if self._parts.is_dir():
            self._remove_half_written()
            for name in OUR_FILES:
                (self._parts / name).unlink(missing_ok=True)
            for first, end in self.done():
                self._part(first, end).unlink()
            with suppress(OSError):
                self._parts.rmdir()

    def _remove_half_written(self) -> None:
        for left in self._parts.glob(f"{HIDDEN}*"):
            left.unlink()

    def summary(self) -> dict[str, Any] | None:
        """Return the summary of a study that is complete and in its place; else None."""
        if self._beside:
            return None
        try:
            document = json.loads((self.path / SUMMARY_FILE).read_text("utf-8"))
            return document if document["status"] == "complete" else None
        except (OSError, ValueError, KeyError):
            return None

    def done(self) -> list[tuple[int, int]]:
        """Runs in the parts: ranges from a number to one before another, in order."""
        names = map(_PART.fullmatch, os.listdir(self._parts) if self._parts.is_dir() else ())
        return sorted((int(name[1]), int(name[2])) for name in names if name)

    def missing(self) -> list[tuple[int, int]]:
        """Runs that no part holds, as `done`."""
        found, begin = [], 0
        for first, end in [*self.done(), (self._plan.runs, 0)]:
            if first > begin:
                found.append((begin, first))
            begin = max(begin, end)
        return found

    def write_part(self, first: int, rows: Sequence[Row]) -> None:
        """Keep the rows of the runs from ``first`` on: under another name until they are complete."""
        import pyarrow as pa

        end = rows[-1]["run"] + 1
        self._keep(first, end, pa.Table.from_pylist(rows, self._schema))

    def take(self, runs: bytes) -> None:
        """Put the runs of a ``runs.parquet`` of the same study, stopped earlier, in the place of parts."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        table = pq.read_table(pa.BufferReader(runs))
        numbers = table["run"].to_numpy()
        ends = [*(np.flatnonzero(np.diff(numbers) > 1) + 1), len(numbers)] if len(numbers) else []
        for first, end in zip([0, *ends], ends, strict=False):
            self._keep(numbers[first], numbers[end - 1] + 1, table.slice(first, end - first))

    def join(self) -> Path:
        """Write ``runs.parquet`` from the parts, in the order of the runs; at no time all of it in memory."""
        place = self._place
        with self._placing(place, RUNS_FILE) as file:
            self._write(file, self._grouped())
        return place / RUNS_FILE

    def finish(self, summary: dict[str, Any]) -> None:
        """Write ``summary.json``; a complete study takes the place of earlier results, and has no parts."""
        with self._placing(self._place, SUMMARY_FILE) as file:
            file.write((json.dumps(summary, indent=2, allow_nan=False) + "\n").encode())
        if summary["status"] == "complete":
            if self._beside:
                self._replace_earlier()
            self._remove_parts()

    def _replace_earlier(self) -> None:
        """Replace the earlier results; ``study.toml`` last, so that --resume can end it."""
        require_folder(self.path, OUR_FILES, self._reads)
        with writing(self.path):
            for name in (RUNS_FILE, SUMMARY_FILE, STUDY_FILE):
                os.replace(self._parts / name, self.path / name)

    def _part(self, first: int, end: int) -> Path:
        return self._parts / f"{first:012d}-{end:012d}.parquet"

    def _keep(self, first: int, end: int, table: pa.Table) -> None:
        with writing(self.path), whole(self._part(first, end)) as file:
            self._write(file, [table])

    def _grouped(self) -> Iterator[pa.Table]:
        import pyarrow as pa
        import pyarrow.parquet as pq

        waiting: list[pa.Table] = []
        for first, end in self.done():
            waiting.append(pq.read_table(self._part(first, end)))
            if sum(map(len, waiting)) >= _GROUP_ROWS:
                yield pa.concat_tables(waiting)
                waiting = []
        yield pa.concat_tables([*waiting, self._schema.empty_table()])

    @contextmanager
    def _placing(self, place: Path, name: str) -> Iterator[IO[bytes]]:
        """Give a file that gets its name once complete; what a kill leaves of it lies with the parts."""
        require_folder(self.path, [name], self._reads)
        with writing(self.path), whole(place / name, self._parts) as file:
            yield file

    def _write(self, file: IO[bytes], tables: Iterable[pa.Table]) -> None:
        import pyarrow.parquet as pq

        with pq.ParquetWriter(file, self._schema, compression="zstd") as writer:
            for table in tables:
                writer.write_table(table)


def schema(plan: Plan) -> pa.Schema:
    """Columns of the results."""
    import pyarrow as pa

    number, text, flag = pa.float64(), pa.string(), pa.bool_()
    of_factors = plan.values((0,) * (len(plan.grid) + 1))
    fields = [("run", pa.int64()), ("seed", pa.int64())]
    fields += [(name, text if isinstance(value, str) else number) for name, value in of_factors.items()]
    fields += [("method", text), ("status", text), ("reason", text), ("met", flag)]
    fields += [(key, number) for key in plan.study.output.metrics]
    for k in range(len(plan.scenario.requirement)):
        fields += [(f"requirement_{k}", number), (f"requirement_{k}_met", flag)]
    output = plan.study.output
    names = (series_column(name, hours) for hours in output.epochs_h for name in output.series)
    fields += [(name, number) for name in names]
    return pa.schema(fields)


def _identity(plan: Plan) -> str:
    """Text of ``study.toml``: the complete study, and what else its numbers depend on."""
    files = f", recordings {scenario_hash(plan.scenario)}" if names_files(plan.scenario) else ""
    program = f"# schuler-bench {__version__}, sources {source_digest()}{files}"
    return f"{program}\n{to_toml(plan.study)}"


def _difference(before: str, after: str) -> str:
    """Name the first line that differs."""
    pairs = zip([*before.splitlines(), ""], [*after.splitlines(), ""], strict=False)
    old, new = next((pair for pair in pairs if pair[0] != pair[1]), ("", ""))
    nothing = Text("nothing")
    return Text("{old} there, {new} here", old=old or nothing, new=new or nothing)
