"""The JSON Schema of a scenario as a file: ``python -m navcore.scenario.schema_file`` writes it anew."""

import json

from navcore.foundation.assets import assets_folder
from navcore.scenario.model import Scenario

SCHEMA_FILE = "scenario.schema.json"


def schema_text() -> str:
    """JSON Schema (draft 2020-12) of a scenario, every field with its description, unit and default."""
    schema = Scenario.model_json_schema(by_alias=True)
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["title"] = "Schuler Bench scenario, schema 1"
    return json.dumps(schema, indent=1, sort_keys=True) + "\n"


if __name__ == "__main__":
    (assets_folder() / SCHEMA_FILE).write_text(schema_text(), "utf-8")
