"""A scenario names its source truly: one that was changed is no longer what the paper describes."""

import pytest

from navcore.foundation.text import Text
from navcore.scenario.file import load, presets
from navcore.scenario.provenance import source_of


def test_a_preset_as_it_is_names_its_source() -> None:
    for name in list(presets())[::6]:
        assert source_of(load(name)) == load(name).source


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        (["run.duration_h=3"], "changed in 1 field from liu-step (Liu 2021, fig. 7)"),
        (["run.duration_h=3", "imu.gyro_bias_dph=[1, 0, 0]"],
         "changed in 2 fields from liu-step (Liu 2021, fig. 7)"),
        (["source=own trial"], "own trial"),
        (["view.focus=bode"], "Liu 2021, fig. 7"),
    ],
)  # fmt: skip
def test_a_changed_preset_says_in_how_many_fields(changes: list[str], told: str) -> None:
    assert source_of(load("liu-step", changes)) == told


def test_a_method_more_counts_by_its_fields() -> None:
    scenario = load("liu-step")
    more = scenario.model_copy(update={"method": (*scenario.method, scenario.method[0])})
    told = source_of(more)
    assert isinstance(told, Text) and "from liu-step" in told
