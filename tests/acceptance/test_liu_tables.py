"""Liu 2021, tables 1 to 3: when to damp and how to come back, over four seeds (the report takes twenty)."""

import numpy as np
import pytest

from navcore.scenario.file import load
from tools.papers import liu_switching
from tools.papers.liu_switching import (
    BEST,
    BRIDGE,
    HARD,
    METHODS,
    NOVEL,
    RAMP,
    added_by,
    daily,
    lasting,
    of_method,
    quiet_episodes,
    ratio,
    turns,
)
from tools.papers.runs import Runs


@pytest.fixture(scope="module")
def runs():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(liu_switching, "SEEDS", range(1, 5))
        yield Runs()


def test_the_presets_methods_are_the_studys():
    assert tuple(m.name for m in load("liu-switching").method) == METHODS[:-1]


def test_episodes_return_to_where_they_began():
    events = lasting(1, turns(load("liu-switching")))
    assert len(events) == 16
    changes = np.array([np.array(e["accel_mps2"]) * e["duration_s"] for e in events])
    np.testing.assert_allclose(changes.sum(axis=0), 0.0, atol=1e-12)
    sizes = np.abs(changes[::2]).max(axis=1)
    assert np.all((sizes >= 0.5) & (sizes <= 1.5))


def test_novel_beats_constant_and_yaw_rate_when_the_log_has_no_standing_error(runs):
    assert ratio(runs, "log only", "position", NOVEL, "constant") < 1.0
    assert ratio(runs, "log only", "position", NOVEL, "yaw_rate") < 1.0


def test_with_a_standing_error_it_is_the_recursion_that_helps_and_not_the_ramp(runs):
    assert ratio(runs, "sea", "position", NOVEL, "constant") < 1.05
    assert ratio(runs, "sea", "velocity", NOVEL, "constant") < 0.7
    assert ratio(runs, "sea", "position", RAMP, "constant") > 2.0
    assert ratio(runs, "sea", "velocity", RAMP, "variation + hard") == pytest.approx(1.0, abs=0.05)


def test_bumpless_is_five_times_better_than_ramp_on_lasting_changes(runs):
    assert ratio(runs, "log only", "velocity", RAMP, BEST) >= 5.0


def test_bumpless_is_better_than_the_papers_methods_at_sea(runs):
    for other in METHODS[1 : METHODS.index(BEST)]:
        for quantity in liu_switching.QUANTITIES:
            assert ratio(runs, "sea", quantity, BEST, other) < 1.0, (other, quantity)


def test_on_the_30_min_episodes_bumpless_is_no_worse_than_hard(runs):
    found = quiet_episodes(runs)
    assert np.all(found[METHODS.index(BEST)] <= found[METHODS.index("variation + hard")])


@pytest.mark.parametrize(("ours", "least"), [(BEST, 5.0), (BRIDGE, 3.0)])
def test_the_changes_of_the_log_add_several_times_less_than_with_ramp(runs, ours, least):
    """Four seeds; over the report's twenty bridge comes to 6.6 +- 0.8 and bumpless to 21 +- 1.4."""
    ramp, found = (added_by(runs, "sea", "velocity", name) for name in (RAMP, ours))
    assert np.all(ramp / found > least)


@pytest.mark.parametrize("case", ["sea", "episodes", "episodes at sea"])
def test_bridge_is_never_worse_than_hard(runs, case):
    bridge, hard = (of_method(runs, case, "velocity", name) for name in (BRIDGE, HARD))
    assert np.all(bridge < hard)


def test_constant_damping_is_worse_in_position_than_none_at_sea(runs):
    constant, free = (of_method(runs, "sea", "position", name) for name in ("constant", "free"))
    assert np.mean(constant - free) > 0.0


def test_five_days_of_episodes_do_not_grow(runs):
    for name in ("variation + hard", RAMP, BEST):
        rms = daily(runs, name)
        assert rms[-1] <= 1.05 * rms[0], name


def test_with_the_papers_recursion_they_do(runs):
    rms = daily(runs, NOVEL)
    assert np.all(np.diff(rms) > 0.0) and rms[-1] > 5.0 * rms[0]
