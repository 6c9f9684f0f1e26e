"""``schuler presets``: the scenarios and studies that come with the product."""

from dataclasses import dataclass
from typing import Any

from schuler_bench.cli.terminal import emit_result


@dataclass(frozen=True)
class PresetsCommand:
    """List the presets and studies, and where the JSON Schema of a scenario lies.

    Attributes
    ----------
    json : bool
        Print one JSON document.
    """

    json: bool = False

    def execute(self) -> int:
        """Print the list."""
        document = presets_document()
        listed = document["presets"]
        width = max(len(preset["name"]) for preset in listed)
        lines = [f"{p['name']:<{width}}  {p['title']} ({p['source']})" for p in listed]
        lines += ["", "studies:", *(f"{s['name']:<{width}}  {s['title']}" for s in document["studies"])]
        lines += ["", f"schema of a scenario:  {document['schema_file']}"]
        emit_result(self.json, document, lambda: lines)
        return 0


def presets_document() -> dict[str, Any]:
    """Presets with title, source and fidelity; studies with title; path of the JSON Schema."""
    from navcore.foundation.assets import asset_path
    from navcore.scenario.file import load, presets
    from navcore.scenario.schema_file import SCHEMA_FILE
    from navcore.study import file as study

    scenarios = {name: load(name) for name in presets()}
    listed = [
        {"name": name, "title": s.title, "source": s.source, "fidelity": s.run.fidelity}
        for name, s in scenarios.items()
    ]
    named = [{"name": name, "title": study.load(name).title} for name in study.studies()]
    return {"presets": listed, "studies": named, "schema_file": str(asset_path(SCHEMA_FILE))}
