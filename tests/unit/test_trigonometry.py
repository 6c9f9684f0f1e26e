"""The vectorised sine and cosine against the C library's."""

import math

import numpy as np
import pytest

from navcore.foundation.compiled import kernel
from navcore.foundation.trigonometry import sincos, sincos_cycles


@kernel
def _pairs(x, out):
    for i in range(x.size):
        out[i, 0], out[i, 1] = sincos(x[i])


@kernel
def _cycle_pairs(x, out):
    for i in range(x.size):
        out[i, 0], out[i, 1] = sincos_cycles(x[i])


@pytest.mark.parametrize("reach", [1.0, 100.0, 1e6])
def test_against_the_c_library(reach: float) -> None:
    edges = [k * math.pi / 4 + d for k in range(-9, 10) for d in (-1e-9, 0.0, 1e-9)]
    x = np.concatenate([np.random.default_rng(1).uniform(-reach, reach, 20_000), [reach, -reach], edges])
    out = np.empty((x.size, 2))
    _pairs(x, out)
    assert np.abs(out - np.column_stack([np.sin(x), np.cos(x)])).max() < 4e-16


def test_whole_cycles_leave_no_trace() -> None:
    part = np.array([0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875])
    few, many = np.empty((8, 2)), np.empty((8, 2))
    _cycle_pairs(part, few)
    _cycle_pairs(part - 2.0**40, many)
    assert np.array_equal(few, many)
    assert np.abs(few - np.column_stack([np.sin(2 * np.pi * part), np.cos(2 * np.pi * part)])).max() < 4e-16


def test_what_is_no_number_stays_none() -> None:
    out = np.empty((2, 2))
    _pairs(np.array([math.nan, math.inf]), out)
    assert np.isnan(out).all()
