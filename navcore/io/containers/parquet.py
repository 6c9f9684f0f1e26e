"""Parquet tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from navcore.foundation.errors import Fault, InputError
from navcore.foundation.text import Text
from navcore.io.columns import MOST_COLUMNS
from navcore.io.containers.base import LONGEST_TIME, Container, Part, Raw

if TYPE_CHECKING:
    import pyarrow


class ParquetTable(Container):
    """Columns of a Parquet file."""

    kind = "Parquet table"

    def _parts(self) -> dict[str, Part]:
        import pyarrow.parquet as parquet

        with parquet.ParquetFile(self.path) as file:
            rows, schema = file.metadata.num_rows, file.schema_arrow
            if len(schema.names) > MOST_COLUMNS:
                return dict.fromkeys(schema.names, Part("", None, rows, False, ""))
            return {
                field.name: Part(field.name, None, rows, _is_number(field.type), str(field.type)[:40])
                for field in schema
            }

    def _unpacked(self, wanted: Sequence[int]) -> int:
        import pyarrow.parquet as parquet

        with parquet.ParquetFile(self.path) as file:
            metadata, names = file.metadata, {self.names[index] for index in wanted}
            groups = (metadata.row_group(index) for index in range(metadata.num_row_groups))
            chunks = (group.column(index) for group in groups for index in range(group.num_columns))
            return sum(chunk.total_uncompressed_size for chunk in chunks if chunk.path_in_schema in names)

    def _read(self, wanted: Sequence[int]) -> dict[int, Raw]:
        import pyarrow.parquet as parquet

        names = [self.names[index] for index in wanted]
        with parquet.ParquetFile(self.path) as file:
            for name in names:
                _require_plain(self.path.name, name, file.schema_arrow.field(name).type)
        # A text that repeats is kept once: 0.8 MB of such a column may be gigabytes otherwise.
        texts = [name for name in names if not self.parts[name].is_number]
        with parquet.ParquetFile(self.path, read_dictionary=texts) as file:
            table = file.read(columns=names, use_threads=False)
        return {index: _values(table.column(self.names[index])) for index in wanted}


def _is_number(kind: pyarrow.DataType) -> bool:
    import pyarrow.types as types

    return (
        types.is_floating(kind) or types.is_integer(kind) or types.is_boolean(kind) or types.is_decimal(kind)
    )


def _require_plain(where: str, name: str, kind: pyarrow.DataType) -> None:
    """Refuse lists and structs where times belong, before they are read."""
    import pyarrow.types as types

    text = types.is_string(kind) or types.is_large_string(kind) or types.is_dictionary(kind)
    if not (_is_number(kind) or text or types.is_timestamp(kind) or types.is_date(kind)):
        raise InputError(Fault(where, name, None, Text("must be a column of times")))


def _values(column: pyarrow.ChunkedArray) -> Raw:
    import pyarrow.types as types

    missing = column.is_null().to_numpy()
    if types.is_dictionary(column.type):
        joined = column.unify_dictionaries().combine_chunks()
        chunk = joined.chunk(0) if hasattr(joined, "chunks") else joined
        texts = np.array([str(text)[: LONGEST_TIME + 1] for text in chunk.dictionary.to_pylist()] or [""])
        return texts[chunk.indices.fill_null(0).to_numpy(zero_copy_only=False)], missing
    if types.is_decimal(column.type):
        column = column.cast("float64")
    return np.asarray(column.to_numpy()), missing
