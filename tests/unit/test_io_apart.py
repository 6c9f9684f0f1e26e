"""Streams that share no time for a known reason say which."""

import numpy as np
import pytest

from navcore.foundation.errors import InputError
from navcore.io.recording import shared_window
from navcore.io.series import Series


def _series(start_s: float) -> Series:
    time_s = start_s + np.arange(60.0)
    return Series(time_s, np.zeros((60, 1)), np.ones(60, dtype=bool), "log", "HDT")


@pytest.mark.parametrize(
    ("apart_s", "said"),
    [
        (1024 * 604800.0, "1024 weeks"),
        (-2048 * 604800.0 + 7.0, "2048 weeks"),
        (3 * 3600.0, "3 h: is one of them in local time"),
    ],
)
def test_the_reason_is_named(apart_s: float, said: str) -> None:
    with pytest.raises(InputError, match=said):
        shared_window([_series(1.6e9), _series(1.6e9 + apart_s)])


def test_no_reason_is_made_up() -> None:
    with pytest.raises(InputError) as caught:
        shared_window([_series(1.6e9), _series(1.6e9 + 5.3e6)])
    assert "apart" not in str(caught.value)
