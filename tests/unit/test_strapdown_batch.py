"""A batch gives each run what the single run gives."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from navcore.design.confirm import confirmed
from navcore.engine.ensemble import drawn, outcomes
from navcore.engine.simulation import simulate
from navcore.foundation.earth import WGS84
from navcore.mechanization.recorder import FINAL, POSITION, spans_from
from navcore.mechanization.strapdown import Settings, start_from, start_run
from navcore.mechanization.strapdown.batch import WIDTH, BatchRun
from navcore.networks.classic import Classic2Network
from navcore.networks.compass import CompassNetwork
from navcore.scenario.model import Scenario
from navcore.sensors.imu import Imu
from navcore.sensors.imu_simulation import ImuSimulation, side_by_side
from tests.strapdown import DENG_SWING, DRIVE, SITE, law, reference

RATE, SECONDS, RUNS = 50.0, 400, WIDTH - 3
NOISY = Imu(gyro_arw_dpsh=0.01, accel_vrw_ugpshz=10.0, gyro_bias_dph=(0.1, -0.2, 0.1))


@pytest.mark.parametrize("motion", [DENG_SWING, DRIVE], ids=["swing", "legs"])
@pytest.mark.parametrize(
    "network", [CompassNetwork(sigma=0.05, xi=0.7), Classic2Network()], ids=["compass", "network"]
)
# the mutation run makes the short ones as Python
@pytest.mark.parametrize(("seconds", "law_s"), [(1, 1.0), (3, 0.5), (SECONDS, 1.0)])
def test_each_run_is_the_single_run(motion, network, seconds, law_s):
    rng, samples = np.random.default_rng(4), int(RATE * seconds)
    sims = [ImuSimulation(motion, SITE, WGS84, NOISY, RATE, samples, seed) for seed in range(RUNS)]
    increments = [np.concatenate([chunk.copy() for chunk, _ in sim.chunks()]) for sim in sims]
    truth, before = sims[0].truth_rows(seconds + 1, 1.0), sims[0].before()
    errors = rng.normal(size=(RUNS, 7)) * np.array([0.1, 0.1, 1e-6, 1e-6, 1e-4, 1e-4, 1e-3])
    starts = [start_from(truth[0], e) for e in errors]
    logs = [reference((0.1 * run, -0.2), seconds) for run in range(RUNS)]
    settings = Settings(RATE, samples, int(RATE * law_s), int(RATE), 1.0)
    laws, spans = (
        [law("external", network, law_s) for _ in range(RUNS)],
        spans_from([(2, math.inf), (seconds // 2, math.inf)]),
    )
    batch = BatchRun(starts, laws, logs, settings, WGS84, truth, spans, before)
    # pieces of no round length, and more than there is
    lanes, piece = np.concatenate([*side_by_side(sims, WIDTH)]), min(777, samples * 2 // 5)
    for part in [lanes[i : i + piece] for i in range(0, samples, piece)] + [lanes[:5]]:
        batch.advance(part)
    for run in (0, 7, RUNS - 1):
        single = start_run(
            starts[run], settings, WGS84, law("external", network, law_s), truth, logs[run], before
        )
        single.recorder.spans[:] = spans
        single.advance(increments[run])
        assert_same_spans(batch.spans[run], single.recorder.spans)
        final = single.recorder.stats[POSITION, FINAL]
        assert batch.position_m[run] == pytest.approx(final, rel=1e-7) and not batch.diverged[run]


def assert_same_spans(ours: np.ndarray, theirs: np.ndarray) -> None:
    for name in ("first", "count"):
        np.testing.assert_array_equal(ours[name], theirs[name])
    for name in ("largest", "sums"):
        np.testing.assert_allclose(ours[name], theirs[name], rtol=1e-7)


BLOCKS: dict[str, Any] = {
    "run": {"duration_h": 0.2, "fidelity": "strapdown", "rate_hz": 20.0, "seed": 5},
    "imu": {"gyro_bias_std_dph": 0.1, "accel_bias_std_ug": 50.0, "gyro_instability_dph": 0.01},
    "initial_error": {"level_std_arcmin": 0.5},
    "reference": {"kind": "log", "noise_mps": 0.1, "bias_std_mps": 0.1},
    "requirement": [{"quantity": "tilt_max_arcsec", "at_most": 30.0, "from_h": 0.1}],
    "method": [
        {"name": "damped", "damping": "external", "network": {"id": "classic2"}},
        {
            "name": "jolted",
            "damping": "internal",
            "event": [{"t_h": 0.1, "duration_s": 60.0, "accel_mps2": [0.02, 0.0]}],
        },
    ],
}
SHIP = Scenario.parse(BLOCKS)


def test_seeds_of_a_strapdown_scenario_come_out_as_their_runs():
    """More seeds than a batch holds, all errors of their sensors, spans of the requirements, two methods."""
    fractions: list[float] = []
    results = outcomes(SHIP, SHIP.method, range(WIDTH + 2), fractions.append)
    assert len(results) == WIDTH + 2
    assert fractions == sorted(fractions) and fractions[-1] == pytest.approx(1.0)
    for number in (0, WIDTH - 1, WIDTH + 1):
        for ours, run in zip(results[number], simulate(drawn(SHIP, number)).methods, strict=True):
            assert ours.ended and ours.final_m == pytest.approx(run.errors["position_m"]["final"], rel=1e-7)
            assert [one.from_s for one in ours.spans] == [0.0, 360.0]
            for one, other in zip(ours.spans, run.spans, strict=True):
                assert one.largest == pytest.approx(other.largest, rel=1e-7)
                assert one.rms == pytest.approx(other.rms, rel=1e-7)


def test_a_search_that_is_cancelled_gives_no_half_batch():
    calls = iter([False, False, True])
    assert outcomes(SHIP, SHIP.method, range(3), cancelled=lambda: next(calls, True)) == []
    assert confirmed(SHIP, SHIP.method[0], SHIP.method[1], 3, cancelled=lambda: True) is None


def test_a_run_that_diverges_in_a_batch_is_reported_as_such():
    unstable = {"damping": "external", "network": {"id": "compass", "sigma": 0.0088, "xi": 0.7}}
    runaway = Scenario.parse(
        BLOCKS
        | {
            "run": {"duration_h": 2.0, "fidelity": "strapdown", "rate_hz": 20.0},
            "reference": {"kind": "log", "rate_hz": 0.01, "bias_std_mps": 0.1},
            "method": [unstable, {"name": "free", "damping": "free"}],
        }
    )
    results = outcomes(runaway, runaway.method, range(2))
    assert [[one.ended for one in pair] for pair in results] == [[False, True]] * 2


def test_what_a_batch_cannot_do_is_refused():
    truth = np.zeros((1, 15))
    settings = Settings(50.0, 50, 50, 50, 1.0)

    def batch(settings, runs=1):
        laws = [law("free", CompassNetwork(), 1.0)] * runs
        starts, logs = [start_from(truth[0])] * runs, [reference((0.0, 0.0), 1)] * runs
        return BatchRun(starts, laws, logs, settings, WGS84, truth, spans_from(()), np.zeros(6))

    for wrong, runs, words in (
        (replace(settings, vertical="altimeter"), 1, "locked"),
        (replace(settings, samples=150, record_every=75), 1, "multiple"),
        (settings, WIDTH + 1, "at most 16 runs, not 17"),
    ):
        with pytest.raises(ValueError, match=words):
            batch(wrong, runs)
