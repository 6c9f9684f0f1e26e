"""Sun 2017, Table 1 and eq. 8: the double loop on Sun's own setting, and what it gives instead."""

import numpy as np
import pytest

from navcore.design.sun import Tuning, TuningSettings, tune_table

STEP = 0.05
"""Coarser than Sun's 0.01, for time; the optima below are flat."""


def found(**fields: object) -> Tuning:
    return tune_table(settings=TuningSettings.model_validate({"step": STEP, **fields}))


@pytest.mark.parametrize(("variant", "best"), [("exact", 0.21), ("as_printed", 0.26)])
def test_suns_network_has_no_optimum_near_one_without_a_difference(variant, best):
    # his table has 0.99 at no difference; with gyro drifts alone the least J lies far below
    result = found(network={"id": "pole2", "variant": variant})
    assert result.pairs()[0][1] == pytest.approx(best, abs=STEP + 1e-9)


def test_unity2_rejects_a_constant_difference():
    result = found()
    assert np.ptp(result.best) <= STEP + 1e-9
    assert result.best[0] == pytest.approx(0.16, abs=STEP)
    # 3 kn of constant log error cost no more than a tenth of the gyro drifts' part
    assert np.min(result.cost[-1]) < 1.2 * np.min(result.cost[0])


def test_suns_shape_comes_out_with_a_changing_error_and_the_complementary_network():
    result = found(network={"id": "complementary"}, error="drift")
    knots, best, sun = np.array(result.beside_sun()).T
    assert np.all(np.diff(best) <= 0.0)
    assert best[0] > 0.9 and sun[0] == pytest.approx(0.99)
    falls = knots >= 0.5
    assert np.all(np.abs(best - sun)[falls] <= 0.1)
