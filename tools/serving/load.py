"""Visitors of the soak, each kind a function for a process of its own: people and browsers."""

from __future__ import annotations

import html
import multiprocessing
import random
import re
import statistics
import time
import urllib.request
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from navcore.engine.measures import metrics as measured
from navcore.engine.simulation import simulate
from navcore.scenario.file import load, parse_toml
from navcore.scenario.model import Scenario
from schuler_bench.bench.visitor import PAGE_PAINTED, PAGE_STATE, Visitor
from tests.browser.fields import label_of

if TYPE_CHECKING:
    from multiprocessing.synchronize import Barrier

WINDOW = "1920x1080|Method|Frequency|Errors|Scenario"
ANSWER_S = 30.0
ZETA = label_of("network.zeta")
_PER_PROCESS = 8
_RECOMPUTED_EVERY, _RECOMPUTED_FIRST = 25, 7
_ZETA = re.compile(r"zeta = ([0-9.]+)")
_PRE = re.compile(r"<pre[^>]*>(.*)</pre>", re.DOTALL)
_spawn = multiprocessing.get_context("spawn")


@dataclass
class Seen:
    """Observations of some visitors.

    Attributes
    ----------
    answers_s : list of float
        From the moved control to the last byte of its answer.
    counts : Counter
        ``lost``: moves without an answer. ``compared``: answers that were looked at; ``wrong``: those that
        did not belong to the visitor's own value. ``recomputed``: answers whose scenario was run again in
        this process; ``other``: those whose metrics differ from that.
    seconds : float
        From the moment when all were ready.
    """

    answers_s: list[float] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)
    seconds: float = 0.0

    def add(self, other: Seen) -> None:
        """Add the answers and counts of another visitor."""
        self.answers_s += other.answers_s
        self.counts.update(other.counts)
        self.seconds = max(self.seconds, other.seconds)

    def quantile_ms(self, hundredth: int) -> float:
        """Quantile of the answers' times, ms; infinite for fewer than two answers."""
        if len(self.answers_s) < 2:
            return float("inf")
        return 1e3 * statistics.quantiles(self.answers_s, n=100, method="inclusive")[hundredth - 1]


@dataclass(frozen=True)
class Order:
    """Task of a visitor: for how long, with which pauses between two moves, s."""

    port: int
    seconds: float
    pause_s: tuple[float, float]
    check: bool = True


def value_of(number: int, step: int) -> float:
    """Four decimals that no other visitor has near that time, and never the same twice in a row."""
    return round(0.5 + 0.0001 * ((37 * number + 11 * step) % 3000), 4)


@contextmanager
def opened(port: int, name: object, seconds: float = 120.0) -> Iterator[Visitor]:
    """A page with the slider zeta, after its first run."""
    with Visitor(port, f"soak-visitor-{name}") as visitor:
        visitor.set(PAGE_STATE, WINDOW)
        visitor.wait(lambda: visitor.run_number >= 1, "its first run", seconds)
        visitor.control(ZETA)
        yield visitor


def _move_on(
    order: Order,
    number: int,
    seen: Seen,
    rest: Callable[[float], None],
    answer_s: Callable[[float], float],
    judge: Callable[[float, bool], dict[str, int]],
) -> None:
    """Move zeta to values of one's own for the whole time, and note what became of each move."""
    chance = random.Random(number)
    began, step = time.monotonic(), 0
    while time.monotonic() < began + order.seconds:
        rest(chance.uniform(*order.pause_s))
        step += 1
        value = value_of(number, step)
        try:
            seen.answers_s.append(answer_s(value))
        except TimeoutError:
            seen.counts["lost"] += 1
            continue
        if order.check:
            seen.counts.update(judge(value, step % _RECOMPUTED_EVERY == _RECOMPUTED_FIRST))
    seen.seconds = time.monotonic() - began


def person(order: Order, number: int, ready: Callable[[], Any], seen: Seen) -> None:
    """Moves zeta, waits for each answer, and looks for the value in the scenario that comes with it."""
    with opened(order.port, f"{number:06d}", 180.0) as visitor:

        def answer_s(value: float) -> float:
            before, sent = visitor.run_number, visitor.set(ZETA, value)
            visitor.wait(lambda: visitor.run_number > before, "an answer", ANSWER_S)
            return visitor.arrived_s - sent

        def judge(value: float, again: bool) -> dict[str, int]:
            visitor.rest(0.1)
            values = {float(text) for text in _ZETA.findall(visitor.text)}
            counts: dict[str, int] = {"compared": bool(values), "wrong": bool(values) and value not in values}
            if not again:
                return counts
            text = _PRE.search(visitor.text)
            assert text is not None, "no scenario in the tab Scenario"
            scenario = Scenario.parse(parse_toml(html.unescape(text[1]), "tab"), "tab")
            return counts | _recomputed(scenario, visitor.metrics)

        ready()
        _move_on(order, number, seen, visitor.rest, answer_s, judge)


def browser(order: Order, number: int, ready: Callable[[], Any], seen: Seen) -> None:
    """The same in headless Chromium: the answer is there when the page carries it."""
    from playwright.sync_api import TimeoutError as PlaywrightTimeout

    from tests.browser.driver import Bench
    from tools.chromium import launched

    later = "n => Number(document.querySelector('#sb-run').dataset.run) > n"
    with launched() as chromium:
        page = chromium.new_page(viewport={"width": 1366, "height": 768})
        page.set_default_timeout(120_000)
        sessions: Any = None
        bench = Bench(page, f"http://127.0.0.1:{order.port}/", sessions).open()
        bench.page.evaluate("() => schuler.command('edit-method', '2')")
        bench.box("network.zeta").wait_for()

        def answer_s(value: float) -> float:
            before, sent = bench.run, time.perf_counter()
            bench.box("network.zeta").fill(str(value))
            try:
                page.wait_for_function(later, arg=before, timeout=1e3 * ANSWER_S)
            except PlaywrightTimeout as error:
                raise TimeoutError from error
            return time.perf_counter() - sent

        def judge(value: float, again: bool) -> dict[str, int]:
            own = load("sikuliaq-like", [f"method.2.network.zeta={value}"])
            return _recomputed(own, bench.metrics) if again else {}

        ready()
        _move_on(order, number, seen, lambda s: page.wait_for_timeout(1e3 * s), answer_s, judge)


def _recomputed(scenario: Scenario, shown: dict[str, Any]) -> dict[str, int]:
    """Compare metrics that were sent with those of running the scenario here."""
    own = measured(simulate(scenario))
    keys = ("scenario_sha256", "methods")
    return {"recomputed": 1, "other": [own[key] for key in keys] != [shown[key] for key in keys]}


def _crowd(
    kind: Callable[..., None], order: Order, numbers: list[int], barrier: Barrier, results: Any
) -> None:
    """Some visitors in threads of this process."""

    def visit(number: int) -> Seen:
        seen, all_ready = Seen(), []
        time.sleep(0.1 * (number - numbers[0]))
        try:
            kind(order, number, lambda: all_ready.append(barrier.wait(300.0)), seen)
        except Exception as error:
            print(f"a visitor ended: {type(error).__name__}: {error}".splitlines()[0], flush=True)
            seen.counts["lost"] += 1
            if not all_ready:
                barrier.abort()
        return seen

    together = Seen()
    with ThreadPoolExecutor(len(numbers)) as threads:
        for seen in threads.map(visit, numbers):
            together.add(seen)
    results.put((kind.__name__, together))


@contextmanager
def _processes(works: list[tuple[Callable[..., None], tuple[Any, ...]]], patience_s: float) -> Iterator[None]:
    """Let functions work, each in a process of its own that ends with the context at the latest."""
    started = [_spawn.Process(target=work, args=arguments, daemon=True) for work, arguments in works]
    for process in started:
        process.start()
    try:
        yield
    finally:
        for process in started:
            process.join(patience_s)
            process.kill()


def crowds(
    order: Order, people: int, browsers: int = 0, first: int = 0, ready: Callable[[], None] = lambda: None
) -> tuple[Seen, Seen]:
    """People and browsers at the same time, a few people to a process, a browser each; what both saw.

    ``ready()`` is called when all pages stand and the first move is about to be made.
    """
    barrier, results = _spawn.Barrier(people + browsers + 1), _spawn.Queue()
    numbers = range(first, first + people)
    parts: list[tuple[Callable[..., None], list[int]]] = [
        (person, list(numbers[at : at + _PER_PROCESS])) for at in range(0, people, _PER_PROCESS)
    ]
    parts += [(browser, [first + people + i]) for i in range(browsers)]
    seen = {"person": Seen(), "browser": Seen()}
    with _processes([(_crowd, (kind, order, part, barrier, results)) for kind, part in parts], 5.0):
        barrier.wait(300.0)
        ready()
        for _ in parts:
            name, theirs = results.get(timeout=order.seconds + 4.0 * ANSWER_S)
            seen[name].add(theirs)
    return seen["person"], seen["browser"]


def long_under_way(port: int) -> float:
    """Long runs that wait or run, as ``/metrics`` tells."""
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=30.0) as answer:
        page = answer.read().decode()
    return sum(map(float, re.findall(r"^schuler_(?:waiting|running)_long (\S+)$", page, re.MULTILINE)))


def beside(
    order: Order,
    attack: Callable[..., None] | None,
    processes: int,
    settle_s: float,
    first: int,
    ready: Callable[[], None] = lambda: None,
) -> Seen:
    """Observations of one visitor beside others who take what they can."""
    ended = _spawn.Event()
    arguments = [(order.port, first + 1000 * (i + 1), ended) for i in range(processes)]
    with _processes([(attack, each) for each in arguments if attack is not None], 20.0):
        try:
            time.sleep(settle_s)
            seen, _ = crowds(order, 1, first=first, ready=ready)
        finally:
            ended.set()
    return seen


# ---------------------------------------------------------------- processor time of one answer


def dragging(port: int, cpu_s: Callable[[], float], seconds: float) -> float:
    """Processor time of an answer while a slider moves, ms: one visitor, the next step at each answer."""
    with opened(port, "drag") as visitor:
        visitor.set(PAGE_PAINTED, "0 1")
        visitor.rest(3.0)
        before, began, answers = cpu_s(), time.monotonic(), 0
        while time.monotonic() < began + seconds:
            answers += 1
            last = visitor.picture_number
            visitor.set(ZETA, value_of(1, answers))
            visitor.wait(lambda last=last: visitor.picture_number > last, "a picture", ANSWER_S)
            visitor.set(PAGE_PAINTED, f"{visitor.picture_number} 1")
        return 1e3 * (cpu_s() - before) / answers


def pausing(port: int, cpu_s: Callable[[], float], moves: int, pause_s: float = 2.5) -> float:
    """Processor time of an answer and of all that follows it in a pause, ms; less what an idle page takes."""
    with opened(port, "rest") as visitor:
        visitor.set(ZETA, 0.4)
        visitor.rest(8.0)
        before = cpu_s()
        visitor.rest(5.0)
        idle = (cpu_s() - before) / 5.0
        before, began = cpu_s(), time.monotonic()
        for step in range(moves):
            visitor.set(ZETA, value_of(2, step))
            visitor.rest(pause_s)
        return 1e3 * (cpu_s() - before - idle * (time.monotonic() - began)) / moves


def connects(port: int, count: int, at_once: int = 20) -> None:
    """Opens a page and leaves again, ``count`` times, a few at once."""

    def one(turn: int) -> None:
        with Visitor(port, f"soak-visitor-connect-{turn}") as visitor:
            visitor.set(PAGE_STATE, WINDOW)
            visitor.rest(0.3)

    with ThreadPoolExecutor(at_once) as threads:
        list(threads.map(one, range(count)))
