"""Deng 2019, tables 1, 2 and 4: what remains of the Schuler oscillation, and how far the errors scatter."""

import numpy as np
import pytest

from navcore.engine.run import Run
from navcore.scenario.file import load
from tools.papers.deng import (
    DAMPED,
    PRINTED,
    SLOW,
    TABLE_1,
    TABLE_2,
    errors,
    improvement,
    largest_tilt,
    schuler_swing,
    tilt,
)
from tools.papers.deng_alignment import tilt_difference
from tools.papers.runs import Runs


class CoarseRuns(Runs):
    """IMU and log at 50 Hz in place of 200 Hz; half the noise of a sample is the same density."""

    def __call__(self, preset: str, *overrides: str) -> Run:
        """Run of a preset with further overrides."""
        return super().__call__(
            preset, "run.rate_hz=50", "reference.rate_hz=50", "reference.noise_mps=0.1", *overrides
        )


@pytest.fixture(scope="module")
def runs() -> Runs:
    return Runs()


@pytest.fixture(scope="module")
def drives() -> Runs:
    """Runs of the drive: the loop follows a tenth of a hertz, and 50 Hz take a fifth of the time."""
    return CoarseRuns()


def test_the_setting_is_the_papers():
    for name, attitude in (("deng-static", (6.0, 8.0, 75.0)), ("deng-swing", (8.0, 6.0, 75.0))):
        scenario = load(name)
        assert scenario.run.fidelity == "strapdown" and scenario.run.rate_hz == 200.0
        assert scenario.run.duration_h == 1.5
        motion = scenario.canonical()["motion"]
        assert (motion["pitch_deg"], motion["roll_deg"], motion["heading_deg"]) == attitude
        assert scenario.imu.gyro_bias_dph == (0.02, 0.02, 0.02)
        assert scenario.imu.gyro_arw_dpsh == 0.006
        assert (scenario.reference.noise_mps, scenario.reference.rate_hz) == (0.2, 200.0)
    swing = load("deng-swing").canonical()["motion"]
    angles = [swing[name] for name in ("roll", "pitch", "heading")]
    assert [angle["amplitude_deg"] for angle in angles] == [12.0, 10.0, 6.0]
    assert [angle["frequency_hz"] for angle in angles] == [0.125, 0.2, 0.15]


@pytest.mark.parametrize(("preset", "table"), [("deng-static", TABLE_1), ("deng-swing", TABLE_2)])
def test_spread_of_level_attitude_and_velocity_is_the_papers_within_a_factor_of_two(runs, preset, table):
    ours = np.std(errors(runs, preset, DAMPED), axis=0)
    for row in (0, 1, 3, 4):
        assert table[row][1] / 2.0 < ours[row] < table[row][1] * 2.0


@pytest.mark.parametrize("preset", ["deng-static", "deng-swing"])
def test_a_slower_loop_lets_less_of_the_logs_noise_through(runs, preset):
    fast, slow = (np.std(errors(runs, preset, name), axis=0) for name in (DAMPED, SLOW))
    # tilt per noise of the log grows with the bandwidth
    assert np.all(slow[:2] < 0.2 * fast[:2])


@pytest.mark.parametrize("preset", ["deng-static", "deng-swing", "deng-vehicle"])
def test_the_schuler_oscillation_disappears(runs, drives, preset):
    found = drives if preset == "deng-vehicle" else runs
    seeds = range(1, 3)
    free, damped = (schuler_swing(found, preset, name, seeds) for name in ("free", DAMPED))
    assert len(free) == 2 and free[0] != free[1]
    assert np.all(free > 0.1) and np.all(damped < 0.01 * free)


def test_table_4_damping_improves_attitude_velocity_and_position(drives):
    assert np.mean(improvement(drives, 0)) > 1.5
    assert np.mean(improvement(drives, 4)) > 50.0
    assert np.mean(improvement(drives, 7)) > 50.0


def test_at_rest_the_damped_tilt_is_worse_than_the_free_one(runs):
    damped, free = (np.mean(tilt(runs, "deng-static", name)) for name in (DAMPED, "free"))
    assert damped == pytest.approx(27.8, abs=1.0)
    assert free == pytest.approx(20.0, abs=1.5)


def test_network_and_feedback_form_have_the_same_tilt(runs):
    assert np.all(tilt_difference(runs) < 0.02)


def test_the_printed_form_has_transients_when_the_speed_changes(drives):
    assert np.mean(largest_tilt(drives, PRINTED) / largest_tilt(drives, SLOW)) > 1.4
