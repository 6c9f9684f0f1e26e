"""A run handed over to other programs: Arrow, pandas, xarray, and files of MATLAB."""

from __future__ import annotations

import keyword
import os
import re
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from navcore.engine.results import timeseries
from navcore.engine.run import Run
from navcore.foundation.errors import Fault, InputError
from navcore.foundation.out import writing
from navcore.foundation.text import Text

if TYPE_CHECKING:
    import pyarrow

_LONGEST_NAME = 63
"""Letters of a name in MATLAB."""


def to_arrow(run: Run) -> pyarrow.Table:
    """Output rows of all methods, columns as in the file ``timeseries.parquet``."""
    return timeseries(run)


def to_pandas(run: Run) -> Any:
    """Return the same as a `pandas.DataFrame`, which needs pandas."""
    _needed("pandas", "to_pandas")
    return timeseries(run).to_pandas()


def to_xarray(run: Run) -> Any:
    """Return the same as an `xarray.Dataset` over method and time, which needs xarray.

    A method that ended early has no values beyond its end.
    """
    xarray = _needed("xarray", "to_xarray")
    table = timeseries(run)
    names = [one.method.name for one in run.lines]
    times = np.asarray(run.t_s)
    rows = [_of(table, name) for name in names]
    variables = {}
    for column in table.column_names[2:]:
        values = np.full((len(names), len(times)), np.nan)
        for k, part in enumerate(rows):
            values[k, : len(part)] = part[column].to_numpy(zero_copy_only=False)
        variables[column] = (("method", "t_s"), values)
    return xarray.Dataset(variables, {"method": names, "t_s": times})


def save(run: Run, path: str | os.PathLike[str]) -> None:
    """Write the rows into one file: ``.mat``, ``.parquet`` or ``.csv``, as its name ends."""
    ending = Path(path).suffix.lower()
    if ending not in (".mat", ".parquet", ".csv"):
        raise InputError(Fault("save", "path", str(path), Text("must end with .mat, .parquet or .csv")))
    table = timeseries(run)
    with writing(path, "path"), open(path, "wb") as file:
        if ending == ".mat":
            from scipy.io import savemat

            savemat(file, matlab_variables(run), long_field_names=True)
        elif ending == ".parquet":
            from pyarrow import parquet

            parquet.write_table(table, file)
        else:
            from pyarrow import csv

            csv.write_csv(table, file)


def matlab_variables(run: Run) -> dict[str, Any]:
    """Return a structure for each method: ``name``, ``t_s`` and the columns.

    The structures bear the methods' names as MATLAB takes them: letters, digits and _, a letter first.
    """
    table = timeseries(run)
    found: dict[str, Any] = {}
    for one in run.lines:
        part = _of(table, one.method.name)
        columns = {name: part[name].to_numpy(zero_copy_only=False) for name in part.column_names[1:]}
        found[matlab_name(one.method.name, found)] = {"name": one.method.name} | columns
    return found


def _of(table: pyarrow.Table, method: str) -> pyarrow.Table:
    """Rows of one method."""
    import pyarrow.compute as pc

    return table.filter(pc.equal(table["method"], method))  # pyright: ignore[reportAttributeAccessIssue]


def matlab_name(text: str, taken: Any = ()) -> str:
    """Return a name that MATLAB takes, and that is none of ``taken``.

    Examples
    --------
    >>> matlab_name("fast (compass)"), matlab_name("2nd", ["m_2nd"]), matlab_name("end")
    ('fast_compass', 'm_2nd_2', 'm_end')
    """
    name = re.sub(r"\W+", "_", text, flags=re.ASCII).strip("_") or "method"
    name = f"m_{name}" if not name[0].isalpha() or keyword.iskeyword(name) or name in _RESERVED else name
    name, number = name[:_LONGEST_NAME], 1
    while name in taken:
        number += 1
        name = f"{name[: _LONGEST_NAME - 4].removesuffix(f'_{number - 1}')}_{number}"
    return name


_RESERVED = frozenset(
    ("case", "catch", "classdef", "end", "function", "otherwise", "parfor", "persistent", "spmd", "switch")
)


def _needed(package: str, what: str) -> Any:
    try:
        return import_module(package)
    except ImportError as error:
        why = Text("needs the package {package}, which is not installed", package=package)
        raise InputError(Fault(what, "", None, why)) from error
