"""Files out: the results of one run in a folder (interface.md)."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from navcore.engine.measures import SeedShare, metrics
from navcore.engine.run import Run
from navcore.foundation.cells import safe_cell
from navcore.foundation.inputs import opened
from navcore.foundation.out import placing, require_folder, utf8, writing
from navcore.quantities import COMPONENTS
from navcore.scenario.file import to_toml
from navcore.scenario.model import Scenario
from navcore.scenario.reads import recordings

if TYPE_CHECKING:
    import numpy as np
    import pyarrow

Format = Literal["parquet", "csv"]
SCENARIO_FILE, METRICS_FILE, SERIES_STEM = "scenario.toml", "metrics.json", "timeseries"
OUR_FILES = frozenset({SCENARIO_FILE, METRICS_FILE, f"{SERIES_STEM}.parquet", f"{SERIES_STEM}.csv"})
_FIRST_COLUMNS = ("method", "t_s", *COMPONENTS)
"""By which the time series of an earlier run are known."""


def require_results(
    scenario: Scenario,
    folder: str | os.PathLike[str],
    format: Format = "parquet",
    reads: Iterable[str | os.PathLike[str]] = (),
) -> None:
    """Refuse a folder to which the results of a scenario cannot be written.

    Parameters
    ----------
    scenario : Scenario
        Its recordings are never replaced.
    folder : path
        May be missing; files of other names in it do not matter.
    format : {"parquet", "csv"}
        Of the time series.
    reads : iterable of path
        Further files that are never replaced: that of the scenario, say.

    Raises
    ------
    InputError
        See `navcore.foundation.out.require_folder`; or a path in the scenario is no UTF-8 text.
    """
    _scenario_text(scenario)
    require_folder(folder, _names(format), [*recordings(scenario), *reads])


def write_results(
    run: Run,
    folder: str | os.PathLike[str],
    format: Format = "parquet",
    reads: Iterable[str | os.PathLike[str]] = (),
    shares: Sequence[SeedShare] = (),
) -> None:
    """Write scenario.toml, metrics.json and timeseries.parquet or .csv into a folder.

    The files take their names once all of them are complete. Files of other names are left alone, but for
    the time series that an earlier run has left there in the other format.

    Parameters
    ----------
    run : Run
        Also a stopped or diverged one; its metrics say so.
    folder : path
        Made with its parents when missing.
    format, reads
        See `require_results`.
    shares
        See `navcore.engine.measures.metrics`.

    Raises
    ------
    InputError
        See `require_results`, or the folder cannot be written (disk full, read-only); what was there stays.
    """
    names = _names(format)
    read = [*recordings(run.scenario), *reads]
    document = json.dumps(metrics(run, shares), indent=2, allow_nan=False) + "\n"
    with placing(folder, names, read) as hidden:
        _write_series(run, hidden / names[0])
        (hidden / METRICS_FILE).write_text(document, "utf-8")
        (hidden / SCENARIO_FILE).write_bytes(_scenario_text(run.scenario))
    for name in OUR_FILES.difference(names):
        _remove_series(Path(folder) / name, read)


def timeseries(run: Run) -> pyarrow.Table:
    """Output rows of all methods one after the other, columns as in interface.md; xi is 0 while undamped.

    A run on ``[ins]`` adds the damped output, and leaves errors that are not known empty. A strapdown run
    adds the navigation solution, a run with a Kalman filter the standard deviations that it gives itself;
    they are empty for the other methods.
    """
    import numpy as np
    import pyarrow as pa

    from navcore.mechanization.recorder import DAMPED_COLUMN, XI_COLUMN

    methods = run.lines

    def joined(column: int) -> np.ndarray:
        return np.concatenate([m.rows[:, column] for m in methods])

    names = [m.method.name for m in methods]
    counts = [len(m.t_s) for m in methods]
    columns: dict[str, object] = {
        "method": pa.array(np.repeat(np.array(names, dtype=object), counts), pa.string()),
        "t_s": np.concatenate([m.t_s for m in methods]),
    }
    columns |= {name: _known(joined(index)) for index, name in enumerate(COMPONENTS)}
    columns |= {"damped": joined(DAMPED_COLUMN).astype(np.int8), "xi": joined(XI_COLUMN)}
    output = [m.output for m in methods if m.output is not None]
    if output:
        from navcore.engine.against import OUTPUT

        damped = np.concatenate(output)
        columns |= {name: _known(damped[:, index]) for index, name in enumerate(OUTPUT)}
    navigation = [m.navigation for m in methods if m.navigation is not None]
    if navigation:
        from navcore.mechanization.strapdown.records import NAVIGATION

        solution = np.concatenate(navigation)
        columns |= {name: solution[:, index] for index, name in enumerate(NAVIGATION)}
    if any(m.sigma is not None for m in methods):
        filtered = np.repeat([m.sigma is not None for m in methods], counts)
        empty = [np.zeros((len(m.t_s), len(COMPONENTS))) if m.sigma is None else m.sigma for m in methods]
        sigma = np.concatenate(empty)
        columns |= {
            f"sigma_{name}": pa.array(sigma[:, index], mask=~filtered)
            for index, name in enumerate(COMPONENTS)
        }
    return pa.table(columns)


def _known(column: np.ndarray) -> pyarrow.Array:
    """Values of a column; what is not a number is left empty."""
    import numpy as np
    import pyarrow as pa

    return pa.array(column, mask=np.isnan(column))


def _names(format: Format) -> tuple[str, str, str]:
    return f"{SERIES_STEM}.{format}", METRICS_FILE, SCENARIO_FILE


def _scenario_text(scenario: Scenario) -> bytes:
    return utf8(to_toml(scenario))


def _remove_series(path: Path, reads: Iterable[str | os.PathLike[str]]) -> None:
    """Remove the time series of an earlier run, which belong to none of the files beside them now."""
    is_read = any(os.path.exists(path) and os.path.exists(file) and path.samefile(file) for file in reads)
    if not path.is_symlink() and not is_read and _first_columns(path) == _FIRST_COLUMNS:
        with writing(path):
            path.unlink()


def _first_columns(path: Path) -> tuple[str, ...]:
    """First columns of time series; empty where there are none."""
    import pyarrow
    import pyarrow.parquet

    try:
        with opened(path) as stream:
            if path.suffix == ".csv":
                header = stream.readline(4096).decode("ascii").strip().split(",")
            else:
                header = pyarrow.parquet.read_schema(stream).names
    except (OSError, ValueError, pyarrow.ArrowException):
        return ()
    return tuple(header[: len(_FIRST_COLUMNS)])


def _write_series(run: Run, path: Path) -> None:
    table = timeseries(run)
    if path.suffix == ".csv":
        import pyarrow.csv

        methods = table["method"].combine_chunks().dictionary_encode()
        safe = pyarrow.array(map(safe_cell, methods.dictionary.to_pylist()), pyarrow.string())
        table = table.set_column(0, "method", safe.take(methods.indices))
        with path.open("wb") as stream:
            # pyarrow puts quotes around every name of a header it writes itself.
            stream.write((",".join(table.column_names) + "\n").encode())
            pyarrow.csv.write_csv(table, stream, pyarrow.csv.WriteOptions(include_header=False))
        return
    import pyarrow.parquet

    with path.open("wb") as stream:
        pyarrow.parquet.write_table(table, stream, compression="zstd")
