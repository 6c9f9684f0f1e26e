"""Visitors of the soak, each kind a function for a process of its own: people, browsers, attackers."""

from __future__ import annotations

import html
import multiprocessing
import random
import re
import statistics
import threading
import time
import urllib.request
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from app.bench.visitor import PAGE_COMMAND, PAGE_PAINTED, PAGE_STATE, Visitor
from tests.browser.fields import box_labels, label_of

if TYPE_CHECKING:
    from multiprocessing.synchronize import Barrier, Event

WINDOW = "1920x1080|Method|Frequency|Errors|Scenario"
ANSWER_S = 30.0
ZETA, DURATION = label_of("network.zeta"), box_labels("run.duration_h")[0]
LONG_RUN_H = 300.0
"""Some seconds of computing, within the memory that a run may take."""
_PER_PROCESS = 8
_CHECKED_EVERY, _CHECKED_FIRST = 25, 7
_ZETA = re.compile(r"zeta = ([0-9.]+)")
_PRE = re.compile(r"<pre[^>]*>(.*)</pre>", re.DOTALL)
_spawn = multiprocessing.get_context("spawn")


@dataclass
class Seen:
    """What some visitors saw.

    Attributes
    ----------
    answers_s : list of float
        From the moved control to the last byte of its answer.
    lost : int
        Moves without an answer.
    wrong, compared : int
        Answers that did not belong to the visitor's own value; answers that were looked at.
    other_numbers, recomputed : int
        Answers whose metrics differ from those of the visitor's scenario, run again in this process; answers
        that were run again.
    seconds : float
        From the moment when all were ready.
    """

    answers_s: list[float] = field(default_factory=list)
    lost: int = 0
    wrong: int = 0
    compared: int = 0
    other_numbers: int = 0
    recomputed: int = 0
    seconds: float = 0.0

    def add(self, other: Seen) -> None:
        self.answers_s += other.answers_s
        self.lost += other.lost
        self.wrong += other.wrong
        self.compared += other.compared
        self.other_numbers += other.other_numbers
        self.recomputed += other.recomputed
        self.seconds = max(self.seconds, other.seconds)

    def quantile_ms(self, hundredth: int) -> float:
        if len(self.answers_s) < 2:
            return float("inf")
        return 1e3 * statistics.quantiles(self.answers_s, n=100, method="inclusive")[hundredth - 1]


@dataclass(frozen=True)
class Order:
    """What a visitor is to do: for how long, with which pauses between two moves, s."""

    port: int
    seconds: float
    pause_s: tuple[float, float]
    check: bool = True


def value_of(number: int, step: int) -> float:
    """Four decimals that no other visitor has near that time, and never the same twice in a row."""
    return round(0.5 + 0.0001 * ((37 * number + 11 * step) % 3000), 4)


def same_numbers(text: str, metrics: dict[str, Any]) -> bool:
    """Whether the metrics that came with a scenario's text are those of running it here."""
    from navcore.engine.measures import metrics as measured
    from navcore.engine.simulation import simulate
    from navcore.scenario.file import parse_toml
    from navcore.scenario.model import Scenario

    found = _PRE.search(text)
    assert found is not None, "no scenario in the tab Scenario"
    scenario = Scenario.parse(parse_toml(html.unescape(found[1]), "tab"), "tab")
    own = measured(simulate(scenario))
    return [own["scenario_sha256"], own["methods"]] == [metrics["scenario_sha256"], metrics["methods"]]


def person(order: Order, number: int, ready: Callable[[], Any], seen: Seen) -> None:
    """Moves zeta to values of their own, and waits for each answer."""
    chance = random.Random(number)
    with Visitor(order.port, f"soak-visitor-{number:06d}") as visitor:
        visitor.set(PAGE_STATE, WINDOW)
        visitor.wait(lambda: visitor.run_number >= 1, "its first run", 180.0)
        visitor.control(ZETA)
        ready()
        began, step = time.monotonic(), 0
        while time.monotonic() < began + order.seconds:
            visitor.rest(chance.uniform(*order.pause_s))
            step += 1
            value, before = value_of(number, step), visitor.run_number
            sent = visitor.set(ZETA, value)
            try:
                visitor.wait(lambda before=before: visitor.run_number > before, "an answer", ANSWER_S)
            except TimeoutError:
                seen.lost += 1
                continue
            seen.answers_s.append(visitor.arrived_s - sent)
            if not order.check:
                continue
            visitor.rest(0.1)
            shown = {float(text) for text in _ZETA.findall(visitor.text)}
            seen.compared += bool(shown)
            seen.wrong += bool(shown) and value not in shown
            if step % _CHECKED_EVERY == _CHECKED_FIRST:
                seen.recomputed += 1
                seen.other_numbers += not same_numbers(visitor.text, visitor.metrics)
        seen.seconds = time.monotonic() - began


def browser(order: Order, number: int, ready: Callable[[], Any], seen: Seen) -> None:
    """The same in headless Chromium: the answer is there when the page carries it."""
    from playwright.sync_api import TimeoutError as PlaywrightTimeout

    from navcore.engine.measures import metrics as measured
    from navcore.engine.simulation import simulate
    from navcore.scenario.file import load
    from tests.browser.driver import Bench
    from tests.chromium import launched

    chance = random.Random(number)
    later = "n => Number(document.querySelector('#sb-run').dataset.run) > n"
    with launched() as chromium:
        page = chromium.new_page(viewport={"width": 1366, "height": 768})
        page.set_default_timeout(120_000)
        sessions: Any = None
        bench = Bench(page, f"http://127.0.0.1:{order.port}/", sessions).open()
        bench.choose("method", "complementary")
        bench.box("network.zeta").wait_for()
        ready()
        began, step = time.monotonic(), 0
        while time.monotonic() < began + order.seconds:
            page.wait_for_timeout(1e3 * chance.uniform(*order.pause_s))
            step += 1
            value, before = value_of(number, step), bench.run
            sent = time.perf_counter()
            bench.box("network.zeta").fill(str(value))
            try:
                page.wait_for_function(later, arg=before, timeout=1e3 * ANSWER_S)
            except PlaywrightTimeout:
                seen.lost += 1
                continue
            seen.answers_s.append(time.perf_counter() - sent)
            if step % _CHECKED_EVERY == _CHECKED_FIRST:
                seen.recomputed += 1
                own = measured(simulate(load("sikuliaq-like", [f"method.2.network.zeta={value}"])))
                shown = bench.metrics
                seen.other_numbers += shown["methods"] != own["methods"]
        seen.seconds = time.monotonic() - began


def _crowd(
    kind: Callable[..., None], order: Order, numbers: list[int], barrier: Barrier, results: Any
) -> None:
    """Some visitors in threads of this process."""
    seen = [Seen() for _ in numbers]

    def one(number: int, mine: Seen) -> None:
        passed = False

        def ready() -> None:
            nonlocal passed
            barrier.wait(300.0)
            passed = True

        try:
            kind(order, number, ready, mine)
        except Exception as error:
            print(f"a visitor ended: {type(error).__name__}: {error}".splitlines()[0], flush=True)
            mine.lost += 1
            if not passed:
                barrier.abort()

    threads = [
        threading.Thread(target=one, args=pair, daemon=True) for pair in zip(numbers, seen, strict=True)
    ]
    for thread in threads:
        thread.start()
        time.sleep(0.1)
    for thread in threads:
        thread.join()
    together = Seen()
    for mine in seen:
        together.add(mine)
    results.put((kind.__name__, together))


def crowds(
    order: Order, people: int, browsers: int = 0, first: int = 0, ready: Callable[[], None] = lambda: None
) -> tuple[Seen, Seen]:
    """People and browsers at the same time, a few people to a process, a browser each; what both saw.

    ``ready()`` is called when all pages stand and the first move is about to be made.
    """
    barrier, results = _spawn.Barrier(people + browsers + 1), _spawn.Queue()
    numbers = list(range(first, first + people))
    parts: list[tuple[Callable[..., None], list[int]]] = [
        (person, numbers[at : at + _PER_PROCESS]) for at in range(0, people, _PER_PROCESS)
    ]
    parts += [(browser, [first + people + i]) for i in range(browsers)]
    started = [
        _spawn.Process(target=_crowd, args=(kind, order, part, barrier, results)) for kind, part in parts
    ]
    for process in started:
        process.daemon = True
        process.start()
    found = {"person": Seen(), "browser": Seen()}
    try:
        barrier.wait(300.0)
        ready()
        for _ in started:
            name, seen = results.get(timeout=order.seconds + 4.0 * ANSWER_S)
            found[name].add(seen)
    finally:
        for process in started:
            process.join(5.0)
            process.kill()
    return found["person"], found["browser"]


# ---------------------------------------------------------------- those who take what they can


def flood_of_a_slider(port: int, number: int, ended: Event) -> None:
    """Moves a slider as fast as the connection takes it, without waiting for any answer."""
    _flood(port, number, ended, ZETA, lambda step: round(0.5 + 0.0001 * (step % 3000), 4))


def flood_of_commands(port: int, number: int, ended: Event) -> None:
    """Asks for another run as often as the connection takes it."""
    _flood(port, number, ended, PAGE_COMMAND, lambda step: f'[[{step},"run",""]]')


def _flood(port: int, number: int, ended: Event, label: str, value: Callable[[int], Any]) -> None:
    with Visitor(port, f"soak-visitor-{number}") as visitor:
        visitor.set(PAGE_STATE, WINDOW)
        visitor.wait(lambda: visitor.run_number >= 1, "its first run", 120.0)
        visitor.control(label)
        step = 0
        while not ended.is_set():
            for _ in range(50):
                step += 1
                visitor.set(label, value(step))
            visitor.rest(0.05)


def long_runs(port: int, number: int, ended: Event, count: int = 10) -> None:
    """Some visitors whose every run takes long, and who start it again and again."""
    threads = [threading.Thread(target=_long_run, args=(port, number + i, ended)) for i in range(count)]
    for thread in threads:
        thread.start()
        time.sleep(0.1)
    for thread in threads:
        thread.join()


def _long_run(port: int, number: int, ended: Event) -> None:
    with Visitor(port, f"soak-visitor-{number}") as visitor:
        visitor.set(PAGE_STATE, WINDOW)
        visitor.wait(lambda: visitor.run_number >= 1, "its first run", 120.0)
        visitor.set(DURATION, LONG_RUN_H)
        visitor.rest(1.0)
        if visitor.notices:
            raise RuntimeError(f"the long run was refused: {visitor.notices[0]}")
        step = 0
        while not ended.is_set():
            visitor.rest(3.0)
            step += 1
            visitor.set(ZETA, round(0.5 + 0.001 * (step % 300), 3))


def long_under_way(port: int) -> float:
    """Long runs that wait or run, as ``/metrics`` tells."""
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/metrics", timeout=30.0) as answer:
        found = re.findall(r"^schuler_(?:waiting|running)_long (\S+)$", answer.read().decode(), re.MULTILINE)
    return sum(map(float, found))


def beside(
    order: Order,
    attack: Callable[..., None] | None,
    processes: int,
    settle_s: float,
    first: int,
    ready: Callable[[], None] = lambda: None,
) -> Seen:
    """What one visitor sees beside others who take what they can."""
    ended = _spawn.Event()
    started = [
        _spawn.Process(target=attack, args=(order.port, first + 1000 * (i + 1), ended), daemon=True)
        for i in range(processes if attack is not None else 0)
    ]
    for process in started:
        process.start()
    try:
        time.sleep(settle_s)
        seen, _ = crowds(order, 1, first=first, ready=ready)
    finally:
        ended.set()
        for process in started:
            process.join(20.0)
            process.kill()
    return seen


# ---------------------------------------------------------------- processor time of one answer


def dragging(port: int, cpu_s: Callable[[], float], seconds: float) -> float:
    """Processor time of an answer while a slider moves, ms: one visitor, the next step at each answer."""
    with _open(port, "drag") as visitor:
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
    with _open(port, "rest") as visitor:
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


@contextmanager
def _open(port: int, name: str) -> Iterator[Visitor]:
    with Visitor(port, f"soak-visitor-{name}") as visitor:
        visitor.set(PAGE_STATE, WINDOW)
        visitor.wait(lambda: visitor.run_number >= 1, "its first run", 120.0)
        visitor.control(ZETA)
        yield visitor


def connects(port: int, count: int, at_once: Sequence[int] = range(20)) -> None:
    """Opens a page and leaves again, ``count`` times, a few at once."""

    def some(worker: int) -> None:
        for turn in range(count // len(at_once)):
            with Visitor(port, f"soak-visitor-connect-{worker}-{turn}") as visitor:
                visitor.set(PAGE_STATE, WINDOW)
                visitor.rest(0.3)

    threads = [threading.Thread(target=some, args=(worker,)) for worker in at_once]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
