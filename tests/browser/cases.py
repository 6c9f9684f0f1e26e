"""Windows in which the page is looked at, and which cases of a test `make test` leaves out."""

from collections.abc import Iterable
from typing import Any

import pytest

SIZES = [(1920, 1080), (1366, 768), (1280, 720)]
"""Windows in which the page is looked at; most tests run in the first."""
SWEEP = [
    pytest.param(SIZES[0], marks=pytest.mark.slow),
    pytest.param(SIZES[1], marks=pytest.mark.nightly),
    SIZES[2],
]
"""The same for a test that runs in all of them: always in the smallest, in the one in the middle at night."""


def first_of(cases: Iterable[Any]) -> list[Any]:
    """Cases of a test, of which all but the first are slow."""
    return [pytest.param(case, marks=pytest.mark.slow if n else ()) for n, case in enumerate(cases)]
