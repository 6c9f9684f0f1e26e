"""``schuler presets``, and the JSON Schema it points to."""

import json
from pathlib import Path

from app.cli import main
from navcore.scenario.file import presets
from navcore.scenario.schema_file import schema_text


def test_json_lists_every_preset_with_its_source(capsys):
    assert main(["presets", "--json"]) == 0
    captured = capsys.readouterr()
    document = json.loads(captured.out)
    assert list(document) == ["presets", "studies", "schema_file"]
    assert document["studies"] == []
    assert [p["name"] for p in document["presets"]] == sorted(presets())
    assert {"liu-networks", "liu-overshoot", "sun-step", "zha-fast"} <= set(presets())
    for preset in document["presets"]:
        assert list(preset) == ["name", "title", "source", "fidelity"]
        assert all(preset.values())
    assert Path(document["schema_file"]).is_file()


def test_people_get_a_line_a_preset(capsys):
    assert main(["presets"]) == 0
    lines = capsys.readouterr().out.splitlines()
    for name in presets():
        assert any(line.startswith(f"{name} ") for line in lines)


def test_the_schema_file_is_up_to_date(capsys):
    assert main(["presets", "--json"]) == 0
    file = Path(json.loads(capsys.readouterr().out)["schema_file"])
    assert file.read_text("utf-8") == schema_text(), "write it anew: python -m navcore.scenario.schema_file"


def test_the_schema_knows_the_fields_and_their_ranges():
    schema = json.loads(schema_text())
    assert set(schema["properties"]) >= {
        "schema",
        "run",
        "site",
        "motion",
        "imu",
        "reference",
        "method",
        "view",
    }
    duration = schema["$defs"]["RunSettings"]["properties"]["duration_h"]
    assert (duration["exclusiveMinimum"], duration["maximum"], duration["unit"]) == (0.0, 8760.0, "h")
    assert "required" not in schema  # every field has a default
