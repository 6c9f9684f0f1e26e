"""The rate of a stream is a count over its time, whatever its stamps do."""

import numpy as np
import pytest

from navcore.io.series import stream_report


def _stamps(rate_hz: float, kind: str) -> np.ndarray:
    t = np.arange(0.0, 3600.0, 1.0 / rate_hz)
    random = np.random.default_rng(1)
    if kind == "jitter":
        # host stamps: most a little late, a few very late
        return np.sort(t + random.gamma(0.3, 0.2 / rate_hz, t.size))
    if kind == "bursts":
        # several arrive together
        return np.repeat(t[::10], 10)[: t.size] + np.tile(0.0377 * np.arange(10), t.size // 10 + 1)[: t.size]
    if kind == "sawtooth":
        # the logger's loop takes 5 % longer than the interval, and now and then catches up
        return t + 0.05 / rate_hz * (np.arange(t.size) % 20)
    if kind == "gap":
        return t[(t < 600.0) | (t > 1800.0)]
    return t


@pytest.mark.parametrize("kind", ["even", "jitter", "bursts", "sawtooth", "gap"])
@pytest.mark.parametrize("rate_hz", [1.0, 2.0])
def test_the_rate_is_told_through_jitter_bursts_and_gaps(rate_hz: float, kind: str) -> None:
    time_s = _stamps(rate_hz, kind)
    assert stream_report("VDVBW", time_s.size, True, time_s).rate_hz == pytest.approx(rate_hz, rel=0.005)
