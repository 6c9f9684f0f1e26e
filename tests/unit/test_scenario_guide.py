"""docs/scenario.md is what the models say."""

import pytest

from navcore.scenario.guide import guide

pytestmark = pytest.mark.contract


def test_the_guide_is_up_to_date(repo_root):
    written = (repo_root / "docs" / "scenario.md").read_text(encoding="utf-8")
    assert written == guide(), "run `make guide`"


def test_the_guide_names_every_network_policy_and_motion():
    text = guide()
    for word in ("compass", "unity2", "threshold", "legs", "gyro_arw_dpsh", "drift_tau_s", "limit_mps"):
        assert word in text
