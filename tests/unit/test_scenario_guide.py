"""docs/scenario.md and the JSON Schema are what the models say."""

import pytest

from navcore.scenario.guide import guide
from navcore.scenario.schema_file import schema_text

pytestmark = pytest.mark.contract


def test_the_guide_is_up_to_date(repo_root):
    written = (repo_root / "docs" / "scenario.md").read_text(encoding="utf-8")
    assert written == guide(), "run `make guide`"


def test_the_schema_file_is_up_to_date(repo_root):
    written = (repo_root / "assets" / "scenario.schema.json").read_text("utf-8")
    assert written == schema_text(), "write it anew: python -m navcore.scenario.schema_file"


def test_the_guide_names_every_network_policy_and_motion():
    text = guide()
    for word in ("compass", "unity2", "threshold", "legs", "gyro_arw_dpsh", "drift_tau_s", "limit_mps"):
        assert word in text
