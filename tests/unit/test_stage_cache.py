"""The cache of the stages: bounded by bytes, shared fairly, given back when its owners have gone."""

import numpy as np
import pytest

from navcore.foundation import stage_cache
from navcore.foundation.stage_cache import SharedCache, kept, working_for

MIB = 1 << 20


def block(mib: float) -> np.ndarray:
    return np.zeros(int(mib * MIB / 8))


def test_one_owner_with_much_does_not_displace_the_others():
    cache = SharedCache(100 * MIB)
    for visitor in range(10):
        cache.put(("small", visitor), block(3), visitor)
    for number in range(50):
        cache.put(("large", number), block(30), "large")
    assert all(cache.get(("small", visitor)) is not None for visitor in range(10))
    assert cache.get(("large", 49)) is not None
    assert cache.get(("large", 0)) is None
    assert cache.bytes <= 100 * MIB


def test_what_was_used_last_stays():
    cache = SharedCache(10 * MIB)
    for name in "abc":
        cache.put(name, block(3), None)
    cache.get("a")
    cache.put("d", block(3), None)
    assert cache.get("b") is None
    assert cache.get("a") is not None and cache.get("d") is not None


def test_a_value_that_is_larger_than_all_is_not_kept():
    cache = SharedCache(MIB)
    cache.put("small", block(0.5), None)
    cache.put("large", block(2), None)
    assert cache.get("large") is None and cache.get("small") is not None


def test_what_nobody_needs_any_more_is_forgotten(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(stage_cache, "_cache", SharedCache(100 * MIB))
    made = []

    def of(owner: object, key: str) -> None:
        with working_for(owner):
            kept(key, lambda: made.append(key) or block(1))

    of("gone", "g")
    of("here", "h")
    of(None, "n")
    stage_cache.keep_only({"here"})
    for owner, key in (("gone", "g"), ("here", "h"), (None, "n")):
        of(owner, key)
    assert made == ["g", "h", "n", "g"]
    assert stage_cache._cache.bytes < 4 * MIB
