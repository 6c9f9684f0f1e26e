"""Records: named numbers that compiled code reads as fast as numbered slots (numpy structured types).

numba reads ``p.law_step`` of a record as one load at a known offset. A record is passed by reference, so a
kernel changes the record that Python holds. A field may be a small array or a record of its own.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

FLAG, COUNT, REAL = "?", "i8", "f8"
"""Types of a field: True or False, a whole number, a number."""
Field = str | np.dtype | tuple[str | np.dtype, tuple[int, ...]]
"""Type of a field, or its type and shape."""


def record_type(**fields: Field) -> np.dtype:
    """Make the type of a record.

    Parameters
    ----------
    **fields : str, dtype or tuple
        Type of each field, or its type and shape, in order.

    Returns
    -------
    dtype
        Aligned. A record without fields holds one that nothing reads: numba knows no empty record.

    Examples
    --------
    >>> record_type(damped=FLAG, offset=(REAL, (2,))).itemsize
    24
    """
    shaped = [(name, *kind) if isinstance(kind, tuple) else (name, kind) for name, kind in fields.items()]
    return np.dtype(shaped or [("nothing", FLAG)], align=True)


def new_record(kind: np.dtype, **values: Any) -> np.void:
    """Make a record, zero but for the given values.

    Parameters
    ----------
    kind : dtype
        From `record_type`.
    **values
        Of fields by name; of a field that is itself a record, a mapping of its values.
    """
    record = np.zeros(1, kind)[0]
    fill_record(record, values)
    return record


def fill_record(record: np.void, values: Mapping[str, Any]) -> None:
    """Set fields of a record; of a field that is itself a record, those that the mapping names."""
    for name, value in values.items():
        if isinstance(value, Mapping):
            fill_record(record[name], value)
        else:
            record[name] = value


def stacked(records: Sequence[np.void], kind: np.dtype) -> np.ndarray:
    """Copy records of one kind into an array, shape (n,)."""
    out = np.zeros(len(records), kind)
    for i, each in enumerate(records):
        out[i] = each
    return out
