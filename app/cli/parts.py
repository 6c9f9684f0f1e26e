"""``schuler parts``: sensors and logs by name, with the figures that their makers publish."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from navcore.foundation.answers import columns, number
from schuler_bench.cli.terminal import emit_result


@dataclass(frozen=True)
class PartsCommand:
    """List sensors and logs by name, each figure as published with its source, and what grades mean.

    Attributes
    ----------
    json : bool
        Print one JSON document.
    """

    json: bool = False

    def execute(self) -> int:
        """Print the list."""
        document = parts_document()
        emit_result(self.json, document, lambda: [*_lines(document)])
        return 0


def parts_document() -> dict[str, Any]:
    """Parts with block, grade, source, figures and what they do not state; grades."""
    from navcore.sensors.data_sheets import data_sheets, grades

    return {
        "parts": [sheet.document() for sheet in data_sheets().values()],
        "grades": [grade.document() for grade in grades()],
    }


def _lines(document: dict[str, Any]) -> Iterator[str]:
    for part in document["parts"]:
        yield f"{part['name']} ({part['grade']})"
        rows = [
            [one["figure"], f"{number(one['value'], 6)} {one['unit']}", _field(one)]
            for one in part["figures"]
        ]
        yield from (f"  {line}" for line in columns(rows, left=(2,)))
        if part["absent"]:
            yield f"  not stated: {', '.join(part['absent'])}"
        yield f"  source: {part['source']}"
        yield ""
    yield "grades"
    for grade in document["grades"]:
        yield f"  {grade['name']}: {', '.join(grade['figures']) or 'no source found'}"
        if grade["source"]:
            yield f"    source: {grade['source']}"


def _field(figure: dict[str, Any]) -> str:
    if figure["field"] is None:
        return ""
    return f"{figure['field']} = {number(figure['in_field'], 6)}"
