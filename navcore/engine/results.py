"""Files out: the folder of one run (interface.md), made or replaced as a whole."""

from __future__ import annotations

import json
import os
import secrets
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from navcore.engine.measures import metrics
from navcore.engine.run import Run
from navcore.foundation.out import refused, writing
from navcore.foundation.text import Text
from navcore.quantities import COMPONENTS
from navcore.scenario.file import to_toml

if TYPE_CHECKING:
    import pyarrow

Format = Literal["parquet", "csv"]
SCENARIO_FILE, METRICS_FILE, SERIES_STEM = "scenario.toml", "metrics.json", "timeseries"
OUR_FILES = frozenset({SCENARIO_FILE, METRICS_FILE, f"{SERIES_STEM}.parquet", f"{SERIES_STEM}.csv"})


def require_replaceable(folder: str | os.PathLike[str]) -> None:
    """Refuse a folder that a run must not replace: one that is not an earlier run's and holds other files.

    A folder with a run's scenario and metrics is replaced with whatever files lie beside them, but not with
    folders in it, and not where the user stands.

    Raises
    ------
    InputError
        It is no folder, cannot be looked into, or holds what no run writes; that is named.
    """
    folder = Path(folder)
    with writing(folder):
        if not folder.exists() and not folder.is_symlink():
            return
        if not folder.is_dir():
            raise refused(folder, Text("exists and is not a folder"))
        entries = list(os.scandir(folder))
        files = {entry.name for entry in entries if entry.is_file()}
        a_runs = files >= {SCENARIO_FILE, METRICS_FILE} and _exchangeable(folder.resolve())
        foreign = sorted(e.name for e in entries if e.is_dir() or not (a_runs or e.name in OUR_FILES))
    if foreign:
        named = ", ".join(foreign[:3]) + (
            Text(" and {foreign} more", foreign=len(foreign) - 3) if len(foreign) > 3 else ""
        )
        raise refused(
            folder, Text("would be replaced as a whole, but holds what no run wrote: {named}", named=named)
        )


def write_results(run: Run, folder: str | os.PathLike[str], format: Format = "parquet") -> None:
    """Write scenario.toml, metrics.json and timeseries.parquet or .csv into a folder.

    The files are completed beside the folder and then take its place, so that no half-written one is ever
    seen under its name. Where the folder itself cannot be exchanged (a mount point, the current folder, a
    parent that cannot be written), complete files replace those in it one by one.

    Parameters
    ----------
    run : Run
        Also a stopped or diverged one; its metrics say so.
    folder : path
        Made with its parents when missing.
    format : {"parquet", "csv"}
        Of the time series.

    Raises
    ------
    InputError
        The folder is not replaceable (`require_replaceable`), or cannot be written (disk full, read-only).
    """
    require_replaceable(folder)
    target = Path(os.path.realpath(folder))
    with writing(Path(folder)):
        target.parent.mkdir(parents=True, exist_ok=True)
        if _exchangeable(target):
            _exchange(run, target, format)
        else:
            _replace_inside(run, target, format)


def timeseries(run: Run) -> pyarrow.Table:
    """Output rows of all methods one after the other, columns as in interface.md; xi is 0 while undamped.

    A strapdown run adds the navigation solution, a run with a Kalman filter the standard deviations that it
    gives itself; they are empty for the other methods.
    """
    import numpy as np
    import pyarrow as pa

    from navcore.mechanization.recorder import DAMPED_COLUMN, XI_COLUMN

    def joined(column: int) -> np.ndarray:
        return np.concatenate([m.rows[:, column] for m in run.methods])

    names = [m.method.name for m in run.methods]
    counts = [len(m.t_s) for m in run.methods]
    columns: dict[str, object] = {
        "method": pa.array(np.repeat(np.array(names, dtype=object), counts), pa.string()),
        "t_s": np.concatenate([m.t_s for m in run.methods]),
    }
    columns |= {name: joined(index) for index, name in enumerate(COMPONENTS)}
    columns |= {"damped": joined(DAMPED_COLUMN).astype(np.int8), "xi": joined(XI_COLUMN)}
    navigation = [m.navigation for m in run.methods if m.navigation is not None]
    if navigation:
        from navcore.mechanization.strapdown.records import NAVIGATION

        solution = np.concatenate(navigation)
        columns |= {name: solution[:, index] for index, name in enumerate(NAVIGATION)}
    if any(m.sigma is not None for m in run.methods):
        filtered = np.repeat([m.sigma is not None for m in run.methods], counts)
        empty = [np.zeros((len(m.t_s), len(COMPONENTS))) if m.sigma is None else m.sigma for m in run.methods]
        sigma = np.concatenate(empty)
        columns |= {
            f"sigma_{name}": pa.array(sigma[:, index], mask=~filtered)
            for index, name in enumerate(COMPONENTS)
        }
    return pa.table(columns)


def _write_files(run: Run, folder: Path, format: Format) -> list[str]:
    # First what needs imports and may refuse, last what is small.
    series = f"{SERIES_STEM}.{format}"
    _write_series(run, folder / series)
    document = json.dumps(metrics(run), indent=2, allow_nan=False) + "\n"
    (folder / METRICS_FILE).write_text(document, "utf-8")
    (folder / SCENARIO_FILE).write_text(to_toml(run.scenario), "utf-8")
    return [series, METRICS_FILE, SCENARIO_FILE]


def _write_series(run: Run, path: Path) -> None:
    table = timeseries(run)
    if path.suffix == ".csv":
        import pyarrow.csv

        with path.open("wb") as stream:
            # pyarrow puts quotes around every name of a header it writes itself.
            stream.write((",".join(table.column_names) + "\n").encode())
            pyarrow.csv.write_csv(table, stream, pyarrow.csv.WriteOptions(include_header=False))
        return
    import pyarrow.parquet

    with path.open("wb") as stream:
        pyarrow.parquet.write_table(table, stream, compression="zstd")


def _beside(target: Path, role: str) -> Path:
    return target.parent / f".{target.name}.{role}-{secrets.token_hex(4)}"


def _exchangeable(target: Path) -> bool:
    here = Path.cwd()
    if target == here or target in here.parents or os.path.ismount(target):
        return False
    return os.access(target.parent, os.W_OK | os.X_OK)


def _exchange(run: Run, target: Path, format: Format) -> None:
    complete, old = _beside(target, "new"), _beside(target, "old")
    try:
        complete.mkdir()
        _write_files(run, complete, format)
        if target.exists():
            target.rename(old)
        try:
            complete.rename(target)
        except BaseException:
            if old.exists():
                old.rename(target)
            raise
    finally:
        shutil.rmtree(complete, ignore_errors=True)
        shutil.rmtree(old, ignore_errors=True)


def _replace_inside(run: Run, target: Path, format: Format) -> None:
    target.mkdir(exist_ok=True)
    complete = target / f".new-{secrets.token_hex(4)}"
    try:
        complete.mkdir()
        written = _write_files(run, complete, format)
        for name in OUR_FILES - set(written):
            (target / name).unlink(missing_ok=True)
        for name in written:
            os.replace(complete / name, target / name)
    finally:
        shutil.rmtree(complete, ignore_errors=True)
