"""The pool of callbacks: turns by visitor, order, coalescing, bounds."""

import threading

import pytest

from navcore.foundation import stage_cache
from schuler_bench.bridge.pool import MOST_WAITING, FairPool


def same_text(call: object, arguments: tuple[object, ...]) -> object:
    return arguments[1] if len(arguments) > 1 else None


@pytest.fixture
def pool():
    made = FairPool(2, key=lambda arguments: arguments[0], same=same_text)
    yield made
    made.shutdown()


def test_one_visitor_has_one_callback_at_a_time_in_order(pool: FairPool) -> None:
    seen, running, most = [], [0], [0]
    lock = threading.Lock()

    def call(visitor: str, number: int) -> None:
        with lock:
            running[0] += 1
            most[0] = max(most[0], running[0])
        seen.append(number)
        with lock:
            running[0] -= 1

    futures = [pool.submit(call, "a", number) for number in range(20)]
    for future in futures:
        future.result(5.0)
    assert seen == list(range(20)) and most[0] == 1


def test_a_flood_of_one_visitor_does_not_delay_another(pool: FairPool) -> None:
    gate, order = threading.Event(), []
    first = pool.submit(lambda _: gate.wait(5.0), "flood")
    late = [pool.submit(lambda _, n=n: order.append(n), "flood") for n in range(40)]
    pool.submit(lambda _: order.append("other"), "other").result(5.0)
    assert order == ["other"]
    gate.set()
    first.result(5.0)
    late[-1].result(5.0)
    assert order == ["other", *range(40)]


def test_equal_callbacks_that_wait_run_once(pool: FairPool) -> None:
    gate, runs = threading.Event(), []
    began = threading.Event()

    def call(visitor: str, control: str) -> None:
        began.set()
        gate.wait(5.0)
        runs.append(control)

    first = pool.submit(call, "a", "zeta")
    assert began.wait(5.0)
    for _ in range(50):
        pool.submit(call, "a", "zeta")
    last = pool.submit(call, "a", "xi")
    gate.set()
    first.result(5.0)
    last.result(5.0)
    assert runs == ["zeta", "zeta", "xi"]


def test_no_more_than_a_bounded_number_waits(pool: FairPool) -> None:
    gate, runs = threading.Event(), []
    began = threading.Event()

    def hold(_: str) -> None:
        began.set()
        gate.wait(5.0)

    pool.submit(hold, "a")
    assert began.wait(5.0)
    kept = [pool.submit(lambda _: runs.append(1), "a") for _ in range(3 * MOST_WAITING)]
    assert pool.dropped == 2 * MOST_WAITING
    gate.set()
    kept[MOST_WAITING - 1].result(5.0)
    assert len(runs) == MOST_WAITING


def test_what_waits_of_a_visitor_who_has_gone_is_dropped(pool: FairPool) -> None:
    gate, runs, began = threading.Event(), [], threading.Event()

    def hold(_: str) -> None:
        began.set()
        gate.wait(5.0)

    held = pool.submit(hold, "a")
    assert began.wait(5.0)
    pool.submit(lambda _: runs.append(1), "a")
    pool.forget("a")
    gate.set()
    held.result(5.0)
    pool.submit(lambda _: None, "a").result(5.0)
    assert runs == []


def test_a_failure_is_in_the_future_and_the_thread_lives_on(pool: FairPool) -> None:
    def fail(_: str) -> None:
        raise ValueError("broken")

    assert isinstance(pool.submit(fail, "a").exception(5.0), ValueError)
    assert pool.submit(lambda _: 3, "a").result(5.0) == 3


def test_what_a_visitor_s_callbacks_keep_belongs_to_them_and_goes_with_them(
    pool: FairPool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A recording that an upload read stayed for good: it belonged to nobody."""
    monkeypatch.setattr(stage_cache, "_cache", cache := stage_cache.SharedCache(1 << 20))
    pool.work_for("a", "session")
    for visitor in ("a", "b"):
        pool.submit(lambda key: stage_cache.kept(key, lambda: key), visitor).result(5.0)
    stage_cache.keep_only({"session"})
    assert cache.get("a") is not None
    stage_cache.keep_only(frozenset())
    assert (cache.get("a"), cache.get("b") is not None) == (None, True)
    pool.forget("a")
    pool.submit(lambda key: stage_cache.kept(key, lambda: key), "a").result(5.0)
    stage_cache.keep_only(frozenset())
    assert cache.get("a") is not None
